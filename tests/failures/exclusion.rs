//! Segments that a hasty criterion would exclude.

use glam::{DVec3, dvec3};
use perpend::Place;
use perpend::kernel::extrusion;

use super::case::{Case, close, u, uv};
use super::shapes::{bezier, flat};

/// Both ends of the control polygon lead away from `p`.
fn leads_away(points: &[DVec3], p: DVec3) -> bool {
    let n = points.len() - 1;
    (points[1] - points[0]).dot(p - points[0]) < 0.0 && (points[n - 1] - points[n]).dot(p - points[n]) < 0.0
}

/// A segment that leaves the query point at both ends and comes back to it in its middle.
fn returning() -> Vec<DVec3> {
    flat(&[[-1.0, 0.0], [-6.0, 1.6], [6.0, 1.6], [1.0, 0.0]])
}

/// Selimovic 2006, Fig. 1, on the criterion of Dyllong and Luther 1999: a segment was excluded, as if an end were its nearest point,
/// although the solution lies inside it.
#[test]
fn a_segment_that_leaves_at_both_ends_and_returns_is_not_excluded() {
    let case = Case::new(bezier(returning()));
    for x in [-0.2, -0.1, 0.0, 0.05, 0.2] {
        let p = dvec3(x, 1.0, 0.0);
        assert!(leads_away(&case.shape.points, p), "the case is not of the kind");
        let foot = case.foot_by_oracle(p);
        let to_ends = [0.0, 1.0].map(|end| case.at(end, 0.0).distance(p));
        assert!(foot.distance < 0.3 && to_ends[0].min(to_ends[1]) > 1.2, "{foot:?}");
        assert_eq!(foot.place, Place::Interior);
    }
    // by symmetry: the foot of (0, 1) is the middle, (0, 1.2)
    let foot = case.foot_at(DVec3::Y, 0.2);
    close(u(&foot), 0.5, 1e-9);
}

/// The same as a surface: all four edges lead away from the query point.
#[test]
fn a_patch_that_leaves_at_all_edges_and_returns_is_not_excluded() {
    let wall = extrusion(&bezier(returning()), dvec3(0.0, 0.0, 2.0)).expect("a path");
    let case = Case::new(wall);
    for (x, z) in [(0.0, 1.0), (0.1, 0.3), (-0.15, 1.9)] {
        let p = dvec3(x, 1.0, z);
        let foot = case.foot_by_oracle(p);
        assert!(foot.distance < 0.3);
        assert_eq!(foot.place, Place::Interior);
        close(uv(&foot).1, z / 2.0, 1e-9);
    }
}
