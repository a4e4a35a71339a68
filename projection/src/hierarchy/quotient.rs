//! Boxes around the derivatives of a rational piece.
//!
//! With `S = A / w` the quotient rule gives
//!
//! ```text
//! S_s  = V / w²,                        V = A_s w - A w_s,      S_t likewise with U = A_t w - A w_t
//! S_ss = (V_s w - 2 V w_s) / w³,        S_st = (V_t w - 2 V w_t) / w³,      S_tt = (U_t w - 2 U w_t) / w³
//! ```
//!
//! Numerators and denominators are Bernstein polynomials; raised to one degree, the quotient is a convex combination of the quotients of their
//! coefficients, as all weights are positive. So it lies in the box around these.
//!
//! All coefficients are kept times their binomials: products are then convolutions, `n C(n - 1, i) (c[i + 1] - c[i]) = (i + 1) c~[i + 1] - (n - i) c~[i]`
//! gives derivatives, and the binomials fall out of the quotients.
//!
//! # Rounding
//!
//! A coefficient of a product is, but for its binomials, a convex combination of at most `N = (p + 1)(q + 1)` products of coefficients: it errs by at
//! most `(N + 10) u` of the largest of these. With `|A| <= r W`, `w <= W`, a derivative being at most `2 n` times its polynomial and `n` the greater
//! degree: `|V| <= 4 n r W²` errs by `6 n (N + 10) u r W²`, the numerators of the second derivatives are at most `24 n² r W³` and err by
//! `100 n² (N + 10) u r W³`. Divided by the least denominator, with `rho` the ratio of the weights, `margin` is twice that.

use glam::{DMat3, DVec3, DVec4};
use perpend_kernel::{Aabb, binomial};

use super::ROUNDING;
use super::form::Shape;

/// Boxes around a rational piece and its derivatives, along given axes.
#[derive(Debug)]
pub(super) struct Boxes {
    pub p: Aabb,
    pub ps: Aabb,
    pub pt: Aabb,
    pub pss: Aabb,
    pub pst: Aabb,
    pub ptt: Aabb,
}

impl Boxes {
    /// Around a piece whose control points lie within `radius` of the origin and whose weights are at most `heaviest` and at least `lightest`.
    pub(super) fn around(leaf: Shape<'_>, axes: &DMat3, radius: f64, (lightest, heaviest): (f64, f64)) -> Self {
        let turned = |h: &DVec4| (*axes * h.truncate()).extend(h.w);
        let net = Polynomial::scaled(leaf.degree, leaf.net.iter().map(turned));
        let [net_s, net_t] = [net.derivative_s(), net.derivative_t()];
        let w2 = net.times(&net);
        let w3 = w2.times(&net);
        let (v, u) = (net.numerator(&net_s, 1.0), net.numerator(&net_t, 1.0));
        let ss = net.second(&v, &v.derivative_s(), &net_s);
        let st = net.second(&v, &v.derivative_t(), &net_t);
        let tt = net.second(&u, &u.derivative_t(), &net_t);
        let margin = |power: i32| margin(leaf.degree, radius, heaviest / lightest, power);
        Self {
            p: wider(net.quotients(&net), margin(1)),
            ps: wider(v.quotients(&w2), margin(2)),
            pt: wider(u.quotients(&w2), margin(2)),
            pss: wider(ss.quotients(&w3), margin(3)),
            pst: wider(st.quotients(&w3), margin(3)),
            ptt: wider(tt.quotients(&w3), margin(3)),
        }
    }
}

/// What the coefficients of a quotient with the weight to the given power are off by rounding, at most; `ratio` is that of the weights.
fn margin((p, q): (usize, usize), radius: f64, ratio: f64, power: i32) -> f64 {
    let (n, count) = (p.max(q) as f64, ((p + 1) * (q + 1)) as f64);
    200.0 * n * n * (count + 10.0) * ROUNDING * radius * ratio.powi(power)
}

fn wider(bounds: Aabb, margin: f64) -> Aabb {
    Aabb { min: bounds.min - DVec3::splat(margin), max: bounds.max + DVec3::splat(margin) }
}

/// A polynomial in Bernstein form, a vector and, as fourth coordinate, a weight: every coefficient times its binomials.
struct Polynomial {
    degree: (usize, usize),
    coefficients: Vec<DVec4>,
}

impl Polynomial {
    fn zero(degree: (usize, usize)) -> Self {
        Self { degree, coefficients: vec![DVec4::ZERO; (degree.0 + 1) * (degree.1 + 1)] }
    }

