//! Edits of models with trimmed faces and bodies: faces follow their carriers, and parts are not lost.

#[path = "bodies/solids.rs"]
#[expect(dead_code, reason = "shared with the tests of bodies")]
mod solids;

use std::sync::Arc;

use perpend::glam::DVec2;
use perpend::{
    Carrier, Consent, CurveData, DVec3, EditError, Effect, EntityId, Line, Model, NurbsSurface, Operation, QueryError,
    QueryOptions, RebuildError, Relation, Shell, StationaryOptions, SurfaceData, TrimmedSurface, TrimmingData,
};

use solids::{closed, cuboid, plane, polygon, rectangle};

fn unit() -> (DVec2, DVec2) {
    (DVec2::ZERO, DVec2::ONE)
}

fn flat(height: f64) -> NurbsSurface {
    plane(height * DVec3::Z, DVec3::X, DVec3::Y, unit())
}

fn half(edge: Option<EntityId>) -> TrimmingData {
    let mut one = rectangle(DVec2::ZERO, DVec2::new(0.5, 1.0));
    one.curves[1].edge = edge;
    TrimmingData { reversed: false, tolerance: 1e-6, loops: vec![one] }
}

fn segment(from: DVec3, to: DVec3) -> CurveData {
    CurveData { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], control_points: vec![from, to], weights: None }
}

/// A carrier (1), an edge (2), a face of both (3), and a body of the face (4).
fn model() -> Model {
    let mut model = Model::new();
    let carrier = model.insert("carrier", flat(0.0)).unwrap();
    let edge = model.insert("edge", segment(DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.5, 1.0, 0.0))).unwrap();
    let one = TrimmedSurface { surface: Carrier::Ref(carrier), trimming: half(Some(edge)) };
    let face = model.insert_trimmed("half", one).unwrap();
    model.insert_body("sheet", vec![Shell { faces: vec![face], closed: false }]).unwrap();
    model
}

fn ids() -> [EntityId; 4] {
    [1, 2, 3, 4].map(EntityId::new)
}

#[test]
fn a_face_follows_its_carrier() {
    let [carrier, _, face, body] = ids();
    let mut model = model();
    let p = DVec3::new(1.0, 0.5, 2.0);
    assert!((model.project(face, p).unwrap().distance - 0.5_f64.hypot(2.0)).abs() < 1e-9);
    model.replace(carrier, flat(2.0)).unwrap();
    assert!(Arc::ptr_eq(model.entity(face).unwrap().definition(), model.entity(carrier).unwrap().definition()));
    assert_eq!(model.entity(face).unwrap().revision(), 1);
    assert!((model.project(face, p).unwrap().distance - 0.5).abs() < 1e-9);
    let (nearest, foot) = model.nearest_of(body, p, &QueryOptions::default()).unwrap().unwrap();
    assert_eq!((nearest, foot.distance), (face, model.project(face, p).unwrap().distance));
    assert_eq!(Model::from_ron(&model.to_ron()).unwrap(), model);
}

#[test]
fn a_carrier_on_which_the_trim_does_not_hold_is_refused_and_nothing_changes() {
    let [carrier, edge, face, _] = ids();
    let mut model = model();
    let before = model.clone();
    // its domain ends where the face goes on
    let narrow = plane(DVec3::ZERO, DVec3::X, DVec3::Y, (DVec2::ZERO, DVec2::new(0.25, 1.0)));
    let error = model.replace(carrier, narrow).unwrap_err();
    assert_eq!(
        error.to_string(),
        "entity 3, which follows entity 1: definition: loops[0].curves[0] leaves the surface's domain by 1e0 of its extent (at most 1e-3 is clamped): correct the p-curve or extend the surface"
    );
    let error = model.replace(carrier, segment(DVec3::ZERO, DVec3::X)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "entity 1 would become one which is a curve, and definition.surface of entity 3 names it: remove or replace entity 3 first"
    );
    let trimmed = TrimmedSurface { surface: Carrier::Own(flat(0.0)), trimming: half(None) };
    assert!(matches!(model.replace_trimmed(carrier, trimmed), Err(EditError::Rebuild(_))));
    assert!(matches!(model.replace(edge, flat(0.0)), Err(EditError::Rebuild(_))));
    assert!(matches!(model.replace(face, segment(DVec3::ZERO, DVec3::X)), Err(EditError::Rebuild(_))));
    assert_eq!(model, before);
    assert_eq!(model.to_ron(), before.to_ron());
}

