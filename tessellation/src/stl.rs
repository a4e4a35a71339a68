//! STL: triangles alone, as bytes or as text.
//!
//! The binary form has single precision: its coordinates are rounded to 24 bits.

use std::io::{self, Write};

use glam::DVec3;

use crate::mesh::Mesh;

/// Writes meshes as one binary STL.
///
/// # Errors
///
/// More than 2³² - 1 triangles, or those of the writer.
pub fn binary(mut out: impl Write, meshes: &[&Mesh]) -> io::Result<()> {
    let count: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let count = u32::try_from(count).map_err(|_| io::Error::other("binary STL holds at most 4294967295 triangles"))?;
    let mut header = [b' '; 80];
    // a header that begins with "solid" would be taken for the text form
    let title = b"binary STL by perpend";
    header[..title.len()].copy_from_slice(title);
    out.write_all(&header)?;
    out.write_all(&count.to_le_bytes())?;
    for corners in meshes.iter().flat_map(|mesh| mesh.corners()) {
        for DVec3 { x, y, z } in [facet_normal(corners), corners[0], corners[1], corners[2]] {
            for number in [x, y, z] {
                out.write_all(&(number as f32).to_le_bytes())?;
            }
        }
        out.write_all(&[0, 0])?;
    }
    Ok(())
}

/// Writes named solids, of any number of meshes each, as STL text; coordinates read back bit for bit.
///
/// # Errors
///
/// Those of the writer.
pub fn ascii(mut out: impl Write, solids: &[(&str, &[&Mesh])]) -> io::Result<()> {
    for (name, meshes) in solids {
        let name: String = name.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
        writeln!(out, "solid {name}")?;
        for corners in meshes.iter().flat_map(|mesh| mesh.corners()) {
            let DVec3 { x, y, z } = facet_normal(corners);
            writeln!(out, "facet normal {x:e} {y:e} {z:e}\n outer loop")?;
            for DVec3 { x, y, z } in corners {
                writeln!(out, "  vertex {x:e} {y:e} {z:e}")?;
            }
            writeln!(out, " endloop\nendfacet")?;
        }
        writeln!(out, "endsolid {name}")?;
    }
    Ok(())
}

/// The unit normal of a triangle; zero where it has no area, which the format allows.
fn facet_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    fn corner() -> Mesh {
        Mesh {
            vertices: vec![DVec3::ZERO, DVec3::X, 0.1 * DVec3::Y],
            normals: vec![DVec3::Z; 3],
            parameters: vec![DVec2::ZERO; 3],
            triangles: vec![[0, 1, 2]],
            error: 0.0,
        }
    }

    #[test]
    fn a_binary_file_is_a_header_a_count_and_fifty_bytes_a_triangle() {
        let mut bytes = Vec::new();
        binary(&mut bytes, &[&corner(), &corner()]).unwrap();
        assert_eq!(bytes.len(), 84 + 2 * 50);
        assert_eq!(bytes[80..84], 2_u32.to_le_bytes());
        let number = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        assert_eq!([number(84), number(88), number(92)], [0.0, 0.0, 1.0]);
        assert_eq!(number(84 + 12 + 24 + 4), 0.1);
    }

    #[test]
    fn text_names_its_solids_and_keeps_every_bit() {
        let mut text = Vec::new();
        ascii(&mut text, &[("lid", &[&corner()])]).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.starts_with("solid lid\nfacet normal 0e0 0e0 1e0\n outer loop\n  vertex 0e0 0e0 0e0\n"), "{text}");
        assert!(text.contains("vertex 0e0 1e-1 0e0\n") && text.ends_with("endsolid lid\n"), "{text}");
    }
}
