//! All stationary points of the distance from a point: on the rim of a hole, on its axis, and on a free-form surface.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::error::Error;
use std::path::Path;

use perpend::{DVec3, Definition, Extremum, Model, StationaryOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let model = Model::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/workshop.ron"))?;
    show(&model, "rim", "beside its axis", DVec3::new(471.0, 250.0, 70.0))?;
    show(&model, "rim", "on its axis", DVec3::new(470.0, 250.0, 70.0))?;
    show(&model, "dust pan", "above it", DVec3::new(10.0, 20.0, 200.0))?;
    Ok(())
}

/// Prints the stationary points of an entity for a point, and what they add up to.
fn show(model: &Model, name: &str, place: &str, p: DVec3) -> Result<(), Box<dyn Error>> {
    let entity = model.named(name).next().ok_or("make_workshop writes the model anew")?;
    let found = model.stationary_points(entity.id(), p, &StationaryOptions::default())?;
    println!("{name}, from a point {place}:");
    for point in &found.points {
        let kind = point.kind.map_or_else(|| "Unknown".to_owned(), |kind| format!("{kind:?}"));
        let inward = if point.descends_inward { ", falling inward" } else { "" };
        println!("    {kind} at {:.6} mm, {:?}{inward}, {:?}", point.distance, point.place, point.certainty);
    }
    if matches!(**entity.definition(), Definition::NurbsSurface(_)) {
        let counted = found.points.iter().filter(|point| !point.descends_inward);
        let sum: i32 = counted.map(|point| if point.kind == Some(Extremum::Saddle) { -1 } else { 1 }).sum();
        println!("    minima less saddles plus maxima, those that fall inward apart: {sum}");
    }
    for continuum in &found.continua {
        println!("    a continuum of {} boxes", continuum.boxes.len());
    }
    println!("    {}", if found.complete { "and no others, proven" } else { "the work bound was met" });
    Ok(())
}
