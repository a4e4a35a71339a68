//! All zeros of gradients: boxes are excluded by sign, proven to hold one zero, split, or left undecided.
//!
//! A box whose polynomials, or a combination of them, have one sign holds no zero. On a box, widened a little, let `J` bound the derivative of
//! `F`, `Y` be about the inverse of its middle, and `|1 - Y J| <= rho < 1` in the maximum norm. Then `F` has at most one zero in the widened box; and where
//! `|Y F(x)| <= (1 - rho) r`, the map `x - Y F(x)` takes the ball of radius `r` about `x` into itself, so that one lies in it (Krawczyk).

use std::collections::VecDeque;

use perpend_kernel::Direction;
use smallvec::SmallVec;

use super::polynomial::Polynomial;
use crate::stationary::Extremum;
use crate::statistics::Work;

/// A contraction slower than this proves one zero no better than a split would.
const SLOWEST: f64 = 0.9;

/// Steps of Newton's method for a zero; from where the map contracts, it needs about five.
const STEPS: usize = 20;

/// The gradient on one piece of a stratum: one polynomial (a curve, an edge) or two (a surface).
pub(super) type System = SmallVec<[Polynomial; 2]>;

/// A zero of a system, in the parameters of its piece. It may lie outside the unit square, beside it: there the polynomials go on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Zero {
    pub at: [f64; 2],
    /// It is no farther from there, in either direction.
    pub radius: [f64; 2],
    pub kind: Extremum,
}

/// A part of a piece.
pub(super) type Range = [(f64, f64); 2];

/// What was found on one piece.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub zeros: Vec<Zero>,
    pub undecided: Vec<Range>,
}

struct Cell {
    piece: usize,
    range: Range,
    system: System,
}

/// Finds the zeros of all systems. `lengths(piece, range)` says how long a part of a piece is in its directions; parts of at most
/// `tolerance` are not split. `splits` bounds the work.
///
/// Boxes are taken in the order of their generation, so that what is left when the bound is met is equally fine everywhere. Returns
/// whether the bound was not met.
pub(super) fn isolate(
    systems: impl Iterator<Item = System>,
    lengths: impl Fn(usize, Range) -> [f64; 2],
    tolerance: f64,
    splits: &mut u64,
    work: &mut Work,
) -> (Vec<Found>, bool) {
    let mut found = Vec::new();
    let mut cells = VecDeque::new();
    for (piece, system) in systems.enumerate() {
        work.pieces += 1;
        found.push(Found::default());
        if !system.iter().any(Polynomial::has_no_zero) {
            cells.push_back(Cell { piece, range: [(0.0, 1.0); 2], system });
        }
    }
    let mut complete = true;
    while let Some(cell) = cells.pop_front() {
        work.cells += 1;
        match examine(&cell, work) {
            Verdict::Empty => {}
            Verdict::Zero(zero) => found[cell.piece].add(zero),
            Verdict::Open => {
                let direction = split_direction(&cell, lengths(cell.piece, cell.range), tolerance);
                match direction {
                    Some(direction) if *splits > 0 => {
                        *splits = splits.saturating_sub(cost(&cell));
                        work.subdivisions += 1;
                        let halves = halves(cell, direction);
                        cells
                            .extend(halves.into_iter().filter(|half| !half.system.iter().any(Polynomial::has_no_zero)));
                    }
                    direction => {
                        complete &= direction.is_none();
                        work.unresolved += u64::from(direction.is_some());
                        found[cell.piece].undecided.push(cell.range);
                    }
                }
            }
        }
    }
    (found, complete)
}

impl Found {
    /// Takes note of a zero; neighbouring boxes find one on their border both.
    fn add(&mut self, zero: Zero) {
        let same = |known: &Zero| {
            (0..2).all(|d| (known.at[d] - zero.at[d]).abs() <= 2.0 * (known.radius[d] + zero.radius[d]) + f64::EPSILON)
        };
        if !self.zeros.iter().any(same) {
            self.zeros.push(zero);
        }
    }
}

enum Verdict {
    Empty,
    Zero(Zero),
    Open,
}

