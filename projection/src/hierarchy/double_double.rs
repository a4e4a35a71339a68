//! Arithmetic of about 32 digits, and random numbers, for tests.

use std::ops::{Add, Div, Mul, Sub};

use glam::{DVec3, DVec4};
use perpend_kernel::binomial;

/// The unevaluated sum of two numbers, the second at most half an ulp of the first (Dekker 1971).
#[derive(Debug, Clone, Copy)]
pub(crate) struct DoubleDouble(f64, f64);

impl DoubleDouble {
    pub(crate) fn to_f64(self) -> f64 {
        self.0 + self.1
    }

    /// `a + b` exactly, for any order of magnitudes (Knuth).
    fn two_sum(a: f64, b: f64) -> Self {
        let sum = a + b;
        let part = sum - a;
        Self(sum, (a - (sum - part)) + (b - part))
    }

    fn renormalise(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self(sum, low - (sum - high))
    }
}

impl From<f64> for DoubleDouble {
    fn from(x: f64) -> Self {
        Self(x, 0.0)
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = (Self::two_sum(self.0, other.0), Self::two_sum(self.1, other.1));
        let first = Self::renormalise(high.0, high.1 + low.0);
        Self::renormalise(first.0, first.1 + low.1)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self(-other.0, -other.1)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let error = self.0.mul_add(other.0, -product);
        Self::renormalise(product, error + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div<f64> for DoubleDouble {
    type Output = Self;

    fn div(self, by: f64) -> Self {
        let first = self.0 / by;
        let rest = self - Self(first, 0.0) * Self(by, 0.0);
        Self::renormalise(first, rest.to_f64() / by)
    }
}

impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, by: Self) -> Self {
        let first = Self(self.0 / by.0, 0.0);
        let rest = self - first * by;
        let second = Self(rest.0 / by.0, 0.0);
        let rest = rest - second * by;
        first + second + Self(rest.0 / by.0, 0.0)
    }
}

/// A small generator of reproducible random numbers (xorshift).
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 >> 11
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next() as f64 / (1_u64 << 53) as f64
    }

    /// A point of the cube of side 2 about the origin.
    pub(crate) fn point(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }
}

/// Bernstein polynomials of degree `n`, and their first two derivatives.
pub(crate) fn basis(n: usize, x: f64) -> Vec<[DoubleDouble; 3]> {
    let number = DoubleDouble::from;
    let power = |base: DoubleDouble, k: usize| (0..k).fold(number(1.0), |product, _| product * base);
    let (x, y) = (number(x), number(1.0) - number(x));
    // of degree `n - less`, and 0 for an index outside
    let value = |less: usize, i: usize, back: usize| match i.checked_sub(back) {
        Some(i) if less <= n && i <= n - less => number(binomial(n - less, i)) * power(x, i) * power(y, n - less - i),
        _ => number(0.0),
    };
    (0..=n)
        .map(|i| {
            let second = value(2, i, 2) - value(2, i, 1) - value(2, i, 1) + value(2, i, 0);
            let factors = [n as f64, (n * n.saturating_sub(1)) as f64].map(number);
            [value(0, i, 0), factors[0] * (value(1, i, 1) - value(1, i, 0)), factors[1] * second]
        })
        .collect()
}

/// A point of a Bézier piece with the homogeneous net `net`, and its derivatives: `S`, `S_s`, `S_t`, `S_ss`, `S_st`, `S_tt`.
pub(crate) fn derivatives(net: &[DVec4], (p, q): (usize, usize), s: f64, t: f64) -> [[DoubleDouble; 3]; 6] {
    let number = DoubleDouble::from;
    let (bs, bt) = (basis(p, s), basis(q, t));
    let orders = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)];
    let mut sums = [[number(0.0); 4]; 6];
    for (e, h) in net.iter().enumerate() {
        for (sum, (k, l)) in sums.iter_mut().zip(orders) {
            let share = bs[e / (q + 1)][k] * bt[e % (q + 1)][l];
            (0..4).for_each(|c| sum[c] = sum[c] + share * number(h[c]));
        }
    }
    let [w, ws, wt, wss, wst, wtt] = sums.map(|sum| sum[3]);
    let quotient = |of: usize, less: &[(DoubleDouble, [DoubleDouble; 3])]| {
        [0, 1, 2].map(|c| less.iter().fold(sums[of][c], |sum, (factor, from)| sum - *factor * from[c]) / w)
    };
    let point = quotient(0, &[]);
    let (s, t) = (quotient(1, &[(ws, point)]), quotient(2, &[(wt, point)]));
    let ss = quotient(3, &[(ws, s), (ws, s), (wss, point)]);
    let st = quotient(4, &[(ws, t), (wt, s), (wst, point)]);
    let tt = quotient(5, &[(wt, t), (wt, t), (wtt, point)]);
    [point, s, t, ss, st, tt]
}

/// The squared distance `D` from `x` to a point of a Bézier piece, and its derivatives: `D`, `D_s`, `D_t`, `D_ss`, `D_st`, `D_tt`.
pub(crate) fn squared_distance(
    net: &[DVec4],
    degree: (usize, usize),
    x: DVec3,
    (s, t): (f64, f64),
) -> [DoubleDouble; 6] {
    let number = DoubleDouble::from;
    let [point, s, t, ss, st, tt] = derivatives(net, degree, s, t);
    let offset = [0, 1, 2].map(|c| point[c] - number(x[c]));
    let dot = |a: [DoubleDouble; 3], b: [DoubleDouble; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let twice = |x: DoubleDouble| x + x;
    [
        dot(offset, offset),
        twice(dot(offset, s)),
        twice(dot(offset, t)),
        twice(dot(s, s) + dot(offset, ss)),
        twice(dot(s, t) + dot(offset, st)),
        twice(dot(t, t) + dot(offset, tt)),
    ]
}

#[test]
fn thirds_add_up_to_thirty_digits() {
    let third = DoubleDouble::from(1.0) / 3.0;
    let one = third + third + third;
    assert!((one - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
    let seventh = DoubleDouble::from(1.0) / DoubleDouble::from(7.0);
    assert!((seventh * DoubleDouble::from(7.0) - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
    assert!((third * DoubleDouble::from(3.0) - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
}

#[test]
fn derivatives_of_a_squared_distance_are_its_differences() {
    let mut random = Random(41);
    let net: Vec<DVec4> = (0..12).map(|_| random.point().extend(random.between(0.5, 2.0))).collect();
    let (x, at, h) = (random.point(), (0.3, 0.6), 1e-4);
    let value = |ds: f64, dt: f64| squared_distance(&net, (3, 2), x, (at.0 + ds * h, at.1 + dt * h))[0].to_f64();
    let found = squared_distance(&net, (3, 2), x, at).map(DoubleDouble::to_f64);
    let expected = [
        value(0.0, 0.0),
        (value(1.0, 0.0) - value(-1.0, 0.0)) / (2.0 * h),
        (value(0.0, 1.0) - value(0.0, -1.0)) / (2.0 * h),
        (value(1.0, 0.0) - 2.0 * value(0.0, 0.0) + value(-1.0, 0.0)) / (h * h),
        (value(1.0, 1.0) - value(1.0, -1.0) - value(-1.0, 1.0) + value(-1.0, -1.0)) / (4.0 * h * h),
        (value(0.0, 1.0) - 2.0 * value(0.0, 0.0) + value(0.0, -1.0)) / (h * h),
    ];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{found} {expected}");
    }
}
