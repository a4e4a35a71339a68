//! The bare data of an entity, and what the tests do to it: move, reparametrise, refine, evaluate to 30 digits.
//!
//! A curve is a surface of degree 0 and one column in v, so that one code serves both. Nothing here uses the kernel's algorithms.

use glam::DVec3;
use perpend_kernel::{Definition, Direction, NurbsCurve, NurbsSurface};

use super::double_double::Dd;

/// A point in homogeneous form, `(w x, w y, w z, w)`, to 30 digits.
pub type Form = [Dd; 4];

#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    pub curve: bool,
    /// In u and in v.
    pub degree: [usize; 2],
    pub knots: [Vec<f64>; 2],
    pub rows: usize,
    pub columns: usize,
    /// Row by row.
    pub points: Vec<DVec3>,
    /// In the layout of the points; none: all 1.
    pub weights: Option<Vec<f64>>,
}

impl Shape {
    pub fn curve(degree: usize, knots: Vec<f64>, points: Vec<DVec3>, weights: Option<Vec<f64>>) -> Self {
        let rows = points.len();
        Self { curve: true, degree: [degree, 0], knots: [knots, vec![0.0, 1.0]], rows, columns: 1, points, weights }
    }

    /// A surface from a net in row order.
    pub fn surface(degree: [usize; 2], knots: [Vec<f64>; 2], points: Vec<DVec3>, weights: Option<Vec<f64>>) -> Self {
        let rows = knots[0].len() - degree[0] - 1;
        let columns = points.len() / rows;
        Self { curve: false, degree, knots, rows, columns, points, weights }
    }

    /// The data of a definition.
    pub fn of(definition: &Definition) -> Self {
        let weights = definition.weights().map(<[f64]>::to_vec);
        match definition {
            Definition::NurbsCurve(c) => {
                Self::curve(c.degree(), c.knots().as_slice().to_vec(), c.control_points().to_vec(), weights)
            }
            Definition::NurbsSurface(s) => {
                let (p, q) = s.degree();
                let knots = [Direction::U, Direction::V].map(|d| s.knots(d).as_slice().to_vec());
                Self::surface([p, q], knots, s.control_points().to_vec(), weights)
            }
        }
    }

    /// The definition with these data.
    ///
    /// # Panics
    ///
    /// Where the kernel refuses them.
    pub fn definition(&self) -> Definition {
        let [u, v] = self.knots.clone();
        let made = if self.curve {
            NurbsCurve::new(self.degree[0], u, self.points.clone(), self.weights.clone()).map(Definition::from)
        } else {
            let rows = |flat: &[f64]| flat.chunks(self.columns).map(<[f64]>::to_vec).collect();
            let points = self.points.chunks(self.columns).map(<[DVec3]>::to_vec).collect();
            NurbsSurface::new((self.degree[0], self.degree[1]), (u, v), points, self.weights.as_deref().map(rows))
                .map(Definition::from)
        };
        made.unwrap_or_else(|error| panic!("the kernel refuses {self:?}: {error}"))
    }

    pub fn weight(&self, i: usize) -> f64 {
        self.weights.as_ref().map_or(1.0, |w| w[i])
    }

    /// The corners of the control points' box.
    pub fn bounds(&self) -> [DVec3; 2] {
        let start = [self.points[0], self.points[0]];
        self.points.iter().fold(start, |[low, high], p| [low.min(*p), high.max(*p)])
    }

    /// The diagonal of the control points' box.
    pub fn size(&self) -> f64 {
        let [low, high] = self.bounds();
        (high - low).length()
    }

    /// The largest |coordinate|.
    pub fn reach(&self) -> f64 {
        let [low, high] = self.bounds();
        low.abs().max(high.abs()).max_element()
    }

    /// First and last parameter of a direction.
    pub fn domain(&self, along: usize) -> [f64; 2] {
        let knots = &self.knots[along];
        [knots[self.degree[along]], knots[knots.len() - 1 - self.degree[along]]]
    }

    /// The non-empty spans of a direction: index of the knot at which each starts.
    pub fn spans(&self, along: usize) -> Vec<usize> {
        let knots = &self.knots[along];
        (self.degree[along]..knots.len() - 1 - self.degree[along]).filter(|i| knots[*i] < knots[i + 1]).collect()
    }

    fn span(&self, along: usize, parameter: Dd) -> usize {
        let spans = self.spans(along);
        let inside = spans.iter().rev().find(|i| Dd::from(self.knots[along][**i]) <= parameter);
        *inside.unwrap_or(&spans[0])
    }