fn examine(cell: &Cell, work: &mut Work) -> Verdict {
    let system = &cell.system;
    let Some(inverse) = Inverse::of(&jacobian(system)) else { return Verdict::Open };
    if let [f, g] = &system[..] {
        let [[a, b], [c, d]] = inverse.y;
        if Polynomial::combined(a, f, b, g).has_no_zero() || Polynomial::combined(c, f, d, g).has_no_zero() {
            return Verdict::Empty;
        }
    }
    if inverse.rho >= SLOWEST {
        return Verdict::Open;
    }
    // wider by so little that the coefficients grow by a small factor at most
    let by = 0.25 / (1 + system[0].m.max(system[0].n)) as f64;
    let wide: System = system
        .iter()
        .map(|f| {
            let f = f.widened(Direction::U, by);
            if f.n == 0 { f } else { f.widened(Direction::V, by) }
        })
        .collect();
    let Some(inverse) = Inverse::of(&jacobian(&wide)).filter(|inverse| inverse.rho < SLOWEST) else {
        return Verdict::Open;
    };
    work.newton += 1;
    match inverse.zero(&wide) {
        Some(zero) => Verdict::Zero(in_piece(&zero, &cell.range, by)),
        None => Verdict::Open,
    }
}

/// A zero of the widened box, in the parameters of the piece.
fn in_piece(zero: &Zero, range: &Range, by: f64) -> Zero {
    let mut result = *zero;
    for (d, (from, to)) in range.iter().enumerate() {
        let width = (to - from) * (1.0 + 2.0 * by);
        result.at[d] = from - by * (to - from) + zero.at[d] * width;
        result.radius[d] = zero.radius[d] * width + f64::EPSILON;
    }
    result
}

/// Bounds of the derivatives of a system on its box; of one polynomial, completed by a second that is `t`.
fn jacobian(system: &System) -> [[(f64, f64); 2]; 2] {
    match &system[..] {
        [f] => [[f.slope(Direction::U), (0.0, 0.0)], [(0.0, 0.0), (1.0, 1.0)]],
        system => [0, 1].map(|k| [Direction::U, Direction::V].map(|direction| system[k].slope(direction))),
    }
}

/// About the inverse of a matrix that is known within bounds.
struct Inverse {
    y: [[f64; 2]; 2],
    /// Bound of `|1 - Y J|` in the maximum norm.
    rho: f64,
    determinant: f64,
}

impl Inverse {
    fn of(j: &[[(f64, f64); 2]; 2]) -> Option<Self> {
        let middle = j.map(|row| row.map(|(low, high)| 0.5 * (low + high)));
        let [[a, b], [c, d]] = middle;
        let determinant = a * d - b * c;
        let r = determinant.recip();
        let y = [[d * r, -b * r], [-c * r, a * r]];
        if !y.iter().flatten().all(|x| x.is_finite()) {
            return None;
        }
        // entry (k, l) of `1 - Y J`, bounded
        let entry = |k: usize, l: usize| {
            let unit = if k == l { 1.0 } else { 0.0 };
            let products = [0, 1].map(|m| y[k][m] * middle[m][l]);
            let spread = |m: usize| y[k][m].abs() * 0.5 * (j[m][l].1 - j[m][l].0);
            let rounding = 8.0 * f64::EPSILON * (products[0].abs() + products[1].abs() + 1.0);
            (unit - products[0] - products[1]).abs() + spread(0) + spread(1) + rounding
        };
        let rho = f64::max(entry(0, 0) + entry(0, 1), entry(1, 0) + entry(1, 1));
        Some(Self { y, rho, determinant })
    }

