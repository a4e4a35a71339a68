//! Distances to curves: all stationary points and the ends, the least counts.

use super::turn::Range;
use super::vector::Vector;
use crate::common::double_double::Dd;

pub fn least(distances: impl IntoIterator<Item = Dd>) -> Dd {
    let infinite = Dd::from(f64::INFINITY);
    distances.into_iter().fold(infinite, |least, distance| if distance < least { distance } else { least })
}

/// The distance from `p` to the segment from `a` to `b`.
pub fn to_segment(p: Vector, a: Vector, b: Vector) -> Dd {
    let side = b.minus(a);
    let square = side.dot(side);
    let ends = least([p.minus(a).length(), p.minus(b).length()]);
    if square <= Dd::ZERO {
        return ends;
    }
    let share = p.minus(a).dot(side) / square;
    if share > Dd::ZERO && share < Dd::ONE {
        return least([ends, p.minus(a.plus(side.times(share))).length()]);
    }
    ends
}

/// An arc of a circle or of an ellipse: `centre + a cos t x + b sin t y`.
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    pub centre: Vector,
    pub x: Vector,
    pub y: Vector,
    pub radii: [Dd; 2],
    pub range: Range,
}

impl Arc {
    fn at(&self, [cos, sin]: [Dd; 2]) -> Vector {
        self.centre.plus(self.x.times(self.radii[0] * cos)).plus(self.y.times(self.radii[1] * sin))
    }

    /// The distance from `p` to the arc, whose radii are equal.
    pub fn distance_of_circle(&self, p: Vector) -> Dd {
        let arm = p.minus(self.centre);
        let (x, y) = (arm.dot(self.x), arm.dot(self.y));
        let ends = self.range.ends.map(|end| p.minus(self.at(end)).length());
        let beside = (x * x + y * y).sqrt();
        // at the centre of the circle all points are as near as the ends
        if beside > Dd::ZERO && self.range.holds(x, y) {
            return least([ends[0], ends[1], p.minus(self.at([x / beside, y / beside])).length()]);
        }
        least(ends)
    }

    /// The distance from `p` to the arc of the ellipse.
    ///
    /// With `s = tan(t / 2)` the foot's equation is `b y s⁴ + 2 (a x + e) s³ + 2 (a x - e) s - b y = 0`, where
    /// `e = a² - b²`; of each half turn `s` runs through `[-1, 1]`.
    pub fn distance_of_ellipse(&self, p: Vector) -> Dd {
        let arm = p.minus(self.centre);
        let [a, b] = self.radii;
        let (x, y) = (arm.dot(self.x) / a, arm.dot(self.y) / a);
        // in units of a, so that no power of a length overflows
        let (b, two) = (b / a, Dd::from(2.0));
        let excess = Dd::ONE - b * b;
        let mut found = least(self.range.ends.map(|end| p.minus(self.at(end)).length()));
        for half in [Dd::ONE, -Dd::ONE] {
            let (x, y) = (half * x, half * y);
            let equation = [-(b * y), two * (x - excess), Dd::ZERO, two * (x + excess), b * y];
            for s in stationary(&equation) {
                let below = Dd::ONE + s * s;
                let at = [half * (Dd::ONE - s * s) / below, half * two * s / below];
                if self.range.holds(at[0], at[1]) {
                    found = least([found, p.minus(self.at(at)).length()]);
                }
            }
        }
        found
    }
}

/// The roots in `[-1, 1]` of a polynomial (coefficients from the constant up), those of its derivatives (at which roots may
/// fall together), and the ends.
fn stationary(polynomial: &[Dd]) -> Vec<Dd> {
    let value = |s: Dd| polynomial.iter().rev().fold(Dd::ZERO, |sum, c| sum * s + *c);
    if polynomial.len() < 2 {
        return vec![-Dd::ONE, Dd::ONE];
    }
    let derivative: Vec<Dd> = polynomial.iter().enumerate().skip(1).map(|(k, c)| Dd::from(k as f64) * *c).collect();
    let slope = |s: Dd| derivative.iter().rev().fold(Dd::ZERO, |sum, c| sum * s + *c);
    let mut places = stationary(&derivative);
    places.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    let mut roots = Vec::new();
    for pair in places.windows(2) {
        let (mut low, mut high) = (pair[0], pair[1]);
        let rising = value(low) < value(high);
        if (value(low) > Dd::ZERO) == (value(high) > Dd::ZERO) {
            continue;
        }
        for _ in 0..60 {
            let middle = (low + high) * Dd::from(0.5);
            if (value(middle) < Dd::ZERO) == rising { low = middle } else { high = middle }
        }
        // the last digits by Newton's method, which may not leave the bracket
        let mut root = (low + high) * Dd::from(0.5);
        for _ in 0..3 {
            let next = root - value(root) / slope(root);
            if next >= low && next <= high {
                root = next;
            }
        }
        roots.push(root);
    }
    places.extend(roots);
    places
}
