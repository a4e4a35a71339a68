//! Query points on and beside the sets where a foot is not alone or not regular.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::DVec3;
use perpend::Multiplicity;

use super::shapes::frame_of;
use crate::common::exact::Exact;
use crate::common::exact::vector::Axes;
use crate::common::random::Random;
use crate::common::shape::Shape;

/// A query point, and what its foot's multiplicity must be, where that is known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probe {
    pub(crate) point: DVec3,
    pub(crate) multiplicity: Option<Multiplicity>,
}

/// The points that are special to a shape.
pub(crate) fn special(exact: &Exact, random: &mut Random) -> Vec<Probe> {
    let mut probes = Vec::new();
    let Some(frame) = frame_of(exact) else {
        let (corner, sides) = match exact {
            Exact::Segment { a, b } => (*a, [*b - *a, DVec3::ZERO]),
            Exact::Parallelogram { corner, a, b } => (*corner, [*a, *b]),
            _ => return probes,
        };
        let across = sides[0].cross(if sides[1] == DVec3::ZERO { random.direction() } else { sides[1] });
        let across = sides[0].length() * across.normalize();
        for s in [-0.5, 0.0, 0.5, 1.0, 1.5] {
            for t in [-0.5, 0.0, 0.5, 1.0, 1.5] {
                for h in [0.0, 1.0, -0.5] {
                    let point = corner + s * sides[0] + t * sides[1] + h * across;
                    probes.push(Probe { point, multiplicity: Some(Multiplicity::Unique) });
                }
            }
        }
        return probes;
    };
    let axes = Axes::new(frame.centre, frame.axis, frame.xdir);
    let mut add = |x: f64, y: f64, z: f64, multiplicity: Option<Multiplicity>| {
        probes.push(Probe { point: axes.point(x, y, z), multiplicity });
    };
    let ring = Some(Multiplicity::Continuum);
    match *exact {
        Exact::Circle { radius, .. } => {
            for z in [0.0, 0.5, -1.0, 10.0] {
                add(0.0, 0.0, z * radius, ring);
            }
        }
        Exact::Ellipse { radii: (a, b), sweep, .. } => {
            let (large, whole) = (a.max(b), sweep.1 - sweep.0 >= TAU);
            let split = (a * a - b * b) / large;
            let along = |share: f64| if a > b { (share * split, 0.0) } else { (0.0, share * split) };
            for share in [0.0, 0.5, 0.99, 1.0, 1.5, -1.0, 3.0] {
                let (x, y) = along(share);
                // between the cusps of the evolute there are two feet, unless the ellipse is so round that they are one
                let apart = share.abs() < 0.9 && (a - b).abs() > 0.02 * large && whole;
                add(x, y, 0.0, apart.then_some(Multiplicity::Tied));
                add(y, x, 0.0, None);
                add(x, y, 0.3 * large, apart.then_some(Multiplicity::Tied));
            }
            for _ in 0..12 {
                // on the evolute
                let t = random.between(0.0, TAU);
                add((a * a - b * b) / a * t.cos().powi(3), (b * b - a * a) / b * t.sin().powi(3), 0.0, None);
            }
        }
        Exact::Cylinder { radius, height, .. } => {
            for z in [height.0, height.1, 0.5 * (height.0 + height.1), height.1 + radius, height.0 - 10.0 * radius] {
                add(0.0, 0.0, z, ring);
            }
            add(radius, 0.0, height.1 + radius, None);
            add(-2.0 * radius, 0.0, height.0, None);
        }
        Exact::Cone { radii, height, .. } => {
            let truncated = radii.0 > 0.0 && radii.1 > 0.0;
            for share in [-10.0, -1.0, 0.0, 1e-3, 0.25, 0.5, 0.9, 1.0, 1.5, 20.0] {
                let z = height.0 + share * (height.1 - height.0);
                // the apex alone is the foot from behind it
                let towards_apex = if radii.0 == 0.0 { share <= 0.0 } else { share >= 1.0 };
                let multiplicity = if truncated {
                    ring
                } else if towards_apex {
                    Some(Multiplicity::Unique)
                } else {
                    None
                };
                add(0.0, 0.0, z, multiplicity);
            }
            // in the polar cone of the apex, or in the solid beyond the narrow end
            let (narrow, out) = if radii.0 < radii.1 { (height.0, -1.0) } else { (height.1, 1.0) };
            let length = height.1 - height.0;
            add(0.01 * length, 0.02 * length, narrow + out * 5.0 * length, None);
            // on the boundary of that cone: at right angles to the ruling from the apex
            let slope = (radii.1 - radii.0).abs() / length;
            add(length, 0.0, narrow + out * slope * length, None);
        }
        Exact::Sphere { radius, latitude, .. } => {
            add(0.0, 0.0, 0.0, ring);
            let poles = [latitude.0 == -FRAC_PI_2, latitude.1 == FRAC_PI_2];
            for z in [0.5, 1.0, 1.5, 10.0] {
                for (side, pole) in [(-1.0, poles[0]), (1.0, poles[1])] {
                    let alone = (pole && z > 0.1).then_some(Multiplicity::Unique);
                    let zone = (!poles[0] && !poles[1]).then_some(Multiplicity::Continuum);
                    add(0.0, 0.0, side * z * radius, alone.or(zone));
                }
            }
        }
        Exact::Torus { major, minor, .. } => {
            for z in [0.0, 0.5, -2.0] {
                let horn = major == minor && z == 0.0;
                add(0.0, 0.0, z * minor, if horn { None } else { ring });
            }
            let turn = sweep_of(exact);
            for share in [0.0, 0.3, 0.5, 1.0] {
                // on the circle of the tube's centres; 0 and 90 degrees are exact
                let angle = turn.0 + share * (turn.1 - turn.0);
                add(major * angle.cos(), major * angle.sin(), 0.0, ring);
            }
            add(major, 0.0, 3.0 * minor, None);
            // beside the tube's centre, and on the tube circle's plane
            add(major + 0.5 * minor, 0.0, 0.0, None);
        }
        _ => {}
    }
    // in the half plane opposite the middle of the sweep both ends tie
    let turn = sweep_of(exact);
    if turn.1 - turn.0 < 6.0 {
        let angle = 0.5 * (turn.0 + turn.1) + PI;
        let (scale, levels, alone) = match *exact {
            Exact::Circle { radius, .. } => (radius, vec![0.0, 0.7 * radius], false),
            Exact::Cylinder { radius, height, .. } => (radius, vec![height.0, height.1, height.1 + radius], false),
            Exact::Cone { radii, height, .. } => {
                (radii.0.max(radii.1), vec![height.0, height.1], radii.0.min(radii.1) == 0.0)
            }
            Exact::Sphere { radius, latitude, .. } => {
                let pole = latitude.0 == -FRAC_PI_2 || latitude.1 == FRAC_PI_2;
                (radius, vec![0.0, 0.5 * radius], pole)
            }
            Exact::Torus { major, minor, .. } => (major, vec![0.0, minor], major == minor),
            _ => return probes,
        };
        for level in levels {
            for share in [0.3, 1.0, 4.0] {
                let point = axes.point(share * scale * angle.cos(), share * scale * angle.sin(), level);
                let multiplicity = (!alone).then_some(Multiplicity::Tied);
                probes.push(Probe { point, multiplicity });
            }
        }
    }
    probes
}

