//! The bracket: a plate with two bolt holes, a boss with a bore and a fillet at its foot, and a block with a free-form seat.
//!
//! Every edge is exact on both of its faces, but for rounding: circles where cylinders, the fillet and flat faces meet, and the sides of
//! the seat, whose control points lie in the planes of the block's faces.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use perpend::{Cylinder, DVec3, Frame, Model, NurbsSurface, Torus};

use super::Outcome;
use super::builder::{Along, Builder, Edge, boundary};

/// Half the plate's length and width, its height, and the radius of its corners.
const LENGTH: f64 = 70.0;
const WIDTH: f64 = 40.0;
const HEIGHT: f64 = 12.0;
const CORNER: f64 = 14.0;

/// Where the bolt holes are: about the axes of two corners.
const HOLES: [(f64, f64); 2] = [(-56.0, -26.0), (56.0, 26.0)];
const HOLE: f64 = 5.5;

/// The boss: its axis, its radius, that of its bore, that of its fillet, and its height.
const BOSS: (f64, f64) = (26.0, -4.0);
const RADIUS: f64 = 20.0;
const BORE: f64 = 11.0;
const FILLET: f64 = 6.0;
const TOP: f64 = 46.0;

/// From where to where the block stands, in x and in y.
const BLOCK: [(f64, f64); 2] = [(-46.0, -12.0), (-28.0, 28.0)];

/// The model: one closed body.
pub(crate) fn model() -> Outcome<Model> {
    let mut builder = Builder::default();
    let plate = plate(&mut builder)?;
    let holes = holes(&mut builder)?;
    let boss = boss(&mut builder)?;
    let block = block(&mut builder)?;

    let mut above: Vec<Vec<Along<'_>>> = vec![plate.top.iter().map(|edge| (edge, true)).collect()];
    above.push(block.iter().rev().map(|edge| (edge, false)).collect());
    above.extend(holes.iter().map(|[_, top]| vec![(top, false)]));
    above.push(vec![(&boss.foot, false)]);
    builder.flat("plate top", Frame { centre: DVec3::new(0.0, 0.0, HEIGHT), ..Frame::WORLD }, &above)?;

    let mut below: Vec<Vec<Along<'_>>> = vec![plate.bottom.iter().rev().map(|edge| (edge, false)).collect()];
    below.extend(holes.iter().map(|[bottom, _]| vec![(bottom, true)]));
    below.push(vec![(&boss.bore, true)]);
    builder.flat("plate bottom", Frame { axis: DVec3::NEG_Z, ..Frame::WORLD }, &below)?;
    builder.finish("bracket")
}

/// The edges of the plate's outline, counter-clockwise seen from above: a straight one and an arc, four times.
struct Outline {
    bottom: Vec<Edge>,
    top: Vec<Edge>,
}

/// The plate's sides and corners.
fn plate(builder: &mut Builder) -> Outcome<Outline> {
    let (l, w) = (LENGTH - CORNER, WIDTH - CORNER);
    let centres = [(l, -w), (l, w), (-l, w), (-l, -w)];
    // from the corner before it to the corner after it
    let straight = [
        [(-l, -WIDTH), (l, -WIDTH)],
        [(LENGTH, -w), (LENGTH, w)],
        [(l, WIDTH), (-l, WIDTH)],
        [(-LENGTH, w), (-LENGTH, -w)],
    ];
    let at = |(x, y): (f64, f64), z: f64| DVec3::new(x, y, z);
    let sweep = |k: usize| (FRAC_PI_2 * (k as f64 - 1.0), FRAC_PI_2 * k as f64);
    let mut outline = |z: f64, name: &str| -> Outcome<Vec<Edge>> {
        let mut edges = Vec::new();
        for k in 0..4 {
            let [from, to] = straight[k];
            edges.push(builder.line(&format!("{name} {}", k + 1), at(from, z), at(to, z))?);
            edges.push(builder.arc(&format!("{name} arc {}", k + 1), at(centres[k], z), CORNER, sweep(k))?);
        }
        Ok(edges)
    };
    let (bottom, top) = (outline(0.0, "plate bottom edge")?, outline(HEIGHT, "plate top edge")?);
    let mut upright = Vec::new();
    for (k, place) in straight.into_iter().flatten().enumerate() {
        upright.push(builder.line(&format!("plate upright {}", k + 1), at(place, 0.0), at(place, HEIGHT))?);
    }
    for k in 0..4 {
        let [from, to] = straight[k];
        let side = wall(at(from, 0.0), at(to, 0.0));
        let around =
            [(&bottom[2 * k], true), (&upright[2 * k + 1], true), (&top[2 * k], false), (&upright[2 * k], false)];
        builder.flat(&format!("plate side {}", k + 1), side, &[around.to_vec()])?;
        let frame = Frame { centre: at(centres[k], 0.0), ..Frame::WORLD };
        let corner = Cylinder::new(frame, CORNER, (0.0, HEIGHT), sweep(k))?.to_nurbs()?;
        let edges = [&upright[2 * k + 1], &top[2 * k + 1], &upright[(2 * k + 2) % 8], &bottom[2 * k + 1]];
        builder.whole(&format!("plate corner {}", k + 1), corner, true, edges)?;
    }
    Ok(Outline { bottom, top })
}

/// The frame of an upright face over a way along which the material is at the left.
fn wall(from: DVec3, to: DVec3) -> Frame {
    let along = (to - from).normalize();
    Frame { centre: from, axis: along.cross(DVec3::Z), xdir: along }
}

