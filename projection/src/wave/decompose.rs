//! A curve as nearly equally spaced points (Piegl et al. 2008, §5).

use glam::DVec3;

use super::arc_length::ArcLength;
use super::settings::Steps;

/// How often a step is corrected at most: a bracket that is halved as often is one parameter.
const CORRECTIONS: u32 = 60;

/// A curve's points, nearly equally spaced, and what they cost.
#[derive(Debug, Clone, Default)]
pub(super) struct Decomposition {
    /// Ascending, both ends of the range among them.
    pub parameters: Vec<f64>,
    pub points: Vec<DVec3>,
    /// Evaluations of the steps.
    pub evaluations: u64,
    /// Evaluations for the arc length, before them.
    pub length_evaluations: u64,
}

/// The distances between neighbours that are allowed, in the model's unit.
#[derive(Debug, Clone, Copy)]
struct Allowed {
    least: f64,
    most: f64,
}

/// Decomposes a curve.
///
/// Neighbours are between `jitter * tolerance` and `tolerance` times the arc length apart, and none lies beyond a cut: the last step
/// before a cut or the end may be shorter. The distance is that of the chord, or half the arc where the curve coils up and its chord is
/// shorter than that. `nodes` are the parameters over which the arc length is measured; their ends are the range. After `most` points,
/// what is left before each cut and before the end is one step.
pub(super) fn decompose(
    point: impl Fn(f64) -> DVec3,
    nodes: &[f64],
    cuts: &[f64],
    steps: Steps,
    most: usize,
) -> Decomposition {
    let (from, to) = (nodes[0], nodes[nodes.len() - 1]);
    let arc = ArcLength::through(nodes, &point);
    let upper = steps.tolerance * arc.total();
    let allowed = Allowed { least: steps.jitter * upper, most: upper };
    let mut done = Decomposition { length_evaluations: nodes.len() as u64, evaluations: 1, ..Decomposition::default() };
    done.parameters.push(from);
    done.points.push(point(from));
    let target = 0.5 * (allowed.least + allowed.most);
    // of the arc, as much as the last step's chord and arc tell, since little changes from one step to the next
    let mut coherence = 1.0;
    let inner = cuts.iter().copied().filter(|cut| *cut > from && *cut < to);
    for end in inner.chain(std::iter::once(to)) {
        let mut at = done.parameters[done.parameters.len() - 1];
        while at < end {
            let (next, there) = if done.parameters.len() < most {
                let (walked, here) = (arc.to(at), done.points[done.points.len() - 1]);
                let found = next(&point, &arc, &mut done, (arc.at(walked + target * coherence), end), allowed);
                let ratio: f64 = (arc.to(found.0) - walked) / here.distance(found.1);
                coherence = if ratio.is_finite() { ratio.clamp(0.5, 2.0) } else { 1.0 };
                found
            } else {
                done.evaluations += 1;
                (end, point(end))
            };
            done.parameters.push(next);
            done.points.push(there);
            at = next;
        }
    }
    done
}

/// The next point, at most at `end`, from a guess: where that is too far or too near, a bracket around the right place is narrowed.
fn next(
    point: &impl Fn(f64) -> DVec3,
    arc: &ArcLength,
    done: &mut Decomposition,
    (guess, end): (f64, f64),
    allowed: Allowed,
) -> (f64, DVec3) {
    let last = done.parameters.len() - 1;
    let (start, here) = (done.parameters[last], done.points[last]);
    let target = 0.5 * (allowed.least + allowed.most);
    let (mut short, mut long) = (start, None);
    // no progress, no guess
    let mut u = if guess > start && guess < end { guess } else { end };
    for _ in 0..CORRECTIONS {
        let there = point(u);
        done.evaluations += 1;
        let distance = here.distance(there).max(0.5 * arc.at_least(start, u));
        if distance > allowed.most {
            long = Some(u);
        } else if distance < allowed.least && u < end {
            short = u;
        } else {
            return (u, there);
        }
        // a straight line through the start tells where the distance is right; once that is between two, the middle
        let straight = start + (u - start) * (target / distance);
        let next = match long {
            Some(long) if short == start && straight > short && straight < long => straight,
            Some(long) => short + 0.5 * (long - short),
            None if straight > short && straight < end => straight,
            None => end,
        };
        let bracket = long.unwrap_or(end);
        if next <= short || (next >= bracket && long.is_some()) {
            break;
        }
        u = next;
    }
    // two neighbouring parameters are too far apart: nothing lies between them
    let u = long.unwrap_or(end);
    done.evaluations += 1;
    (u, point(u))
}
