//! How far two definitions are from each other, parameter by parameter, with proof.
//!
//! Both are brought to common degrees and knots by elevation and refinement, which leave them where they are. Then two bounds hold
//! for the distance between their points at any one parameter, and the smaller is taken. With `P, w` and `Q, z` their control
//! points and weights and `d` the diagonal of the box of the `Q`, no point is farther from its partner than
//!
//! ```text
//! max over i of  |P_i - Q_i| + |w_i - z_i| / w_i * d
//! ```
//!
//! (see knot removal in the kernel), which is the control points' distance where there are no weights. And on a pair of Bézier
//! pieces the difference is the quotient of Bernstein forms of twice the degree,
//!
//! ```text
//! C - D = (A z - B w) / (w z),    coefficient m:  Σ s_ij w_i z_j (P_i - Q_j) / Σ s_ij w_i z_j,    i + j = m
//! ```
//!
//! whose denominator is positive, so that the longest quotient of coefficients bounds it. That bound does not mind weights of
//! which one set is a multiple of the other.
//!
//! All is done about the middle of both, so that rounding is that of their size and not of their place. It is added to the bound:
//! of a change of basis `24 (p + 1) ε` of the extent a step (as for knot removal), of the products `(64 + 16 p) ε` of it.

use glam::{DVec3, DVec4};
use perpend_kernel::bezier::{curve_pieces, surface_pieces};
use perpend_kernel::{Aabb, Definition, Direction, KnotVector, NurbsCurve, NurbsSurface, binomial};
use serde::{Deserialize, Serialize};

/// The products of weights that are formed before the bound by pieces is given up: some tenths of a second of work.
const PRODUCTS: usize = 50_000_000;
/// The control points that common knots may take before both are taken as two hulls.
const POINTS: usize = 2_000_000;

/// How far two definitions are from each other, parameter by parameter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Proven, rounding included: at no parameter are the two farther apart.
    ///
    /// Where the domains differ, or common knots would take too many control points, it bounds the distance between any point of
    /// the one and any point of the other: the diagonal of the box of both. So it does between a curve and a surface.
    pub proven: f64,
    /// The largest distance that was met at sampled parameters: at most the deviation (where the domains differ, at equal
    /// shares of them). Between a curve and a surface it is not measured, and is `proven`.
    pub measured: f64,
    /// In what the two are built differently.
    pub differs: Vec<Difference>,
}

/// In what two definitions are built differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Difference {
    /// One is a curve, the other a surface.
    Kind,
    /// The degrees.
    Degree,
    /// The domains.
    Domain,
    /// The knots, or how many there are.
    Knots,
    /// One is rational, the other is not.
    Weights,
}

impl Deviation {
    /// Whether the two are built alike: of one kind, with the same degrees and knots, both rational or neither.
    #[must_use]
    pub fn is_same_structure(&self) -> bool {
        self.differs.is_empty()
    }
}

/// How far two definitions are from each other, parameter by parameter. Of two that are equal in all bits, 0.
///
/// The work is bounded: past some 5·10⁷ products or 2·10⁶ control points a coarser bound is given.
#[must_use]
pub fn deviation(one: &Definition, other: &Definition) -> Deviation {
    if one == other {
        return Deviation { proven: 0.0, measured: 0.0, differs: Vec::new() };
    }
    let differs = differences(one, other);
    let both = one.control_box().join(other.control_box());
    // a few ulps for the box's own rounding
    let apart = both.diagonal() * (1.0 + 8.0 * f64::EPSILON);
    if differs.contains(&Difference::Kind) {
        return Deviation { proven: apart, measured: apart, differs };
    }
    let bound = if differs.contains(&Difference::Domain) { None } else { bound(one, other, both.centre()) };
    let proven = bound.filter(|bound| bound.is_finite()).map_or(apart, |bound| bound.min(apart));
    // what exceeds the bound is rounding of evaluation
    let measured = measured(one, other).min(proven);
    Deviation { proven, measured, differs }
}

