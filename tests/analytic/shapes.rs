//! Shapes of every class, size and place.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;
use perpend::Frame;

use crate::common::exact::Exact;
use crate::common::random::Random;

pub(crate) const CLASSES: [&str; 8] = ["Line", "Circle", "Ellipse", "Plane", "Cylinder", "Cone", "Sphere", "Torus"];

/// Where a shape stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Standing {
    /// About its radius.
    pub(crate) scale: f64,
    /// How far from the origin.
    pub(crate) offset: f64,
    /// Along the axes of space, so that its special points are exact.
    pub(crate) upright: bool,
}

impl Standing {
    pub(crate) const WORLD: Self = Self { scale: 1.0, offset: 0.0, upright: true };

    pub(crate) fn random(random: &mut Random) -> Self {
        let scale = if random.chance(0.5) { 1.0 } else { random.power(-3.0, 6.0) };
        let offset = if random.chance(0.5) { 0.0 } else { scale * random.power(-1.0, 6.0) };
        Self { scale, offset, upright: random.chance(0.4) }
    }
}

fn frame(random: &mut Random, standing: Standing) -> Frame {
    if standing.upright {
        return Frame::new(standing.offset * DVec3::new(1.0, -0.5, 0.25), DVec3::Z, DVec3::X).expect("a frame");
    }
    let [x, _, z] = random.frame();
    Frame::new(standing.offset * random.direction(), z, x).expect("a frame")
}

/// A range of angles of 0.95 to 360 degrees, from anywhere.
pub(crate) fn sweep(random: &mut Random) -> (f64, f64) {
    let degrees = match random.count(0, 7) {
        0..=2 => return (0.0, TAU),
        3 => random.pick(&[0.95, 2.8, 5.0, 10.0]),
        4 => random.pick(&[90.0, 120.0, 180.0, 270.0, 355.0, 359.0]),
        _ => random.between(5.0, 355.0),
    };
    let start = random.pick(&[0.0, 0.0, -FRAC_PI_2, 2.5, random.clone().between(-4.0, 4.0)]);
    (start, start + degrees.to_radians())
}

/// A shape of a class.
pub(crate) fn shape(random: &mut Random, class: &str, standing: Standing) -> Exact {
    let (frame, scale, sweep) = (frame(random, standing), standing.scale, sweep(random));
    let radius = if standing.upright { scale } else { scale * random.between(0.3, 2.0) };
    let height = random.pick(&[(-1.0, 1.0), (0.0, 3.0), (0.5, 0.75), (-4.0, -1.0)]);
    let height = (scale * height.0, scale * height.1);
    match class {
        "Line" => Exact::Segment { a: frame.centre, b: frame.centre + radius * random.direction() },
        "Circle" => Exact::Circle { frame, radius, sweep },
        "Ellipse" => {
            // a sliver of an ellipse is a parabola to the digits that there are
            let turn = (sweep.1 - sweep.0).max(10.0_f64.to_radians());
            let second = radius * random.pick(&[0.05, 0.5, 0.99, 2.0, 10.0]);
            Exact::Ellipse { frame, radii: (radius, second), sweep: (sweep.0, sweep.0 + turn) }
        }
        "Plane" => {
            let (x, y) = (frame.xdir, frame.ydir());
            let skew = random.pick(&[0.0, 0.0, 0.5, -3.0]);
            Exact::Parallelogram { corner: frame.centre, a: radius * x, b: scale * (y + skew * x) }
        }
        "Cylinder" => Exact::Cylinder { frame, radius, height, sweep },
        "Cone" => {
            let other = random.pick(&[0.0, 0.0, 0.5 * radius, 3.0 * radius, 1.01 * radius]);
            let radii = if random.chance(0.5) { (radius, other) } else { (other, radius) };
            Exact::Cone { frame, radii, height, sweep }
        }
        "Sphere" => {
            let low = random.pick(&[-FRAC_PI_2, -FRAC_PI_2, -1.2, -0.3, 0.1]);
            let high = random.pick(&[FRAC_PI_2, FRAC_PI_2, 1.3, 0.4]);
            Exact::Sphere { frame, radius, latitude: (low, high), sweep }
        }
        _ => {
            let tube = random.pick(&[(0.0, TAU), (0.0, TAU), (-1.0, 1.0), (1.5, 5.0), (0.0, FRAC_PI_2)]);
            let minor = radius * random.pick(&[0.1, 0.5, 0.9, 1.0]);
            Exact::Torus { frame, major: radius, minor, tube, sweep }
        }
    }
}

/// The frame of a shape, where it has one.
pub(crate) fn frame_of(exact: &Exact) -> Option<&Frame> {
    match exact {
        Exact::Circle { frame, .. }
        | Exact::Ellipse { frame, .. }
        | Exact::Cylinder { frame, .. }
        | Exact::Cone { frame, .. }
        | Exact::Sphere { frame, .. }
        | Exact::Torus { frame, .. } => Some(frame),
        _ => None,
    }
}
