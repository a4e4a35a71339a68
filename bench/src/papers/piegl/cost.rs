//! §5: evaluations per point of a decomposition; the paper says about 1.25.

use std::sync::Arc;

use perpend_projection::{DecompositionCost, Steps, Wave, WaveSettings};

use super::corpus;
use crate::Failure;

const TOLERANCES: [f64; 3] = [0.1, 0.05, 0.01];

pub(super) fn print() -> Result<(), Failure> {
    println!("\nEvaluations per point of a decomposition, jitter 80 % (Piegl et al. 2008, §5: about 1.25)");
    println!("{:<16}{:<24}{:>24}{:>30}", "set", "entity", "steps: 10 % | 5 % | 1 %", "with arc length: 10 | 5 | 1 %");
    let mut totals = [DecompositionCost::default(); 3];
    for set in ["seeds-curves", "seeds-surfaces"] {
        for entity in &corpus(set)?.entities {
            let definition = Arc::new(entity.definition()?);
            let costs = TOLERANCES.map(|tolerance| {
                let steps = Steps::of(tolerance);
                let settings = WaveSettings { decomposition: [steps; 2], sampling: steps };
                Wave::new(Arc::clone(&definition), settings).cost()
            });
            for (total, cost) in totals.iter_mut().zip(costs) {
                total.points += cost.points;
                total.evaluations += cost.evaluations;
                total.length_evaluations += cost.length_evaluations;
            }
            line(set, &entity.name, costs);
        }
    }
    line("all", "", totals);
    Ok(())
}

fn line(set: &str, name: &str, costs: [DecompositionCost; 3]) {
    let per = |cost: DecompositionCost, evaluations: u64| format!("{:8.2}", evaluations as f64 / cost.points as f64);
    let steps = costs.map(|cost| per(cost, cost.evaluations)).concat();
    let all = costs.map(|cost| per(cost, cost.evaluations + cost.length_evaluations)).concat();
    println!("{set:<16}{name:<24}{steps:>24}{all:>30}");
}
