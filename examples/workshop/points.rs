//! Points to be projected, as measured or as asked on purpose: near, beyond edges, far, and where many feet tie.

use std::fmt::Write;

use perpend::{DVec3, Definition, Direction, Entity, Kind, Model};

use super::random::Random;

/// The points of a scan per entity: within a scanner's noise of it, off it, beyond its edges, and far from it.
const NEAR: usize = 32;
const OFF: usize = 16;
const BEYOND: usize = 16;
const FAR: usize = 8;

/// About 2,000 points, each with the id of the entity that it is asked of: `entity,x,y,z`.
pub(crate) fn scan(model: &Model) -> String {
    let mut random = Random::new(2008);
    let mut text = String::from("entity,x,y,z\n");
    for entity in model.entities() {
        let size = entity.definition().size();
        let mut points: Vec<DVec3> = Vec::new();
        points.extend((0..NEAR).map(|_| beside(entity, 0.05, &mut random)));
        points.extend((0..OFF).map(|_| beside(entity, 0.25 * size, &mut random)));
        points.extend((0..BEYOND).map(|_| beyond(entity, 0.1 * size, &mut random)));
        points.extend((0..FAR).map(|_| beside(entity, 10.0 * size, &mut random)));
        points.extend(ties(entity));
        for point in points {
            write_row(&mut text, &format!("{},", entity.id()), point);
        }
    }
    text
}

/// 1,000 points for the whole model: `x,y,z`.
pub(crate) fn cloud(model: &Model) -> String {
    let mut random = Random::new(2006);
    let mut text = String::from("x,y,z\n");
    for _ in 0..600 {
        let entity = &model.entities()[random.index(model.len())];
        write_row(&mut text, "", beside(entity, 0.5, &mut random));
    }
    for reach in [model.size(), 20.0 * model.size()] {
        for _ in 0..200 {
            write_row(&mut text, "", reach * random.in_ball());
        }
    }
    text
}

/// A point at most `reach` from a point of the entity.
fn beside(entity: &Entity, reach: f64, random: &mut Random) -> DVec3 {
    let on = match entity.definition().as_ref() {
        Definition::NurbsCurve(curve) => {
            let (first, last) = curve.domain();
            curve.point(random.within(first, last))
        }
        Definition::NurbsSurface(surface) => {
            let [u, v] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
            surface.point(random.within(u.0, u.1), random.within(v.0, v.1))
        }
    };
    on + reach * random.in_ball()
}

/// A point near where the entity would go if it went on past an edge, straight, for at most `reach`.
fn beyond(entity: &Entity, reach: f64, random: &mut Random) -> DVec3 {
    let at_end = random.index(2) == 1;
    let (edge, along) = match entity.definition().as_ref() {
        Definition::NurbsCurve(curve) => {
            let (first, last) = curve.domain();
            let mut jet = [DVec3::ZERO; 2];
            curve.derivatives(if at_end { last } else { first }, &mut jet);
            (jet[0], jet[1])
        }
        Definition::NurbsSurface(surface) => {
            let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
            let mut jet = [DVec3::ZERO; 4]; // S, S_v, S_u, S_uv
            if random.index(2) == 0 {
                surface.derivatives(if at_end { u1 } else { u0 }, random.within(v0, v1), 1, &mut jet);
                (jet[0], jet[2])
            } else {
                surface.derivatives(random.within(u0, u1), if at_end { v1 } else { v0 }, 1, &mut jet);
                (jet[0], jet[1])
            }
        }
    };
    let outwards = if at_end { along } else { -along }.normalize_or_zero();
    edge + random.within(0.0, reach) * outwards + 0.05 * reach * random.in_ball()
}

/// Points to which many points of the entity are nearest, or two: centres, axes, the spine of a torus.
fn ties(entity: &Entity) -> Vec<DVec3> {
    let classification = entity.record().and_then(|record| record.classification.as_ref());
    let Some(kind) = classification.and_then(|classification| classification.kind.as_ref()) else { return Vec::new() };
    let on_axis = |origin: DVec3, axis: DVec3, heights: [f64; 4]| heights.map(|height| origin + height * axis).to_vec();
    match &kind.value {
        Kind::Circle { centre, axis, .. } => on_axis(*centre, *axis, [0.0, 5.0, -10.0, 1000.0]),
        Kind::Ellipse { centre, axis, .. } => on_axis(*centre, *axis, [0.0, 5.0, -10.0, 1000.0]),
        Kind::Cylinder { centre, axis, .. } => on_axis(*centre, *axis, [0.0, 25.0, 70.0, 300.0]),
        Kind::Cone { apex, axis, .. } => on_axis(*apex, *axis, [-10.0, 30.0, 60.0, 300.0]),
        Kind::Sphere { centre, .. } => vec![*centre],
        Kind::Torus { centre, axis, xdir, major_radius, .. } => {
            let mut points = on_axis(*centre, *axis, [0.0, 5.0, -10.0, 300.0]);
            let ydir = axis.cross(*xdir);
            points.extend([*xdir, ydir, -*xdir, -ydir].map(|direction| *centre + *major_radius * direction));
            points
        }
        Kind::Revolution { origin, axis, .. } => on_axis(*origin, *axis, [40.0, 80.0, 120.0, 300.0]),
        _ => Vec::new(),
    }
}

/// Rounded to 1e-6 mm: points on axes of the workshop stay on them, and the last bits of an evaluation do not show.
fn write_row(text: &mut String, entity: &str, point: DVec3) {
    let DVec3 { x, y, z } = (point * 1e6).round() / 1e6 + 0.0; // + 0.0: no negative zero
    writeln!(text, "{entity}{x},{y},{z}").expect("a string takes all that is written to it");
}

impl Random {
    /// One of `count` indices.
    fn index(&mut self, count: usize) -> usize {
        (self.within(0.0, count as f64) as usize).min(count - 1)
    }

    /// A point of the unit ball, evenly.
    fn in_ball(&mut self) -> DVec3 {
        loop {
            let p = DVec3::new(self.within(-1.0, 1.0), self.within(-1.0, 1.0), self.within(-1.0, 1.0));
            if p.length_squared() <= 1.0 {
                return p;
            }
        }
    }
}
