//! Wavefront OBJ: triangles and polylines as text.

use std::io::{self, Write};

use glam::DVec3;

use crate::curve::Polyline;
use crate::mesh::Mesh;

/// An OBJ file under way: one object after the other.
///
/// Vertices and normals are written so that they read back bit for bit.
#[derive(Debug)]
pub struct ObjWriter<W> {
    out: W,
    vertices: usize,
    normals: usize,
}

impl<W: Write> ObjWriter<W> {
    /// Begins a file with a line of comment, as for the unit, which the format has no place for.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn new(mut out: W, comment: &str) -> io::Result<Self> {
        writeln!(out, "# {}", one_line(comment))?;
        Ok(Self { out, vertices: 0, normals: 0 })
    }

    /// Writes a mesh as an object of this name.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn mesh(&mut self, name: &str, mesh: &Mesh) -> io::Result<()> {
        self.object(name, &mesh.vertices)?;
        for DVec3 { x, y, z } in &mesh.normals {
            writeln!(self.out, "vn {x} {y} {z}")?;
        }
        for triangle in &mesh.triangles {
            write!(self.out, "f")?;
            for corner in triangle.map(|i| i as usize + 1) {
                write!(self.out, " {}//{}", self.vertices + corner, self.normals + corner)?;
            }
            writeln!(self.out)?;
        }
        self.vertices += mesh.vertices.len();
        self.normals += mesh.normals.len();
        Ok(())
    }

    /// Writes a polyline as an object of this name.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn polyline(&mut self, name: &str, polyline: &Polyline) -> io::Result<()> {
        self.object(name, &polyline.points)?;
        write!(self.out, "l")?;
        for corner in 1..=polyline.points.len() {
            write!(self.out, " {}", self.vertices + corner)?;
        }
        self.vertices += polyline.points.len();
        writeln!(self.out)
    }

    fn object(&mut self, name: &str, vertices: &[DVec3]) -> io::Result<()> {
        writeln!(self.out, "o {}", one_line(name))?;
        for DVec3 { x, y, z } in vertices {
            writeln!(self.out, "v {x} {y} {z}")?;
        }
        Ok(())
    }
}

/// The text with every control character as a space: a line ends where the format says.
fn one_line(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, polyline, tessellate};
    use perpend_kernel::{Frame, Line, Plane};

    #[test]
    fn objects_follow_each_other_and_count_on() {
        let plane = Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 0.1)).unwrap().to_nurbs().unwrap();
        let line = Line { start: DVec3::X, end: DVec3::Y }.to_nurbs().unwrap();
        let mut text = Vec::new();
        let mut obj = ObjWriter::new(&mut text, "lengths in mm").unwrap();
        obj.polyline("a\nline", &polyline(&line, 1.0, Limits::default()).unwrap()).unwrap();
        obj.mesh("plane", &tessellate(&plane, None, 1.0, Limits::default()).unwrap()).unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "# lengths in mm\no a line\nv 1 0 0\nv 0 1 0\nl 1 2\no plane\nv 0 0 0\nv 1 0 0\nv 1 0.1 0\nv 0 0.1 0\n\
             vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 3//1 4//2 5//3\nf 3//1 5//3 6//4\n"
        );
    }
}