fn knots(definition: &Definition) -> Vec<&KnotVector> {
    match definition {
        Definition::NurbsCurve(curve) => vec![curve.knots()],
        Definition::NurbsSurface(surface) => vec![surface.knots(Direction::U), surface.knots(Direction::V)],
    }
}

fn differences(one: &Definition, other: &Definition) -> Vec<Difference> {
    let (a, b) = (knots(one), knots(other));
    if a.len() != b.len() {
        return vec![Difference::Kind];
    }
    let any = |differ: &dyn Fn(&KnotVector, &KnotVector) -> bool| a.iter().zip(&b).any(|(a, b)| differ(a, b));
    [
        (Difference::Degree, any(&|a, b| a.degree() != b.degree())),
        (Difference::Domain, any(&|a, b| a.domain() != b.domain())),
        (
            Difference::Knots,
            any(&|a, b| {
                a.distinct().count() != b.distinct().count() || {
                    let raised = |knots: &KnotVector| {
                        knots
                            .distinct()
                            .map(|(knot, count)| (knot, knots.degree() - count.min(knots.degree())))
                            .collect::<Vec<_>>()
                    };
                    raised(a) != raised(b)
                }
            }),
        ),
        (Difference::Weights, one.weights().is_some() != other.weights().is_some()),
    ]
    .into_iter()
    .filter_map(|(difference, is_there)| is_there.then_some(difference))
    .collect()
}

/// A definition about a centre: degrees, knots and net that elevation and refinement work on.
fn local(definition: &Definition, centre: DVec3) -> Option<Definition> {
    let points: Vec<DVec3> = definition.control_points().iter().map(|p| *p - centre).collect();
    Some(match definition {
        Definition::NurbsCurve(curve) => {
            let weights = curve.weights().map(<[f64]>::to_vec);
            NurbsCurve::new(curve.degree(), curve.knots().as_slice().to_vec(), points, weights).ok()?.into()
        }
        Definition::NurbsSurface(surface) => {
            let columns = surface.columns();
            let [u, v] = [Direction::U, Direction::V].map(|along| surface.knots(along).as_slice().to_vec());
            let rows = points.chunks(columns).map(<[DVec3]>::to_vec).collect();
            let weights = surface.weights().map(|w| w.chunks(columns).map(<[f64]>::to_vec).collect());
            NurbsSurface::new(surface.degree(), (u, v), rows, weights).ok()?.into()
        }
    })
}

/// The definition with higher degrees and more knots, and how many changes of basis that took.
fn raised(definition: Definition, like: &[Common]) -> Option<(Definition, usize)> {
    let mut steps = 0;
    let raised = match definition {
        Definition::NurbsCurve(mut curve) => {
            let by = like[0].degree - curve.degree();
            steps += by;
            curve = curve.elevate_degree(by).ok()?;
            let missing = like[0].missing(curve.knots());
            if !missing.is_empty() {
                steps += 1;
                curve = curve.refine(&missing).ok()?;
            }
            curve.into()
        }
        Definition::NurbsSurface(mut surface) => {
            for (along, common) in [Direction::U, Direction::V].into_iter().zip(like) {
                let by = common.degree - surface.knots(along).degree();
                steps += by;
                surface = surface.elevate_degree(along, by).ok()?;
                let missing = common.missing(surface.knots(along));
                if !missing.is_empty() {
                    steps += 1;
                    surface = surface.refine(along, &missing).ok()?;
                }
            }
            surface.into()
        }
    };
    Some((raised, steps))
}

/// A degree, and the interior knots that two vectors have together at it.
struct Common {
    degree: usize,
    breaks: Vec<(f64, usize)>,
}

impl Common {
    fn of(a: &KnotVector, b: &KnotVector) -> Self {
        let degree = a.degree().max(b.degree());
        let raised = |knots: &KnotVector| {
            let by = degree - knots.degree();
            knots.breaks().map(move |one| (one.at, one.multiplicity + by)).collect::<Vec<_>>()
        };
        let mut all = raised(a);
        all.extend(raised(b));
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        let breaks = all
            .chunk_by(|a, b| a.0 == b.0)
            .map(|run| (run[0].0, run.iter().map(|(_, count)| *count).max().unwrap_or_default()))
            .collect();
        Self { degree, breaks }
    }

