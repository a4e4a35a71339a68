//! Polynomials in Bernstein form with a bound of their rounding, after Berchtold & Bowyer 2000.
//!
//! Every operation forms sums whose weights are known, so that a bound for the error of all coefficients follows from the largest
//! coefficients: to first order in `u = 2⁻⁵³`, with factors rounded up. A sign that exceeds the bound is the sign of the exact polynomial.

use perpend_kernel::{Direction, binomial};

/// The unit roundoff `u`.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// A polynomial of degree `(m, n)` over the unit square: `(m + 1)(n + 1)` coefficients in row order; in one variable `n = 0`.
#[derive(Debug, Clone)]
pub(super) struct Polynomial {
    pub m: usize,
    pub n: usize,
    pub c: Vec<f64>,
    /// No coefficient errs by more.
    pub error: f64,
}

impl Polynomial {
    /// The largest |coefficient|.
    pub(super) fn size(&self) -> f64 {
        self.c.iter().fold(0.0, |most, c| if c.abs() > most { c.abs() } else { most })
    }

    /// The least and the largest coefficient: the values lie between them.
    pub(super) fn range(&self) -> (f64, f64) {
        range(self.c.iter().copied())
    }

    /// Whether the polynomial is proven to have no zero on its box: all coefficients have one sign.
    pub(super) fn has_no_zero(&self) -> bool {
        let (low, high) = self.range();
        low > self.error || high < -self.error
    }

    /// Whether rounding is all that the coefficients show.
    pub(super) fn is_noise(&self) -> bool {
        self.size() <= 2.0 * self.error
    }

