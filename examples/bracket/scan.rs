//! What a scanner saw of a bracket that was not made quite as it was drawn.

use std::fmt::Write as _;

use perpend::glam::DVec2;
use perpend::{DVec3, Definition, Direction, Entity, Model, NurbsSurface, Side};

use super::random::Random;

/// Points a mm².
const DENSITY: f64 = 0.14;

/// The scanner's noise: its standard deviation.
const NOISE: f64 = 0.006;

/// The seat was ground too high by this much, and the bore too wide.
const SEAT: f64 = 0.03;
const BORE: f64 = -0.02;

/// Something fell on the plate: where, how deep and how wide the dent is.
const DENT: (DVec3, f64, f64) = (DVec3::new(-2.0, -30.0, 12.0), -0.12, 7.0);

/// `x,y,z,made`: points on all that is seen from above, and by how much the surface is off where each was taken, noise included.
///
/// Rows stand face by face. Points beside an edge may be nearer to the face beyond it than to their own.
pub(crate) fn scan(model: &Model) -> String {
    let mut random = Random::new(2015);
    let mut text = String::from("x,y,z,made\n");
    for body in model.bodies() {
        for entity in body.faces().filter_map(|id| model.entity(id)).filter(|entity| entity.name() != "plate bottom") {
            of_face(entity, &mut random, &mut text);
        }
    }
    text
}

fn of_face(entity: &Entity, random: &mut Random, text: &mut String) {
    let (Definition::NurbsSurface(surface), Some(trimming)) = (entity.definition().as_ref(), entity.trimming()) else {
        return;
    };
    let [u, v] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
    let sign = if trimming.reversed() { -1.0 } else { 1.0 };
    for _ in 0..(DENSITY * area(surface, u, v)).round() as usize {
        let at = DVec2::new(random.within(u.0, u.1), random.within(v.0, v.1));
        if trimming.region().side(at) != Side::Inside {
            continue;
        }
        let on = surface.point(at.x, at.y);
        let made = rounded(off(entity.name(), on) + NOISE * normal(random));
        let outward = sign * surface.normal(at.x, at.y).normalize();
        let p = (on + made * outward).to_array().map(rounded);
        writeln!(text, "{},{},{},{made}", p[0], p[1], p[2]).expect("a string takes all that is written to it");
    }
}

/// By how much the bracket's surface is off, away from the material.
fn off(face: &str, at: DVec3) -> f64 {
    match face {
        "seat" => SEAT,
        "bore" => BORE,
        "plate top" => {
            let (centre, depth, width) = DENT;
            depth * (-(at - centre).length_squared() / (width * width)).exp()
        }
        _ => 0.0,
    }
}

/// The area of a whole surface, by the middles of a grid.
fn area(surface: &NurbsSurface, u: (f64, f64), v: (f64, f64)) -> f64 {
    const CELLS: usize = 24;
    let middle = |(from, to): (f64, f64), k: usize| from + (to - from) * (k as f64 + 0.5) / CELLS as f64;
    let mut jet = [DVec3::ZERO; 4]; // S, S_v, S_u, S_uv
    let mut sum = 0.0;
    for i in 0..CELLS {
        for j in 0..CELLS {
            surface.derivatives(middle(u, i), middle(v, j), 1, &mut jet);
            sum += jet[2].cross(jet[1]).length();
        }
    }
    sum * (u.1 - u.0) * (v.1 - v.0) / (CELLS * CELLS) as f64
}

/// Twelve numbers that are even over an interval of length 1: nearly normal, with a standard deviation of 1.
fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.within(-0.5, 0.5)).sum()
}

/// To 1e-6 mm, without a negative zero.
fn rounded(x: f64) -> f64 {
    (x * 1e6).round() / 1e6 + 0.0
}