    /// From coefficients without their binomials, in row order.
    fn scaled(degree: (usize, usize), coefficients: impl Iterator<Item = DVec4>) -> Self {
        let width = degree.1 + 1;
        let scale = |(at, c)| binomial(degree.0, at / width) * binomial(degree.1, at % width) * c;
        Self { degree, coefficients: coefficients.enumerate().map(scale).collect() }
    }

    fn at(&self, i: usize, j: usize) -> DVec4 {
        self.coefficients[i * (self.degree.1 + 1) + j]
    }

    /// All four coordinates times the other's weight.
    fn times(&self, other: &Self) -> Self {
        let degree = (self.degree.0 + other.degree.0, self.degree.1 + other.degree.1);
        let (width, others, product) = (self.degree.1 + 1, other.degree.1 + 1, degree.1 + 1);
        let mut result = Self::zero(degree);
        for (i, row) in self.coefficients.chunks_exact(width).enumerate() {
            for (k, weights) in other.coefficients.chunks_exact(others).enumerate() {
                let sums = &mut result.coefficients[(i + k) * product..][..product];
                for (l, weight) in weights.iter().enumerate() {
                    sums[l..].iter_mut().zip(row).for_each(|(sum, a)| *sum += weight.w * *a);
                }
            }
        }
        result
    }

    fn minus(mut self, other: &Self, factor: f64) -> Self {
        self.coefficients.iter_mut().zip(&other.coefficients).for_each(|(a, b)| *a -= factor * *b);
        self
    }

    fn derivative_s(&self) -> Self {
        let (p, q) = self.degree;
        let mut result = Self::zero((p.saturating_sub(1), q));
        for i in 0..p {
            for j in 0..=q {
                result.coefficients[i * (q + 1) + j] =
                    (i + 1) as f64 * self.at(i + 1, j) - (p - i) as f64 * self.at(i, j);
            }
        }
        result
    }

    fn derivative_t(&self) -> Self {
        let (p, q) = self.degree;
        let mut result = Self::zero((p, q.saturating_sub(1)));
        for i in 0..=p {
            for j in 0..q {
                result.coefficients[i * q + j] = (j + 1) as f64 * self.at(i, j + 1) - (q - j) as f64 * self.at(i, j);
            }
        }
        result
    }

    /// `self' w - factor self w'` with the weight of `self` and its derivative `self'`.
    fn numerator(&self, derivative: &Self, factor: f64) -> Self {
        derivative.times(self).minus(&self.times(derivative), factor)
    }

    /// `v' w - 2 v w'` with the weight of `self`, whose derivative is `derivative`, and the derivative `v'` of `v` in the same direction.
    fn second(&self, v: &Self, v_derivative: &Self, derivative: &Self) -> Self {
        v_derivative.times(self).minus(&v.times(derivative), 2.0)
    }

    /// The same polynomial in a form of a higher degree.
    fn raised(&self, degree: (usize, usize)) -> Self {
        let by = (degree.0 - self.degree.0, degree.1 - self.degree.1);
        let one = Self::scaled(by, std::iter::repeat_n(DVec4::W, (by.0 + 1) * (by.1 + 1)));
        self.times(&one)
    }

    /// The box around the quotients of the vector coefficients and a denominator's weights.
    fn quotients(&self, denominator: &Self) -> Aabb {
        let raised = self.raised(denominator.degree);
        let quotients = raised.coefficients.iter().zip(&denominator.coefficients);
        Aabb::around(quotients.map(|(a, w)| a.truncate() / w.w))
    }
}

#[cfg(test)]
mod tests {
    use super::super::double_double::{DoubleDouble, Random};
    use super::super::jet::Jet;
    use super::*;
    use fearless_simd::Level;