    /// Bounds of the derivative in a direction.
    pub(super) fn slope(&self, direction: Direction) -> (f64, f64) {
        let width = self.n + 1;
        let (degree, step) = match direction {
            Direction::U => (self.m, width),
            Direction::V => (self.n, 1),
        };
        if degree == 0 {
            return (0.0, 0.0);
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (at, c) in self.c.iter().enumerate() {
            let inside = match direction {
                Direction::U => at + width < self.c.len(),
                Direction::V => at % width < self.n,
            };
            if inside {
                let difference = self.c[at + step] - c;
                low = f64::min(low, difference);
                high = f64::max(high, difference);
            }
        }
        let degree = degree as f64;
        let error = degree * (2.0 * self.error + 4.0 * ROUNDING * self.size());
        (degree * low - error, degree * high + error)
    }

    /// Both halves in a direction, by de Casteljau: halving is exact, one rounding a level.
    pub(super) fn halves(&self, direction: Direction) -> [Self; 2] {
        let (mut low, mut high) = (self.clone(), self.clone());
        let (lines, degree, step, across) = self.lines(direction);
        for line in 0..lines {
            let at = |k: usize| line * across + k * step;
            let work = &mut low.c;
            high.c[at(degree)] = work[at(degree)];
            for k in 1..=degree {
                for i in (k..=degree).rev() {
                    work[at(i)] = 0.5 * (work[at(i - 1)] + work[at(i)]);
                }
                high.c[at(degree - k)] = work[at(degree)];
            }
        }
        let error = self.error + degree as f64 * ROUNDING * self.size();
        (low.error, high.error) = (error, error);
        [low, high]
    }

    /// The polynomial over `[-by, 1 + by]` of its box in a direction, as one over the unit interval.
    pub(super) fn widened(&self, direction: Direction, by: f64) -> Self {
        let (lines, degree, step, across) = self.lines(direction);
        let mut wide = self.clone();
        // the part from 0 to `1 + by`, then of it the part from `from` to 1
        let (to, from) = (1.0 + by, -by / (1.0 + by));
        for line in 0..lines {
            let at = |k: usize| line * across + k * step;
            let work = &mut wide.c;
            for k in 1..=degree {
                for i in (k..=degree).rev() {
                    work[at(i)] = (1.0 - to) * work[at(i - 1)] + to * work[at(i)];
                }
            }
            for k in 1..=degree {
                for i in 0..=degree - k {
                    work[at(i)] = (1.0 - from) * work[at(i)] + from * work[at(i + 1)];
                }
            }
        }
        let growth = (1.0 + 2.0 * by).powi(degree as i32) * (1.0 - 2.0 * from).powi(degree as i32);
        wide.error = growth * (self.error + 8.0 * degree as f64 * ROUNDING * self.size());
        wide
    }

    /// The value at a point of the box or near it, with a bound of its error.
    pub(super) fn value(&self, s: f64, t: f64) -> (f64, f64) {
        let (bs, bt) = (bernstein(self.m, s), bernstein(self.n, t));
        let rows = self.c.chunks_exact(self.n + 1).zip(&bs);
        let value = rows.map(|(row, b)| b * row.iter().zip(&bt).map(|(c, b)| c * b).sum::<f64>()).sum();
        let growth = |x: f64, degree: usize| ((1.0 - x).abs() + x.abs()).powi(degree as i32);
        let terms = 4.0 * (self.m + self.n + 2) as f64;
        (value, growth(s, self.m) * growth(t, self.n) * (self.error + terms * ROUNDING * self.size()))
    }

    /// The derivatives in s and t at a point, without a bound.
    pub(super) fn gradient(&self, s: f64, t: f64) -> [f64; 2] {
        let (bs, bt) = (bernstein(self.m, s), bernstein(self.n, t));
        let width = self.n + 1;
        let mut sums = [0.0; 2];
        if self.m > 0 {
            let lower = bernstein(self.m - 1, s);
            for (i, b) in lower.iter().enumerate() {
                let row = |j: usize| self.c[(i + 1) * width + j] - self.c[i * width + j];
                sums[0] += self.m as f64 * b * bt.iter().enumerate().map(|(j, b)| b * row(j)).sum::<f64>();
            }
        }
        if self.n > 0 {
            let lower = bernstein(self.n - 1, t);
            for (row, b) in self.c.chunks_exact(width).zip(&bs) {
                let slope = row.windows(2).zip(&lower).map(|(pair, b)| b * (pair[1] - pair[0])).sum::<f64>();
                sums[1] += self.n as f64 * b * slope;
            }
        }
        sums
    }

    /// The derivative in a direction.
    pub(super) fn derivative(&self, direction: Direction) -> Self {
        let width = self.n + 1;
        let (m, n, degree, step) = match direction {
            Direction::U => (self.m - 1, self.n, self.m, width),
            Direction::V => (self.m, self.n - 1, self.n, 1),
        };
        let mut c = Vec::with_capacity((m + 1) * (n + 1));
        for i in 0..=m {
            for j in 0..=n {
                let at = i * width + j;
                c.push(degree as f64 * (self.c[at + step] - self.c[at]));
            }
        }
        let error = degree as f64 * (2.0 * self.error + 4.0 * ROUNDING * self.size());
        Self { m, n, c, error }
    }

    /// The same polynomial, one degree higher in a direction.
    pub(super) fn raised(&self, direction: Direction) -> Self {
        let width = self.n + 1;
        let (m, n) = match direction {
            Direction::U => (self.m + 1, self.n),
            Direction::V => (self.m, self.n + 1),
        };
        let mut c = Vec::with_capacity((m + 1) * (n + 1));
        for i in 0..=m {
            for j in 0..=n {
                let (k, degree, step) = match direction {
                    Direction::U => (i, m, width),
                    Direction::V => (j, n, 1),
                };
                let at = i * width + j;
                let before = if k > 0 { k as f64 / degree as f64 * self.c[at - step] } else { 0.0 };
                let here = if k < degree { (degree - k) as f64 / degree as f64 * self.c[at] } else { 0.0 };
                c.push(before + here);
            }
        }
        Self { m, n, c, error: self.error + 3.0 * ROUNDING * self.size() }
    }

    /// The polynomial divided by `s` (by `1 - s` at the far end), of which it has the factor: the row of coefficients there is rounding
    /// and is taken for zero. What it was joins the bound.
    pub(super) fn divided(&self, direction: Direction, far: bool) -> Self {
        let width = self.n + 1;
        let (m, n, degree) = match direction {
            Direction::U => (self.m - 1, self.n, self.m),
            Direction::V => (self.m, self.n - 1, self.n),
        };
        let on_end = |at: usize| {
            let k = if direction == Direction::U { at / width } else { at % width };
            k == if far { degree } else { 0 }
        };
        let dropped = self.c.iter().enumerate().filter(|(at, _)| on_end(*at)).fold(0.0_f64, |a, (_, c)| a.max(c.abs()));
        let mut c = Vec::with_capacity((m + 1) * (n + 1));
        for i in 0..=m {
            for j in 0..=n {
                let k = if direction == Direction::U { i } else { j };
                let shift = usize::from(!far);
                let at = match direction {
                    Direction::U => (i + shift) * width + j,
                    Direction::V => i * width + j + shift,
                };
                // B(k + 1, m) = s m/(k + 1) B(k, m - 1), and from the other end B(k, m) = (1 - s) m/(m - k) B(k, m - 1)
                let parts = if far { degree - k } else { k + 1 };
                c.push(degree as f64 / parts as f64 * self.c[at]);
            }
        }
        let error = degree as f64 * (self.error + dropped + 2.0 * ROUNDING * self.size());
        Self { m, n, c, error }
    }

    /// The polynomial on an edge of its box: in a direction at 0, or at 1 (`far`).
    pub(super) fn edge(&self, direction: Direction, far: bool) -> Self {
        let width = self.n + 1;
        let c: Vec<f64> = match direction {
            Direction::U => {
                let row = if far { self.m } else { 0 };
                self.c[row * width..(row + 1) * width].to_vec()
            }
            Direction::V => self.c.iter().skip(if far { self.n } else { 0 }).step_by(width).copied().collect(),
        };
        Self { m: c.len() - 1, n: 0, c, error: self.error }
    }

    /// `a f + b g`, of polynomials of the same degrees.
    pub(super) fn combined(a: f64, f: &Self, b: f64, g: &Self) -> Self {
        let c = f.c.iter().zip(&g.c).map(|(x, y)| a * x + b * y).collect();
        let rounding = 2.0 * ROUNDING;
        let error = a.abs() * (f.error + rounding * f.size()) + b.abs() * (g.error + rounding * g.size());
        Self { m: f.m, n: f.n, c, error }
    }

    /// How the coefficients lie along a direction: lines, degree, the step along a line and from line to line.
    fn lines(&self, direction: Direction) -> (usize, usize, usize, usize) {
        let width = self.n + 1;
        match direction {
            Direction::U => (width, self.m, width, 1),
            Direction::V => (self.m + 1, self.n, 1, width),
        }
    }
}

/// The least and the largest of some numbers.
pub(super) fn range(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| {
        (if c < low { c } else { low }, if c > high { c } else { high })
    })
}

