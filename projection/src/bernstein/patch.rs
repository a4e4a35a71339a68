//! Bézier pieces, and the gradient of the squared distance on them.
//!
//! On a piece with numerator `A` about the piece's own origin and weight `w`, and a query at `x`, let `Q = A - x w`. Half of the squared
//! distance has the derivative
//!
//! ```text
//! Q · (A' w - A w') / w³,   for w = 1:   Q · A'
//! ```
//!
//! (`Q' w - Q w'` is `A' w - A w'`: the query drops out). The numerator has its sign and its zeros, and is the polynomial that is used:
//! of degree `(3 m - 2, 3 n)` for the derivative in u, for `w = 1` of degree `(2 m - 1, 2 n)`. Both derivatives are raised to common degrees.

use glam::{DVec3, DVec4};
use perpend_kernel::bezier::{curve_pieces, surface_pieces};
use perpend_kernel::{Aabb, Definition, Direction, cartesian};
use smallvec::{SmallVec, smallvec};

use super::polynomial::{Polynomial, Products, bernstein};

/// The unit roundoff `u`.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// A Bézier piece in the entity's own coordinates; a curve's has degree `(p, 0)`.
#[derive(Debug)]
pub(super) struct Patch {
    pub degree: (usize, usize),
    /// Homogeneous control points about `origin`, in row order; the largest weight is 1.
    net: Vec<DVec4>,
    origin: DVec3,
    /// The definition's parameters that it covers.
    pub u: (f64, f64),
    pub v: (f64, f64),
    /// The edges that are one point: at the start and end of u, then of v.
    pub poles: [[bool; 2]; 2],
}

/// What all patches of an entity have in common.
#[derive(Debug)]
pub(super) struct Common {
    pub rational: bool,
    pub products: Products,
    /// How far a coefficient of a patch may be from that of the definition: of a numerator, as a share of the entity's largest coordinate, of a weight as a
    /// share of itself.
    ///
    /// Extraction of the piece takes `6 n + 1` roundings per direction of degree `n`, entering the frame and forming `w P` four, moving to
    /// the patch's origin four; numerator and weight are both moved, hence the factor two. All factors are non-negative, so that weights keep their
    /// relative accuracy.
    pub moved: f64,
    /// The largest |coordinate| of a control point.
    pub reach: f64,
}

impl Common {
    pub(super) fn new((p, q): (usize, usize), rational: bool, reach: f64) -> Self {
        let factor = if rational { 6 } else { 4 };
        Self {
            rational,
            products: Products::up_to(factor * p.max(q) + 2),
            moved: (12 * (p + q) + 20) as f64 * ROUNDING,
            reach,
        }
    }
}

/// The grid of patches of a definition whose homogeneous net in some coordinates is `net`: rows along u, and how many along v.
pub(super) fn patches(definition: &Definition, net: &[DVec4], poles: [[bool; 2]; 2]) -> (Vec<Patch>, usize) {
    match definition {
        Definition::NurbsCurve(curve) => {
            let patch = |piece: perpend_kernel::bezier::BezierCurve| {
                Patch::new((curve.degree(), 0), piece.points, (piece.span.start, piece.span.end), (0.0, 0.0))
            };
            (curve_pieces(curve.knots(), net).into_iter().map(patch).collect(), 1)
        }
        Definition::NurbsSurface(surface) => {
            let pieces = surface_pieces(surface.knots(Direction::U), surface.knots(Direction::V), net);
            let columns = surface.knots(Direction::V).spans().count();
            let (last_row, last_column) = (pieces.len() / columns - 1, columns - 1);
            let patch = |(at, piece): (usize, perpend_kernel::bezier::BezierSurface)| {
                let (row, column) = (at / columns, at % columns);
                let (u, v) = piece.spans;
                let mut patch = Patch::new(piece.degree, piece.points, (u.start, u.end), (v.start, v.end));
                patch.poles = [
                    [poles[0][0] && row == 0, poles[0][1] && row == last_row],
                    [poles[1][0] && column == 0, poles[1][1] && column == last_column],
                ];
                patch
            };
            (pieces.into_iter().enumerate().map(patch).collect(), columns)
        }
    }
}

