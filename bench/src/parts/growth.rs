//! How the cost of a query grows with the number of faces: a block of faces, patterned in space.

use glam::{DAffine3, DVec3};
use perpend::{Aabb, Carrier, Definition, Model, NurbsSurface, QueryOptions, TrimmedSurface, TrimmingData};
use perpend_bench::Failure;

use crate::Run;
use crate::plate::plates;
use crate::real::RealPart;
use crate::table::{Goal, Table};
use crate::timing::least_seconds;
use crate::whole::times;

/// Faces of a block.
const BLOCK: usize = 50;

/// How many copies each model has.
const COPIES: [usize; 4] = [1, 4, 20, 100];

/// How many points are asked of every copy, one copy after the other.
const POINTS: usize = 500;

/// How many points are asked of another copy each time.
const SCATTERED: usize = 2000;

/// How far from the surface points lie at most, as a share of the block's size.
const NEAR: f64 = 0.01;

/// The middles of copies are this many sizes of the block apart.
const STEP: f64 = 1.25;

/// Faces with points near them.
pub(crate) struct Block {
    pub name: String,
    pub faces: Vec<(NurbsSurface, TrimmingData)>,
    pub points: Vec<DVec3>,
}

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    let real = run.parts.iter().find(|part| part.name == "nist-ftc-06");
    let blocks = real.map(block).transpose()?.into_iter().chain([plates(BLOCK)?]);
    for block in blocks {
        table.heading(format!("points within {NEAR} of the size of {}, {POINTS} a copy", block.name));
        let models: Vec<(Model, [Vec<DVec3>; 2])> =
            COPIES.iter().map(|copies| patterned(&block, *copies)).collect::<Result<_, _>>()?;
        for (of, order) in ["one copy after the other", "another copy each time"].into_iter().enumerate() {
            let mut least = Vec::new();
            for (model, points) in &models {
                let faces = model.len();
                let found = times(model, &points[of], run.passes, &mut |what, faults| {
                    table.faults(format!("{faces} faces, {what}"), faults);
                })?;
                table.line(format!("{faces} faces, {order}"), Goal::None, "us", found.whole);
                table.line("  the nearest face alone", Goal::None, "us", found.alone);
                least.push(found.whole);
            }
            if let [first, .., last] = least.as_slice() {
                let what = format!("{} faces against {BLOCK}, {order}", BLOCK * COPIES[COPIES.len() - 1]);
                table.line(what, Goal::AtMost(2.0), "x", last / first);
            }
        }
        first_query(&block, table)?;
    }
    Ok(())
}

/// The first query to the largest model: every face is made ready.
fn first_query(block: &Block, table: &mut Table) -> Result<(), Failure> {
    let (model, points) = patterned(block, COPIES[COPIES.len() - 1])?;
    let [first] = least_seconds(
        1,
        [&mut || {
            let _ = std::hint::black_box(model.nearest(points[0][0], &QueryOptions::default()));
        }],
    );
    table.line(format!("the first query to {} faces", model.len()), Goal::None, "ms", first * 1e3);
    Ok(())
}

/// The first faces of a part, with points near them.
fn block(part: &RealPart) -> Result<Block, Failure> {
    let mut faces = Vec::new();
    for entity in part.model.entities() {
        if let (Some(trimming), Definition::NurbsSurface(surface)) = (entity.trimming(), entity.definition().as_ref()) {
            let mut data = trimming.data();
            // the copies have no edges
            data.loops.iter_mut().flat_map(|one| &mut one.curves).for_each(|curve| curve.edge = None);
            faces.push((surface.clone(), data));
        }
        if faces.len() == BLOCK {
            break;
        }
    }
    let name = format!("{} faces of {}", faces.len(), part.name);
    let mut block = Block { name, faces, points: Vec::new() };
    let (model, _) = patterned(&block, 1)?;
    let near = QueryOptions { max_distance: Some(NEAR * model.size()), ..QueryOptions::default() };
    let found = model.nearest_all(&part.points, &near);
    block.points =
        part.points.iter().zip(found).filter(|(_, found)| matches!(found, Ok(Some(_)))).map(|(p, _)| *p).collect();
    Ok(block)
}

/// Copies of a block in a cube of them, and points about these in two orders: one copy after the other, and another copy each time.
fn patterned(block: &Block, copies: usize) -> Result<(Model, [Vec<DVec3>; 2]), Failure> {
    let boxes = block.faces.iter().map(|(surface, _)| surface.control_box());
    let step = STEP * boxes.fold(Aabb::EMPTY, Aabb::join).diagonal();
    let side = (1..).find(|side: &usize| side.pow(3) >= copies).unwrap_or(1);
    let place = |copy: usize| {
        let at = [copy % side, copy / side % side, copy / (side * side)];
        step * DVec3::from_array(at.map(|k| k as f64))
    };
    let mut model = Model::new();
    for copy in 0..copies {
        let map = DAffine3::from_translation(place(copy));
        for (surface, trimming) in &block.faces {
            let surface = Carrier::Own(surface.transformed(&map)?);
            model.insert_trimmed("copy", TrimmedSurface { surface, trimming: trimming.clone() })?;
        }
    }
    let asked = |k: usize, copy: usize| Some(*block.points.get(k % block.points.len().max(1))? + place(copy));
    let scan = (0..copies * POINTS).filter_map(|k| asked(k % POINTS, k / POINTS)).collect();
    // each copy is asked a few times, and never twice in a row; 37 is prime to the numbers of copies
    let scattered = (0..SCATTERED).filter_map(|k| asked(k, k * 37 % copies)).collect();
    Ok((model, [scan, scattered]))
}
