//! Sides that triangles share.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use perpend_kernel::{Cylinder, Frame, NurbsSurface, Plane, Sphere, Torus};
use perpend_tessellation::{Limits, Mesh, tessellate};

use crate::oracle::{circle, distance_to_segment, entered};

fn bits(p: DVec3) -> [u64; 3] {
    [p.x, p.y, p.z].map(|x| (x + 0.0).to_bits())
}

/// The sides that one triangle alone has, from and to, by the bits of the points.
fn open_sides(mesh: &Mesh) -> Vec<[DVec3; 2]> {
    let mut sides: HashMap<_, (i32, [DVec3; 2])> = HashMap::new();
    for corners in mesh.corners() {
        for i in 0..3 {
            let (from, to) = (corners[i], corners[(i + 1) % 3]);
            let sense = if bits(from) < bits(to) { 1 } else { -1 };
            let key = (bits(from).min(bits(to)), bits(from).max(bits(to)));
            sides.entry(key).or_insert((0, [from, to])).0 += sense;
        }
    }
    sides.into_values().filter(|(count, _)| *count != 0).map(|(_, side)| side).collect()
}

fn mesh(surface: &NurbsSurface, chord: f64) -> Mesh {
    tessellate(surface, None, chord, Limits::default()).unwrap()
}

#[test]
fn closed_surfaces_have_closed_meshes() {
    let torus = Torus::whole(Frame::WORLD, 3.0, 1.0).unwrap().to_nurbs().unwrap();
    let sphere = Sphere::whole(Frame::WORLD, 2.0).unwrap().to_nurbs().unwrap();
    // curvature that differs from place to place, so that cells of different sizes meet also at the seam
    let bumped = {
        let mut rows: Vec<Vec<DVec3>> = torus.control_points().chunks(torus.columns()).map(<[DVec3]>::to_vec).collect();
        for row in &mut rows {
            row[3] *= 1.7;
        }
        let knots =
            [perpend_kernel::Direction::U, perpend_kernel::Direction::V].map(|d| torus.knots(d).as_slice().to_vec());
        let [u, v] = knots;
        NurbsSurface::new((2, 2), (u, v), rows, None).unwrap()
    };
    for (surface, chord) in [(&torus, 0.1), (&torus, 0.003), (&sphere, 0.1), (&sphere, 0.001), (&bumped, 0.02)] {
        let open = open_sides(&mesh(surface, chord));
        assert!(open.is_empty(), "{} open sides, such as {:?}", open.len(), open[0]);
    }
}

#[test]
fn a_tube_is_open_at_its_rims_alone() {
    let tube = Cylinder::new(Frame::WORLD, 1.0, (0.0, 2.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    for [from, to] in open_sides(&mesh(&tube, 0.01)) {
        assert!(from.z == to.z && (from.z == 0.0 || from.z == 2.0), "{from} {to}");
    }
}

#[test]
fn faces_that_share_an_edge_meet_within_the_chord_error() {
    // a tube, and a lid that its rim trims
    let tube = Cylinder::new(Frame::WORLD, 1.0, (0.0, 2.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let frame = Frame { centre: 2.0 * DVec3::Z, ..Frame::WORLD };
    let plane = Plane::new(frame, (-2.0, 2.0), (-2.0, 2.0)).unwrap().to_nurbs().unwrap();
    let trimming = entered(&plane, vec![circle(DVec2::splat(0.5), 0.25, true)], false);
    for chord in [0.2, 0.01, 0.0005] {
        let lid = open_sides(&tessellate(&plane, Some(&trimming), chord, Limits::default()).unwrap());
        let rim: Vec<_> = open_sides(&mesh(&tube, chord)).into_iter().filter(|[from, _]| from.z == 2.0).collect();
        for (sides, others) in [(&lid, &rim), (&rim, &lid)] {
            for [from, to] in sides {
                for point in [*from, *to, 0.5 * (*from + *to)] {
                    let gap =
                        others.iter().map(|[a, b]| distance_to_segment(point, *a, *b)).fold(f64::INFINITY, f64::min);
                    assert!(gap <= chord, "{gap} > {chord}");
                }
            }
        }
    }
}
