//! Lines, circles and quadrics, whole and in part. Each enters with a record of its class and the parameters of that.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6, PI, TAU};

use perpend::{Circle, Cone, Cylinder, DVec3, Ellipse, Frame, Line, Model, Operation, Plane, Sphere, Torus};

use super::Outcome;
use super::known::{self, Known};

/// The top of the bench, on which all else stands.
pub(crate) fn bench(model: &mut Model) -> Outcome<()> {
    machined(model, "bench top", Plane::new(Frame::WORLD, (-600.0, 600.0), (-350.0, 350.0))?)
}

pub(crate) fn add(model: &mut Model) -> Outcome<()> {
    let upright = |x: f64, y: f64, z: f64| Frame { centre: DVec3::new(x, y, z), ..Frame::WORLD };
    let whole = (0.0, TAU);

    machined(model, "bar", Cylinder::new(upright(120.0, -220.0, 0.0), 20.0, (0.0, 120.0), whole)?)?;
    let lying = Frame::new(DVec3::new(200.0, -60.0, 45.0), DVec3::X, DVec3::Y)?;
    machined(model, "gutter", Cylinder::new(lying, 40.0, (0.0, 160.0), (PI, TAU))?)?;
    let leaning = Frame::new(DVec3::new(190.0, -240.0, 10.0), DVec3::new(0.6, 0.0, 0.8), DVec3::Y)?;
    machined(model, "cut pipe", Cylinder::new(leaning, 15.0, (0.0, 100.0), (0.0, 1.5 * PI))?)?;

    machined(model, "funnel", Cone::new(upright(330.0, -240.0, 10.0), (10.0, 60.0), (20.0, 100.0), whole)?)?;
    machined(model, "plumb bob", Cone::new(upright(330.0, -120.0, 140.0), (0.0, 20.0), (0.0, 50.0), whole)?)?;

    machined(model, "ball", Sphere::whole(upright(470.0, -260.0, 40.0), 40.0)?)?;
    let bowl = Sphere::new(upright(470.0, -130.0, 60.0), 60.0, (-FRAC_PI_2, -FRAC_PI_6), whole)?;
    machined(model, "bowl", bowl)?;

    machined(model, "ring", Torus::whole(upright(460.0, 10.0, 15.0), 50.0, 15.0)?)?;
    machined(model, "elbow", Torus::new(upright(530.0, 90.0, 30.0), 60.0, 12.0, whole, (FRAC_PI_2, PI))?)?;

    machined(model, "rim", Circle::whole(upright(470.0, 250.0, 60.0), 60.0)?)?;
    let across = Frame::new(DVec3::new(470.0, 250.0, 60.0), DVec3::Y, DVec3::NEG_X)?;
    machined(model, "bail", Circle::new(across, 70.0, (FRAC_PI_6, PI - FRAC_PI_6))?)?;
    machined(model, "oval", Ellipse::whole(upright(330.0, 300.0, 1.0), (40.0, 25.0))?)?;

    machined(model, "straightedge", Line::new(DVec3::new(-560.0, 60.0, 1.0), DVec3::new(-160.0, 60.0, 1.0))?)
}

fn machined(model: &mut Model, name: &str, shape: impl Into<Operation>) -> Outcome<()> {
    known::make(model, name, shape, &[], Known::designed("machining"))?;
    Ok(())
}
