//! The oracle of trimmed faces: dense points inside the trims and along them, the best of them improved without leaving the face.
//!
//! What is reported is the distance of a real point of the face, evaluated to 30 digits: an upper bound of the true distance. The
//! trims are judged by [`Outline`], which has no code in common with the kernel's regions.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsSurface, Trimming};

use super::outline::{Outline, Verdict};
use super::shape::Shape;

/// About so many samples each way over the box of the trims.
const ACROSS: usize = 48;

/// About so many samples along the outline.
const ALONG: usize = 900;

/// So many of the best places are improved.
const STARTS: usize = 5;

pub struct FaceOracle {
    pub shape: Shape,
    pub outline: Outline,
    surface: NurbsSurface,
    /// Parameters of the grid.
    grid: [Vec<f64>; 2],
    /// Points of the grid in row order; none: not inside.
    inside: Vec<Option<DVec3>>,
    /// The steps along the outline, loop by loop: each begins at a sample.
    rim: Vec<Vec<Step>>,
}

/// A step along the outline.
struct Step {
    /// Where it begins.
    point: DVec3,
    /// Which chord of its loop.
    chord: usize,
    /// From and to, as shares of the chord.
    range: [f64; 2],
}

/// The oracle's answer.
#[derive(Debug, Clone, Copy)]
pub struct NearestOfFace {
    pub distance: f64,
    pub uv: DVec2,
    /// Whether it was found along the outline.
    pub on_rim: bool,
}

impl FaceOracle {
    pub fn new(surface: &NurbsSurface, trimming: &Trimming) -> Self {
        let outline = Outline::new(surface, trimming.loops());
        let (low, high) = outline.bounds();
        let grid = [samples(surface, Direction::U, low.x, high.x), samples(surface, Direction::V, low.y, high.y)];
        let mut inside = Vec::with_capacity(grid[0].len() * grid[1].len());
        for u in &grid[0] {
            for v in &grid[1] {
                let is_inside = outline.side(DVec2::new(*u, *v)) == Verdict::Inside;
                inside.push(is_inside.then(|| surface.point(*u, *v)));
            }
        }
        let rim = rim(surface, &outline);
        let shape = Shape::of(&surface.clone().into());
        Self { shape, outline, surface: surface.clone(), grid, inside, rim }
    }

    /// How many points of the grid lie inside the trims.
    pub fn inside_count(&self) -> usize {
        self.inside.iter().flatten().count()
    }

