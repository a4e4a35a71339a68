//! Newton's method, made to descend from any start, inside a box of parameters.
//!
//! The step is Newton's where the Hessian of `f = |S - p|² / 2` is positive definite and its step leads downhill, else the gradient's; it is
//! halved until `f` falls by a quarter of what the slope promises (the Armijo rule; globalised as in Polak 1997). A parameter
//! at its border, with the slope leading out, stays there.

use glam::DVec3;
use perpend_kernel::Definition;

use crate::hierarchy::Frame;
use crate::statistics::Work;

/// How often a step is halved at most: beyond, it is rounding.
const HALVINGS: u32 = 40;

/// How many steps are made at most. From inside a flat segment few are needed; where the parametrisation degenerates, descent may creep.
const STEPS: u32 = 60;

/// The squared distance as a function of the definition's parameters in a box.
pub(super) struct Target<'a> {
    pub definition: &'a Definition,
    pub frame: &'a Frame,
    /// The query, in the entity's own coordinates.
    pub point: DVec3,
    /// The box, in u and v.
    pub range: [(f64, f64); 2],
    /// The difference of distances that matters: a step that would lower the distance by less than a thousandth of it is the last.
    pub gap: f64,
}

/// `f` with its derivatives, in parameters that run over the box from 0 to 1.
struct Jet {
    f: f64,
    gradient: [f64; 2],
    /// Second derivatives: uu, uv, vv.
    hessian: [f64; 3],
    /// Squares of the speeds.
    speeds: [f64; 2],
}

impl Target<'_> {
    /// The parameters at which the search from `start`, shares of the box, ends, with the squared distance there.
    pub(super) fn search(&self, start: [f64; 2], work: &mut Work) -> ([f64; 2], f64) {
        let mut at = start.map(|x| if x.is_finite() { x.clamp(0.0, 1.0) } else { 0.5 });
        let mut here = self.jet(at, work);
        for _ in 0..STEPS {
            let Some((next, jet)) = self.step(at, &here, work) else { break };
            (at, here) = (next, jet);
        }
        ([0, 1].map(|d| self.parameter(d, at[d])), 2.0 * here.f)
    }

    /// The point after one step; none where no step is worth it.
    fn step(&self, at: [f64; 2], here: &Jet, work: &mut Work) -> Option<([f64; 2], Jet)> {
        let [gu, gv] = here.gradient;
        let free = [0, 1].map(|d| {
            let (x, g) = (at[d], here.gradient[d]);
            here.speeds[d] > 0.0 && !(x == 0.0 && g >= 0.0) && !(x == 1.0 && g <= 0.0)
        });
        let downhill = |d: usize| if free[d] { -here.gradient[d] / here.speeds[d] } else { 0.0 };
        let [huu, huv, hvv] = here.hessian;
        let newton = match free {
            [true, true] => {
                let determinant = huu * hvv - huv * huv;
                (huu > 0.0 && determinant > 1e-14 * huu * hvv)
                    .then(|| [(gv * huv - gu * hvv) / determinant, (gu * huv - gv * huu) / determinant])
            }
            [true, false] => (huu > 0.0).then(|| [-gu / huu, 0.0]),
            [false, true] => (hvv > 0.0).then(|| [0.0, -gv / hvv]),
            [false, false] => None,
        };
        let gradient = [downhill(0), downhill(1)];
        let least = 1e-3 * self.gap * (2.0 * here.f).sqrt().max(self.gap);
        for direction in newton.into_iter().chain([gradient]) {
            let mut length = 1.0;
            for _ in 0..HALVINGS {
                let next = [0, 1].map(|d| (at[d] + length * direction[d]).clamp(0.0, 1.0));
                let slope = gu * (next[0] - at[0]) + gv * (next[1] - at[1]);
                if slope.is_nan() || slope >= -least * length {
                    break;
                }
                work.newton += 1;
                let jet = self.jet(next, work);
                if jet.f - here.f <= 0.25 * slope {
                    return Some((next, jet));
                }
                length *= 0.5;
            }
        }
        None
    }

    fn parameter(&self, direction: usize, share: f64) -> f64 {
        let (from, to) = self.range[direction];
        if share >= 1.0 { to } else { (from + share * (to - from)).min(to) }
    }

    fn jet(&self, at: [f64; 2], work: &mut Work) -> Jet {
        work.evaluations += 1;
        let [u, v] = [0, 1].map(|d| self.parameter(d, at[d]));
        // at the end of the box, and of one that a break ends, the derivatives are those from inside
        let from_below = [u >= self.range[0].1, v >= self.range[1].1];
        let [width_u, width_v] = self.range.map(|(from, to)| to - from);
        let mut d = [DVec3::ZERO; 9];
        let (s, [su, sv], [suu, suv, svv]) = match self.definition {
            Definition::NurbsCurve(curve) => {
                let d = &mut d[..3];
                if from_below[0] {
                    curve.derivatives_from_left(u, d);
                } else {
                    curve.derivatives(u, d);
                }
                (d[0], [d[1], DVec3::ZERO], [d[2], DVec3::ZERO, DVec3::ZERO])
            }
            Definition::NurbsSurface(surface) => {
                surface.derivatives_from(u, v, from_below, 2, &mut d);
                (d[0], [d[3], d[1]], [d[6], d[4], d[2]])
            }
        };
        let scale = self.frame.scale;
        let (su, sv) = (su * width_u * scale, sv * width_v * scale);
        let (suu, svv) = (suu * width_u * width_u * scale, svv * width_v * width_v * scale);
        let suv = suv * width_u * width_v * scale;
        let r = self.frame.enter(s) - self.point;
        Jet {
            f: 0.5 * r.length_squared(),
            gradient: [r.dot(su), r.dot(sv)],
            hessian: [su.length_squared() + r.dot(suu), su.dot(sv) + r.dot(suv), sv.length_squared() + r.dot(svv)],
            speeds: [su.length_squared(), sv.length_squared()],
        }
    }
}
