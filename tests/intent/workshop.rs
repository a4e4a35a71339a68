//! The workshop's entities say how they were made, and can be made again.

use perpend::{DVec3, Model, Operation};

use super::record;

#[test]
fn every_entity_of_the_workshop_replays_without_drift() {
    let model = Model::read(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/workshop.ron")).expect("the workshop");
    for entity in model.entities() {
        let replay = model.replay(entity.id()).expect("it says how it was made");
        // made on another machine, whose sines may differ in the last bit
        let rounding = 64.0 * f64::EPSILON * entity.definition().reach();
        assert!(
            replay.drift.proven <= rounding && replay.drift.is_same_structure(),
            "{}: {:?}",
            entity.name(),
            replay.drift
        );
        assert!(!replay.is_overridden, "{}", entity.name());
    }
}

#[test]
fn the_vase_follows_its_profile() {
    let mut model = Model::read(concat!(env!("CARGO_MANIFEST_DIR"), "/examples/workshop.ron")).expect("the workshop");
    let id = |name: &str| model.named(name).next().expect("it is there").id();
    let (profile, vase) = (id("vase profile"), id("vase"));
    let Operation::Interpolation { degree, points, columns, spacing } =
        record(&model, profile).intent[0].operation.clone()
    else {
        panic!("the profile passes points")
    };
    let points = points.into_iter().map(|p| if p.z > 30.0 && p.z < 50.0 { p + 10.0 * DVec3::X } else { p }).collect();
    let wider = Operation::Interpolation { degree, points, columns, spacing };
    let beside = DVec3::new(140.0, 40.0, 39.0);
    let before = model.project(vase, beside).expect("a valid query").distance;
    assert_eq!(model.edit(profile, wider), Ok(vec![profile, vase]));
    let after = model.project(vase, beside).expect("a valid query").distance;
    assert!((before - after - 10.0).abs() < 0.5, "{before} and {after}");
}
