//! Points with more than one nearest point: a circle's centre, a cylinder's axis, and midway between two faces.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::error::Error;
use std::path::Path;

use perpend::{DVec3, Model, QueryOptions};

fn main() -> Result<(), Box<dyn Error>> {
    let model = Model::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/workshop.ron"))?;
    show(&model, "rim", "its centre", DVec3::new(470.0, 250.0, 60.0))?;
    show(&model, "bar", "on its axis", DVec3::new(120.0, -220.0, 50.0))?;
    show(&model, "knife", "midway between its faces", DVec3::new(-100.0, -120.0, 30.0))?;
    show(&model, "rim", "beside its centre", DVec3::new(471.0, 250.0, 60.0))?;
    Ok(())
}

/// Asks an entity for all its points that are nearest to `p`, and prints them.
fn show(model: &Model, name: &str, place: &str, p: DVec3) -> Result<(), Box<dyn Error>> {
    let entity = model.named(name).next().ok_or("make_workshop writes the model anew")?;
    let options = QueryOptions::default();
    let ties = model.project_ties(entity.id(), p, &options)?.expect("no distance was too far");
    let proof = if ties.complete { "and no others, proven" } else { "perhaps with others" };
    println!("{name}, {place}: {:?} at {:.6} mm", ties.nearest.multiplicity, ties.nearest.distance);
    for foot in &ties.points {
        println!("    the point {:.6}, {:?}", foot.point, foot.parameter);
    }
    for continuum in &ties.continua {
        let ends = |range: fn(&perpend::ParameterBox) -> (f64, f64)| {
            let from = continuum.boxes.iter().map(range).fold(f64::INFINITY, |least, (from, _)| least.min(from));
            let to = continuum.boxes.iter().map(range).fold(f64::NEG_INFINITY, |most, (_, to)| most.max(to));
            format!("{from:.6} to {to:.6}")
        };
        println!("    a continuum over u {} and v {}: {} boxes", ends(|b| b.u), ends(|b| b.v), continuum.boxes.len());
    }
    println!("    {proof}");
    Ok(())
}
