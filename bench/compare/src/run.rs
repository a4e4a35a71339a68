//! Measuring all contenders on one entity.

use std::time::{Duration, Instant};

use perpend::DVec3;

use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Answer, Contender, Entrant};
use crate::judgement::Judgement;

/// A pass over the rows is repeated until it has taken this long: the clock and a wake-up of the machine are small beside it.
const LEAST: Duration = Duration::from_millis(2);
/// Setups that are timed; the median counts.
const SETUPS: usize = 3;
/// A setup that takes longer is timed once.
const LONG_SETUP: Duration = Duration::from_millis(50);

/// What was measured of a contender on an entity.
pub(crate) struct Measured {
    /// Which contender, by its place in the table.
    pub(crate) contender: usize,
    /// Which entity, by its place in the set.
    pub(crate) case: usize,
    /// Microseconds per query, one for each pass, in ascending order.
    pub(crate) times: Vec<f64>,
    /// Rows that were timed.
    pub(crate) timed: usize,
    /// From the definition to the first answer, in microseconds.
    pub(crate) setup: f64,
    /// Heap bytes that it holds after its queries; none where they could not be counted.
    pub(crate) heap: Option<u64>,
    /// How its answers were.
    pub(crate) judgement: Judgement,
    /// The measured error of what stands for the entity, as a share of its size.
    pub(crate) chord_error: Option<f64>,
}

impl Measured {
    /// The median of the passes.
    pub(crate) fn median(&self) -> f64 {
        let (n, middle) = (self.times.len(), self.times.len() / 2);
        if n % 2 == 1 { self.times[middle] } else { 0.5 * (self.times[middle - 1] + self.times[middle]) }
    }

    /// The fastest pass: other programs only ever add time, so ratios are taken of these.
    pub(crate) fn fastest(&self) -> f64 {
        self.times[0]
    }

    /// The slowest pass.
    pub(crate) fn slowest(&self) -> f64 {
        self.times[self.times.len() - 1]
    }
}

/// A contender on the entity, between its judgement and its passes.
struct Entered {
    entrant: Box<dyn Entrant>,
    points: Vec<DVec3>,
    stride: usize,
    measured: Measured,
}

/// Measures these contenders on an entity, pass by pass in turn, so that what disturbs the machine disturbs all. What keeps one from taking part is the
/// entity's failure.
pub(crate) fn measure(
    set: Set,
    (at, case): (usize, &Case),
    contenders: &[(usize, &dyn Contender)],
    passes: usize,
    every: usize,
    failures: &mut Vec<String>,
) -> Vec<Measured> {
    let mut entered = Vec::new();
    let mut failed = |contender: &dyn Contender, error: Failure| {
        failures.push(format!("{} on {}: {error}", contender.name(), case.name));
    };
    for (index, contender) in contenders {
        match enter(set, case, *contender, every) {
            Ok(Some(mut ready)) => {
                (ready.measured.contender, ready.measured.case) = (*index, at);
                entered.push(ready);
            }
            Ok(None) => {}
            Err(error) => failed(*contender, error),
        }
    }
    for _ in 0..passes {
        entered.retain_mut(|ready| match pass(ready) {
            Ok(time) => {
                ready.measured.times.push(time);
                true
            }
            Err(error) => {
                failures.push(format!("{}: {error}", case.name));
                false
            }
        });
    }
    let finished = entered.into_iter().map(|mut ready| {
        ready.measured.times.sort_by(f64::total_cmp);
        ready.measured
    });
    finished.collect()
}

/// Makes a contender ready and judges it.
fn enter(set: Set, case: &Case, contender: &dyn Contender, every: usize) -> Result<Option<Entered>, Failure> {
    let (judged, stride) = contender.pace(set).strides(every);
    let points = case.points(judged);
    let mut answers: Vec<Option<Answer>> = vec![None; points.len()];
    let mut result = Ok(None);
    let mut setups = Vec::new();
    let counted = allocation_counter::measure(|| {
        result = (|| {
            let start = Instant::now();
            let Some(mut entrant) = contender.enter(case, &points)? else { return Ok(None) };
            // a child measures its setup itself, and is not to be started twice
            if entrant.own().setup.is_none() {
                entrant.judge(&points[..1], &mut answers[..1])?;
                setups.push(start.elapsed());
            }
            entrant.judge(&points, &mut answers)?;
            Ok::<_, Failure>(Some(entrant))
        })();
    });
    let Some(entrant) = result? else { return Ok(None) };
    while setups.first().is_some_and(|first| *first < LONG_SETUP) && setups.len() < SETUPS {
        let start = Instant::now();
        if let Some(mut again) = contender.enter(case, &points)? {
            again.judge(&points[..1], &mut [None])?;
        }
        setups.push(start.elapsed());
    }
    setups.sort();
    let own = entrant.own();
    let setup = own.setup.or(setups.get(setups.len() / 2).copied()).unwrap_or_default();
    let heap = own.heap.or(u64::try_from(counted.bytes_current).ok()).filter(|_| !own.is_heap_unseen);
    let mut judgement = Judgement::of(&case.definition, &case.rows, judged, &answers);
    judgement.aborted = own.aborted;
    let measured = Measured {
        contender: 0,
        case: 0,
        times: Vec::new(),
        timed: points.len().div_ceil(stride),
        setup: setup.as_secs_f64() * 1e6,
        heap,
        judgement,
        chord_error: own.chord_error,
    };
    Ok(Some(Entered { entrant, points, stride, measured }))
}

/// Microseconds per query of a pass.
fn pass(ready: &mut Entered) -> Result<f64, Failure> {
    let (mut total, mut rounds) = (Duration::ZERO, 0_u32);
    while total < LEAST {
        total += ready.entrant.pass(&ready.points, ready.stride)?;
        rounds += 1;
    }
    Ok(total.as_secs_f64() * 1e6 / (f64::from(rounds) * ready.measured.timed as f64))
}