impl Patch {
    fn new(degree: (usize, usize), mut net: Vec<DVec4>, u: (f64, f64), v: (f64, f64)) -> Self {
        let origin = Aabb::around(net.iter().map(|h| cartesian(*h))).centre();
        // a piece may be lighter than its entity by many decades
        let heaviest = net.iter().fold(0.0_f64, |most, h| most.max(h.w));
        for h in &mut net {
            let weight = h.w / heaviest;
            *h = ((cartesian(*h) - origin) * weight).extend(weight);
        }
        Self { degree, net, origin, u, v, poles: [[false; 2]; 2] }
    }

    /// Half the gradient of the squared distance from `p`, times a positive function: one polynomial on a curve, two of the same degrees on a
    /// surface. The factors by which it vanishes at poles are taken out.
    pub(super) fn gradient(&self, p: DVec3, common: &Common) -> SmallVec<[Polynomial; 2]> {
        let x = p - self.origin;
        let numerator = [0, 1, 2].map(|k| self.coordinate(common, |h| h[k], common.reach));
        // the query's own coordinates round on their way into these
        let query_error = 4.0 * ROUNDING * (p.length() + common.reach);
        let weight = self.coordinate(common, |h| h.w, if common.rational { 1.0 } else { 0.0 });
        let q = [0, 1, 2].map(|k| {
            let mut q = numerator[k].clone();
            q.c.iter_mut().zip(&weight.c).for_each(|(a, w)| *a -= x[k] * w);
            let heaviest = weight.size();
            q.error += x[k].abs() * (weight.error + 2.0 * ROUNDING * heaviest)
                + query_error * heaviest
                + 2.0 * ROUNDING * numerator[k].size();
            q
        });
        let directions: &[Direction] = if self.degree.1 == 0 { &[Direction::U] } else { &[Direction::U, Direction::V] };
        let mut gradient: SmallVec<[Polynomial; 2]> = smallvec![];
        for direction in directions {
            let along = [0, 1, 2].map(|k| match common.rational {
                true => common.products.wronskian(&numerator[k], &weight, *direction),
                false => numerator[k].derivative(*direction),
            });
            let mut slope = common.products.sum(q.iter().zip(&along));
            // the derivative along an edge that is one point vanishes there
            let across = if *direction == Direction::U { Direction::V } else { Direction::U };
            for far in [false, true] {
                if self.poles[across as usize][usize::from(far)] {
                    slope = slope.divided(across, far).raised(across);
                }
            }
            for _ in 0..if common.rational { 2 } else { 1 } {
                if directions.len() == 2 {
                    slope = slope.raised(*direction);
                }
            }
            gradient.push(slope);
        }
        gradient
    }

    fn coordinate(&self, common: &Common, of: impl Fn(&DVec4) -> f64, reach: f64) -> Polynomial {
        let (m, n) = self.degree;
        Polynomial { m, n, c: self.net.iter().map(of).collect(), error: common.moved * reach }
    }

    /// The point at the patch's own parameters, in the entity's coordinates.
    pub(super) fn point(&self, s: f64, t: f64) -> DVec3 {
        let (bs, bt) = (bernstein(self.degree.0, s), bernstein(self.degree.1, t));
        let mut sum = DVec4::ZERO;
        for (row, a) in self.net.chunks_exact(self.degree.1 + 1).zip(&bs) {
            for (h, b) in row.iter().zip(&bt) {
                sum += a * b * *h;
            }
        }
        cartesian(sum) + self.origin
    }

    /// How long a box of the patch is in s and in t, as nine points of it tell.
    pub(super) fn lengths(&self, s: (f64, f64), t: (f64, f64)) -> [f64; 2] {
        let three = |(from, to): (f64, f64)| [from, 0.5 * (from + to), to];
        if self.degree.1 == 0 {
            let points = three(s).map(|s| self.point(s, 0.0));
            return [points[0].distance(points[1]) + points[1].distance(points[2]), 0.0];
        }
        let grid = three(s).map(|s| three(t).map(|t| self.point(s, t)));
        let longest = |line: &dyn Fn(usize, usize) -> DVec3| {
            let length = |k: usize| line(k, 0).distance(line(k, 1)) + line(k, 1).distance(line(k, 2));
            length(0).max(length(1)).max(length(2))
        };
        [longest(&|k, i| grid[i][k]), longest(&|k, i| grid[k][i])]
    }

