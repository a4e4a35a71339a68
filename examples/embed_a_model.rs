//! A model inside an application: build entities in code, save them, load them, and query them by id.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::error::Error;

use perpend::{CurveData, DVec3, EntityId, Frame, Model, Sphere};

fn main() -> Result<(), Box<dyn Error>> {
    let mut model = Model::new(); // in millimetres

    // An entity from control points, knots and degree; data that break a rule are refused with the rule.
    let rib = CurveData {
        degree: 3,
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0, 2.0],
        control_points: vec![
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(10.0, 25.0, 0.0),
            DVec3::new(30.0, 30.0, 5.0),
            DVec3::new(50.0, 10.0, 10.0),
            DVec3::new(60.0, 0.0, 0.0),
        ],
        weights: None,
    };
    let rib: EntityId = model.insert("rib", rib)?;

    // An analytic shape enters as its exact NURBS form, with a record of what it is.
    let centre = Frame { centre: DVec3::new(30.0, 0.0, 40.0), ..Frame::WORLD };
    let knob = model.insert("knob", Sphere::whole(centre, 8.0)?)?;

    // The file is written whole or not at all, and reads back bit for bit.
    let path = std::env::temp_dir().join(format!("embed-a-model-{}.ron", std::process::id()));
    model.write(&path)?;
    let loaded = Model::read(&path)?;
    std::fs::remove_file(&path)?;
    assert_eq!(loaded, model);

    // The application keeps ids; a model never gives one twice.
    let probe = DVec3::new(25.0, 5.0, 20.0);
    for id in [rib, knob] {
        let foot = loaded.project(id, probe)?;
        let name = loaded.entity(id).map_or("", |entity| entity.name());
        println!("{name} ({id}): {:.6} mm away, at {:.4} ({:?})", foot.distance, foot.point, foot.place);
        println!("    proven: the true distance is at most {:.1e} mm less", foot.gap());
    }
    Ok(())
}
