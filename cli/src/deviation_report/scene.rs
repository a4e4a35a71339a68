//! What the script of the page draws.

use std::collections::HashMap;

use perpend::{Aabb, DVec3, Definition, Entity, EntityId};
use perpend_tessellation::{InvalidChord, Limits, Mesh, polyline, tessellate};
use rayon::prelude::*;
use serde::Serialize;

use crate::deviation_report::base64::numbers;
use crate::deviation_report::colours::STOPS;
use crate::deviation_report::number::Decimals;
use crate::deviation_report::survey::{Measured, Thinned};

/// How many triangles a page holds, more or less: as many as a telephone turns without effort.
const TRIANGLES: usize = 1_000_000;

/// What the script reads. Arrays are little-endian and in base64.
#[derive(Debug, Serialize)]
pub(super) struct Scene {
    unit: &'static str,
    /// Where the colours end.
    limit: f64,
    /// With how many decimals deviations are shown; none: with powers of ten.
    decimals: Option<usize>,
    colours: [[u8; 3]; 9],
    /// The origin of the coordinates that are `f32`.
    centre: [f64; 3],
    faces: Vec<FaceForm>,
    part: PartForm,
    /// The ends of segments, six `f32` each.
    edges: String,
    points: PointsForm,
}

#[derive(Debug, Serialize)]
struct FaceForm {
    id: EntityId,
    name: String,
    /// The first of its corners among those of the triangles, and how many there are; of a curve none.
    first: usize,
    indices: usize,
    /// Red, green and blue from 0 to 1, where it has a colour of its own.
    colour: Option<[f64; 3]>,
}

#[derive(Debug, Default, Serialize)]
struct PartForm {
    /// `f32`.
    vertices: String,
    /// `f32`.
    normals: String,
    /// `u32`.
    triangles: String,
}

#[derive(Debug, Serialize)]
struct PointsForm {
    /// `f64`.
    position: String,
    /// `f64`.
    deviation: String,
    /// `f64`.
    lower_bound: String,
    /// `f64`.
    line: String,
    /// `u32`, into the faces.
    face: String,
    /// `u8`: 1 where the deviation has no sign, 2 where the answer is not certified.
    flags: String,
}

/// The triangles and edges of entities.
#[derive(Debug)]
pub(super) struct Part {
    entities: Vec<Drawn>,
    centre: DVec3,
    /// The largest proven chord error.
    pub(super) error: f64,
    pub(super) triangles: usize,
}

/// An entity with what is drawn of it.
#[derive(Debug)]
struct Drawn {
    id: EntityId,
    name: String,
    colour: Option<[f64; 3]>,
    form: Form,
}

#[derive(Debug)]
enum Form {
    Face(Mesh),
    Curve(Vec<DVec3>),
}

impl Part {
    /// Of these entities, within a chord error.
    pub(super) fn new(entities: &[&Entity], chord: f64) -> Result<Self, InvalidChord> {
        let triangles = (TRIANGLES / entities.len().max(1)).max(1000);
        let limits = Limits { triangles, ..Limits::default() };
        let drawn = entities.par_iter().map(|entity| {
            let (form, error) = match &**entity.definition() {
                Definition::NurbsSurface(surface) => {
                    let mesh = tessellate(surface, entity.trimming().map(AsRef::as_ref), chord, limits)?;
                    let error = mesh.error;
                    (Form::Face(mesh), error)
                }
                Definition::NurbsCurve(curve) => {
                    let line = polyline(curve, chord, limits)?;
                    (Form::Curve(line.points), line.error)
                }
            };
            let (id, name, colour) = (entity.id(), entity.name().to_owned(), entity.colour());
            Ok((Drawn { id, name, colour, form }, error))
        });
        let drawn = drawn.collect::<Result<Vec<_>, InvalidChord>>()?;
        let error = drawn.iter().map(|(_, error)| *error).fold(0.0, f64::max);
        let entities: Vec<Drawn> = drawn.into_iter().map(|(drawn, _)| drawn).collect();
        let bounds = Aabb::around(entities.iter().flat_map(Drawn::points).copied());
        let triangles = entities.iter().map(|drawn| drawn.mesh().map_or(0, |mesh| mesh.triangles.len())).sum();
        Ok(Self { entities, centre: bounds.centre(), error, triangles })
    }

    /// The entities' ids and names, in their order.
    pub(super) fn names(&self) -> impl Iterator<Item = (EntityId, &str)> {
        self.entities.iter().map(|drawn| (drawn.id, drawn.name.as_str()))
    }
}

impl Drawn {
    fn mesh(&self) -> Option<&Mesh> {
        match &self.form {
            Form::Face(mesh) => Some(mesh),
            Form::Curve(_) => None,
        }
    }

    fn points(&self) -> &[DVec3] {
        match &self.form {
            Form::Face(mesh) => &mesh.vertices,
            Form::Curve(points) => points,
        }
    }
}