    /// The definition's parameters at the patch's own; the ends exactly.
    pub(super) fn parameters(&self, s: f64, t: f64) -> [f64; 2] {
        let between = |(from, to): (f64, f64), s: f64| match s {
            s if s <= 0.0 => from,
            s if s >= 1.0 => to,
            s => (from + s * (to - from)).min(to),
        };
        [between(self.u, s), between(self.v, t)]
    }
}

#[cfg(test)]
mod tests {
    use perpend_kernel::{NurbsCurve, NurbsSurface};

    use super::super::Bernstein;
    use super::*;
    use crate::hierarchy::double_double::{DoubleDouble, Random};
    use crate::landmarks::Landmarks;

    type Form = [DoubleDouble; 4];

    fn number(x: f64) -> DoubleDouble {
        DoubleDouble::from(x)
    }

    /// The point of a Bézier net of forms in one variable, and its derivative over the degree.
    fn evaluated(net: &[Form], s: f64) -> [Form; 2] {
        let mix = |a: &Form, b: &Form| [0, 1, 2, 3].map(|k| (number(1.0) - number(s)) * a[k] + number(s) * b[k]);
        let mut net = net.to_vec();
        while net.len() > 2 {
            net = net.windows(2).map(|pair| mix(&pair[0], &pair[1])).collect();
        }
        [mix(&net[0], &net[1]), [0, 1, 2, 3].map(|k| net[1][k] - net[0][k])]
    }

    /// The gradient's numerators at a point of a patch that is the whole definition, to 30 digits, from the definition's own numbers.
    fn exact(entity: &Bernstein, definition: &Definition, query: DVec3, s: f64, t: f64) -> [DoubleDouble; 2] {
        let (p, q) = entity.patches[0].degree;
        let heaviest = definition.weights().map_or(1.0, |w| w.iter().copied().fold(0.0, f64::max));
        let local = |x: DVec3, k: usize| (number(x[k]) - number(entity.frame.origin[k])) * number(entity.frame.scale);
        let form = |(at, point): (usize, &DVec3)| {
            let w = definition.weights().map_or(number(1.0), |w| number(w[at]) / number(heaviest));
            [local(*point, 0) * w, local(*point, 1) * w, local(*point, 2) * w, w]
        };
        let forms: Vec<Form> = definition.control_points().iter().enumerate().map(form).collect();
        let factor = |degree: usize, f: Form| f.map(|x| x * number(degree as f64));
        let rows: Vec<[Form; 2]> = match q {
            0 => forms.iter().map(|form| [*form, [number(0.0); 4]]).collect(),
            q => forms.chunks_exact(q + 1).map(|row| evaluated(row, t)).collect(),
        };
        let along = |which: usize| evaluated(&rows.iter().map(|row| row[which]).collect::<Vec<_>>(), s);
        let ([a, a_s], [a_t, _]) = (along(0), along(1));
        let numerator = |derivative: Form| {
            (0..3).fold(number(0.0), |sum, k| {
                let offset = a[k] - local(query, k) * a[3];
                sum + offset * (derivative[k] * a[3] - a[k] * derivative[3])
            })
        };
        [numerator(factor(p, a_s)), numerator(factor(q, a_t))]
    }

    fn definitions(random: &mut Random) -> Vec<Definition> {
        let mut definitions = Vec::new();
        let clamped = |n: usize| [vec![0.0; n + 1], vec![1.0; n + 1]].concat();
        let weight = |random: &mut Random| 10.0_f64.powf(random.between(-1.0, 1.0));
        for degree in [1, 2, 3, 5, 9, 25] {
            for rational in [false, true] {
                let points = (0..=degree).map(|_| random.point()).collect();
                let weights = rational.then(|| (0..=degree).map(|_| weight(random)).collect());
                definitions.push(NurbsCurve::new(degree, clamped(degree), points, weights).expect("valid").into());
            }
        }
        for (p, q) in [(1, 1), (2, 3), (3, 3), (5, 2), (9, 9)] {
            for rational in [false, true] {
                let points = (0..=p).map(|_| (0..=q).map(|_| random.point()).collect()).collect();
                let weights = rational.then(|| (0..=p).map(|_| (0..=q).map(|_| weight(random)).collect()).collect());
                let surface = NurbsSurface::new((p, q), (clamped(p), clamped(q)), points, weights);
                definitions.push(surface.expect("valid").into());
            }
        }
        definitions
    }