/// The bolt holes; their edges below and above.
fn holes(builder: &mut Builder) -> Outcome<[[Edge; 2]; 2]> {
    let mut hole = |k: usize| {
        let name = format!("bolt hole {}", k + 1);
        let (x, y) = HOLES[k];
        turned(builder, &name, DVec3::new(x, y, 0.0), HOLE, (0.0, HEIGHT), None, None, false)
    };
    Ok([hole(0)?, hole(1)?])
}

/// A whole turn of a cylinder as a face; its edges below and above, of which some may be there already.
#[allow(clippy::too_many_arguments, reason = "a cylinder, its edges and its side")]
fn turned(
    builder: &mut Builder,
    name: &str,
    foot: DVec3,
    radius: f64,
    height: (f64, f64),
    below: Option<Edge>,
    above: Option<Edge>,
    reversed: bool,
) -> Outcome<[Edge; 2]> {
    let at = |z: f64| foot + z * DVec3::Z;
    let mut circle = |known: Option<Edge>, z: f64, what: &str| match known {
        Some(edge) => Ok(edge),
        None => builder.arc(&format!("{name} {what}"), at(z), radius, (0.0, TAU)),
    };
    let (below, above) = (circle(below, height.0, "below")?, circle(above, height.1, "above")?);
    let start = foot + radius * DVec3::X;
    let seam = builder.line(&format!("{name} seam"), start + height.0 * DVec3::Z, start + height.1 * DVec3::Z)?;
    let surface = Cylinder::new(Frame { centre: foot, ..Frame::WORLD }, radius, height, (0.0, TAU))?.to_nurbs()?;
    builder.whole(name, surface, reversed, [&seam, &above, &seam, &below])?;
    Ok([below, above])
}

/// Where the boss meets the plate: the foot of its fillet on the top, and its bore in the bottom.
struct Boss {
    foot: Edge,
    bore: Edge,
}

/// The boss.
fn boss(builder: &mut Builder) -> Outcome<Boss> {
    let on_axis = DVec3::new(BOSS.0, BOSS.1, 0.0);
    let [bore, mouth] = turned(builder, "bore", on_axis, BORE, (0.0, TOP), None, None, false)?;
    let [neck, rim] = turned(builder, "boss", on_axis, RADIUS, (HEIGHT + FILLET, TOP), None, None, true)?;
    let top = Frame { centre: on_axis + TOP * DVec3::Z, ..Frame::WORLD };
    builder.flat("boss top", top, &[vec![(&rim, true)], vec![(&mouth, false)]])?;

    let foot = builder.arc("fillet foot", on_axis + HEIGHT * DVec3::Z, RADIUS + FILLET, (0.0, TAU))?;
    let spine = Frame { centre: on_axis + (HEIGHT + FILLET) * DVec3::Z, ..Frame::WORLD };
    let fillet = Torus::new(spine, RADIUS + FILLET, FILLET, (PI, 1.5 * PI), (0.0, TAU))?.to_nurbs()?;
    let [_, _, seam, _] = boundary(&fillet)?;
    let seam = builder.edge("fillet seam", seam)?;
    builder.whole("fillet", fillet, false, [&seam, &foot, &seam, &neck])?;
    Ok(Boss { foot, bore })
}

/// The block with the seat on it; the edges of its foot, counter-clockwise seen from above.
fn block(builder: &mut Builder) -> Outcome<Vec<Edge>> {
    let seat = seat()?;
    let [u0, u1, v0, v1] = boundary(&seat)?;
    let rims = [v0, u1, v1.reversed(), u0.reversed()];
    let [(x0, x1), (y0, y1)] = BLOCK;
    let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| DVec3::new(x, y, HEIGHT));
    let (mut feet, mut tops, mut upright) = (Vec::new(), Vec::new(), Vec::new());
    for (k, rim) in rims.into_iter().enumerate() {
        feet.push(builder.line(&format!("block foot {}", k + 1), corners[k], corners[(k + 1) % 4])?);
        upright.push(builder.line(&format!("block upright {}", k + 1), corners[k], rim.control_points()[0])?);
        tops.push(builder.edge(&format!("seat rim {}", k + 1), rim)?);
    }
    for k in 0..4 {
        let next = (k + 1) % 4;
        let around = [(&feet[k], true), (&upright[next], true), (&tops[k], false), (&upright[k], false)];
        let frame = wall(corners[k], corners[next]);
        builder.flat(&format!("block side {}", k + 1), frame, &[around.to_vec()])?;
    }
    builder.whole("seat", seat, false, [&tops[0], &tops[1], &tops[2], &tops[3]])?;
    Ok(feet)
}

/// The seat: a bicubic surface over the block, hollow along y, which rises and falls along it.
fn seat() -> Outcome<NurbsSurface> {
    const COUNT: usize = 8;
    let mut knots = vec![0.0; 4];
    knots.extend((1..COUNT - 3).map(|k| k as f64 / (COUNT - 3) as f64));
    knots.extend([1.0; 4]);
    // where the control points of a straight line lie
    let share = |k: usize| knots[k + 1..k + 4].iter().sum::<f64>() / 3.0;
    let [x, y] = BLOCK.map(|(from, to)| move |share: f64| from + share * (to - from));
    let point = |i: usize, j: usize| {
        let (u, v) = (share(i), share(j));
        let height = 30.0 + 20.0 * (u - 0.5).powi(2) + 3.5 * (TAU * v + 0.8).cos() - 6.0 * (u - 0.5) * (v - 0.5);
        // short in the file, and the same where cosines differ in the last bit
        DVec3::new(x(u), y(v), (height * 1e4).round() / 1e4)
    };
    let points = (0..COUNT).map(|i| (0..COUNT).map(|j| point(i, j)).collect()).collect();
    Ok(NurbsSurface::new((3, 3), (knots.clone(), knots.clone()), points, None)?)
}