#[test]
fn a_face_follows_a_carrier_that_is_made_anew_and_all_that_is_made_of_it_does_too() {
    let mut model = Model::new();
    let [low, high] = [0.0, 1.0].map(|y| Line::new(y * DVec3::Y, y * DVec3::Y + DVec3::X).unwrap());
    let low = model.make("low", low, &[]).unwrap();
    let high = model.make("high", high, &[]).unwrap();
    let carrier = model.make("carrier", Operation::Rule, &[low, high]).unwrap();
    let [(u0, u1), (v0, v1)] = match model.entity(carrier).unwrap().definition().as_ref() {
        perpend::Definition::NurbsSurface(surface) => {
            [perpend::Direction::U, perpend::Direction::V].map(|direction| surface.domain(direction))
        }
        perpend::Definition::NurbsCurve(_) => unreachable!("ruled"),
    };
    let corners = [(u0, v0), (u1, v0), (u1, v1)].map(DVec2::from);
    let trimming = TrimmingData { reversed: false, tolerance: 0.0, loops: vec![polygon(true, &corners)] };
    let face = model.insert_trimmed("face", TrimmedSurface { surface: Carrier::Ref(carrier), trimming }).unwrap();
    let copy = Operation::Transform { columns: (DVec3::X, DVec3::Y, DVec3::Z), translation: 5.0 * DVec3::Z };
    let copy = model.make("copy", copy, &[face]).unwrap();

    let impact = model.impact(low).unwrap();
    let touched: Vec<(EntityId, &Effect)> = impact.iter().map(|one| (one.id, &one.effect)).collect();
    assert_eq!(touched, [carrier, face, copy].map(|id| (id, &Effect::Rebuilt)));
    assert_eq!(impact[1].because, [(Relation::PartOf, carrier)]);

    let changed = model.edit(low, Line::new(-3.0 * DVec3::Y, -3.0 * DVec3::Y + DVec3::X).unwrap()).unwrap();
    assert_eq!(changed, [low, carrier, face, copy]);
    assert!(Arc::ptr_eq(model.entity(face).unwrap().definition(), model.entity(carrier).unwrap().definition()));
    let foot = model.project(copy, DVec3::new(0.5, -3.0, 5.0)).unwrap();
    assert!(foot.distance < 1e-9, "{foot:?}");

    // nothing is made of what trims it
    let error = model.remake(low, Operation::Rule, &[face, high]).unwrap_err();
    assert!(matches!(error, RebuildError::Cycle { .. }), "{error}");
    let error = model.rebuild(face).unwrap_err();
    assert_eq!(error, RebuildError::FollowsCarrier { id: face, carrier });
}

#[test]
fn parts_in_use_are_not_removed() {
    let [carrier, edge, face, body] = ids();
    let mut model = model();
    let before = model.clone();
    for (id, by, field) in [
        (carrier, face, "definition.surface"),
        (edge, face, "definition.loops[0].curves[1].edge"),
        (face, body, "definition.shells[0].faces[0]"),
    ] {
        assert_eq!(model.remove(id).unwrap_err(), EditError::PartOf { id, by, field: field.to_owned() });
    }
    assert_eq!(model.remove_body(face).unwrap_err(), EditError::UnknownBody { id: face });
    assert_eq!(model, before);
    assert_eq!(model.remove_body(body).unwrap().name(), "sheet");
    model.remove(face).unwrap();
    model.remove(edge).unwrap();
    model.remove(carrier).unwrap();
    assert!(model.is_empty() && model.bodies().is_empty());
    assert_eq!(model.next_id(), EntityId::new(5));
}

#[test]
fn plain_data_make_a_face_untrimmed_and_a_trim_makes_it_a_face_again() {
    let [carrier, _, face, _] = ids();
    let mut model = model();
    model.replace(face, flat(1.0)).unwrap();
    let entity = model.entity(face).unwrap();
    assert!(entity.trimming().is_none() && entity.carrier().is_none());
    assert!(model.project(face, DVec3::new(0.9, 0.5, 1.0)).unwrap().distance < 1e-12);
    model.replace_trimmed(face, TrimmedSurface { surface: Carrier::Ref(carrier), trimming: half(None) }).unwrap();
    assert_eq!(model.entity(face).unwrap().carrier(), Some(carrier));
    assert!((model.project(face, DVec3::new(0.9, 0.5, 0.0)).unwrap().distance - 0.4).abs() < 1e-9);
    assert_eq!(model.entity(face).unwrap().revision(), 2);
    let itself = TrimmedSurface { surface: Carrier::Ref(face), trimming: half(None) };
    assert!(matches!(model.replace_trimmed(face, itself), Err(EditError::Trimmed { .. })));
}