    /// Values of the gradient and of its halves, in and a little beside their boxes, err by less than they state, for queries on the entity, near and
    /// far; and the bound is not so wide that it says nothing: a thousandth of it is exceeded.
    #[test]
    fn the_gradient_errs_by_less_than_its_bound() {
        let mut random = Random(3);
        let mut worst = 0.0_f64;
        for definition in definitions(&mut random) {
            let entity = Bernstein::new(&definition, &Landmarks::of(&definition));
            let degree = entity.patches[0].degree;
            for reach in [0.0, 0.3, 3.0, 1e4] {
                let query = definition.control_points()[0] + reach * random.point();
                let mut parts = entity.patches[0].gradient(entity.frame.enter(query), &entity.common);
                let is_surface = parts.len() == 2;
                let mut range = [(0.0, 1.0), (0.0, 1.0)];
                for level in 0..12 {
                    for _ in 0..4 {
                        // in eighths of the box and halves beside it: what they are in the patch is no rounded number
                        let mut eighths =
                            || (random.next() % 9) as f64 / 8.0 + [0.0, 0.015_625][(random.next() % 2) as usize];
                        let (x, y) = (eighths(), if is_surface { eighths() } else { 0.0 });
                        let at = |d: usize, x: f64| range[d].0 + x * (range[d].1 - range[d].0);
                        let exact = exact(&entity, &definition, query, at(0, x), at(1, y));
                        for (f, exact) in parts.iter().zip(exact) {
                            let (value, error) = f.value(x, y);
                            let off = (number(value) - exact).to_f64().abs();
                            assert!(off <= error, "{degree:?}, {reach}, level {level}: {off:e} > {error:e}");
                            worst = worst.max(off / error);
                        }
                    }
                    let direction = if is_surface && level % 2 == 1 { Direction::V } else { Direction::U };
                    let far = random.next() % 2 == 1;
                    parts = parts.iter().map(|f| f.halves(direction)[usize::from(far)].clone()).collect();
                    let (from, to) = range[direction as usize];
                    let middle = 0.5 * (from + to);
                    range[direction as usize] = if far { (middle, to) } else { (from, middle) };
                }
            }
        }
        assert!(worst > 1e-3, "the bound is exceeded by {worst:e} of it at most");
    }

    /// Widening, raising and dividing leave the polynomial what it is.
    #[test]
    fn changes_of_form_keep_the_polynomial() {
        let c: Vec<f64> = (0..20).map(|k| f64::from(k * k % 13) - 4.0).collect();
        let f = Polynomial { m: 3, n: 4, c, error: 0.0 };
        let value = |f: &Polynomial, x: f64, y: f64| f.value(x, y).0;
        for direction in [Direction::U, Direction::V] {
            let (wide, raised) = (f.widened(direction, 0.25), f.raised(direction));
            for (x, y) in [(0.0, 0.0), (0.3, 0.8), (1.0, 0.5), (0.9, 1.0)] {
                let stretched = |x: f64| (x + 0.25) / 1.5;
                let (a, b) = if direction == Direction::U { (stretched(x), y) } else { (x, stretched(y)) };
                assert!((value(&wide, a, b) - value(&f, x, y)).abs() < 1e-12);
                assert!((value(&raised, x, y) - value(&f, x, y)).abs() < 1e-12);
                let ([a, b], h) = (f.gradient(x, y), 1e-6);
                assert!((a - (value(&f, x + h, y) - value(&f, x - h, y)) / (2.0 * h)).abs() < 1e-6);
                assert!((b - (value(&f, x, y + h) - value(&f, x, y - h)) / (2.0 * h)).abs() < 1e-6);
            }
            for far in [false, true] {
                let mut vanishing = f.clone();
                for (at, c) in vanishing.c.iter_mut().enumerate() {
                    let (k, end) = if direction == Direction::U { (at / 5, 3) } else { (at % 5, 4) };
                    if k == if far { end } else { 0 } {
                        *c = 0.0;
                    }
                }
                let (x, y) = (0.3, 0.6);
                let s = if direction == Direction::U { x } else { y };
                let factor = if far { 1.0 - s } else { s };
                let divided = vanishing.divided(direction, far);
                assert!((value(&divided, x, y) * factor - value(&vanishing, x, y)).abs() < 1e-12);
            }
        }
    }
}