    fn points(&self) -> usize {
        self.degree + 1 + self.breaks.iter().map(|(_, count)| count).sum::<usize>()
    }

    fn missing(&self, present: &KnotVector) -> Vec<f64> {
        let lacking = |(knot, count): &(f64, usize)| {
            std::iter::repeat_n(*knot, count.saturating_sub(present.multiplicity(*knot)))
        };
        self.breaks.iter().flat_map(lacking).collect()
    }
}

fn bound(one: &Definition, other: &Definition, centre: DVec3) -> Option<f64> {
    let common: Vec<Common> = knots(one).into_iter().zip(knots(other)).map(|(a, b)| Common::of(a, b)).collect();
    if common.iter().map(Common::points).try_fold(1_usize, usize::checked_mul)? > POINTS {
        return None;
    }
    let (one, steps) = raised(local(one, centre)?, &common)?;
    let (other, more) = raised(local(other, centre)?, &common)?;
    let degree: usize = common.iter().map(|common| common.degree).sum();
    let reach = |definition: &Definition| definition.control_points().iter().map(|p| p.length()).fold(0.0, f64::max);
    let extent = reach(&one).max(reach(&other));
    let rounding = f64::EPSILON * extent * (4.0 + (24 * (degree + 1) * (steps + more)) as f64);
    let by_points = by_points(&one, &other).min(by_points(&other, &one)) + rounding;
    let by_pieces = by_pieces(&one, &other)
        .map(|bound| bound + rounding + (64.0 + 16.0 * degree as f64) * f64::EPSILON * 2.0 * extent);
    Some(by_pieces.map_or(by_points, |by_pieces| by_pieces.min(by_points)))
}

/// The first bound.
fn by_points(one: &Definition, other: &Definition) -> f64 {
    let weight = |definition: &Definition, k: usize| definition.weights().map_or(1.0, |w| w[k]);
    let diagonal = Aabb::around(other.control_points().iter().copied()).diagonal();
    let pairs = one.control_points().iter().zip(other.control_points()).enumerate();
    let apart = pairs.map(|(k, (p, q))| {
        let (w, z) = (weight(one, k), weight(other, k));
        p.distance(*q) + (w - z).abs() / w * diagonal
    });
    apart.fold(0.0, f64::max) * (1.0 + 8.0 * f64::EPSILON)
}

/// The second bound; none where both are without weights, so that the first is as good, or where it takes too long.
fn by_pieces(one: &Definition, other: &Definition) -> Option<f64> {
    if one.weights().is_none() && other.weights().is_none() {
        return None;
    }
    let products = |degrees: (usize, usize)| ((degrees.0 + 1) * (degrees.1 + 1)).pow(2);
    match (one, other) {
        (Definition::NurbsCurve(one), Definition::NurbsCurve(other)) => {
            let degrees = (one.degree(), 0);
            if one.knots().spans().count() * products(degrees) > PRODUCTS {
                return None;
            }
            let (a, b) = (
                curve_pieces(one.knots(), &one.homogeneous_points()),
                curve_pieces(other.knots(), &other.homogeneous_points()),
            );
            Some(a.iter().zip(&b).map(|(a, b)| quotient(&a.points, &b.points, degrees)).fold(0.0, f64::max))
        }
        (Definition::NurbsSurface(one), Definition::NurbsSurface(other)) => {
            let (degrees, [u, v]) = (one.degree(), [Direction::U, Direction::V].map(|along| one.knots(along)));
            if u.spans().count() * v.spans().count() * products(degrees) > PRODUCTS {
                return None;
            }
            let pieces = |surface: &NurbsSurface| surface_pieces(u, v, &surface.homogeneous_points());
            let (a, b) = (pieces(one), pieces(other));
            Some(a.iter().zip(&b).map(|(a, b)| quotient(&a.points, &b.points, degrees)).fold(0.0, f64::max))
        }
        _ => None,
    }
}