/// The Bernstein polynomials of degree `n` at `x`, which may lie outside the unit interval.
pub(super) fn bernstein(n: usize, x: f64) -> smallvec::SmallVec<[f64; 32]> {
    let mut b = smallvec::smallvec![0.0; n + 1];
    b[0] = 1.0;
    for degree in 1..=n {
        let mut carried = 0.0;
        for value in &mut b[..degree] {
            let share = *value;
            *value = carried + (1.0 - x) * share;
            carried = x * share;
        }
        b[degree] = carried;
    }
    b
}

/// Products of polynomials, with the binomial coefficients that they need.
#[derive(Debug)]
pub(super) struct Products {
    /// Row `n` holds the binomial coefficients of degree `n`.
    rows: Vec<Vec<f64>>,
}

impl Products {
    /// For products up to this degree in each direction.
    pub(super) fn up_to(degree: usize) -> Self {
        Self { rows: (0..=degree).map(|n| (0..=n).map(|k| binomial(n, k)).collect()).collect() }
    }

    /// The sum of the products of pairs; all first factors have one pair of degrees, and all second ones.
    pub(super) fn sum<'a>(&self, pairs: impl Iterator<Item = (&'a Polynomial, &'a Polynomial)>) -> Polynomial {
        self.sum_weighted(pairs, None)
    }

    /// The sum over pairs of `f' g - f g'`, the derivatives in a direction, without its leading degree, which cancels:
    /// with `f̂`, `ĝ` the coefficients times their binomials, coefficient `k` is the sum over `i + j = k + 1` of `(i - j) f̂_i ĝ_j`, over
    /// its binomial of degree `2 m - 2`.
    pub(super) fn wronskian(&self, f: &Polynomial, g: &Polynomial, direction: Direction) -> Polynomial {
        self.sum_weighted(std::iter::once((f, g)), Some(direction))
    }

    fn sum_weighted<'a>(
        &self,
        pairs: impl Iterator<Item = (&'a Polynomial, &'a Polynomial)>,
        wronskian: Option<Direction>,
    ) -> Polynomial {
        let mut result = Polynomial { m: 0, n: 0, c: Vec::new(), error: 0.0 };
        let (mut terms, mut magnitude, mut error) = (0, 0.0, 0.0);
        for (f, g) in pairs {
            let drop = |direction: Direction| if wronskian == Some(direction) { 2 } else { 0 };
            result.m = f.m + g.m - drop(Direction::U);
            result.n = f.n + g.n - drop(Direction::V);
            let width = result.n + 1;
            result.c.resize((result.m + 1) * width, 0.0);
            let (f_hat, g_hat) = (self.scaled(f), self.scaled(g));
            for (at_f, x) in f_hat.iter().enumerate() {
                let (i, k) = (at_f / (f.n + 1), at_f % (f.n + 1));
                for (row, line) in g_hat.chunks_exact(g.n + 1).enumerate() {
                    match wronskian {
                        None => {
                            let at = (i + row) * width + k;
                            result.c[at..=at + g.n].iter_mut().zip(line).for_each(|(sum, y)| *sum += x * y);
                        }
                        Some(Direction::U) if i != row => {
                            let (at, factor) = ((i + row - 1) * width + k, i as f64 - row as f64);
                            result.c[at..=at + g.n].iter_mut().zip(line).for_each(|(sum, y)| *sum += factor * x * y);
                        }
                        Some(Direction::V) => {
                            for (l, y) in line.iter().enumerate().filter(|(l, _)| *l != k) {
                                result.c[(i + row) * width + k + l - 1] += (k as f64 - l as f64) * x * y;
                            }
                        }
                        Some(Direction::U) => {}
                    }
                }
            }
            let (a, b) = (f.size(), g.size());
            terms += (f.m.min(g.m) + 1) * (f.n.min(g.n) + 1);
            magnitude += a * b;
            error += a * g.error + b * f.error + f.error * g.error;
        }
        let (down, along) = (&self.rows[result.m], &self.rows[result.n]);
        for (row, b) in result.c.chunks_exact_mut(result.n + 1).zip(down) {
            row.iter_mut().zip(along).for_each(|(c, d)| *c /= b * d);
        }
        // binomial coefficients are exact up to degree 50, and err by two roundings a factor beyond
        let degree = result.m.max(result.n) + 2;
        let binomials = if degree > 50 { 12 * degree } else { 0 };
        let weights = wronskian.map_or(1.0, |direction| {
            let degree = if direction == Direction::U { result.m } else { result.n };
            self.wronskian_weight(degree)
        });
        result.error = weights * (error + (terms + 10 + binomials) as f64 * ROUNDING * magnitude);
        result
    }

    /// The largest sum of |weights| in a coefficient of a Wronskian of this degree.
    fn wronskian_weight(&self, degree: usize) -> f64 {
        let m = degree / 2 + 1;
        let weight = |k: usize| {
            let inner = (0..=m).filter(|i| k + 1 >= *i && k + 1 - i <= m);
            let sum = inner.map(|i| {
                let j = k + 1 - i;
                i.abs_diff(j) as f64 * self.rows[m][i] * self.rows[m][j]
            });
            sum.sum::<f64>() / self.rows[degree][k]
        };
        (0..=degree).map(weight).fold(0.0, f64::max)
    }

    fn scaled(&self, f: &Polynomial) -> Vec<f64> {
        let (down, along) = (&self.rows[f.m], &self.rows[f.n]);
        let rows = f.c.chunks_exact(f.n + 1).zip(down);
        rows.flat_map(|(row, b)| row.iter().zip(along).map(move |(c, d)| c * (b * d))).collect()
    }
}
