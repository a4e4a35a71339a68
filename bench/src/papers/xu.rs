//! Xu et al. 2014, Fig. 2 as a table: how often Newton's method is wrong from a good start, and how often the squared gradient is.
//!
//! The paper shows one point. Here are the test corpora: Newton's method starts at the nearest of samples 1e-3 of the domain apart; an answer is wrong where it is
//! farther than the truth by more than 1e-6 of the size.

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::DVec3;
use perpend_bench::{Corpus, Row, corpora, rows};
use perpend_kernel::{Definition, Direction};
use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch, StationaryOptions};

use crate::Failure;

/// Queries of each entity.
const QUERIES: usize = 100;

/// Samples of each direction: 1e-3 apart.
const SAMPLES: usize = 1001;

/// An answer that is farther than the truth by more than this share of the size is wrong.
const WRONG: f64 = 1e-6;

pub(crate) fn print() -> Result<(), Failure> {
    for set in ["seeds-curves", "circles-table1", "seeds-surfaces", "quadrics"] {
        let corpus = Corpus::read(&corpora().join(set).with_extension("json"))?;
        let truth = rows(&corpora().join(format!("{set}.truth.csv")))?;
        println!(
            "\nXu et al. 2014, {set}: {QUERIES} queries each; wrong answers in %, work, and median times in microseconds"
        );
        println!(
            "{:<22}{:>9}{:>9}{:>9}{:>8}{:>8}{:>10}{:>11}{:>11}{:>10}{:>9}",
            "entity",
            "sample",
            "Newton",
            "squared",
            "proved",
            "splits",
            "us",
            "hierarchy",
            "stationary",
            "points",
            "decided"
        );
        for entity in &corpus.entities {
            let all: Vec<&Row> = truth.iter().filter(|row| row.entity == entity.id).collect();
            let asked: Vec<&Row> = all.iter().step_by(all.len().div_ceil(QUERIES)).copied().collect();
            line(&entity.name, &Arc::new(entity.definition()?), &asked);
        }
    }
    Ok(())
}

fn line(name: &str, definition: &Arc<Definition>, asked: &[&Row]) {
    let samples = Samples::of(definition);
    let tolerance = WRONG * definition.size();
    let count = asked.len() as f64;
    let percent = |wrong: usize| 100.0 * wrong as f64 / count;
    let is_wrong = |row: &Row, distance: f64| distance > row.distance + tolerance;
    let starts: Vec<[f64; 2]> = asked.iter().map(|row| samples.nearest(row.point)).collect();
    let at_start = |(row, at): &(&&Row, &[f64; 2])| is_wrong(row, samples.distance(**at, row.point));
    let sampled = asked.iter().zip(&starts).filter(at_start).count();
    let by_newton =
        |(row, at): &(&&Row, &[f64; 2])| is_wrong(row, samples.distance(samples.newton(**at, row.point), row.point));
    let newton = asked.iter().zip(&starts).filter(by_newton).count();
    let prepared = Prepared::new(Arc::clone(definition), None);
    let ask = |method: Method| {
        let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
        // the first query prepares
        let first = Query::new(asked[0].point, options).expect("finite points");
        prepared.project(&first, &mut Scratch::default()).expect("no distance limit");
        let (mut scratch, mut wrong, mut times) = (Scratch::default(), 0, Vec::new());
        for row in asked {
            let query = Query::new(row.point, options).expect("finite points");
            let started = Instant::now();
            let foot = prepared.project(&query, &mut scratch).expect("no distance limit");
            times.push(started.elapsed());
            wrong += usize::from(is_wrong(row, foot.distance));
        }
        (wrong, scratch.statistics, median(times))
    };
    let (wrong, statistics, time) = ask(Method::Bernstein);
    let (_, _, hierarchy) = ask(Method::Hierarchy);
    let (mut points, mut decided, mut times) = (0, 0, Vec::new());
    for row in asked {
        let started = Instant::now();
        let found = prepared
            .stationary_points(row.point, &StationaryOptions::default(), &mut Scratch::default())
            .expect("finite points");
        times.push(started.elapsed());
        points += found.points.len();
        decided += usize::from(found.complete && found.continua.is_empty());
    }
    let stationary = median(times);
    println!(
        "{:<22.21}{:>9.1}{:>9.1}{:>9.1}{:>8.1}{:>8.0}{:>10.1}{:>11.2}{:>11.1}{:>10.1}{:>9.0}",
        name,
        percent(sampled),
        percent(newton),
        percent(statistics.corrected as usize),
        percent(wrong),
        statistics.proposal.subdivisions as f64 / count,
        time,
        hierarchy,
        stationary,
        points as f64 / count,
        percent(decided),
    );
}

