//! What a model knows of its entities after it has learned: speeds with proven bounds, continuity, irregularities, and how
//! each of these is known.
//!
//! `cargo run --example learn_a_model`, or with a model of your own: `cargo run --example learn_a_model -- MODEL`.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::error::Error;
use std::path::{Path, PathBuf};

use perpend::{AcquireOptions, Basis, Categories, Category, Model, Trust};

fn main() -> Result<(), Box<dyn Error>> {
    let workshop = || Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/workshop.ron");
    let path = std::env::args_os().nth(1).map_or_else(workshop, PathBuf::from);
    // What the file states is checked; what is false is acquired again here, and would be an error with `Model::read`.
    let mut model = Model::read_with(path, Trust::Repair)?;

    // An application names parametrisation factors as it likes, and chooses the settings that follow from them.
    let category = |upper, name: &str, tolerance, jitter| Category { upper, name: name.to_owned(), tolerance, jitter };
    let categories = Categories::new(vec![category(0.3, "even", 0.1, 0.5), category(1.0, "uneven", 0.02, 0.8)])?;
    let options = AcquireOptions { categories, ..AcquireOptions::default() };
    println!("learned of {} of {} entities", model.learn_all_with(&options), model.len());

    for entity in model.entities() {
        println!("\n{} {:?}", entity.id(), entity.name());
        let Some(part) = entity.record().and_then(|record| record.representation.as_ref()) else { continue };
        for item in part.speed.iter().flatten() {
            let (speed, name) = (&item.value, item.value.category.as_ref().map_or("", |c| c.name.as_str()));
            let Basis::Proved { gap } = item.basis else { continue };
            println!(
                "  speed in {}: {:.6} to {:.6} ({name}, factor {:.3}), proved within {gap:.0e}",
                speed.direction, speed.min, speed.max, speed.factor
            );
        }
        let breaks = part.breaks.iter().flatten();
        let creases = breaks.clone().filter(|item| item.value.g == 0).count();
        println!("  {} breaks in continuity, {creases} of them creases", breaks.count());
        for item in part.irregularities.iter().flatten().take(3) {
            println!("  {:?}, {:?}", item.value, item.basis);
        }
    }
    Ok(())
}