    /// Parameters and points of the grid inside the trims.
    pub fn inner_points(&self) -> impl Iterator<Item = (DVec2, DVec3)> + '_ {
        self.inside.iter().enumerate().filter_map(|(k, point)| Some((self.uv(k), (*point)?)))
    }

    /// Points of the outline.
    pub fn rim_points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.rim.iter().flatten().map(|step| step.point)
    }

    /// The nearest point of the face to `p` that is found.
    pub fn nearest(&self, p: DVec3) -> NearestOfFace {
        let mut best = (f64::INFINITY, DVec2::ZERO, true);
        let mut take = |(value, uv): (f64, DVec2), on_rim: bool| {
            if value < best.0 {
                best = (value, uv, on_rim);
            }
        };
        let (low, high) = self.outline.bounds();
        let first_step = (high - low) / DVec2::new(self.grid[0].len() as f64, self.grid[1].len() as f64);
        for start in self.best_of_grid(p) {
            take(self.descend(p, start, first_step), false);
        }
        for (of, k) in self.best_of_rim(p) {
            let steps = &self.rim[of];
            for step in [&steps[(k + steps.len() - 1) % steps.len()], &steps[k]] {
                let on_rim = self.along(p, of, step);
                take(on_rim, true);
                // from the outline inwards, which finds what the grid is too coarse for
                let inwards = self.descend_from_rim(p, on_rim.1, 0.25 * first_step);
                if inwards.0 < on_rim.0 {
                    take(inwards, false);
                }
            }
        }
        let (_, uv, on_rim) = best;
        NearestOfFace { distance: self.shape.distance_at(p, uv.x.into(), uv.y.into()), uv, on_rim }
    }

    fn uv(&self, k: usize) -> DVec2 {
        let columns = self.grid[1].len();
        DVec2::new(self.grid[0][k / columns], self.grid[1][k % columns])
    }

    /// The best local minima among the grid's points inside.
    fn best_of_grid(&self, p: DVec3) -> Vec<DVec2> {
        let (rows, columns) = (self.grid[0].len(), self.grid[1].len());
        let far = |point: &Option<DVec3>| point.map_or(f64::INFINITY, |point| point.distance_squared(p));
        let value: Vec<f64> = self.inside.iter().map(far).collect();
        let mut minima: Vec<(f64, usize)> = Vec::new();
        for i in 0..rows {
            for j in 0..columns {
                let here = value[i * columns + j];
                let neighbours = (i.saturating_sub(1)..rows.min(i + 2))
                    .flat_map(|a| (j.saturating_sub(1)..columns.min(j + 2)).map(move |b| a * columns + b));
                if here.is_finite() && neighbours.into_iter().all(|k| here <= value[k]) {
                    minima.push((here, i * columns + j));
                }
            }
        }
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        minima.into_iter().take(STARTS).map(|(_, k)| self.uv(k)).collect()
    }

    /// The best local minima among the samples of the outline: loop and step.
    fn best_of_rim(&self, p: DVec3) -> Vec<(usize, usize)> {
        let mut minima: Vec<(f64, usize, usize)> = Vec::new();
        for (of, steps) in self.rim.iter().enumerate() {
            let value: Vec<f64> = steps.iter().map(|step| step.point.distance_squared(p)).collect();
            let n = value.len();
            for k in 0..n {
                if value[k] <= value[(k + n - 1) % n] && value[k] <= value[(k + 1) % n] {
                    minima.push((value[k], of, k));
                }
            }
        }
        minima.sort_by(|a, b| a.0.total_cmp(&b.0));
        minima.into_iter().take(STARTS).map(|(_, of, k)| (of, k)).collect()
    }

    /// The squared distance and the parameters of the best point along a step, by golden section.
    fn along(&self, p: DVec3, of: usize, step: &Step) -> (f64, DVec2) {
        let chord = &self.outline.loops[of][step.chord];
        let look = |s: f64| {
            let uv = self.outline.at(chord, s);
            (self.surface.point(uv.x, uv.y).distance_squared(p), uv)
        };
        let [mut a, mut b] = step.range;
        let share = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut best, end) = (look(a), look(b));
        if end.0 < best.0 {
            best = end;
        }
        let (mut x, mut y) = (b - share * (b - a), a + share * (b - a));
        let (mut at_x, mut at_y) = (look(x), look(y));
        for _ in 0..60 {
            if at_x.0 <= at_y.0 {
                (b, y, at_y) = (y, x, at_x);
                x = b - share * (b - a);
                at_x = look(x);
            } else {
                (a, x, at_x) = (x, y, at_y);
                y = a + share * (b - a);
                at_y = look(y);
            }
            for seen in [at_x, at_y] {
                if seen.0 < best.0 {
                    best = seen;
                }
            }
        }
        best
    }

    /// As [`descend`](Self::descend), from the best of some points around one of the outline.
    fn descend_from_rim(&self, p: DVec3, start: DVec2, step: DVec2) -> (f64, DVec2) {
        let around = ways().flat_map(|way| [1.0, 1e-2, 1e-4].map(|size| start + size * way * step));
        let inside = around.filter(|uv| self.is_inside(*uv));
        let seen = inside.map(|uv| (self.surface.point(uv.x, uv.y).distance_squared(p), uv));
        match seen.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((_, uv)) => self.descend(p, uv, step),
            None => (f64::INFINITY, start),
        }
    }

    /// In the domain and inside the trims for certain.
    fn is_inside(&self, uv: DVec2) -> bool {
        let q = self.outline.share(uv);
        q.cmpge(DVec2::ZERO).all() && q.cmple(DVec2::ONE).all() && self.outline.side(uv) == Verdict::Inside
    }

    /// The squared distance and the parameters of a point inside that is no farther than the one at `start`: Newton's steps where they
    /// lead inside and down, else the best of eight ways, else shorter ways.
    fn descend(&self, p: DVec3, start: DVec2, mut step: DVec2) -> (f64, DVec2) {
        let value = |uv: DVec2| self.surface.point(uv.x, uv.y).distance_squared(p);
        let mut at = (value(start), start);
        let least = 1e-10 * step;
        for _ in 0..400 {
            let mut way = self.newton(p, at.1);
            let mut moved = false;
            for _ in 0..4 {
                let next = at.1 + way;
                let there = value(next);
                if there < at.0 && self.is_inside(next) {
                    moved = at.0 - there > 1e-14 * at.0;
                    at = (there, next);
                    break;
                }
                way *= 0.25;
            }
            if moved {
                continue;
            }
            let around = ways().map(|way| at.1 + way * step).map(|next| (value(next), next));
            let better = around.filter(|(there, next)| *there < at.0 && self.is_inside(*next));
            match better.min_by(|a, b| a.0.total_cmp(&b.0)) {
                Some(next) => at = next,
                None if step.cmplt(least).all() => break,
                None => step *= 0.25,
            }
        }
        at
    }

    /// Newton's step towards a stationary point of the squared distance; where its matrix is not positive, Gauss's.
    fn newton(&self, p: DVec3, at: DVec2) -> DVec2 {
        let mut d = [DVec3::ZERO; 9];
        self.surface.derivatives(at.x, at.y, 2, &mut d);
        // d[k * 3 + l]: k times by u, l times by v
        let (r, u, v) = (d[0] - p, d[3], d[1]);
        let gradient = DVec2::new(r.dot(u), r.dot(v));
        let gauss = [u.dot(u), u.dot(v), v.dot(v)];
        let whole = [gauss[0] + r.dot(d[6]), gauss[1] + r.dot(d[4]), gauss[2] + r.dot(d[2])];
        for [a, b, c] in [whole, gauss] {
            let determinant = a * c - b * b;
            if a > 0.0 && determinant > 1e-12 * a * c {
                return -DVec2::new(c * gradient.x - b * gradient.y, a * gradient.y - b * gradient.x) / determinant;
            }
        }
        DVec2::ZERO
    }
}

