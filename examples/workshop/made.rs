//! A knife with a creased edge, and surfaces made from curves of the model: ruled, turned, extruded.

use std::f64::consts::{PI, TAU};

use perpend::kernel::{Spacing, curve_through, extrusion, revolution, ruled};
use perpend::{Circle, DVec3, Definition, Direction, Frame, Kind, Line, Model, Operation, Relation, SurfaceData};

use super::dust_pan::clamped;
use super::known::{self, Known};
use super::{Outcome, rounded};

pub(crate) fn add(model: &mut Model) -> Outcome<()> {
    knife(model)?;
    chute(model)?;
    vase(model)?;
    corrugated_sheet(model)
}

/// Two faces that meet in the cutting edge, a crease at v = 0.5, and run together in the point.
fn knife(model: &mut Model) -> Outcome<()> {
    // along the blade, the height of the spine, the height of the edge, half the thickness of the spine
    let stations = [
        (0.0, 32.0, 2.0, 1.5),
        (30.0, 32.0, 1.0, 1.5),
        (70.0, 31.0, 0.0, 1.5),
        (110.0, 29.0, 1.0, 1.25),
        (145.0, 26.0, 5.0, 1.0),
        (170.0, 23.0, 12.0, 0.5),
        (185.0, 20.0, 20.0, 0.0),
    ];
    let heel = DVec3::new(-150.0, -120.0, 10.0);
    let row = |(along, spine, edge, half): &(f64, f64, f64, f64)| {
        let side = |y: f64| heel + DVec3::new(*along, y, *spine);
        vec![side(-half), heel + DVec3::new(*along, 0.0, *edge), side(*half)]
    };
    let control_points: Vec<Vec<DVec3>> = stations.iter().map(row).collect();
    let knots = (clamped(stations.len()), vec![0.0, 0.0, 0.5, 1.0, 1.0]);
    let blade = SurfaceData { degree: (3, 1), knots, control_points, weights: None };
    known::add(model, "knife", blade, Known::designed("grinding").made_by(Operation::ByData, &[], ""))?;
    Ok(())
}

/// Ruled from a half circle down to a line.
fn chute(model: &mut Model) -> Outcome<()> {
    let frame = Frame::new(DVec3::new(-460.0, 0.0, 90.0), DVec3::X, DVec3::Y)?;
    let inlet = Circle::new(frame, 40.0, (PI, TAU))?;
    let outlet = Line::new(DVec3::new(-320.0, -30.0, 20.0), DVec3::new(-320.0, 30.0, 20.0))?;
    let rails = [
        known::add(model, "chute inlet", inlet, Known::designed("machining"))?,
        known::add(model, "chute outlet", outlet, Known::designed("machining"))?,
    ];
    let made = Known::derived("ruled", &rails, "bending")
        .kind(Kind::Ruled { ruling: Direction::V })
        .made_by(Operation::Rule, &rails, "ruled, so that it rolls from flat sheet")
        .related(Relation::Rail, rails[0])
        .related(Relation::Rail, rails[1]);
    known::add(model, "chute", ruled(&inlet.to_nurbs()?, &outlet.to_nurbs()?)?, made)?;
    Ok(())
}

/// A vase, turned from its profile. The profile starts on the axis, which gives a pole.
fn vase(model: &mut Model) -> Outcome<()> {
    let foot = DVec3::new(40.0, 40.0, 1.0);
    let outline = [
        (0.0, 0.0),
        (15.0, 0.0),
        (28.0, 2.0),
        (36.0, 15.0),
        (42.0, 38.0),
        (38.0, 64.0),
        (22.0, 88.0),
        (13.0, 106.0),
        (14.0, 124.0),
        (24.0, 140.0),
    ];
    let points: Vec<DVec3> = outline.iter().map(|(r, z)| rounded(foot + DVec3::new(*r, 0.0, *z))).collect();
    let profile = curve_through(&points, 3, Spacing::Centripetal)?;
    let operation = Operation::Interpolation { degree: (3, 0), points };
    let made = Known::designed("styling").made_by(operation, &[], "");
    let profile_id = known::add(model, "vase profile", profile.clone(), made)?;

    let made = Known::derived("revolution", &[profile_id], "turning")
        .kind(Kind::Revolution { origin: foot, axis: DVec3::Z, sweep: TAU, angular: Direction::V })
        .made_by(Operation::Revolve { origin: foot, axis: DVec3::Z, angle: TAU }, &[profile_id], "")
        .related(Relation::Profile, profile_id);
    known::add(model, "vase", revolution(&profile, foot, DVec3::Z, TAU)?, made)?;
    Ok(())
}

/// The wave, moved upwards.
fn corrugated_sheet(model: &mut Model) -> Outcome<()> {
    let wave = model.named("wave").next().expect("the curves come first");
    let Definition::NurbsCurve(profile) = wave.definition().as_ref() else { unreachable!("the wave is a curve") };
    let (profile_id, vector) = (wave.id(), DVec3::new(0.0, 0.0, 80.0));
    let sheet = extrusion(profile, vector)?;
    let made = Known::derived("extrusion", &[profile_id], "bending")
        .kind(Kind::Extrusion { vector, along: Direction::V })
        .made_by(Operation::Extrude { vector }, &[profile_id], "")
        .related(Relation::Profile, profile_id);
    known::add(model, "corrugated sheet", sheet, made)?;
    Ok(())
}
