//! The axis about which rows of points are turned.

use glam::DVec3;

use super::least_squares::least_squares;

/// An axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    pub(super) centre: DVec3,
    pub(super) axis: DVec3,
}

/// After how many steps a fit that is still bad is given up: of a surface that turns, the first steps leave rounding.
const PATIENCE: usize = 5;

/// A residual above this share of the rows' extent is bad: a billion times what a class is accepted with.
const HOPELESS: f64 = 1e-2;

/// The step after one below this is of its square: nothing, and what rounding makes of it.
const TINY: f64 = 1e-13;

/// What is left to fit at a point: the residual and its derivatives by two turns and two shifts of the axis.
type Equation = [f64; 5];

/// The axis of rows of points: `rows[b][a]` lies on circle `b` at angle `a`.
///
/// It starts at the circle through three points of a row that are far apart. Gauss–Newton steps then fit
/// direction and place: radius and height are the same along a row and, with `meridians`, points of one angle lie in a plane
/// with the axis, which tells far more of the axis where arcs are short. None where no row is bent.
pub(super) fn fit(rows: &[Vec<DVec3>], meridians: bool) -> Option<Axis> {
    let mut axis = rows.iter().filter_map(|row| through(row)).max_by(|a, b| a.1.total_cmp(&b.1))?.0;
    let (mut with_meridians, mut before) = (false, f64::INFINITY);
    for count in 0..32 {
        let equations = axis.equations(rows, with_meridians);
        if count == PATIENCE && residual(&equations) > HOPELESS * extent(rows) {
            return None;
        }
        let Some(x) = step(&equations) else { break };
        let (u, v) = axis.axis.any_orthonormal_pair();
        let turned = axis.axis + x[0] * u + x[1] * v;
        let moved = Axis { centre: axis.centre + x[2] * u + x[3] * v, axis: turned.normalize() };
        if !(moved.centre.is_finite() && moved.axis.is_finite()) {
            break;
        }
        let length = x[0].hypot(x[1]).max(x[2].hypot(x[3]) / axis.largest_radius(rows));
        axis = moved;
        // steps that shrink no more are rounding, and so is what follows a tiny one
        if length < 1e-6 && length >= 0.25 * before || length < TINY {
            if with_meridians == meridians {
                break;
            }
            (with_meridians, before) = (true, f64::INFINITY);
        } else {
            before = length;
        }
    }
    Some(axis)
}

impl Axis {
    /// Mean height and mean radius of a row.
    pub(super) fn mean(&self, row: &[DVec3]) -> (f64, f64) {
        let n = row.len() as f64;
        let height = row.iter().map(|p| (*p - self.centre).dot(self.axis)).sum::<f64>() / n;
        (height, row.iter().map(|p| self.across(*p).length()).sum::<f64>() / n)
    }

    fn across(&self, p: DVec3) -> DVec3 {
        let arm = p - self.centre;
        arm - arm.dot(self.axis) * self.axis
    }

    fn largest_radius(&self, rows: &[Vec<DVec3>]) -> f64 {
        rows.iter().flatten().map(|p| self.across(*p).length()).fold(0.0, f64::max)
    }

    /// The direction across the axis in which the points of angle `a` lie.
    fn meridian(&self, rows: &[Vec<DVec3>], a: usize) -> DVec3 {
        rows.iter().map(|row| self.across(row[a])).sum::<DVec3>().normalize_or_zero()
    }

    fn equations(&self, rows: &[Vec<DVec3>], meridians: bool) -> Vec<Equation> {
        let (u, v) = self.axis.any_orthonormal_pair();
        let least = 1e-6 * self.largest_radius(rows);
        let mut all = Vec::with_capacity(3 * rows.len() * rows[0].len());
        for row in rows {
            let [mut radial, mut axial] = [0, 1].map(|_| Vec::with_capacity(row.len()));
            for p in row {
                let arm = *p - self.centre;
                let (z, across) = (arm.dot(self.axis), self.across(*p));
                let rho = across.length();
                axial.push([z, arm.dot(u), arm.dot(v), 0.0, 0.0]);
                if rho > least {
                    let out = across / rho;
                    let (x, y) = (out.dot(u), out.dot(v));
                    radial.push([rho, -z * x, -z * y, -x, -y]);
                }
            }
            for mut group in [radial, axial] {
                let ones = vec![1.0; group.len()];
                eliminate(&mut group, &ones);
                all.extend(group);
            }
        }
        if meridians {
            for a in 0..rows[0].len() {
                let side = self.axis.cross(self.meridian(rows, a));
                let (x, y) = (side.dot(u), side.dot(v));
                let (mut group, mut radii) = (Vec::with_capacity(rows.len()), Vec::with_capacity(rows.len()));
                for row in rows {
                    let arm = row[a] - self.centre;
                    let z = arm.dot(self.axis);
                    group.push([side.dot(arm), -z * x, -z * y, -x, -y]);
                    radii.push(self.across(row[a]).length());
                }
                eliminate(&mut group, &radii);
                all.extend(group);
            }
        }
        all
    }
}

/// Takes an unknown off a group of equations, in each of which it stands with its share.
fn eliminate(group: &mut [Equation], shares: &[f64]) {
    let norm: f64 = shares.iter().map(|s| s * s).sum();
    if norm == 0.0 {
        return;
    }
    let mut means = [0.0; 5];
    for (e, s) in group.iter().zip(shares) {
        for k in 0..5 {
            means[k] += e[k] * s;
        }
    }
    let means = means.map(|sum| sum / norm);
    for (e, s) in group.iter_mut().zip(shares) {
        for k in 0..5 {
            e[k] -= means[k] * s;
        }
    }
}

/// The largest residual.
fn residual(equations: &[Equation]) -> f64 {
    equations.iter().map(|e| e[0].abs()).fold(0.0, f64::max)
}

/// How far the rows extend.
fn extent(rows: &[Vec<DVec3>]) -> f64 {
    perpend_kernel::Aabb::around(rows.iter().flatten().copied()).diagonal()
}

/// The step that makes the residuals least.
fn step(equations: &[Equation]) -> Option<[f64; 4]> {
    let column = |k: usize| equations.iter().map(|e| e[k]).collect::<Vec<f64>>();
    let x = least_squares([1, 2, 3, 4].map(column), column(0))?;
    Some([-x[0], -x[1], -x[2], -x[3]])
}

/// The axis of the circle through the first point of a row, the point farthest from it, and the one farthest from the line through both; and twice
/// the area of their triangle. None where all lie on a line.
pub(super) fn through(row: &[DVec3]) -> Option<(Axis, f64)> {
    let a = row[0];
    let farthest = |measure: &dyn Fn(DVec3) -> f64| {
        row.iter().fold((0.0, a), |(most, far), p| {
            let here = measure(*p);
            if here > most { (here, *p) } else { (most, far) }
        })
    };
    let (size, b) = farthest(&|p| p.distance(a));
    let (area, c) = farthest(&|p| (b - a).cross(p - a).length());
    if area <= 1e-9 * size * size {
        return None;
    }
    let (b, c) = (b - a, c - a);
    let normal = b.cross(c);
    let centre =
        (c.length_squared() * normal.cross(b) - b.length_squared() * normal.cross(c)) / (2.0 * normal.length_squared());
    let axis = Axis { centre: a + centre, axis: normal.normalize() };
    (axis.centre.is_finite() && axis.axis.is_finite()).then_some((axis, area))
}
