//! The wave's own answers on the test corpora, before the proof.

use std::sync::Arc;

use perpend_bench::{corpora, rows};
use perpend_projection::{NewtonTolerances, Query, QueryOptions, Wave, WaveSettings};

use super::corpus;
use crate::Failure;

pub(super) fn print() -> Result<(), Failure> {
    println!("\nOwn answers before the proof, recommended setup, all rows of the corpora");
    println!(
        "{:<16}{:<24}{:>7}{:>8}{:>6}{:>18}{:>18}{:>10}",
        "set", "entity", "rows", "Newton", "most", "beyond gap, %", "other foot, %", "worst"
    );
    for set in ["seeds-curves", "seeds-surfaces"] {
        let truth = rows(&corpora().join(format!("{set}.truth.csv")))?;
        for entity in &corpus(set)?.entities {
            let definition = Arc::new(entity.definition()?);
            let wave = Wave::new(Arc::clone(&definition), WaveSettings::recommended(&definition));
            let (size, mut count, mut newton, mut most) = (definition.size(), 0, 0, 0);
            let (mut beyond, mut other, mut worst) = (0, 0, 0.0_f64);
            for row in truth.iter().filter(|row| row.entity == entity.id) {
                let tolerances = NewtonTolerances { coincidence: Some(1e-6), perpendicularity: 1e-4 };
                let options = QueryOptions { newton: tolerances, ..QueryOptions::default() };
                let trace = wave.trace(&Query::new(row.point, options)?);
                let excess = (trace.distance - row.distance) / size;
                count += 1;
                newton += trace.work.newton;
                most = most.max(trace.work.newton);
                beyond += u32::from(excess > 1e-9);
                other += u32::from(excess > 1e-6);
                worst = worst.max(excess);
            }
            let share = |n: u32| 100.0 * f64::from(n) / f64::from(count);
            println!(
                "{set:<16}{:<24}{count:>7}{:>8.2}{most:>6}{:>18.2}{:>18.2}{worst:>10.1e}",
                entity.name,
                newton as f64 / f64::from(count),
                share(beyond),
                share(other)
            );
        }
    }
    Ok(())
}
