//! A knife with a creased edge, and surfaces made from curves of the model: ruled, turned, extruded.

use std::f64::consts::{PI, TAU};

use perpend::kernel::Spacing;
use perpend::{Circle, DVec3, Frame, Line, Model, Operation, SurfaceData};

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
    known::add(model, "knife", blade, Known::designed("grinding"))?;
    Ok(())
}

/// Ruled from a half circle down to a line.
fn chute(model: &mut Model) -> Outcome<()> {
    let frame = Frame::new(DVec3::new(-460.0, 0.0, 90.0), DVec3::X, DVec3::Y)?;
    let inlet = Circle::new(frame, 40.0, (PI, TAU))?;
    let outlet = Line::new(DVec3::new(-320.0, -30.0, 20.0), DVec3::new(-320.0, 30.0, 20.0))?;
    let rails = [
        known::make(model, "chute inlet", inlet, &[], Known::designed("machining"))?,
        known::make(model, "chute outlet", outlet, &[], Known::designed("machining"))?,
    ];
    let known = Known::designed("bending").because("ruled, so that it rolls from flat sheet");
    known::make(model, "chute", Operation::Rule, &rails, known)?;
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
    let profile = Operation::Interpolation { degree: (3, 0), points, columns: 0, spacing: Spacing::Centripetal };
    let profile = known::make(model, "vase profile", profile, &[], Known::designed("styling"))?;
    let turned = Operation::Revolve { origin: foot, axis: DVec3::Z, angle: TAU };
    known::make(model, "vase", turned, &[profile], Known::designed("turning"))?;
    Ok(())
}

/// The wave, moved upwards.
fn corrugated_sheet(model: &mut Model) -> Outcome<()> {
    let wave = model.named("wave").next().expect("the curves come first").id();
    let raised = Operation::Extrude { vector: DVec3::new(0.0, 0.0, 80.0) };
    known::make(model, "corrugated sheet", raised, &[wave], Known::designed("bending"))?;
    Ok(())
}
