//! Answers against the truth.

use perpend::{DVec3, Definition, Parameter};
use perpend_bench::Row;

use crate::contender::Answer;

/// A distance within this of the truth is right, as a share of the entity's size.
const RIGHT: f64 = 1e-7;
/// The same for perpend's own claim, and the gap that it is asked for.
const CLAIM: f64 = 1e-9;
/// How far above the recorded distance a bound may lie before it is false, as a share of the size: the records' own accuracy.
const RECORDED: f64 = 1e-10;

/// How an entity's answers were; the sum over entities is a set's.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Judgement {
    /// Rows judged.
    pub(crate) rows: usize,
    /// Answers within 1e-7 of the size of the truth.
    pub(crate) right: usize,
    /// Rows without an answer.
    pub(crate) unanswered: usize,
    /// Rows at which the process died; among those without an answer.
    pub(crate) aborted: usize,
    /// The worst error of an answer, as a share of the size.
    pub(crate) worst: f64,
    /// Whether it claims bounds: only then the rest has a meaning.
    pub(crate) has_bounds: bool,
    /// Answers farther than 1e-9 of the size from the truth.
    pub(crate) wrong: usize,
    /// Lower bounds above the truth.
    pub(crate) false_bounds: usize,
    /// Answers whose gap is larger than was asked for.
    pub(crate) uncertified: usize,
}

impl Judgement {
    /// Judges the answers to every `stride`-th row.
    ///
    /// Where an answer has a parameter, both count: the distance that it states and that of the definition there.
    pub(crate) fn of(definition: &Definition, rows: &[Row], stride: usize, answers: &[Option<Answer>]) -> Self {
        let (size, reach) = (definition.size(), definition.reach());
        let mut judgement = Self::default();
        for (row, answer) in rows.iter().step_by(stride).zip(answers) {
            judgement.rows += 1;
            let Some(answer) = answer else {
                judgement.unanswered += 1;
                continue;
            };
            let scale = reach + row.point.abs().max_element();
            let noise = 16.0 * f64::EPSILON * scale + 1e-13 * row.distance;
            let there = answer.parameter.map(|at| row.point.distance(point(definition, at)));
            let distances = [Some(answer.distance), there].into_iter().flatten();
            let errors = distances.map(|distance| (distance - row.distance).abs());
            // what is not a number is as wrong as can be
            let error = errors.map(|e| if e.is_nan() { f64::INFINITY } else { e }).fold(0.0, f64::max);
            judgement.right += usize::from(error <= RIGHT * size + noise);
            judgement.worst = judgement.worst.max(error / size);
            if let Some(lower) = answer.lower_bound {
                judgement.has_bounds = true;
                judgement.wrong += usize::from(error > CLAIM * size + noise);
                judgement.false_bounds += usize::from(lower > row.distance + RECORDED * size + noise);
                let allowed = CLAIM * size + 32.0 * f64::EPSILON * scale;
                judgement.uncertified += usize::from(answer.distance - lower > allowed);
            }
        }
        judgement
    }

    /// The judgement on both.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            rows: self.rows + other.rows,
            right: self.right + other.right,
            unanswered: self.unanswered + other.unanswered,
            aborted: self.aborted + other.aborted,
            worst: self.worst.max(other.worst),
            has_bounds: self.has_bounds || other.has_bounds,
            wrong: self.wrong + other.wrong,
            false_bounds: self.false_bounds + other.false_bounds,
            uncertified: self.uncertified + other.uncertified,
        }
    }
}

fn point(definition: &Definition, at: Parameter) -> DVec3 {
    match (definition, at) {
        (Definition::NurbsCurve(curve), at) => curve.point(at.u()),
        (Definition::NurbsSurface(surface), at) => surface.point(at.u(), at.v().unwrap_or_default()),
    }
}
