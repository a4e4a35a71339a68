//! Curves joined end to end into one.

use perpend::kernel::cartesian;
use perpend::{InvalidDefinition, NurbsCurve};

/// The pieces as one curve: piece `i` runs over the parameters `i` to `i + 1`, and each starts where the one before it ends.
///
/// A start that lies beside that end is drawn onto it. Pieces of lower degree are elevated; the weights of a piece are scaled so that it meets
/// the one before it in one control point.
pub(super) fn joined(pieces: &[NurbsCurve]) -> Result<NurbsCurve, InvalidDefinition> {
    let degree = pieces.iter().map(NurbsCurve::degree).max().unwrap_or(0);
    let rational = pieces.iter().any(|piece| piece.weights().is_some());
    let (mut knots, mut net) = (vec![0.0; degree + 1], Vec::new());
    for (i, piece) in pieces.iter().enumerate() {
        let (start, end) = (i as f64, (i + 1) as f64);
        // the degree is that of a valid piece, so that only too many points can be refused
        let too_many = |_| InvalidDefinition::TooManyPoints { points: piece.control_points().len() * (degree + 1) };
        let piece = piece.elevate_degree(degree - piece.degree()).map_err(too_many)?.with_domain(start, end)?;
        let points = piece.homogeneous_points();
        let scale = net.last().map_or(1.0, |end: &glam::DVec4| end.w / points[0].w);
        net.extend(points[usize::from(i > 0)..].iter().map(|point| *point * scale));
        let own = piece.knots().as_slice();
        // of the start's knots none, of the end's as many as the degree
        knots.extend_from_slice(&own[degree + 1..own.len() - 1]);
    }
    knots.push(pieces.len() as f64);
    let points = net.iter().map(|point| cartesian(*point)).collect();
    NurbsCurve::new(degree, knots, points, rational.then(|| net.iter().map(|point| point.w).collect()))
}
