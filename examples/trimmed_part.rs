//! A plate with a hole, and a closed box: nearest points that respect the trim, and a distance with a sign.
//! `cargo run --example trimmed_part`.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

use std::error::Error;

use perpend::glam::DVec2;
use perpend::{
    Carrier, DVec3, EntityId, Model, NurbsSurface, QueryOptions, Shell, SurfaceData, TrimCurveData, TrimLoopData,
    TrimmedSurface, TrimmingData,
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut model = Model::new();

    // A plate of 80 by 50 mm with a hole of 20 mm in its middle. Its carrier is larger than it: what the loops bound counts.
    let sheet = plane(DVec3::ZERO, DVec3::X, DVec3::Y, DVec2::new(100.0, 100.0))?;
    let loops = vec![rectangle(DVec2::new(80.0, 50.0)), circle(DVec2::new(40.0, 25.0), 10.0)];
    let trimming = TrimmingData { reversed: false, tolerance: 1e-6, loops };
    let plate = model.insert_trimmed("plate", TrimmedSurface { surface: Carrier::Own(sheet), trimming })?;

    let over_the_hole = model.project(plate, DVec3::new(40.0, 25.0, 24.0))?;
    println!("over the hole: {:.6} mm to the rim, {:?}", over_the_hole.distance, over_the_hole.place);
    let over_the_plate = model.project(plate, DVec3::new(20.0, 25.0, 24.0))?;
    println!("over the plate: {:.6} mm, {:?}", over_the_plate.distance, over_the_plate.place);

    // A closed box of 30 mm beside it: a body of six faces, whose normals point outward.
    let faces = cube(&mut model, DVec3::new(100.0, 0.0, 0.0), 30.0)?;
    let body = model.insert_body("block", vec![Shell { faces, closed: true }])?;
    let options = QueryOptions::default();
    for p in [DVec3::new(115.0, 15.0, 40.0), DVec3::new(115.0, 15.0, 22.0), DVec3::new(135.0, 35.0, 35.0)] {
        let found = model.signed_distance(body, p, &options)?;
        println!("{p}: {:+.6} mm, {:?}, nearest is face {}", found.signed_distance, found.side, found.face);
    }

    // Both at once: the three faces nearest to a point between them.
    for (id, foot) in model.nearest_k(DVec3::new(90.0, 25.0, 5.0), 3, &options)? {
        println!("face {id} at {:.6} mm", foot.distance);
    }
    Ok(())
}

/// A plane over `(0, 0)` to `extent`, in its own lengths.
fn plane(origin: DVec3, x: DVec3, y: DVec3, extent: DVec2) -> Result<NurbsSurface, Box<dyn Error>> {
    let at = |u: f64, v: f64| origin + u * x + v * y;
    let data = SurfaceData {
        degree: (1, 1),
        knots: (vec![0.0, 0.0, extent.x, extent.x], vec![0.0, 0.0, extent.y, extent.y]),
        control_points: vec![vec![at(0.0, 0.0), at(0.0, extent.y)], vec![at(extent.x, 0.0), at(extent.x, extent.y)]],
        weights: None,
    };
    Ok(NurbsSurface::enter(data)?.0)
}

/// The rectangle from `(0, 0)` to a corner, as one p-curve of four sides.
fn rectangle(corner: DVec2) -> TrimLoopData {
    let points = [(0.0, 0.0), (corner.x, 0.0), (corner.x, corner.y), (0.0, corner.y), (0.0, 0.0)].map(DVec2::from);
    let knots = vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0];
    let side = TrimCurveData { degree: 1, knots, points: points.to_vec(), weights: None, edge: None };
    TrimLoopData { outer: true, curves: vec![side] }
}

/// A hole: a whole circle, exact, as one rational p-curve, clockwise.
fn circle(centre: DVec2, radius: f64) -> TrimLoopData {
    let corners = [(1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0)];
    let points = corners.map(|(x, y)| centre + radius * DVec2::new(f64::from(x), f64::from(y))).to_vec();
    let weights = (0..9).map(|k| if k % 2 == 1 { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 }).collect();
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let curve = TrimCurveData { degree: 2, knots, points, weights: Some(weights), edge: None };
    TrimLoopData { outer: false, curves: vec![curve] }
}

/// The six faces of a cube. Three of them look along their carriers' normals, the others are reversed.
fn cube(model: &mut Model, at: DVec3, size: f64) -> Result<Vec<EntityId>, Box<dyn Error>> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        let (x, y) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
        for far in [true, false] {
            let origin = if far { at + size * DVec3::AXES[axis] } else { at };
            let surface = Carrier::Own(plane(origin, x, y, DVec2::splat(2.0 * size))?);
            let loops = vec![rectangle(DVec2::splat(size))];
            let trimming = TrimmingData { reversed: !far, tolerance: 1e-6, loops };
            faces.push(model.insert_trimmed("side", TrimmedSurface { surface, trimming })?);
        }
    }
    Ok(faces)
}