    /// The control points in homogeneous form about `origin`, exact but for the last of 32 digits.
    pub fn form(&self, origin: DVec3) -> Vec<Form> {
        let about = |i: usize, p: DVec3| {
            let w = Dd::from(self.weight(i));
            let [x, y, z] = [p.x - origin.x, p.y - origin.y, p.z - origin.z];
            let exact = [(p.x, origin.x), (p.y, origin.y), (p.z, origin.z)].map(|(a, b)| Dd::difference(a, b));
            debug_assert!(x == exact[0].high && y == exact[1].high && z == exact[2].high);
            [w * exact[0], w * exact[1], w * exact[2], w]
        };
        self.points.iter().enumerate().map(|(i, p)| about(i, *p)).collect()
    }

    /// The vector from `origin` to the point at `(u, v)`, right to some 30 digits (de Boor's algorithm in double-double).
    pub fn seen_from(&self, origin: DVec3, u: Dd, v: Dd) -> [Dd; 3] {
        let [p, q] = self.degree;
        let (i, j) = (self.span(0, u), self.span(1, v));
        let across = Quotients::new(&self.knots[0], p, i, &vec![u; p]);
        let along = Quotients::new(&self.knots[1], q, j, &vec![v; q]);
        let mut column = Vec::with_capacity(p + 1);
        for row in i - p..=i {
            let mut line: Vec<Form> = (j - q..=j)
                .map(|k| {
                    let at = row * self.columns + k;
                    let (point, w) = (self.points[at], Dd::from(self.weight(at)));
                    let seen = [(point.x, origin.x), (point.y, origin.y), (point.z, origin.z)];
                    let [x, y, z] = seen.map(|(a, b)| w * Dd::difference(a, b));
                    [x, y, z, w]
                })
                .collect();
            column.push(along.blossom(&mut line));
        }
        let [x, y, z, w] = across.blossom(&mut column);
        [x / w, y / w, z / w]
    }

    /// The distance from `p` to the point at `(u, v)`.
    pub fn distance_at(&self, p: DVec3, u: Dd, v: Dd) -> f64 {
        let [x, y, z] = self.seen_from(p, u, v);
        (x * x + y * y + z * z).sqrt().value()
    }