#[test]
fn cleaning_and_purging_keep_the_trim() {
    let [carrier, _, face, _] = ids();
    let mut model = model();
    assert_eq!(model.clean(face).unwrap_err(), EditError::FollowsCarrier { id: face, carrier });
    let consent = Consent::within(1e-3);
    assert_eq!(model.purge(face, consent).unwrap_err(), EditError::FollowsCarrier { id: face, carrier });
    // a carrier with knots that it does not need
    let knots = vec![0.0, 0.0, 0.25, 0.5, 1.0, 1.0];
    let at = |u: f64, v: f64| DVec3::new(u, v, if u == 0.25 { 1e-5 } else { 0.0 });
    let rows = [0.0, 0.25, 0.5, 1.0].map(|u| vec![at(u, 0.0), at(u, 1.0)]).to_vec();
    let data =
        SurfaceData { degree: (1, 1), knots: (knots, vec![0.0, 0.0, 1.0, 1.0]), control_points: rows, weights: None };
    model.replace(carrier, data.clone()).unwrap();
    let own = face_of(data);
    let own = model.insert_trimmed("own", own).unwrap();
    for id in [carrier, own] {
        let done = model.purge(id, consent).unwrap();
        assert!(!done.steps.is_empty() && done.deviation <= 1e-3);
    }
    assert!(model.entity(own).unwrap().trimming().is_some() && model.entity(own).unwrap().original().is_some());
    for id in [face, own] {
        let foot = model.project(id, DVec3::new(0.75, 0.5, 0.0)).unwrap();
        assert!((foot.distance - 0.25).abs() < 1e-9, "{foot:?}");
    }
    assert_eq!(Model::from_ron(&model.to_ron()).unwrap(), model);
    model.restore(own).unwrap();
    assert!(model.entity(own).unwrap().trimming().is_some());
}

fn face_of(data: SurfaceData) -> TrimmedSurface {
    TrimmedSurface { surface: Carrier::Own(NurbsSurface::enter(data).unwrap().0), trimming: half(None) }
}

#[test]
fn a_colour_is_three_shares_of_light() {
    let [carrier, .., body] = ids();
    let mut model = model();
    for id in [carrier, body] {
        model.set_colour(id, Some([0.0, 0.5, 1.0])).unwrap();
        for wrong in [[0.0, -0.1, 0.5], [0.0, 1.5, 0.0], [f64::NAN, 0.0, 0.0]] {
            assert!(matches!(model.set_colour(id, Some(wrong)), Err(EditError::Colour { .. })));
        }
    }
    assert_eq!(model.entity(carrier).unwrap().colour(), Some([0.0, 0.5, 1.0]));
    model.set_colour(body, None).unwrap();
    assert_eq!(model.body(body).unwrap().colour(), None);
    assert!(matches!(model.set_colour(EntityId::new(77), None), Err(EditError::UnknownEntity { .. })));
}

#[test]
fn what_is_not_answered_of_trimmed_faces_says_so() {
    let [carrier, _, face, _] = ids();
    let model = model();
    let p = DVec3::splat(0.4);
    let refused = |what: &'static str| QueryError::TrimmedFace { id: face, what };
    let options = QueryOptions::default();
    assert_eq!(model.project_ties(face, p, &options).unwrap_err(), refused("all nearest points"));
    let mut projector = model.projector(face).unwrap();
    assert_eq!(projector.project_ties(p, &options).unwrap_err(), refused("all nearest points"));
    assert_eq!(
        model.stationary_points(face, p, &StationaryOptions::default()).unwrap_err(),
        refused("stationary points")
    );
    assert!(model.project_ties(carrier, p, &options).is_ok());
}

/// A face stands for its carrier and its edges, unless a body names these themselves.
#[test]
fn a_whole_model_is_not_asked_for_parts_of_faces() {
    let [carrier, edge, face, _] = ids();
    let mut model = model();
    let p = DVec3::new(0.9, 0.5, 0.1);
    let options = QueryOptions::default();
    let all =
        |model: &Model| model.within(p, 10.0, &options).unwrap().into_iter().map(|(id, _)| id).collect::<Vec<_>>();
    assert_eq!(all(&model), [face]);
    assert_eq!(model.nearest(p, &options).unwrap().unwrap().0, face);
    model.insert_body("whole", vec![Shell { faces: vec![carrier], closed: false }]).unwrap();
    assert_eq!(all(&model), [carrier, face]);
    assert!(!all(&model).contains(&edge));
}

#[test]
fn a_body_is_asked_anew_after_its_faces_were_edited() {
    let mut model = Model::new();
    let faces = cuboid(&mut model, DVec3::ZERO, DVec3::ONE, false);
    let body = closed(&mut model, faces.clone());
    let p = DVec3::new(0.5, 0.5, 1.5);
    let ask = |model: &Model| model.signed_distance(body, p, &QueryOptions::default()).unwrap().signed_distance;
    assert!((ask(&model) - 0.5).abs() < 1e-9);
    // the lid and the walls rise
    let taller = cuboid(&mut model, DVec3::ZERO, DVec3::new(1.0, 1.0, 2.0), false);
    for (old, new) in faces.iter().zip(taller) {
        let entity = model.entity(new).unwrap();
        let surface = match entity.definition().as_ref() {
            perpend::Definition::NurbsSurface(surface) => surface.clone(),
            perpend::Definition::NurbsCurve(_) => unreachable!("a face"),
        };
        let trimming = entity.trimming().unwrap().data();
        model.replace_trimmed(*old, TrimmedSurface { surface: Carrier::Own(surface), trimming }).unwrap();
    }
    assert!((ask(&model) + 0.5).abs() < 1e-9);
}
