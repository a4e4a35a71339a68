//! What all contenders have in common: perpend's methods and the rivals.

use std::hint::black_box;
use std::time::{Duration, Instant};

use perpend::{DVec3, Parameter};

use crate::Failure;
use crate::case::{Case, Set};

/// What a contender answers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Answer {
    /// The distance that it gives.
    pub(crate) distance: f64,
    /// Where on the entity's definition; none where its parameters are others.
    pub(crate) parameter: Option<Parameter>,
    /// What it claims to have proven of the distance; none where it claims nothing.
    pub(crate) lower_bound: Option<f64>,
}

/// Which rows a contender is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pace {
    /// Judged and timed on all.
    All,
    /// Judged on all and timed on every N-th: it is slow.
    Thinned,
    /// Judged and timed on every N-th: it is very slow, or prepares anew for each.
    Few,
}

impl Pace {
    /// Every how many rows it is judged and, of those, timed, where slow contenders have every `n`-th.
    pub(crate) fn strides(self, n: usize) -> (usize, usize) {
        match self {
            Self::All => (1, 1),
            Self::Thinned => (1, n),
            Self::Few => (n, 1),
        }
    }
}

/// A method of perpend, or a rival.
pub(crate) trait Contender {
    /// Its name in the table.
    fn name(&self) -> String;

    /// Which rows of a set it is asked.
    fn pace(&self, set: Set) -> Pace;

    /// Makes an entity ready from the data of its definition; none where it has no use for this one.
    ///
    /// `points` are the rows that it will be judged on.
    ///
    /// # Errors
    ///
    /// What keeps it from taking an entity that it should take.
    fn enter(&self, case: &Case, points: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure>;
}

/// A contender made ready for one entity.
pub(crate) trait Entrant {
    /// Answers all points into `answers`, which is as long; none where it gives no answer.
    ///
    /// # Errors
    ///
    /// A process that cannot be spoken to.
    fn judge(&mut self, points: &[DVec3], answers: &mut [Option<Answer>]) -> Result<(), Failure>;

    /// The time of every `stride`-th point, for all of them together.
    ///
    /// # Errors
    ///
    /// As [`judge`](Self::judge).
    fn pass(&mut self, points: &[DVec3], stride: usize) -> Result<Duration, Failure>;

    /// What it measured of itself, in place of what is seen from outside.
    fn own(&self) -> Own {
        Own::default()
    }
}

/// What an entrant knows better than its measurement from outside.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Own {
    /// From the definition to the first answer.
    pub(crate) setup: Option<Duration>,
    /// Heap bytes that it holds.
    pub(crate) heap: Option<u64>,
    /// What is seen from outside of its heap is not all of it.
    pub(crate) is_heap_unseen: bool,
    /// Queries at which its process died.
    pub(crate) aborted: usize,
    /// The largest distance from the entity to what stands for it that was measured, as a share of the size.
    pub(crate) chord_error: Option<f64>,
}

/// A contender that answers point by point within this process.
pub(crate) trait Ask {
    /// The nearest point to `p`; none where it gives no answer.
    fn ask(&mut self, p: DVec3) -> Option<Answer>;

    /// As [`Entrant::own`].
    fn own(&self) -> Own {
        Own::default()
    }
}

impl<A: Ask> Entrant for A {
    fn judge(&mut self, points: &[DVec3], answers: &mut [Option<Answer>]) -> Result<(), Failure> {
        for (p, answer) in points.iter().zip(answers) {
            *answer = self.ask(*p);
        }
        Ok(())
    }

    fn pass(&mut self, points: &[DVec3], stride: usize) -> Result<Duration, Failure> {
        let start = Instant::now();
        for p in points.iter().step_by(stride) {
            black_box(self.ask(black_box(*p)));
        }
        Ok(start.elapsed())
    }

    fn own(&self) -> Own {
        Ask::own(self)
    }
}