/// The angles about the axis, from the lower one.
fn sweep_of(exact: &Exact) -> (f64, f64) {
    match *exact {
        Exact::Circle { sweep, .. }
        | Exact::Ellipse { sweep, .. }
        | Exact::Cylinder { sweep, .. }
        | Exact::Cone { sweep, .. }
        | Exact::Sphere { sweep, .. }
        | Exact::Torus { sweep, .. } => (sweep.0.min(sweep.1), sweep.0.max(sweep.1)),
        _ => (0.0, TAU),
    }
}

/// Query points: `special` ones and beside them, on the surface and beside it, around and far away.
pub(crate) fn probes(special: &[Probe], shape: &Shape, count: usize, random: &mut Random) -> Vec<Probe> {
    let [low, high] = shape.bounds();
    let (middle, size) = (0.5 * (low + high), shape.size());
    let mut probes = special.to_vec();
    let anywhere = |point: DVec3| Probe { point, multiplicity: None };
    let beside = |point: DVec3, random: &mut Random| {
        let direction = random.pick(&[DVec3::X, -DVec3::Y, DVec3::Z, random.clone().direction()]);
        anywhere(point + size * random.power(-16.0, -6.0) * direction)
    };
    while probes.len() < count + special.len() {
        if !special.is_empty() {
            let probe = random.pick(special);
            probes.push(beside(probe.point, random));
        }
        // on it: at ends, middles and knots too
        let at = [0, 1].map(|k| {
            let [first, last] = shape.domain(k);
            match random.count(0, 5) {
                0 => first,
                1 => last,
                2 => 0.5 * (first + last),
                3 => random.pick(&shape.knots[k]),
                _ => random.between(first, last),
            }
        });
        let on = shape.point(at[0], at[1]);
        probes.extend([anywhere(on), beside(on, random)]);
        // off an edge or corner, in any direction
        probes.push(anywhere(on + size * random.power(-6.0, 0.5) * random.direction()));
        let other = [0, 1].map(|k| random.between(shape.domain(k)[0], shape.domain(k)[1]));
        probes.push(anywhere(0.5 * (on + shape.point(other[0], other[1]))));
        probes.push(anywhere(middle + 1.5 * size * random.in_cube()));
        probes.push(anywhere(middle + size * random.pick(&[10.0, 1e3, 1e6]) * random.direction()));
    }
    probes.truncate(count + special.len());
    probes
}
