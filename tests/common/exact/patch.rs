//! Distances to patches of spheres, cylinders, cones and tori: the stationary points of the whole surface that lie in the patch,
//! and the four edges, each a segment or an arc in space with its ends. The least counts.
//!
//! Where stationary points are not isolated (an axis, a centre, a spine), whole circles or the whole patch are as near, and
//! each of them meets an edge; so nothing is missed by leaving them out.

use super::curve::{Arc, least, to_segment};
use super::turn::{Range, direction};
use super::vector::Vector;
use crate::common::double_double::Dd;

/// What is turned about z: in the half plane of an angle, `(distance from the axis, height)`.
#[derive(Debug, Clone, Copy)]
pub enum Profile {
    /// From and to.
    Ruling([[Dd; 2]; 2]),
    /// A part of the circle about `(spine, 0)`.
    Arc { spine: Dd, radius: Dd, range: Range },
}

/// A profile turned about the z axis of coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Patch {
    pub profile: Profile,
    pub sweep: Range,
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn unit(axis: [f64; 3]) -> Vector {
    Vector(axis.map(Dd::from))
}

impl Patch {
    pub fn distance(&self, p: Vector) -> Dd {
        let inside = self.stationary(p).into_iter().filter(|(_, held)| *held).map(|(q, _)| p.minus(q).length());
        least(inside.chain(self.meridians(p)).chain(self.parallels(p)))
    }

    /// The isolated stationary points of the distance on the whole surface, each with whether the patch holds it.
    fn stationary(&self, p: Vector) -> Vec<(Vector, bool)> {
        let [x, y, _] = p.0;
        let outward = Vector([x, y, Dd::ZERO]).unit();
        let beside = |sign: f64| outward.map(|w| w.times(Dd::from(sign)));
        let turned = |q: Vector| self.sweep.holds(q.0[0], q.0[1]);
        let mut found = Vec::new();
        match self.profile {
            Profile::Ruling([[r0, z0], [r1, z1]]) => {
                // the nearest and the farthest ruling of the whole surface, met at right angles
                for w in [beside(1.0), beside(-1.0)].into_iter().flatten() {
                    let start = w.times(r0).plus(unit(Z).times(z0));
                    let side = w.times(r1 - r0).plus(unit(Z).times(z1 - z0));
                    let share = p.minus(start).dot(side) / side.dot(side);
                    let held = share >= Dd::ZERO && share <= Dd::ONE && turned(w);
                    found.push((start.plus(side.times(share)), held));
                }
            }
            Profile::Arc { spine, radius, range } if spine == Dd::ZERO => {
                // a sphere: on the line through its centre
                if let Some(w) = p.unit() {
                    for sign in [1.0, -1.0] {
                        let q = w.times(Dd::from(sign));
                        let across = Vector([q.0[0], q.0[1], Dd::ZERO]).length();
                        found.push((q.times(radius), turned(q) && range.holds(across, q.0[2])));
                    }
                }
            }
            Profile::Arc { spine, radius, range } => {
                for w in [beside(1.0), beside(-1.0)].into_iter().flatten() {
                    let middle = w.times(spine);
                    let Some(towards) = p.minus(middle).unit() else { continue };
                    for sign in [1.0, -1.0] {
                        let arm = towards.times(Dd::from(sign));
                        let held = turned(w) && range.holds(arm.dot(w), arm.0[2]);
                        found.push((middle.plus(arm.times(radius)), held));
                    }
                }
            }
        }
        found
    }

    /// The distances to the edges at both ends of the sweep.
    fn meridians(&self, p: Vector) -> Vec<Dd> {
        let meridian = |[cos, sin]: [Dd; 2]| {
            let out = Vector([cos, sin, Dd::ZERO]);
            match self.profile {
                Profile::Ruling(ends) => {
                    let [a, b] = ends.map(|[r, z]| out.times(r).plus(unit(Z).times(z)));
                    to_segment(p, a, b)
                }
                Profile::Arc { spine, radius, range } => {
                    let (centre, y) = (out.times(spine), unit(Z));
                    Arc { centre, x: out, y, radii: [radius; 2], range }.distance_of_circle(p)
                }
            }
        };
        self.sweep.ends.map(meridian).to_vec()
    }

    /// The distances to the edges at both ends of the profile.
    fn parallels(&self, p: Vector) -> Vec<Dd> {
        let ends = match self.profile {
            Profile::Ruling(ends) => ends,
            Profile::Arc { spine, radius, range } => range.ends.map(|[cos, sin]| [spine + radius * cos, radius * sin]),
        };
        let parallel = |[r, z]: [Dd; 2]| {
            let centre = unit(Z).times(z);
            Arc { centre, x: unit(X), y: unit(Y), radii: [r; 2], range: self.sweep }.distance_of_circle(p)
        };
        ends.map(parallel).to_vec()
    }
}

impl Patch {
    pub fn ruled(radii: (f64, f64), height: (f64, f64), sweep: (f64, f64)) -> Self {
        let [a, b] = [[radii.0, height.0], [radii.1, height.1]].map(|end| end.map(Dd::from));
        Self { profile: Profile::Ruling([a, b]), sweep: Range::new(sweep) }
    }

    /// Of a torus; of a sphere, where the spine is 0 and `section` is the latitude.
    pub fn round(spine: f64, radius: f64, section: (f64, f64), sweep: (f64, f64)) -> Self {
        let (spine, radius, range) = (spine.into(), radius.into(), Range::new(section));
        Self { profile: Profile::Arc { spine, radius, range }, sweep: Range::new(sweep) }
    }

    /// The point at an angle about the axis and a share of the ruling or an angle of the section.
    pub fn at(&self, angle: f64, along: f64) -> Vector {
        let [cos, sin] = direction(angle);
        let [r, z] = match self.profile {
            Profile::Ruling([a, b]) => [0, 1].map(|k| a[k] + (b[k] - a[k]) * Dd::from(along)),
            Profile::Arc { spine, radius, .. } => {
                let [c, s] = direction(along);
                [spine + radius * c, radius * s]
            }
        };
        Vector([r * cos, r * sin, z])
    }
}
