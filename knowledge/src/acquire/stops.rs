//! Where a derivative of a surface vanishes.

use perpend_kernel::{Direction, NurbsSurface};

use super::ends::Pole;
use super::found::{Found, proved};
use super::options::AcquireOptions;
use super::source::Source;
use super::{other, place, speed};
use crate::representation::{Irregularity, ParameterPoint};

/// Vanishing derivatives of a surface: along poles, along edges whose control points stand still, and where the least speed
/// of a span is none.
pub(super) fn of(
    surface: &NurbsSurface,
    sources: &[(Direction, Source)],
    ranges: &[(Direction, Vec<speed::Range>)],
    poles: &[Pole],
    options: &AcquireOptions,
) -> Vec<Found> {
    let mut found = Vec::new();
    for ((direction, ranges), (_, source)) in ranges.iter().zip(sources) {
        let direction = *direction;
        let (first, last) = surface.domain(direction);
        let slow = options.vanishing * 2.0 * source.reach / (last - first);
        let mut lines: Vec<(Direction, f64)> = Vec::new();
        let mut tell = |at, speed, gap| {
            found.push(proved(Irregularity::VanishingDerivative { direction, at, speed }, gap, slow));
        };
        // along a pole of the other direction the derivative is a derivative of one point
        for pole in poles.iter().filter(|pole| pole.direction == other(direction)) {
            let bound = edge_speed(source, pole.extent);
            tell(ParameterPoint::Iso(pole.direction, pole.at), 0.0, bound);
            lines.push((pole.direction, pole.at));
        }
        for (at, is_end) in [(first, false), (last, true)] {
            let bound = edge_speed(source, standstill(surface, direction, is_end));
            if bound <= slow {
                tell(ParameterPoint::Iso(direction, at), 0.0, bound);
                lines.push((direction, at));
            }
        }
        let mut places: Vec<(f64, f64)> = Vec::new();
        for least in ranges.iter().map(|range| range.least).filter(|least| least.attained <= slow) {
            let (s, t) = least.at;
            let on_line = lines.iter().any(|line| *line == (direction, s) || *line == (other(direction), t));
            if !on_line && !places.contains(&least.at) {
                places.push(least.at);
                let gap = (least.attained - least.bound).max(0.0);
                tell(place(false, direction, least.at), least.attained, gap);
            }
        }
    }
    found
}

/// A bound of the first derivative in the first parameter where its control points are within `extent` of each other: `p`
/// times that, per span, times the ratio of weights twice.
fn edge_speed(source: &Source, extent: f64) -> f64 {
    let narrowest = source.knots().spans().map(|s| s.end - s.start).fold(f64::INFINITY, f64::min);
    2.0 * source.degree().0 as f64 * extent / (narrowest * source.lightest * source.lightest)
}

/// The largest distance between corresponding control points of an edge and of the row beside it.
fn standstill(surface: &NurbsSurface, direction: Direction, is_end: bool) -> f64 {
    let (rows, columns) = (surface.rows(), surface.columns());
    let points = surface.control_points();
    let pair = |a: usize, b: usize| points[a].distance(points[b]);
    match (direction, is_end) {
        (Direction::U, false) => (0..columns).map(|j| pair(j, columns + j)).fold(0.0, f64::max),
        (Direction::U, true) => {
            (0..columns).map(|j| pair((rows - 1) * columns + j, (rows - 2) * columns + j)).fold(0.0, f64::max)
        }
        (Direction::V, false) => (0..rows).map(|i| pair(i * columns, i * columns + 1)).fold(0.0, f64::max),
        (Direction::V, true) => {
            (0..rows).map(|i| pair((i + 1) * columns - 1, (i + 1) * columns - 2)).fold(0.0, f64::max)
        }
    }
}