    /// Every derivative of random rational pieces lies in its box, and the boxes of a piece that hardly bends are not much larger than what they hold.
    #[test]
    fn derivatives_lie_in_their_boxes() {
        let mut random = Random(21);
        for round in 0..200 {
            let degree = [(1, 0), (2, 0), (5, 0), (1, 1), (2, 1), (1, 2), (3, 2), (2, 5)][round % 8];
            let count = (degree.0 + 1) * (degree.1 + 1);
            let net: Vec<DVec4> = (0..count)
                .map(|_| {
                    let weight = 10.0_f64.powf(random.between(-0.5, 0.0));
                    (random.point() * weight).extend(weight)
                })
                .collect();
            let weights = net.iter().fold((f64::MAX, 0.0_f64), |(a, b), h| (a.min(h.w), b.max(h.w)));
            let radius = net.iter().map(|h| (h.truncate() / h.w).length()).fold(0.0, f64::max);
            let leaf = Shape { degree, rational: true, net: &net };
            let boxes = Boxes::around(leaf, &DMat3::IDENTITY, radius, weights);
            for _ in 0..200 {
                let (s, t) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
                let jet = Jet::at(Level::new(), &net, degree, true, s, t);
                let held = [
                    (jet.p, boxes.p),
                    (jet.ps, boxes.ps),
                    (jet.pt, boxes.pt),
                    (jet.pss, boxes.pss),
                    (jet.pst, boxes.pst),
                    (jet.ptt, boxes.ptt),
                ];
                for (k, (value, bounds)) in
                    held.into_iter().enumerate().filter(|(k, _)| degree.1 > 0 || [0, 1, 3].contains(k))
                {
                    let value = value.truncate();
                    let slack = DVec3::splat(1e-11 * (1.0 + value.abs().max_element()));
                    let wider = Aabb { min: bounds.min - slack, max: bounds.max + slack };
                    assert!(wider.contains(value), "{degree:?} derivative {k}: {value} outside {bounds:?}");
                }
            }
        }
        // a straight line with equal weights: the boxes are the derivatives themselves
        let net: Vec<DVec4> = (0..3).map(|i| DVec4::new(f64::from(i), 0.0, 0.0, 1.0)).collect();
        let leaf = Shape { degree: (2, 0), rational: true, net: &net };
        let boxes = Boxes::around(leaf, &DMat3::IDENTITY, 2.0, (1.0, 1.0));
        assert!((boxes.ps.max - DVec3::new(2.0, 0.0, 0.0)).length() < 1e-9 && boxes.pss.diagonal() < 1e-9);
    }

    /// As [`Polynomial`], to 30 digits.
    struct Exact {
        degree: (usize, usize),
        coefficients: Vec<[DoubleDouble; 4]>,
    }

    impl Exact {
        fn at(&self, i: usize, j: usize) -> [DoubleDouble; 4] {
            self.coefficients[i * (self.degree.1 + 1) + j]
        }

        /// All four coordinates times the other's weight.
        fn times(&self, other: &Self) -> Self {
            let ((p, q), (m, n)) = (self.degree, other.degree);
            let number = DoubleDouble::from;
            let mut sums = vec![[number(0.0); 4]; (p + m + 1) * (q + n + 1)];
            for (e, a) in self.coefficients.iter().enumerate() {
                for (f, b) in other.coefficients.iter().enumerate() {
                    let (i, j, k, l) = (e / (q + 1), e % (q + 1), f / (n + 1), f % (n + 1));
                    let ways = [binomial(p, i), binomial(m, k), binomial(q, j), binomial(n, l)];
                    let share = ways.iter().fold(b[3], |share, way| share * number(*way));
                    let share = share / exact_binomial(p + m, i + k) / exact_binomial(q + n, j + l);
                    let sum = &mut sums[(i + k) * (q + n + 1) + j + l];
                    (0..4).for_each(|c| sum[c] = sum[c] + share * a[c]);
                }
            }
            Self { degree: (p + m, q + n), coefficients: sums }
        }

        fn minus(mut self, other: &Self, factor: f64) -> Self {
            for (a, b) in self.coefficients.iter_mut().zip(&other.coefficients) {
                (0..4).for_each(|c| a[c] = a[c] - DoubleDouble::from(factor) * b[c]);
            }
            self
        }

        fn derivative(&self, in_s: bool) -> Self {
            let (p, q) = self.degree;
            let (by, degree) = if in_s { (p, (p - 1, q)) } else { (q, (p, q - 1)) };
            let factor = DoubleDouble::from(by as f64);
            let indices = (0..=degree.0).flat_map(|i| (0..=degree.1).map(move |j| (i, j)));
            let coefficients = indices.map(|(i, j)| {
                let (next, here) = (if in_s { self.at(i + 1, j) } else { self.at(i, j + 1) }, self.at(i, j));
                [0, 1, 2, 3].map(|c| factor * (next[c] - here[c]))
            });
            Self { degree, coefficients: coefficients.collect() }
        }

