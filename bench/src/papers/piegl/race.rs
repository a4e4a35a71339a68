//! The wave at the recommended setup beside the hierarchy: memory and time from the first query to the last, proof included.
//!
//! Each run is a process of its own, so that its memory is what the system says of it. The time is the processor's, where the system tells it:
//! what other programs take of a shared machine is not in it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch, WaveSettings};

use super::points::{Points, Where};
use super::{ENTITIES, definition};
use crate::Failure;

const METHODS: [(&str, Method); 2] = [("wave", Method::Wave), ("hierarchy", Method::Hierarchy)];

/// Powers of ten at which the clock is read.
const POWERS: u32 = 6;

pub(super) fn print() -> Result<(), Failure> {
    let powers = if std::env::args().any(|a| a == "--quick") { 4 } else { POWERS };
    println!(
        "\nThe wave at the recommended setup beside the hierarchy: ms of processor time from an entity whose class is known to the answer of query n, each proved"
    );
    let counts: String = (0..=powers).map(|k| format!("{:>11}", format!("n = 1e{k}"))).collect();
    println!(
        "{:<28}{:<6}{:<11}{:>9}{:>8}{counts}{:>12}{:>11}",
        "entity", "where", "method", "make ms", "MB", "us a query", "corrected"
    );
    for (set, name, means) in ENTITIES {
        for place in Where::ALL {
            for (method, _) in METHODS {
                let program = std::env::current_exe()?;
                let arguments = ["piegl-run", set, name, place.name(), method, &powers.to_string()];
                let output = std::process::Command::new(program).args(arguments).output()?;
                if !output.status.success() {
                    return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
                }
                print!("{means:<28}{:<6}{method:<11}{}", place.name(), String::from_utf8_lossy(&output.stdout));
            }
        }
    }
    Ok(())
}

/// One line of the table: `SET ENTITY PLACE METHOD POWERS`.
pub(super) fn run(arguments: &[String]) -> Result<(), Failure> {
    let [set, name, place, method, powers] = arguments else {
        return Err("piegl-run is what papers piegl starts itself with".into());
    };
    let place = Where::ALL.into_iter().find(|p| p.name() == place).ok_or("an unknown place")?;
    let (_, method) = METHODS.into_iter().find(|(name, _)| name == method).ok_or("an unknown method")?;
    let definition = definition(set, name)?;
    let prepared = Prepared::new(Arc::clone(&definition), None);
    let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
    let mut points = Points::new(&definition, place);
    let mut scratch = Scratch::default();
    let before = resident();
    let mut prepared = Some(prepared);
    let mut passed = Passed::default().add(|| {
        if method == Method::Wave {
            prepared = prepared.take().map(|p| p.with_wave(WaveSettings::recommended(&definition)));
        }
    });
    let prepared = prepared.ok_or("prepared above")?;
    let made = passed;
    let (mut times, mut asked) = (Vec::new(), 0_u64);
    for power in 0..=powers.parse::<u32>()? {
        // the points are made outside the clock, a portion at a time
        while asked < 10_u64.pow(power) {
            let portion = (10_u64.pow(power) - asked).min(10_000);
            let queries: Vec<Query> =
                (0..portion).map(|_| Query::new(points.next(), options)).collect::<Result<_, _>>()?;
            passed = passed.add(|| {
                for query in &queries {
                    std::hint::black_box(prepared.project(query, &mut scratch));
                }
            });
            asked += portion;
        }
        times.push(passed);
    }
    let last = times[times.len() - 1].ms() - times[times.len() - 2].ms();
    let share = 0.9 * asked as f64;
    println!(
        "{:>9.2}{:>8.1}{}{:>12.2}{:>11}",
        made.ms(),
        (resident() - before) / 1e6,
        times.iter().map(|time| format!("{:>11.2}", time.ms())).collect::<String>(),
        1e3 * last / share,
        scratch.statistics.corrected
    );
    Ok(())
}

/// Bytes of this process in memory; 0 where the system does not say.
fn resident() -> f64 {
    let field =
        std::fs::read_to_string("/proc/self/statm").ok().and_then(|text| text.split(' ').nth(1)?.parse::<f64>().ok());
    field.map_or(0.0, |pages| 4096.0 * pages)
}

/// Time that work took: by the clock on the wall, and by the processor where the system tells it.
#[derive(Debug, Clone, Copy, Default)]
struct Passed {
    wall: Duration,
    processor: Option<Duration>,
}

impl Passed {
    /// The time of some work, added to what passed before.
    fn add(self, work: impl FnOnce()) -> Self {
        let (wall, processor) = (Instant::now(), processor());
        work();
        let passed = processor.zip(self::processor()).map(|(start, now)| now - start);
        Self {
            wall: self.wall + wall.elapsed(),
            processor: passed.map(|passed| passed + self.processor.unwrap_or_default()),
        }
    }

    /// In ms: by the wall where it is short, since the system counts the processor's in ticks.
    fn ms(self) -> f64 {
        let time = self.processor.filter(|time| *time > Duration::from_millis(50)).unwrap_or(self.wall);
        time.as_secs_f64() * 1e3
    }
}

/// The processor time of this thread so far, where the system tells it.
fn processor() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split(' ').next()?.parse().ok().map(Duration::from_nanos)
}
