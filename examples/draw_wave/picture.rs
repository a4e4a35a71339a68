//! The pictures.

use std::error::Error;
use std::sync::Arc;

use perpend::projection::Steps;
use perpend::{Aabb, DVec3, Definition, Direction, Model, NurbsSurface, Query, QueryOptions, Wave, WaveSettings};

use super::svg::{Camera, Drawing, Panel};

const BOX: &str = r##"fill="none" stroke="#999" stroke-width="0.7""##;
const CURVE: &str = r##"fill="none" stroke="#1f4e8c" stroke-width="2""##;
const CANDIDATE: &str = r##"fill="none" stroke="#d1451b" stroke-width="3.5""##;
const CROSS: &str = r#"class="point""#;
const POINT: &str = r##"class="point" fill="#d1451b""##;
const SAMPLE: &str = r##"fill="#1b1b1b""##;
const QUERY: &str = r##"fill="#1b1b1b""##;
const WAY: &str = r##"fill="none" stroke="#2e7d4f" stroke-width="1.3""##;
const REGISTERED: [&str; 3] = [
    r##"fill="#bcd3ee" fill-opacity="0.55" stroke="#5d86b8" stroke-width="0.5""##,
    r##"fill="#a9c6e8" fill-opacity="0.55" stroke="#5d86b8" stroke-width="0.5""##,
    r##"fill="#d6e4f5" fill-opacity="0.55" stroke="#5d86b8" stroke-width="0.5""##,
];
const VISITED: [&str; 3] = [r##"fill="none" stroke="#c9a227" stroke-width="0.35" stroke-opacity="0.55""##; 3];
const HIT: [&str; 3] = [
    r##"fill="#f2d27a" fill-opacity="0.5" stroke="#b08a1e" stroke-width="0.5""##,
    r##"fill="#e8c35e" fill-opacity="0.5" stroke="#b08a1e" stroke-width="0.5""##,
    r##"fill="#f8e3a6" fill-opacity="0.5" stroke="#b08a1e" stroke-width="0.5""##,
];

/// All pictures with their file names.
pub(crate) fn all(model: &Model) -> Result<[(&'static str, String); 3], Box<dyn Error>> {
    let definition = |name: &str| {
        let entity = model.named(name).next().ok_or_else(|| format!("the workshop has no {name}"))?;
        Ok::<Arc<Definition>, Box<dyn Error>>(Arc::clone(entity.definition()))
    };
    let coil = definition("coil")?;
    Ok([
        ("wave-surfaces.svg", surfaces(&definition("dust pan")?, &definition("brush handle")?)),
        ("wave-cells.svg", cells(&coil)),
        ("wave-search.svg", search(&coil)?),
    ])
}

/// Decomposition points of the dust pan and the brush handle: crosses, as in Fig. 4.
fn surfaces(pan: &Arc<Definition>, handle: &Arc<Definition>) -> String {
    let mut drawing = Drawing::new(420.0);
    let views = [
        (pan, Camera::new(-125.0, 38.0), "dust pan, decomposed at 5 %"),
        (handle, Camera::new(-62.0, 24.0), "brush handle, decomposed at 5 %"),
    ];
    for (definition, camera, caption) in views {
        let Definition::NurbsSurface(surface) = &**definition else { continue };
        let steps = Steps::of(0.05);
        let wave = Wave::new(Arc::clone(definition), WaveSettings { decomposition: [steps; 2], sampling: steps });
        let panel = drawing.panel(camera, wave.points().into_iter(), 620.0, caption);
        skin(&mut drawing, panel, surface, wave.parameters(Direction::U), wave.parameters(Direction::V));
    }
    drawing.finish()
}

/// How many quadrilaterals a patch is painted with along each side.
const FINE: usize = 3;

/// Paints a surface patch by patch from back to front, with a cross at every point of the decomposition: what lies behind is painted over.
fn skin(drawing: &mut Drawing, panel: Panel, surface: &NurbsSurface, u: &[f64], v: &[f64]) {
    let camera = panel.camera();
    let mut patches: Vec<(f64, usize, usize)> = Vec::new();
    for i in 0..u.len() - 1 {
        for j in 0..v.len() - 1 {
            let middle = surface.point(0.5 * (u[i] + u[i + 1]), 0.5 * (v[j] + v[j + 1]));
            patches.push((camera.depth(middle), i, j));
        }
    }
    patches.sort_by(|a, b| a.0.total_cmp(&b.0));
    let between = |ends: &[f64], k: usize| ends[0] + (ends[1] - ends[0]) * k as f64 / FINE as f64;
    for (_, i, j) in patches {
        let at = |k: usize, l: usize| surface.point(between(&u[i..], k), between(&v[j..], l));
        for (k, l) in (0..FINE).flat_map(|k| (0..FINE).map(move |l| (k, l))) {
            let corners = [at(k, l), at(k + 1, l), at(k + 1, l + 1), at(k, l + 1)];
            let light = camera.light((corners[2] - corners[0]).cross(corners[3] - corners[1]));
            let grey = (168.0 + 82.0 * light) as u8;
            let fill = format!(r##"fill="#{grey:02x}{grey:02x}{grey:02x}" stroke="#{grey:02x}{grey:02x}{grey:02x}""##);
            drawing.polygon(panel, &corners, &fill);
        }
        let rim: Vec<DVec3> = (0..=FINE)
            .map(|k| at(k, 0))
            .chain((1..=FINE).map(|l| at(FINE, l)))
            .chain((0..FINE).rev().map(|k| at(k, FINE)))
            .chain((0..FINE).rev().map(|l| at(0, l)))
            .collect();
        drawing.line(panel, &rim, r#"class="rim""#);
        for p in [at(0, 0), at(FINE, 0), at(0, FINE), at(FINE, FINE)] {
            drawing.cross(panel, p, 2.0, CROSS);
        }
    }
}

/// A curve in its box with the points of its decomposition, and the cells with which its segments are registered, as in Fig. 5.
fn cells(curve: &Arc<Definition>) -> String {
    let wave = Wave::new(Arc::clone(curve), WaveSettings::recommended(curve));
    let camera = Camera::new(-52.0, 24.0);
    let mut drawing = Drawing::new(440.0);
    let whole = whole(&wave);
    let panel =
        drawing.panel(camera, corners(whole).into_iter(), 480.0, "points at 5 % of the arc length, jitter 80 %");
    frame(&mut drawing, panel, whole);
    drawing.line(panel, &along(curve, &wave, None), CURVE);
    for p in wave.points() {
        drawing.dot(panel, p, 3.4, POINT);
    }
    let occupied: Vec<[usize; 3]> = every(&wave).filter(|cell| !wave.registered(*cell).is_empty()).collect();
    let [x, y, z] = wave.cell_counts();
    let caption = format!("{} of {x} × {y} × {z} cells hold a segment", occupied.len());
    let panel = drawing.panel(camera, corners(whole).into_iter(), 480.0, &caption);
    frame(&mut drawing, panel, whole);
    cubes(&mut drawing, panel, &wave, &occupied, |_| &REGISTERED);
    drawing.line(panel, &along(curve, &wave, None), CURVE);
    drawing.finish()
}

/// The feet of the corners of the box, and how far the wave of one of them comes, as in Fig. 6.
fn search(curve: &Arc<Definition>) -> Result<String, Box<dyn Error>> {
    let wave = Wave::new(Arc::clone(curve), WaveSettings::recommended(curve));
    let camera = Camera::new(-52.0, 24.0);
    let mut drawing = Drawing::new(440.0);
    let whole = whole(&wave);
    let panel =
        drawing.panel(camera, corners(whole).into_iter(), 480.0, "the nearest points of the corners of the box");
    frame(&mut drawing, panel, whole);
    drawing.line(panel, &along(curve, &wave, None), CURVE);
    for corner in corners(whole) {
        let trace = wave.trace(&Query::new(corner, QueryOptions::default())?);
        drawing.line(panel, &[corner, trace.point], WAY);
        drawing.dot(panel, corner, 3.0, QUERY);
        drawing.dot(panel, trace.point, 2.6, POINT);
    }
    let query = corners(whole)[7];
    let trace = wave.trace(&Query::new(query, QueryOptions::default())?);
    let caption = format!("one wave: {} cells visited, {} segments sampled", trace.cells.len(), trace.segments.len());
    let panel = drawing.panel(camera, corners(whole).into_iter(), 480.0, &caption);
    frame(&mut drawing, panel, whole);
    let is_hit = |cell: &[usize; 3]| !wave.registered(*cell).is_empty();
    cubes(&mut drawing, panel, &wave, &trace.cells, |cell| if is_hit(&cell) { &HIT } else { &VISITED });
    drawing.line(panel, &along(curve, &wave, None), CURVE);
    for segment in &trace.segments {
        drawing.line(panel, &along(curve, &wave, Some(*segment)), CANDIDATE);
        for sample in wave.samples(*segment).iter().step_by(8) {
            drawing.dot(panel, *sample, 1.1, SAMPLE);
        }
    }
    drawing.line(panel, &[query, trace.point], WAY);
    drawing.dot(panel, query, 3.4, QUERY);
    drawing.dot(panel, trace.point, 3.0, POINT);
    Ok(drawing.finish())
}

/// The box of all cells.
fn whole(wave: &Wave) -> Aabb {
    let last = wave.cell_counts().map(|n| n - 1);
    wave.cell_box([0; 3]).join(wave.cell_box(last))
}

fn every(wave: &Wave) -> impl Iterator<Item = [usize; 3]> {
    let [nx, ny, nz] = wave.cell_counts();
    (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])))
}

/// A segment of a curve as a fine line, or all of it.
fn along(curve: &Definition, wave: &Wave, segment: Option<usize>) -> Vec<DVec3> {
    let Definition::NurbsCurve(curve) = curve else { return Vec::new() };
    let u = wave.parameters(Direction::U);
    let (first, last) = segment.map_or((u[0], u[u.len() - 1]), |k| (u[k], u[k + 1]));
    let count = if segment.is_some() { 16 } else { 400 };
    (0..=count).map(|k| curve.point(first + (last - first) * f64::from(k) / f64::from(count))).collect()
}

/// The corners of a box; bit 0 of the index is x, bit 1 is y, bit 2 is z.
fn corners(bounds: Aabb) -> [DVec3; 8] {
    [0, 1, 2, 3, 4, 5, 6, 7].map(|k| {
        let pick = |bit: usize, low: f64, high: f64| if k >> bit & 1 == 0 { low } else { high };
        DVec3::new(
            pick(0, bounds.min.x, bounds.max.x),
            pick(1, bounds.min.y, bounds.max.y),
            pick(2, bounds.min.z, bounds.max.z),
        )
    })
}

/// The edges of a box.
fn frame(drawing: &mut Drawing, panel: Panel, bounds: Aabb) {
    let corners = corners(bounds);
    for from in 0..8_usize {
        for bit in [1, 2, 4].into_iter().filter(|bit| from & bit == 0) {
            drawing.line(panel, &[corners[from], corners[from | bit]], BOX);
        }
    }
}

/// Paints cells from back to front: of each the three faces that can be seen, across x, y and z.
fn cubes(
    drawing: &mut Drawing,
    panel: Panel,
    wave: &Wave,
    cells: &[[usize; 3]],
    style: impl Fn([usize; 3]) -> &'static [&'static str; 3],
) {
    let camera = panel.camera();
    let mut sorted: Vec<([usize; 3], Aabb)> = cells.iter().map(|cell| (*cell, wave.cell_box(*cell))).collect();
    sorted.sort_by(|a, b| camera.depth(a.1.centre()).total_cmp(&camera.depth(b.1.centre())));
    for (cell, bounds) in sorted {
        let corners = corners(bounds);
        for axis in 0..3 {
            let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
            let side = 1 << axis;
            let face = |from: usize| [from, from | a, from | a | b, from | b].map(|k| corners[k]);
            let is_seen = |face: &[DVec3; 4]| camera.depth(face[0] + face[2]) > 2.0 * camera.depth(bounds.centre());
            for face in [face(0), face(side)].iter().filter(|face| is_seen(face)) {
                drawing.polygon(panel, face, style(cell)[axis]);
            }
        }
    }
}
