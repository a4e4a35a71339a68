//! Polynomials of which it is known how far rounding has moved them.

use glam::{DVec3, DVec4};

use super::bernstein::{Coefficient, Form, Side};

/// A form, and a bound of the distance between each of its coefficients and the exact one.
#[derive(Debug, Clone)]
pub(super) struct Near<T> {
    pub form: Form<T>,
    pub error: f64,
}

/// What has a length.
pub(super) trait Long: Coefficient {
    fn long(self) -> f64;
}

impl Long for f64 {
    fn long(self) -> f64 {
        self.abs()
    }
}

impl Long for DVec3 {
    fn long(self) -> f64 {
        self.length()
    }
}

impl<T: Long> Near<T> {
    /// The length of the longest coefficient: no value is longer, up to the error.
    pub(super) fn longest(&self) -> f64 {
        self.form.coefficients.iter().map(|c| c.long()).fold(0.0, f64::max)
    }

    /// A bound of the length of all values, rounding included.
    pub(super) fn bound(&self) -> f64 {
        (self.longest() + self.error) * (1.0 + 8.0 * f64::EPSILON)
    }

    /// The product by a map of which `|times(a, b)| <= |a| |b|`.
    pub(super) fn product<B: Long, R: Long>(&self, other: &Near<B>, times: impl Fn(T, B) -> R) -> Near<R> {
        let form = self.form.product(&other.form, times);
        let (a, b) = (self.longest(), other.longest());
        let degree = (form.degree.0 + form.degree.1 + 8) as f64;
        let error = a * other.error + b * self.error + self.error * other.error + 4.0 * degree * f64::EPSILON * a * b;
        Near { form, error }
    }

    /// The sum with a form of the same degree, times a factor.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let coefficients = self.form.coefficients.iter().zip(&other.form.coefficients);
        let form =
            Form { degree: self.form.degree, coefficients: coefficients.map(|(a, b)| *a + *b * factor).collect() };
        let error = self.error
            + factor.abs() * other.error
            + 2.0 * f64::EPSILON * (self.longest() + factor.abs() * other.longest());
        Self { form, error }
    }

    /// The lower and the upper half of a parameter.
    pub(super) fn halves(&self, side: Side) -> (Self, Self) {
        let error = self.error + f64::EPSILON * (self.form.degree.0 + self.form.degree.1) as f64 * self.longest();
        let (lower, upper) = self.form.clone().halves(side);
        (Self { form: lower, error }, Self { form: upper, error })
    }
}

impl Near<DVec3> {
    /// The cross product.
    pub(super) fn cross(&self, other: &Self) -> Self {
        self.product(other, |a, b| a.cross(b))
    }

    /// A lower bound of the lengths of all values, proven by their shadow on one direction; 0 where that proves nothing.
    pub(super) fn least(&self) -> f64 {
        let mean = self.form.coefficients.iter().copied().sum::<DVec3>().normalize_or_zero();
        let shadow = self.form.coefficients.iter().map(|c| c.dot(mean)).fold(f64::INFINITY, f64::min);
        ((shadow - self.error) * (1.0 - 8.0 * f64::EPSILON) - 4.0 * f64::EPSILON * self.longest()).max(0.0)
    }

    /// A direction, and a bound of the angle between it and every value; none where the values may point anywhere.
    pub(super) fn cone(&self) -> Option<(DVec3, f64)> {
        let mean = self.form.coefficients.iter().copied().sum::<DVec3>().try_normalize()?;
        let mut widest = 0.0_f64;
        for c in &self.form.coefficients {
            let (length, along) = (c.length(), c.dot(mean));
            if along <= 4.0 * self.error || length <= 4.0 * self.error {
                return None;
            }
            widest = widest.max(mean.cross(*c).length().atan2(along) + 2.0 * self.error / length + 4.0 * f64::EPSILON);
        }
        (widest < 1.5).then_some((mean, widest))
    }
}

/// A row of homogeneous points as polynomial in one parameter: the points times their weights, and the weights.
pub(super) fn parted(row: &[DVec4], error: f64, per_weight: f64) -> (Near<DVec3>, Near<f64>) {
    let degree = (row.len() - 1, 0);
    let points = Form { degree, coefficients: row.iter().map(|c| c.truncate()).collect() };
    let weights = Form { degree, coefficients: row.iter().map(|c| c.w).collect() };
    (Near { form: points, error }, Near { form: weights, error: per_weight })
}