        /// The least and the most that each coordinate of the coefficients' quotients is.
        fn quotients(&self, denominator: &Self) -> [[DoubleDouble; 2]; 3] {
            let by = (denominator.degree.0 - self.degree.0, denominator.degree.1 - self.degree.1);
            let one = [0.0, 0.0, 0.0, 1.0].map(DoubleDouble::from);
            let raised = self.times(&Self { degree: by, coefficients: vec![one; (by.0 + 1) * (by.1 + 1)] });
            [0, 1, 2].map(|c| {
                let quotients = raised.coefficients.iter().zip(&denominator.coefficients).map(|(a, w)| a[c] / w[3]);
                let by_value = |a: &DoubleDouble, b: &DoubleDouble| a.to_f64().total_cmp(&b.to_f64());
                let all: Vec<DoubleDouble> = quotients.collect();
                let least = all.iter().copied().min_by(by_value).expect("a net has coefficients");
                let most = all.iter().copied().max_by(by_value).expect("a net has coefficients");
                [least, most]
            })
        }
    }

    fn exact_binomial(n: usize, k: usize) -> DoubleDouble {
        let number = DoubleDouble::from;
        (0..k.min(n - k)).fold(number(1.0), |c, i| c * number((n - i) as f64) / number((i + 1) as f64))
    }

    /// The boxes are those of the exact coefficients to within their margins, and of even weights a thousandth of a margin is exceeded.
    #[test]
    fn boxes_err_within_their_margins() {
        let mut random = Random(53);
        let (mut worst, mut worst_even) = (0.0_f64, 0.0_f64);
        for round in 0..240 {
            let degree = [(1, 0), (2, 0), (5, 0), (25, 0), (1, 1), (2, 1), (1, 4), (3, 3)][round % 8];
            // even weights, as wide as a leaf's are, and wider
            let powers = [0.01, 1.2, 5.0][round / 8 % 3];
            let count = (degree.0 + 1) * (degree.1 + 1);
            let net: Vec<DVec4> = (0..count)
                .map(|_| {
                    let weight = 2.0 * 10.0_f64.powf(-random.between(0.0, powers));
                    (random.point() * weight).extend(weight)
                })
                .collect();
            let weights = net.iter().fold((f64::MAX, 0.0_f64), |(a, b), h| (a.min(h.w), b.max(h.w)));
            let radius = net.iter().map(|h| (h.truncate() / h.w).length()).fold(0.0, f64::max);
            let boxes = Boxes::around(Shape { degree, rational: true, net: &net }, &DMat3::IDENTITY, radius, weights);
            let coefficients = net.iter().map(|h| h.to_array().map(DoubleDouble::from)).collect();
            let net = Exact { degree, coefficients };
            let w2 = net.times(&net);
            let w3 = w2.times(&net);
            let directions: &[bool] = if degree.1 > 0 { &[true, false] } else { &[true] };
            let mut held = vec![(boxes.p, net.quotients(&net), 1)];
            for in_s in directions {
                let first = net.derivative(*in_s);
                let v = first.times(&net).minus(&net.times(&first), 1.0);
                held.push((if *in_s { boxes.ps } else { boxes.pt }, v.quotients(&w2), 2));
                for and_s in directions {
                    let other = net.derivative(*and_s);
                    let second = v.derivative(*and_s).times(&net).minus(&v.times(&other), 2.0);
                    let bounds = match (in_s, and_s) {
                        (true, true) => boxes.pss,
                        (false, false) => boxes.ptt,
                        _ => boxes.pst,
                    };
                    held.push((bounds, second.quotients(&w3), 3));
                }
            }
            for (bounds, exact, power) in held {
                let margin = margin(degree, radius, weights.1 / weights.0, power);
                for (c, [least, most]) in exact.into_iter().enumerate() {
                    let beyond = |bound: f64, exact: DoubleDouble| (DoubleDouble::from(bound) - exact).to_f64();
                    let (below, above) = (-beyond(bounds.min[c], least), beyond(bounds.max[c], most));
                    assert!(below >= 0.0 && above >= 0.0, "{degree:?} {power}: {below} {above} of {margin}");
                    let error = (below - margin).abs().max((above - margin).abs()) / margin;
                    worst = worst.max(error);
                    if powers < 0.1 {
                        worst_even = worst_even.max(error);
                    }
                }
            }
        }
        assert!(worst < 1.0, "the margin is exceeded: {worst}");
        assert!(worst_even > 1e-3, "the margins are idle: {worst_even}");
    }
}
