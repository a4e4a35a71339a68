//! Arithmetic of about 32 digits, and random numbers, for tests.

use std::ops::{Add, Div, Mul, Sub};

use glam::DVec3;

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

#[test]
fn thirds_add_up_to_thirty_digits() {
    let third = DoubleDouble::from(1.0) / 3.0;
    let one = third + third + third;
    assert!((one - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
    let seventh = DoubleDouble::from(1.0) / DoubleDouble::from(7.0);
    assert!((seventh * DoubleDouble::from(7.0) - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
    assert!((third * DoubleDouble::from(3.0) - DoubleDouble::from(1.0)).to_f64().abs() < 1e-31);
}