    /// The point at `(u, v)`, rounded.
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        let [x, y, z] = self.seen_from(DVec3::ZERO, u.into(), v.into());
        DVec3::new(x.value(), y.value(), z.value())
    }

    // ---- what the tests do to shapes

    /// Every control point through `map`.
    pub fn mapped(mut self, map: impl Fn(DVec3) -> DVec3) -> Self {
        self.points.iter_mut().for_each(|p| *p = map(*p));
        self
    }

    /// The parameters of a direction moved to `[low, high]`. Where rounding would let knots fall together that were apart, or tear
    /// the order, the knots stay as they were.
    pub fn over(mut self, along: usize, low: f64, high: f64) -> Self {
        let [first, last] = self.domain(along);
        let old = &self.knots[along];
        let new: Vec<f64> = old
            .iter()
            .map(|t| if *t >= last { high } else { low + (high - low) * ((t - first) / (last - first)) })
            .collect();
        if old.windows(2).zip(new.windows(2)).all(|(o, n)| (o[0] < o[1]) == (n[0] < n[1]) && n[0] <= n[1]) {
            self.knots[along] = new;
        }
        self
    }

    /// u and v exchanged.
    pub fn swapped(mut self) -> Self {
        let (rows, columns) = (self.rows, self.columns);
        let order = |i: usize| (i % rows) * columns + i / rows;
        self.points = (0..rows * columns).map(|i| self.points[order(i)]).collect();
        self.weights = self.weights.map(|w| (0..rows * columns).map(|i| w[order(i)]).collect());
        self.degree.swap(0, 1);
        self.knots.swap(0, 1);
        (self.rows, self.columns) = (columns, rows);
        self
    }

    /// u run through backwards: knot t becomes first + last - t.
    pub fn reversed(mut self) -> Self {
        let [first, last] = self.domain(0);
        self.knots[0] = self.knots[0].iter().rev().map(|t| if *t == last { first } else { first + last - t }).collect();
        let backwards = |i: usize| (self.rows - 1 - i / self.columns) * self.columns + i % self.columns;
        self.points = (0..self.points.len()).map(|i| self.points[backwards(i)]).collect();
        self.weights = self.weights.as_ref().map(|w| (0..w.len()).map(|i| w[backwards(i)]).collect());
        self
    }

    /// The same entity with the knot `at` inserted once in u (Boehm 1980, computed to 30 digits and rounded).
    pub fn with_knot(&self, at: f64) -> Self {
        let p = self.degree[0];
        let k = self.span(0, at.into());
        let mut knots = self.knots[0].clone();
        knots.insert(k + 1, at);
        let form = self.form(DVec3::ZERO);
        let mut net = Vec::new();
        for i in 0..=self.rows {
            for j in 0..self.columns {
                let at_row = |i: usize| form[i * self.columns + j];
                net.push(if i + p <= k {
                    at_row(i)
                } else if i > k {
                    at_row(i - 1)
                } else {
                    let (a, b) = (self.knots[0][i], self.knots[0][i + p]);
                    let share = Dd::difference(at, a) / Dd::difference(b, a);
                    mix(&at_row(i - 1), &at_row(i), share)
                });
            }
        }
        let mut shape = self.clone();
        shape.knots[0] = knots;
        shape.rows += 1;
        shape.take_form(&net);
        shape
    }

    /// The Bézier entity of the same shape and one degree more in u. Only for one span.
    pub fn elevated(&self) -> Self {
        let (p, form) = (self.degree[0], self.form(DVec3::ZERO));
        assert_eq!(self.rows, p + 1, "the tests elevate Bézier entities only");
        let mut net = Vec::new();
        for i in 0..=p + 1 {
            for j in 0..self.columns {
                let at_row = |i: usize| form[i * self.columns + j];
                let share = Dd::from((p + 1 - i) as f64) / Dd::from((p + 1) as f64);
                net.push(match i {
                    0 => at_row(0),
                    _ if i == p + 1 => at_row(p),
                    _ => mix(&at_row(i - 1), &at_row(i), share),
                });
            }
        }
        let [first, last] = self.domain(0);
        let mut shape = self.clone();
        shape.knots[0] = bezier_knots(p + 1).iter().map(|t| if *t == 0.0 { first } else { last }).collect();
        shape.degree[0] += 1;
        shape.rows += 1;
        shape.take_form(&net);
        shape
    }

    fn take_form(&mut self, net: &[Form]) {
        let quotient = |h: &Form| DVec3::new((h[0] / h[3]).value(), (h[1] / h[3]).value(), (h[2] / h[3]).value());
        self.points = net.iter().map(quotient).collect();
        self.weights = self.weights.is_some().then(|| net.iter().map(|h| h[3].value()).collect());
    }
}

/// The knots of one Bézier piece over [0, 1].
pub fn bezier_knots(degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.extend(vec![1.0; degree + 1]);
    knots
}

/// Clamped knots whose spans have the given lengths; a length of 0 repeats the knot.
pub fn knots_of_spans(degree: usize, lengths: &[f64]) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    let mut at = 0.0;
    for length in &lengths[..lengths.len() - 1] {
        at += length;
        knots.push(at);
    }
    knots.extend(vec![at + lengths[lengths.len() - 1]; degree + 1]);
    knots
}

/// `(1 - share) a + share b`.
fn mix(a: &Form, b: &Form, share: Dd) -> Form {
    let rest = Dd::ONE - share;
    std::array::from_fn(|k| rest * a[k] + share * b[k])
}

/// The quotients of de Boor's algorithm in one span, for the blossom at one argument a level.
pub struct Quotients {
    degree: usize,
    /// Level by level.
    shares: Vec<Dd>,
}

impl Quotients {
    /// For the blossom at `arguments` (as many as the degree) in the span that starts at `knots[span]`.
    pub fn new(knots: &[f64], degree: usize, span: usize, arguments: &[Dd]) -> Self {
        let mut shares = Vec::with_capacity(degree * (degree + 1) / 2);
        for level in 1..=degree {
            for j in level..=degree {
                let (a, b) = (knots[span - degree + j], knots[span + 1 + j - level]);
                shares.push((arguments[level - 1] - Dd::from(a)) / Dd::difference(b, a));
            }
        }
        Self { degree, shares }
    }

    /// The blossom of the `degree + 1` control points of the span, which are overwritten.
    pub fn blossom(&self, points: &mut [Form]) -> Form {
        let mut at = 0;
        for level in 1..=self.degree {
            for j in level..=self.degree {
                // from low to high: the lower neighbour of this level is still wanted, so it is kept one place down
                points[j - level] = mix(&points[j - level], &points[j - level + 1], self.shares[at]);
                at += 1;
            }
        }
        points[0]
    }
}
