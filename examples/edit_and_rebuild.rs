//! Edits what an entity is made of, and lists, rebuilds and replays what follows: `cargo run --example edit_and_rebuild`.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::error::Error;
use std::path::Path;

use perpend::{DVec3, Model, Operation};

fn main() -> Result<(), Box<dyn Error>> {
    let mut model = Model::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/workshop.ron"))?;
    let profile = model.named("vase profile").next().ok_or("the workshop has a vase")?;
    let (profile, intent) = (profile.id(), profile.record().map(|record| record.intent[0].operation.clone()));
    let Some(Operation::Interpolation { degree, mut points, columns, spacing }) = intent else {
        return Err("the profile passes points".into());
    };

    for one in model.impact(profile)? {
        println!("an edit of {profile} touches {}: {:?}, since {:?}", one.id, one.effect, one.because);
    }

    // the belly of the vase 5 mm wider
    points[4].x += 5.0;
    let changed = model.edit(profile, Operation::Interpolation { degree, points, columns, spacing })?;
    for id in &changed {
        let entity = model.entity(*id).ok_or("it changed, so it is there")?;
        let drift = model.replay(*id)?.drift;
        println!("{id} {:?}: revision {}, drift at most {:e} mm", entity.name(), entity.revision(), drift.proven);
        assert_eq!(drift.proven, 0.0);
    }

    // an edit that cannot be built changes nothing
    let before = model.to_ron();
    let radius = -1.0;
    let circle = Operation::CircleByCentre { centre: DVec3::ZERO, axis: DVec3::Z, radius, xdir: None };
    if let Err(error) = model.edit(profile, circle) {
        println!("refused: {error}");
    }
    assert_eq!(model.to_ron(), before);
    Ok(())
}