/// The median in microseconds: other work on the machine disturbs the mean.
fn median(mut times: Vec<Duration>) -> f64 {
    times.sort_unstable();
    1e6 * times[times.len() / 2].as_secs_f64()
}

/// A definition, and its points at samples of its domain.
struct Samples<'a> {
    definition: &'a Definition,
    domain: [(f64, f64); 2],
    /// Whether it is closed in a direction: there Newton's method goes on at the other end, else it stops at the ends.
    closed: [bool; 2],
    points: Vec<(DVec3, [f64; 2])>,
}

impl<'a> Samples<'a> {
    fn of(definition: &'a Definition) -> Self {
        let (domain, counts) = match definition {
            Definition::NurbsCurve(curve) => ([curve.domain(), (0.0, 0.0)], [SAMPLES, 1]),
            Definition::NurbsSurface(surface) => {
                ([surface.domain(Direction::U), surface.domain(Direction::V)], [SAMPLES; 2])
            }
        };
        let mut samples = Self { definition, domain, closed: [false; 2], points: Vec::new() };
        let same = 1e-12 * definition.size();
        let middle = [0, 1].map(|d: usize| 0.3 * domain[d].0 + 0.7 * domain[d].1);
        samples.closed = [0, 1].map(|d| {
            let [mut from, mut to] = [middle; 2];
            (from[d], to[d]) = domain[d];
            domain[d].0 < domain[d].1 && samples.jet(from)[0].distance(samples.jet(to)[0]) <= same
        });
        let at = |d: usize, k: usize| {
            let (from, to) = domain[d];
            if k == 0 { from } else { from + (to - from) * k as f64 / (SAMPLES - 1) as f64 }
        };
        for i in 0..counts[0] {
            for j in 0..counts[1] {
                let at = [at(0, i), at(1, j)];
                samples.points.push((samples.point(at), at));
            }
        }
        samples
    }

    fn point(&self, [u, v]: [f64; 2]) -> DVec3 {
        match self.definition {
            Definition::NurbsCurve(curve) => curve.point(u),
            Definition::NurbsSurface(surface) => surface.point(u, v),
        }
    }

    fn distance(&self, at: [f64; 2], p: DVec3) -> f64 {
        self.point(at).distance(p)
    }

    /// The point and its derivatives `[S, S_v, S_vv, S_u, S_uv, _, S_uu, ..]`, row by row.
    fn jet(&self, [u, v]: [f64; 2]) -> [DVec3; 9] {
        let mut jet = [DVec3::ZERO; 9];
        match self.definition {
            Definition::NurbsCurve(curve) => {
                let mut d = [DVec3::ZERO; 3];
                curve.derivatives(u, &mut d);
                (jet[0], jet[3], jet[6]) = (d[0], d[1], d[2]);
            }
            Definition::NurbsSurface(surface) => surface.derivatives(u, v, 2, &mut jet),
        }
        jet
    }

    fn nearest(&self, p: DVec3) -> [f64; 2] {
        let mut best = (f64::INFINITY, [0.0; 2]);
        for (point, at) in &self.points {
            let distance = point.distance_squared(p);
            if distance < best.0 {
                best = (distance, *at);
            }
        }
        best.1
    }

    /// Newton's method for a zero of the gradient, from a start to where it stands still or 50 steps.
    fn newton(&self, mut at: [f64; 2], p: DVec3) -> [f64; 2] {
        for _ in 0..50 {
            let jet = self.jet(at);
            let offset = jet[0] - p;
            let gradient = [offset.dot(jet[3]), offset.dot(jet[1])];
            let a = jet[3].length_squared() + offset.dot(jet[6]);
            let b = jet[3].dot(jet[1]) + offset.dot(jet[4]);
            let c = jet[1].length_squared() + offset.dot(jet[2]);
            let step = if matches!(self.definition, Definition::NurbsCurve(_)) {
                [gradient[0] / a, 0.0]
            } else {
                let determinant = a * c - b * b;
                [(c * gradient[0] - b * gradient[1]) / determinant, (a * gradient[1] - b * gradient[0]) / determinant]
            };
            if !step.iter().all(|x| x.is_finite()) {
                break;
            }
            let mut next = at;
            for d in 0..2 {
                let (from, to) = self.domain[d];
                next[d] = at[d] - step[d];
                next[d] = if self.closed[d] {
                    from + (next[d] - from).rem_euclid(to - from)
                } else {
                    next[d].clamp(from, to)
                };
            }
            if next == at {
                break;
            }
            at = next;
        }
        at
    }
}
