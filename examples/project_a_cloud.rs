//! A cloud of measured points against a whole model: each point's nearest entity, in one batch on all cores.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

use perpend::{DVec3, Model, QueryOptions};

/// Points farther away than this were not measured on the model, mm.
const REACH: f64 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let model = Model::read(folder.join("workshop.ron"))?;
    let cloud = read_points(&folder.join("cloud.csv"))?;

    // Entities beyond `max_distance` are no answers, and a query that knows so is cheap.
    let options = QueryOptions { max_distance: Some(REACH), ..QueryOptions::default() };
    let answers = model.nearest_all(&cloud, &options);

    let (mut largest_gap, mut beyond) = (0.0_f64, 0);
    let mut deviations: BTreeMap<_, (usize, f64)> = BTreeMap::new(); // how many points, the largest deviation
    for answer in answers {
        match answer? {
            Some((id, foot)) => {
                largest_gap = largest_gap.max(foot.gap());
                let (count, largest) = deviations.entry(id).or_default();
                *count += 1;
                *largest = largest.max(foot.distance);
            }
            None => beyond += 1,
        }
    }
    for (id, (count, largest)) in &deviations {
        let name = model.entity(*id).map_or("", |entity| entity.name());
        println!("{name:<17} {count:>4} points, largest deviation {largest:.4} mm");
    }
    let largest = deviations.values().fold(0.0_f64, |largest, (_, deviation)| largest.max(*deviation));
    println!("{} points, {beyond} of them beyond {REACH} mm", cloud.len());
    println!("largest deviation {largest:.6} mm, largest gap between the proven bounds {largest_gap:.1e} mm");
    Ok(())
}

/// The points of a CSV file with the header `x,y,z`.
fn read_points(path: &Path) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let text = std::fs::read_to_string(path)?;
    let mut points = Vec::new();
    for line in text.lines().skip(1) {
        let numbers: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let [x, y, z] = numbers[..] else { return Err(format!("not a point: {line}").into()) };
        points.push(DVec3::new(x, y, z));
    }
    Ok(points)
}