/// Eight ways in the plane.
fn ways() -> impl Iterator<Item = DVec2> {
    let steps = [-1.0, 0.0, 1.0];
    steps.into_iter().flat_map(move |x| steps.map(|y| DVec2::new(x, y))).filter(|way| *way != DVec2::ZERO)
}

/// Parameters from `low` to `high`, more where there are more spans.
fn samples(surface: &NurbsSurface, direction: Direction, low: f64, high: f64) -> Vec<f64> {
    let spans: Vec<(f64, f64)> = surface
        .knots(direction)
        .spans()
        .map(|span| (span.start.max(low), span.end.min(high)))
        .filter(|(a, b)| a < b)
        .collect();
    let most = 3 * ACROSS;
    let each = (ACROSS / spans.len().max(1)).clamp(2, ACROSS).min(most.div_ceil(spans.len().max(1)));
    let mut at: Vec<f64> =
        spans.iter().flat_map(|(a, b)| (0..each).map(move |k| a + (b - a) * (k as f64 / each as f64))).collect();
    // far more spans than samples: a share of them
    if at.len() > most {
        let step = at.len() as f64 / most as f64;
        at = (0..most).map(|k| at[(k as f64 * step) as usize]).collect();
    }
    at.push(high);
    at
}

/// The steps along the outline, about equally long in space.
fn rim(surface: &NurbsSurface, outline: &Outline) -> Vec<Vec<Step>> {
    const LOOKS: usize = 16;
    let point = |uv: DVec2| surface.point(uv.x, uv.y);
    let length = |chord| -> f64 {
        let seen: Vec<DVec3> = (0..=LOOKS).map(|k| point(outline.at(chord, k as f64 / LOOKS as f64))).collect();
        seen.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    };
    let lengths: Vec<Vec<f64>> = outline.loops.iter().map(|chords| chords.iter().map(length).collect()).collect();
    let total: f64 = lengths.iter().flatten().sum();
    let mut rim = Vec::with_capacity(lengths.len());
    for (chords, lengths) in outline.loops.iter().zip(&lengths) {
        let mut steps = Vec::new();
        for (index, (chord, length)) in chords.iter().zip(lengths).enumerate() {
            let share = if total > 0.0 { length / total } else { 0.0 };
            // at least some, so that a short chord with many turns is seen
            let count = ((share * ALONG as f64).ceil() as usize).max(if chords.len() < 64 { 8 } else { 1 });
            for k in 0..count {
                let range = [k, k + 1].map(|k| k as f64 / count as f64);
                steps.push(Step { point: point(outline.at(chord, range[0])), chord: index, range });
            }
        }
        rim.push(steps);
    }
    rim
}
