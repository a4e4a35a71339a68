//! What is particular about a definition's parameters: ends that meet, edges that are one point, breaks, cusps.

use glam::DVec3;
use perpend_kernel::bezier::curve_pieces;
use perpend_kernel::{Definition, Direction, KnotVector, NurbsCurve, NurbsSurface, Span, cartesian};

/// Two points of a definition are one where they differ by at most this share of its largest |coordinate|: what rounding
/// leaves of a closed net after a few operations.
const SAME_POINT: f64 = 32.0 * f64::EPSILON;

/// A derivative vanishes where it is below this share of size per parameter range: far above what rounding leaves of a zero, far
/// below the slowest parametrisation that anybody designs.
const VANISHING: f64 = 1e-9;

/// The tangent turns at a break where its direction changes by more than this, in radians: a file with eight digits leaves less in a
/// joint that was designed smooth, and no machine cuts a crease so flat. It names an answer's place and enters no bound.
const TURN: f64 = 1e-7;

/// The particular parameters of a definition.
#[derive(Debug, Clone, Default)]
pub(crate) struct Landmarks {
    /// The first and the last parameter, in u and in v.
    pub ends: [(f64, f64); 2],
    /// Whether the definition closes, in u and in v.
    pub closed: [bool; 2],
    /// Whether the edge at the start and at the end of u is a single point, and of v.
    pub poles: [[bool; 2]; 2],
    /// Interior knots of multiplicity `degree` or more, where a tangent may turn: in u and in v.
    pub breaks: [Vec<f64>; 2],
    /// Parameters of a curve inside its spans at which the first derivative vanishes.
    pub cusps: Vec<f64>,
}

impl Landmarks {
    /// Whether nothing is particular about a parameter in u (0) or in v (1): it lies inside the domain and on no break, and is no cusp.
    #[inline]
    pub(crate) fn is_plain(&self, direction: usize, at: f64) -> bool {
        let (first, last) = self.ends[direction];
        let none = |particular: &[f64]| particular.iter().all(|x| *x != at);
        at > first && at < last && none(&self.breaks[direction]) && (direction == 1 || none(&self.cusps))
    }

    pub(crate) fn of(definition: &Definition) -> Self {
        let same = SAME_POINT * definition.reach();
        match definition {
            Definition::NurbsCurve(curve) => Self {
                ends: [curve.domain(), (0.0, 0.0)],
                closed: [ends_meet(curve, same), false],
                breaks: [full_breaks(curve.knots()), Vec::new()],
                cusps: cusps(curve),
                ..Self::default()
            },
            Definition::NurbsSurface(surface) => Self::of_surface(surface, same),
        }
    }

    fn of_surface(surface: &NurbsSurface, same: f64) -> Self {
        let (rows, columns) = (surface.rows(), surface.columns());
        let point = |i: usize, j: usize| surface.control_points()[i * columns + j];
        let weight = |i: usize, j: usize| surface.weights().map_or(1.0, |w| w[i * columns + j]);
        let close = |a: DVec3, b: DVec3| a.distance(b) <= same;
        // two edges with the same points are one curve where their weights are proportional
        let alike = |a: (f64, f64), b: (f64, f64)| (a.0 * b.1 - a.1 * b.0).abs() <= SAME_POINT * (a.0 * b.1);
        let pole_u = |i: usize| (1..columns).all(|j| close(point(i, 0), point(i, j)));
        let pole_v = |j: usize| (1..rows).all(|i| close(point(0, j), point(i, j)));
        let (across, along) =
            (|j: usize| (weight(0, j), weight(rows - 1, j)), |i: usize| (weight(i, 0), weight(i, columns - 1)));
        let closed_u = (0..columns).all(|j| close(point(0, j), point(rows - 1, j)) && alike(across(0), across(j)));
        let closed_v = (0..rows).all(|i| close(point(i, 0), point(i, columns - 1)) && alike(along(0), along(i)));
        Self {
            ends: [surface.domain(Direction::U), surface.domain(Direction::V)],
            closed: [closed_u, closed_v],
            poles: [[pole_u(0), pole_u(rows - 1)], [pole_v(0), pole_v(columns - 1)]],
            breaks: [full_breaks(surface.knots(Direction::U)), full_breaks(surface.knots(Direction::V))],
            cusps: Vec::new(),
        }
    }
}

fn ends_meet(curve: &NurbsCurve, same: f64) -> bool {
    let points = curve.control_points();
    points[0].distance(points[points.len() - 1]) <= same
}

fn full_breaks(knots: &KnotVector) -> Vec<f64> {
    knots.breaks().filter(|b| b.multiplicity >= knots.degree()).map(|b| b.at).collect()
}

/// Whether the direction turns between two one-sided tangents, by more than `noise` in radians that rounding may have turned them.
pub(crate) fn turns(before: DVec3, after: DVec3, noise: f64) -> bool {
    let lengths = before.length() * after.length();
    before.cross(after).length() > (TURN + noise) * lengths || before.dot(after) < 0.0
}

/// Whether a curve's first derivative `d` vanishes.
pub(crate) fn vanishes(d: DVec3, curve: &NurbsCurve) -> bool {
    let (first, last) = curve.domain();
    d.length() * (last - first) <= VANISHING * curve.control_box().diagonal()
}

/// Parameters strictly inside the spans at which the first derivative vanishes.
///
/// A span whose control polygon never turns back along its chord has none: the derivative is a positive combination of the polygon's
/// sides. On the others the speed is sampled, and Newton's method for `C' · C'' = 0` polishes each local minimum: found, not
/// proven. A cusp that is missed costs a proof more work and an answer its `Place::Cusp`, nothing else.
fn cusps(curve: &NurbsCurve) -> Vec<f64> {
    let mut found = Vec::new();
    for piece in curve_pieces(curve.knots(), &curve.homogeneous_points()) {
        let points: Vec<DVec3> = piece.points.iter().map(|h| cartesian(*h)).collect();
        let chord = points[points.len() - 1] - points[0];
        if points.windows(2).any(|side| (side[1] - side[0]).dot(chord) <= 0.0) {
            found.extend(
                slowest(curve, piece.span).filter(|(_, derivative)| vanishes(*derivative, curve)).map(|(u, _)| u),
            );
        }
    }
    found.dedup();
    found
}

/// Local minima of the speed inside a span, with the derivative there.
fn slowest(curve: &NurbsCurve, span: Span) -> impl Iterator<Item = (f64, DVec3)> {
    let samples = 8 * curve.degree();
    let step = (span.end - span.start) / samples as f64;
    let jet = move |u: f64| {
        let mut d = [DVec3::ZERO; 4];
        if u >= span.end {
            curve.derivatives_from_left(u, &mut d);
        } else {
            curve.derivatives(u, &mut d);
        }
        d
    };
    let speeds: Vec<f64> = (0..=samples).map(|k| jet(span.start + step * k as f64)[1].length()).collect();
    (1..samples).filter(move |k| speeds[*k] <= speeds[k - 1] && speeds[*k] <= speeds[k + 1]).filter_map(move |k| {
        let (low, high) = (span.start + step * (k - 1) as f64, span.start + step * (k + 1) as f64);
        let mut u = 0.5 * (low + high);
        for _ in 0..12 {
            let d = jet(u);
            let slope = d[2].length_squared() + d[1].dot(d[3]);
            if slope > 0.0 {
                u = (u - d[1].dot(d[2]) / slope).clamp(low, high);
            }
        }
        (u > span.start && u < span.end).then(|| (u, jet(u)[1]))
    })
}