/// The longest quotient of coefficients of the difference of two rational pieces of these degrees.
fn quotient(a: &[DVec4], b: &[DVec4], (p, q): (usize, usize)) -> f64 {
    // weights of each piece up to a factor: no product leaves the range of numbers
    let plain = |piece: &[DVec4]| -> Vec<(DVec3, f64)> {
        let largest = piece.iter().map(|h| h.w).fold(0.0, f64::max);
        piece.iter().map(|h| (h.truncate() / h.w, h.w / largest)).collect()
    };
    let (a, b) = (plain(a), plain(b));
    let columns = 2 * q + 1;
    let mut sums = vec![(DVec3::ZERO, 0.0); (2 * p + 1) * columns];
    let shares = |n: usize| (0..=n).map(|k| binomial(n, k)).collect::<Vec<f64>>();
    let (across, along) = (shares(p), shares(q));
    for (k, (point, w)) in a.iter().enumerate() {
        let (i, j) = (k / (q + 1), k % (q + 1));
        for (l, (partner, z)) in b.iter().enumerate() {
            let (m, n) = (l / (q + 1), l % (q + 1));
            let share = across[i] * across[m] * (along[j] * along[n]) * (w * z);
            let sum = &mut sums[(i + m) * columns + j + n];
            sum.0 += share * (*point - *partner);
            sum.1 += share;
        }
    }
    sums.into_iter().map(|(difference, weight)| (difference / weight).length()).fold(0.0, f64::max)
}

/// The largest distance at sampled parameters: those of a grid, and some in every span of the first.
fn measured(one: &Definition, other: &Definition) -> f64 {
    match (one, other) {
        (Definition::NurbsCurve(one), Definition::NurbsCurve(other)) => {
            let partner = share_of(other.domain());
            samples(one.knots(), 1024)
                .map(|(u, share)| one.point(u).distance(other.point(partner(u, share, one.domain()))))
                .fold(0.0, f64::max)
        }
        (Definition::NurbsSurface(one), Definition::NurbsSurface(other)) => {
            let [u, v] = [Direction::U, Direction::V].map(|along| (one.domain(along), share_of(other.domain(along))));
            let columns: Vec<(f64, f64)> =
                samples(one.knots(Direction::V), 64).map(|(at, share)| (at, v.1(at, share, v.0))).collect();
            samples(one.knots(Direction::U), 64)
                .flat_map(|(at, share)| {
                    let partner = u.1(at, share, u.0);
                    columns.iter().map(move |(v, w)| one.point(at, *v).distance(other.point(partner, *w)))
                })
                .fold(0.0, f64::max)
        }
        _ => f64::INFINITY,
    }
}

/// Where in a domain a parameter of another lies: the same, or at the same share where the domains differ.
fn share_of(domain: (f64, f64)) -> impl Fn(f64, f64, (f64, f64)) -> f64 + Copy {
    move |at, share, of| if of == domain { at } else { (1.0 - share) * domain.0 + share * domain.1 }
}

/// About `count` parameters, each with its share of the domain: the ends, and as many in each span.
fn samples(knots: &KnotVector, count: usize) -> impl Iterator<Item = (f64, f64)> {
    let (first, last) = knots.domain();
    let spans: Vec<(f64, f64)> = knots.spans().map(|span| (span.start, span.end)).collect();
    let each = (count / spans.len()).max(1);
    // of very many spans, some
    let step = spans.len().div_ceil(count);
    let inside = spans.into_iter().step_by(step).flat_map(move |(start, end)| {
        (0..each).map(move |k| {
            let t = (k as f64 + 0.5) / each as f64;
            (1.0 - t) * start + t * end
        })
    });
    [first, last].into_iter().chain(inside).map(move |at| (at, (at - first) / (last - first)))
}
