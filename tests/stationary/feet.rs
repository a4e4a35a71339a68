//! The foot of `project` is among the minima, over the test sets.

use perpend::{Extremum, StationaryOptions};

use crate::One;
use crate::common::corpus;

/// Of how many rows one is asked, by index.
const SHARE: usize = 61;

fn check(set: &str) {
    let rows = corpus::rows(&corpus::data().join(format!("{set}.truth.csv")));
    let (mut asked, mut decided) = (0, 0);
    for entry in corpus::entities(&corpus::data().join(format!("{set}.json"))) {
        let one = One::new(entry.shape.definition());
        let size = one.size();
        for row in rows.iter().filter(|row| row.entity == entry.id).step_by(SHARE) {
            let foot = one.model.project(one.id, row.point).expect("finite");
            let found = one.model.stationary_points(one.id, row.point, &StationaryOptions::default()).expect("finite");
            asked += 1;
            let (u, v) = (foot.parameter.u(), foot.parameter.v().unwrap_or(0.0));
            // beside a centre of curvature the distance hardly tells where the foot is
            let near = 1e-9 * size + 1e-9 * foot.distance;
            let minimum = found.points.iter().any(|point| {
                point.kind != Some(Extremum::Saddle)
                    && point.kind != Some(Extremum::Maximum)
                    && (point.distance - foot.distance).abs() <= near
            });
            let slack = 1e-6;
            let holds = |(from, to): (f64, f64), x: f64| from - slack <= x && x <= to + slack;
            let continuum = found.continua.iter().flat_map(|set| &set.boxes).any(|b| holds(b.u, u) && holds(b.v, v));
            assert!(minimum || continuum, "{set} {} at {}: {foot:?} {found:?}", entry.name, row.point);
            let nearest = found.points.iter().map(|point| point.distance).fold(f64::INFINITY, f64::min);
            assert!(nearest >= foot.lower_bound - near, "{set} {} at {}: {nearest}", entry.name, row.point);
            decided += usize::from(crate::is_decided(&found));
        }
    }
    assert!(decided * 10 >= asked * 8, "{set}: only {decided} of {asked} are proven to the last point");
}

#[test]
fn feet_of_the_curves_are_minima() {
    check("seeds-curves");
}

#[test]
fn feet_of_the_surfaces_are_minima() {
    check("seeds-surfaces");
}

#[test]
fn feet_of_the_quadrics_are_minima() {
    check("quadrics");
}

#[test]
fn feet_of_the_circles_are_minima() {
    check("circles-table1");
}