impl Scene {
    pub(super) fn new(part: &Part, points: &Thinned, unit: &'static str, limit: f64, decimals: Decimals) -> Self {
        let mut faces = Vec::new();
        let (mut vertices, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
        let mut edges: Vec<[Corner; 2]> = Vec::new();
        for drawn in &part.entities {
            let first = 3 * triangles.len();
            let corners: Vec<Corner> = drawn.points().iter().map(|p| corner(*p - part.centre)).collect();
            match &drawn.form {
                Form::Face(mesh) => {
                    edges.extend(boundary(&corners, &mesh.triangles));
                    let offset = vertices.len() as u32;
                    triangles.extend(mesh.triangles.iter().map(|triangle| triangle.map(|index| index + offset)));
                    vertices.extend(corners);
                    normals.extend(mesh.normals.iter().map(|normal| corner(*normal)));
                }
                Form::Curve(_) => edges.extend(corners.windows(2).map(|ends| [ends[0], ends[1]])),
            }
            let indices = 3 * triangles.len() - first;
            faces.push(FaceForm { id: drawn.id, name: drawn.name.clone(), first, indices, colour: drawn.colour });
        }
        Self {
            unit,
            limit,
            decimals: match decimals {
                Decimals::Fixed(decimals) => Some(decimals),
                Decimals::Scientific => None,
            },
            colours: STOPS,
            centre: part.centre.to_array(),
            part: PartForm {
                vertices: singles(vertices.into_iter().flatten()),
                normals: singles(normals.into_iter().flatten()),
                triangles: numbers(triangles.into_iter().flatten().map(u32::to_le_bytes)),
            },
            edges: singles(edges.into_iter().flatten().flatten()),
            points: PointsForm::new(&points.points, &faces),
            faces,
        }
    }

    /// As it stands in a page.
    pub(super) fn json(&self) -> String {
        let json = serde_json::to_string(self).expect("plain data with names for keys");
        // no name of an entity may end the script
        json.replace('<', "\\u003c")
    }
}

impl PointsForm {
    fn new(points: &[Measured], faces: &[FaceForm]) -> Self {
        let doubles = |of: &dyn Fn(&Measured) -> f64| numbers(points.iter().map(|point| of(point).to_le_bytes()));
        let places: HashMap<EntityId, u32> = faces.iter().zip(0..).map(|(face, place)| (face.id, place)).collect();
        let flag = |point: &Measured| u8::from(!point.has_side) + 2 * u8::from(!point.is_certified);
        Self {
            position: numbers(points.iter().flat_map(|measured| measured.point.to_array()).map(f64::to_le_bytes)),
            deviation: doubles(&|measured| measured.deviation),
            lower_bound: doubles(&|measured| measured.lower_bound),
            line: doubles(&|measured| measured.line as f64),
            face: numbers(points.iter().map(|measured| places[&measured.entity].to_le_bytes())),
            flags: numbers(points.iter().map(|measured| [flag(measured)])),
        }
    }
}

/// A place as the graphics processor holds it.
type Corner = [f32; 3];

fn corner(p: DVec3) -> Corner {
    // -0 and 0 are one place
    p.to_array().map(|x| x as f32 + 0.0)
}

fn singles(values: impl Iterator<Item = f32>) -> String {
    numbers(values.map(f32::to_le_bytes))
}

/// The edges of triangles that have one triangle only. The two sides of a seam lie at the same places, and so are none.
fn boundary(corners: &[Corner], triangles: &[[u32; 3]]) -> Vec<[Corner; 2]> {
    let sides = || {
        let places = triangles.iter().map(|triangle| triangle.map(|index| corners[index as usize]));
        places.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[from, to]| from != to)
    };
    let key = |[from, to]: [Corner; 2]| {
        let [from, to] = [from, to].map(|corner| corner.map(f32::to_bits));
        [from.min(to), from.max(to)]
    };
    let mut count: HashMap<_, usize> = HashMap::new();
    for side in sides() {
        *count.entry(key(side)).or_default() += 1;
    }
    sides().filter(|side| count[&key(*side)] == 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_boundary_is_what_one_triangle_has() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let found = boundary(&corners, &[[0, 1, 2], [0, 2, 3]]);
        let [a, b, c, d] = corners;
        assert_eq!(found, [[a, b], [b, c], [c, d], [d, a]]);
    }

    #[test]
    fn a_seam_and_a_pole_are_no_boundary() {
        // a cone: 1 and 4 are both ends of its seam, 0 and 5 its apex
        let corners =
            [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let found = boundary(&corners, &[[0, 1, 2], [0, 2, 3], [5, 3, 4], [0, 5, 3]]);
        let [_, b, c, d, ..] = corners;
        assert_eq!(found, [[b, c], [c, d], [d, b]]);
    }
}
