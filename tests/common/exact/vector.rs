//! Vectors and frames of 32 digits.

use glam::DVec3;

use crate::common::double_double::Dd;

/// A vector of 32 digits.
#[derive(Debug, Clone, Copy)]
pub struct Vector(pub [Dd; 3]);

impl Vector {
    pub const ZERO: Self = Self([Dd::ZERO; 3]);

    /// The exact vector from `a` to `b`.
    pub fn between(a: DVec3, b: DVec3) -> Self {
        Self([Dd::difference(b.x, a.x), Dd::difference(b.y, a.y), Dd::difference(b.z, a.z)])
    }

    pub fn plus(self, other: Self) -> Self {
        Self([0, 1, 2].map(|k| self.0[k] + other.0[k]))
    }

    pub fn minus(self, other: Self) -> Self {
        Self([0, 1, 2].map(|k| self.0[k] - other.0[k]))
    }

    pub fn times(self, factor: Dd) -> Self {
        Self(self.0.map(|x| x * factor))
    }

    pub fn dot(self, other: Self) -> Dd {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    pub fn cross(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([b * f - c * e, c * d - a * f, a * e - b * d])
    }

    pub fn length(self) -> Dd {
        self.dot(self).sqrt()
    }

    /// None where the vector is zero.
    pub fn unit(self) -> Option<Self> {
        let length = self.length();
        (length > Dd::ZERO).then(|| self.times(Dd::ONE / length))
    }

    pub fn rounded(self) -> DVec3 {
        DVec3::from_array(self.0.map(Dd::value))
    }
}

impl From<DVec3> for Vector {
    fn from(v: DVec3) -> Self {
        Self(v.to_array().map(Dd::from))
    }
}

/// A right-handed frame whose directions are at right angles to 32 digits.
#[derive(Debug, Clone, Copy)]
pub struct Axes {
    pub centre: DVec3,
    pub x: Vector,
    pub y: Vector,
    pub z: Vector,
}

impl Axes {
    /// The frame next to these directions, which are of unit length and at right angles but for rounding.
    pub fn new(centre: DVec3, axis: DVec3, xdir: DVec3) -> Self {
        let z = Vector::from(axis).unit().expect("an axis");
        let given = Vector::from(xdir);
        let x = given.minus(z.times(given.dot(z))).unit().expect("xdir is across the axis");
        Self { centre, x, y: z.cross(x), z }
    }

    /// The coordinates of a point.
    pub fn coordinates(&self, p: DVec3) -> [Dd; 3] {
        let arm = Vector::between(self.centre, p);
        [arm.dot(self.x), arm.dot(self.y), arm.dot(self.z)]
    }

    /// The point at these coordinates, rounded.
    pub fn point(&self, x: f64, y: f64, z: f64) -> DVec3 {
        let arm = self.x.times(x.into()).plus(self.y.times(y.into())).plus(self.z.times(z.into()));
        Vector::from(self.centre).plus(arm).rounded()
    }
}