    /// The one zero of the system in its box, if it is found there.
    fn zero(&self, system: &System) -> Option<Zero> {
        let curve = system.len() == 1;
        let mut at = [0.5, if curve { 0.0 } else { 0.5 }];
        for _ in 0..STEPS {
            let step = self.newton_step(system, at);
            at = [at[0] - step[0], at[1] - step[1]];
            if !at.iter().all(|x| (-0.5..=1.5).contains(x)) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) <= f64::EPSILON {
                break;
            }
        }
        let (step, error) = self.step(system, at);
        let radius = (0..2).map(|d| step[d].abs() + error[d]).fold(0.0, f64::max) / (1.0 - self.rho) * (1.0 + 1e-9);
        let inside = |x: f64| x - radius >= 0.0 && x + radius <= 1.0;
        if !inside(at[0]) || !(curve || inside(at[1])) {
            return None;
        }
        let j: SmallVec<[[f64; 2]; 2]> = system.iter().map(|f| f.gradient(at[0], at[1])).collect();
        // the Hessian times positive factors, row by row; its determinant is that of every matrix within the bounds
        let kind = match &j[..] {
            [[slope, _]] if *slope > 0.0 => Extremum::Minimum,
            [_] => Extremum::Maximum,
            _ if self.determinant < 0.0 => Extremum::Saddle,
            j if j[0][0] + j[1][1] * (j[0][0] / j[1][1]).abs() > 0.0 => Extremum::Minimum,
            _ => Extremum::Maximum,
        };
        Some(Zero { at, radius: [radius, if curve { 0.0 } else { radius }], kind })
    }

    /// A step of Newton's method; with `Y` for the inverse where the derivative at the point has none.
    fn newton_step(&self, system: &System, at: [f64; 2]) -> [f64; 2] {
        let value = |f: &Polynomial| f.value(at[0], at[1]).0;
        let slope = |f: &Polynomial| f.gradient(at[0], at[1]);
        let step = match &system[..] {
            [f] => [value(f) / slope(f)[0], 0.0],
            system => {
                let ([f, g], [[a, b], [c, d]]) = ([0, 1].map(|k| value(&system[k])), [0, 1].map(|k| slope(&system[k])));
                let determinant = a * d - b * c;
                [(d * f - b * g) / determinant, (a * g - c * f) / determinant]
            }
        };
        if step.iter().all(|x| x.is_finite()) { step } else { self.step(system, at).0 }
    }

    /// `Y F(x)`, and a bound of its error.
    fn step(&self, system: &System, at: [f64; 2]) -> ([f64; 2], [f64; 2]) {
        let values: SmallVec<[(f64, f64); 2]> = system.iter().map(|f| f.value(at[0], at[1])).collect();
        let (mut step, mut error) = ([0.0; 2], [0.0; 2]);
        for (k, row) in self.y.iter().enumerate() {
            for ((value, bound), y) in values.iter().zip(row) {
                step[k] += y * value;
                error[k] += y.abs() * (bound + 4.0 * f64::EPSILON * value.abs());
            }
        }
        (step, error)
    }
}

/// The direction to split a box in: the longer one, of those in which the gradient changes by more than rounding and that are longer than
/// the tolerance; none where there is none.
///
/// Where one of two polynomials is rounding alone, the zeros of the other are a curve. It is narrowed across, and not cut along.
fn split_direction(cell: &Cell, lengths: [f64; 2], tolerance: f64) -> Option<Direction> {
    let telling: SmallVec<[&Polynomial; 2]> = cell.system.iter().filter(|f| !f.is_noise()).collect();
    let steepness = |f: &Polynomial, direction: Direction| {
        let (low, high) = f.slope(direction);
        let degree = if direction == Direction::U { f.m } else { f.n } as f64;
        let changes = low.abs().max(high.abs()) > 8.0 * degree * f.error;
        let monotonous = low > 0.0 || high < 0.0;
        (changes, monotonous)
    };
    let mut wanted = [Direction::U, Direction::V].map(|d| telling.iter().any(|f| steepness(f, d).0));
    if let ([f], 2) = (&telling[..], cell.system.len()) {
        let monotonous = [Direction::U, Direction::V].map(|d| steepness(f, d).1);
        if monotonous != [false; 2] {
            wanted = monotonous;
        }
    }
    let long = |d: usize| wanted[d] && lengths[d] > tolerance;
    match (long(0), long(1)) {
        (false, false) => None,
        (true, true) if lengths[1] > lengths[0] => Some(Direction::V),
        (true, _) => Some(Direction::U),
        (false, true) => Some(Direction::V),
    }
}

/// What a split counts: 1 up to degree 4, more for the larger nets of higher degrees.
fn cost(cell: &Cell) -> u64 {
    let f = &cell.system[0];
    1 + (f.c.len() * (f.m + f.n) / 2_000) as u64
}

fn halves(cell: Cell, direction: Direction) -> [Cell; 2] {
    let at = direction as usize;
    let (from, to) = cell.range[at];
    let middle = 0.5 * (from + to);
    let mut systems = [System::new(), System::new()];
    for f in &cell.system {
        let [low, high] = f.halves(direction);
        systems[0].push(low);
        systems[1].push(high);
    }
    let [low, high] = systems;
    let mut ranges = [cell.range; 2];
    ranges[0][at].1 = middle;
    ranges[1][at].0 = middle;
    [
        Cell { piece: cell.piece, range: ranges[0], system: low },
        Cell { piece: cell.piece, range: ranges[1], system: high },
    ]
}
