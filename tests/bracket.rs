//! The example part: exact on its edges, closed, and its scan measured as it was made.

#[path = "../examples/bracket/mod.rs"]
mod bracket;

use std::collections::BTreeMap;

use perpend::{BodySide, DVec3, Definition, EntityId, Model, NurbsCurve, QueryOptions};

/// The curve of an entity.
fn curve(model: &Model, id: EntityId) -> &NurbsCurve {
    match model.entity(id).map(|entity| entity.definition().as_ref()) {
        Some(Definition::NurbsCurve(curve)) => curve,
        other => panic!("an edge is a curve: {other:?}"),
    }
}

#[test]
fn every_edge_is_of_two_faces_and_lies_on_both() {
    let model = bracket::model().unwrap();
    let mut faces: BTreeMap<EntityId, Vec<EntityId>> = BTreeMap::new();
    for entity in model.entities() {
        for edge in entity.trimming().into_iter().flat_map(|trimming| trimming.edges()) {
            faces.entry(edge).or_default().push(entity.id());
        }
    }
    assert_eq!(faces.len(), 50);
    let mut farthest = 0.0_f64;
    for (edge, of) in &faces {
        assert_eq!(of.len(), 2, "edge {edge}");
        let curve = curve(&model, *edge);
        let (first, last) = curve.domain();
        for k in 0..=40 {
            let p = curve.point(first + (last - first) * f64::from(k) / 40.0);
            let away = of.iter().map(|face| model.project(*face, p).unwrap().distance);
            farthest = away.fold(farthest, f64::max);
        }
    }
    assert!(farthest < 1e-9, "{farthest}");
}

#[test]
fn the_body_is_closed_and_has_its_material_inside() {
    let model = bracket::model().unwrap();
    let body = model.bodies()[0].id();
    let known = [
        (DVec3::new(0.0, 0.0, 6.0), BodySide::Inside, -6.0),
        // on the axes of a bolt hole and of the bore, and between the boss and its bore
        (DVec3::new(-56.0, -26.0, 6.0), BodySide::Outside, 5.5),
        (DVec3::new(26.0, -4.0, 30.0), BodySide::Outside, 11.0),
        (DVec3::new(26.0, 11.5, 30.0), BodySide::Inside, -4.5),
        (DVec3::new(26.0, -4.0, -7.0), BodySide::Outside, 170.0_f64.sqrt()),
        (DVec3::new(73.0, 44.0, 6.0), BodySide::Outside, (17.0_f64 * 17.0 + 18.0 * 18.0).sqrt() - 14.0),
    ];
    for (p, side, distance) in known {
        let found = model.signed_distance(body, p, &QueryOptions::default()).unwrap();
        assert_eq!(found.side, side, "{p}");
        assert!((found.signed_distance - distance).abs() < 1e-9, "{p}: {} {distance}", found.signed_distance);
    }
}

#[test]
fn the_scan_deviates_as_it_was_made() {
    let model = bracket::model().unwrap();
    let body = model.bodies()[0].id();
    let scan = bracket::scan(&model);
    let rows: Vec<[f64; 4]> = scan
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>().try_into().unwrap())
        .collect();
    assert!(rows.len() > 3000, "{}", rows.len());
    let points: Vec<DVec3> = rows.iter().map(|[x, y, z, _]| DVec3::new(*x, *y, *z)).collect();
    let found = model.signed_distance_all(body, &points, &QueryOptions::default());
    let mut beside_edges = 0;
    for (row, found) in rows.iter().zip(found) {
        let found = found.unwrap();
        // three coordinates rounded to 1e-6 move a point by less than 1e-6
        if (found.signed_distance - row[3]).abs() > 1e-6 {
            // only where the face beyond an edge is nearer
            assert!(found.foot.distance < row[3].abs() + 1e-6, "{row:?} {found:?}");
            beside_edges += 1;
        }
    }
    assert!(beside_edges * 50 < rows.len(), "{beside_edges} of {}", rows.len());
}

#[test]
fn making_it_twice_gives_the_same_files() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    let made = ["bracket-1", "bracket-2"].map(|name| {
        let folder = folder.join(name);
        std::fs::create_dir_all(&folder).unwrap();
        let model = bracket::make(&folder).unwrap();
        assert_eq!(Model::read(folder.join("bracket.ron")).unwrap(), model);
        ["bracket.ron", "bracket.csv"].map(|file| std::fs::read(folder.join(file)).unwrap())
    });
    assert_eq!(made[0], made[1]);
}
