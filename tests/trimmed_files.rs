//! Trimmed faces and bodies in files.

#[path = "bodies/solids.rs"]
#[expect(dead_code, reason = "shared with the tests of bodies")]
mod solids;

use perpend::glam::DVec2;
use perpend::{
    Carrier, Cleaning, CurveData, DVec3, Entity, EntityId, Model, NurbsCurve, Shell, TrimmedSurface, TrimmingData,
};

use proptest::prelude::*;
use solids::{closed, cuboid, face, planar, plane, rectangle};

/// A model that is right: a carrier, a curve, two faces and a body; each case makes one thing of it wrong.
const GOOD: &str = r#"Model(
    format: 1,
    entities: [
        (
            id: 3,
            name: "half",
            definition: TrimmedSurface(
                surface: Ref(7),
                reversed: true,
                tolerance: 1e-6,
                loops: [(outer: true, curves: [
                    (degree: 1, knots: [0, 0, 1, 1], points: [(0, 0), (0.5, 0)], edge: Some(5)),
                    (degree: 1, knots: [0, 0, 1, 1], points: [(0.5, 0), (0.5, 1)], weights: Some([1, 2])),
                    (degree: 1, knots: [0, 0, 1, 2, 2], points: [(0.5, 1), (0, 1), (0, 0)], weights: None, edge: None),
                ])],
            ),
        ),
        (
            id: 4,
            colour: Some((0.8, 0.1, 0.5)),
            definition: TrimmedSurface(
                surface: Own(NurbsSurface(
                    degree: (1, 1),
                    knots: ([0, 0, 1, 1], [0, 0, 1, 1]),
                    control_points: [[(0, 0, 1), (0, 1, 1)], [(1, 0, 1), (1, 1, 1)]],
                )),
                tolerance: 0,
                loops: [(outer: true, curves: [
                    (degree: 1, knots: [0, 0, 1, 2, 3, 3], points: [(0, 0), (1, 0), (1, 1), (0, 0)]),
                ])],
            ),
        ),
        (id: 9, name: "lid", definition: Body(shells: [(faces: [3, 4], closed: false)]), colour: Some((1, 0, 0))),
        (
            id: 5,
            definition: NurbsCurve(degree: 1, knots: [0, 0, 1, 1], control_points: [(0, 0, 0), (0.5, 0, 0)]),
        ),
        (
            id: 7,
            definition: NurbsSurface(
                degree: (1, 1),
                knots: ([0, 0, 1, 1], [0, 0, 1, 1]),
                control_points: [[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0)]],
            ),
        ),
    ],
)
"#;

/// What is replaced in `GOOD`, by what, and the message.
const CASES: &[(&str, &str, &str)] = &[
    (
        "Ref(7)",
        "Ref(8)",
        "4: entity 3: definition: surface is Ref(8), which the model does not have: name a surface that is not trimmed, or write it as Own(NurbsSurface(…))",
    ),
    (
        "Ref(7)",
        "Ref(5)",
        "4: entity 3: definition: surface is Ref(5), which is a curve: name a surface that is not trimmed, or write it as Own(NurbsSurface(…))",
    ),
    (
        "Ref(7)",
        "Ref(4)",
        "4: entity 3: definition: surface is Ref(4), which is trimmed itself: name a surface that is not trimmed, or write it as Own(NurbsSurface(…))",
    ),
    (
        "Ref(7)",
        "Ref(3)",
        "4: entity 3: definition: surface is Ref(3), which is trimmed itself: name a surface that is not trimmed, or write it as Own(NurbsSurface(…))",
    ),
    (
        "Ref(7)",
        "Ref(9)",
        "4: entity 3: definition: surface is Ref(9), which is a body: name a surface that is not trimmed, or write it as Own(NurbsSurface(…))",
    ),
    (
        "edge: Some(5)",
        "edge: Some(7)",
        "4: entity 3: definition: loops[0].curves[0].edge is 7, which is a surface: name a curve, or leave the edge out",
    ),
    (
        "edge: Some(5)",
        "edge: Some(6)",
        "4: entity 3: definition: loops[0].curves[0].edge is 6, which the model does not have: name a curve, or leave the edge out",
    ),
    (
        "points: [(0, 0), (0.5, 0)]",
        "points: [(0, 0), (0.25, 0)]",
        "4: entity 3: definition: loops[0].curves[1] begins 2.5e-1 away from the end of the curve before it, and tolerance is 1e-6: put the curves in order, close the loop, or state the tolerance to which it is closed",
    ),
    (
        "[(0, 0), (1, 0), (1, 1), (0, 0)]",
        "[(0, 0), (1.5, 0), (1, 1), (0, 0)]",
        "18: entity 4: definition: loops[0].curves[0] leaves the surface's domain by 5e-1 of its extent (at most 1e-3 is clamped): correct the p-curve or extend the surface",
    ),
    (
        "tolerance: 0,",
        "tolerance: -1,",
        "18: entity 4: definition: tolerance is -1; it is a length in the model's unit, zero or more and finite",
    ),
    ("tolerance: 0,", "", "31:13: entity 4: `TrimmedSurface` lacks its field `tolerance`: add it"),
    (
        "(0, 0, 1), (0, 1, 1)",
        "(0, 0, inf), (0, 1, 1)",
        "18: entity 4: definition: control_points[0][0] is (0.0, 0.0, inf); coordinates are finite and within ±1e70",
    ),
    (
        "Some((0.8, 0.1, 0.5))",
        "Some((0.8, 1.1, 0.5))",
        "18: entity 4: colour is (0.8, 1.1, 0.5); red, green and blue are from 0 to 1",
    ),
    (
        "faces: [3, 4]",
        "faces: [3, 5]",
        "33: entity 9: definition: shells[0].faces[1] is 5, which is a curve: name a surface or a trimmed face",
    ),
    (
        "faces: [3, 4]",
        "faces: [9]",
        "33: entity 9: definition: shells[0].faces[0] is 9, which is a body: name a surface or a trimmed face",
    ),
    (
        "faces: [3, 4]",
        "faces: [3, 4, 3]",
        "33: entity 9: definition: shells[0].faces[2] is 3, which the body has already: name each face once",
    ),
    (
        "faces: [3, 4]",
        "faces: []",
        "33: entity 9: definition: shells[0].faces is empty; a shell has at least one face: remove the shell",
    ),
    (
        "[(faces: [3, 4], closed: false)]",
        "[]",
        "33: entity 9: definition: shells is empty; a body has at least one: give its faces, or remove the body",
    ),
    ("colour: Some((1, 0, 0))", "knowledge: Some(())", "33: entity 9: a body has no knowledge: remove it"),
    ("id: 9", "id: 7", "38: entity 7: id 7 was given on line 33 already; ids are unique: give this entity a new one"),
    (
        "format: 1,",
        "format: 1, next_id: 9,",
        "2: next_id is 9, but entity 9 exists; it is above every id: set it to 10 or leave it out",
    ),
];

#[test]
fn every_mistake_is_named_with_its_place_and_remedy() {
    Model::from_ron(GOOD).expect("the model is right");
    let mut wrong = String::new();
    for (old, new, expected) in CASES {
        assert_eq!(GOOD.matches(old).count(), 1, "{old}");
        let found = match Model::from_ron(&GOOD.replacen(old, new, 1)) {
            Ok(_) => "a model".to_owned(),
            Err(error) => error.to_string(),
        };
        if found != *expected {
            wrong += &format!("{old} -> {new}\n  gives    {found}\n  expected {expected}\n");
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

#[test]
fn a_face_may_stand_before_its_carrier_and_shares_its_definition() {
    let model = Model::from_ron(GOOD).unwrap();
    let [half, lid] = [3, 4].map(|id| model.entity(EntityId::new(id)).unwrap());
    let carrier = model.entity(EntityId::new(7)).unwrap();
    assert!(std::sync::Arc::ptr_eq(half.definition(), carrier.definition()));
    assert_eq!(half.carrier(), Some(EntityId::new(7)));
    assert_eq!((lid.carrier(), lid.colour()), (None, Some([0.8, 0.1, 0.5])));
    assert!(half.trimming().unwrap().reversed() && !lid.trimming().unwrap().reversed());
    assert!(carrier.trimming().is_none());
    let body = model.body(EntityId::new(9)).unwrap();
    assert_eq!((body.name(), body.is_closed(), body.colour()), ("lid", false, Some([1.0, 0.0, 0.0])));
    assert_eq!(body.faces().collect::<Vec<_>>(), [EntityId::new(3), EntityId::new(4)]);
    assert_eq!(model.next_id(), EntityId::new(10));
    assert_eq!(model.len(), 4);
}

#[test]
fn models_with_faces_and_bodies_come_back_bit_for_bit() {
    let read = Model::from_ron(GOOD).unwrap();
    let mut built = Model::new();
    let faces = cuboid(&mut built, DVec3::new(-0.0, 1e-300, 0.1), DVec3::new(1.0, 2.0, 1.0 / 3.0), false);
    let body = closed(&mut built, faces.clone());
    built.set_colour(body, Some([0.0, 0.5, 1.0])).unwrap();
    built.set_colour(faces[2], Some([0.1, 0.2, 0.3])).unwrap();
    built.insert_body("open \"one\"", vec![Shell { faces, closed: false }]).unwrap();
    for model in [read, built] {
        let text = model.to_ron();
        let again = Model::from_ron(&text).unwrap();
        assert_eq!(again, model);
        assert_eq!(again.to_ron(), text);
        assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
    }
}

/// The layout is part of the format: programs that compare files line by line rely on it.
#[test]
fn the_layout_is_kept() {
    let text = Model::from_ron(GOOD).unwrap().to_ron();
    let expected = r#"        (
            id: 3,
            name: "half",
            definition: TrimmedSurface(
                surface: Ref(7),
                reversed: true,
                tolerance: 1e-6,
                loops: [
                    (
                        outer: true,
                        curves: [
                            (
                                degree: 1,
                                knots: [0.0, 0.0, 1.0, 1.0],
                                points: [(0.0, 0.0), (0.5, 0.0)],
                                edge: Some(5),
                            ),
                            (
                                degree: 1,
                                knots: [0.0, 0.0, 1.0, 1.0],
                                points: [(0.5, 0.0), (0.5, 1.0)],
                                weights: Some([1.0, 2.0]),
                            ),
                            (
                                degree: 1,
                                knots: [0.0, 0.0, 1.0, 2.0, 2.0],
                                points: [(0.5, 1.0), (0.0, 1.0), (0.0, 0.0)],
                            ),
                        ],
                    ),
                ],
            ),
        ),
        (
            id: 4,
            name: "",
            colour: Some((0.8, 0.1, 0.5)),
            definition: TrimmedSurface(
                surface: Own(NurbsSurface(
                    degree: (1, 1),
                    knots: (
                        [0.0, 0.0, 1.0, 1.0],
                        [0.0, 0.0, 1.0, 1.0],
                    ),
                    control_points: [
                        [(0.0, 0.0, 1.0), (0.0, 1.0, 1.0)],
                        [(1.0, 0.0, 1.0), (1.0, 1.0, 1.0)],
                    ],
                )),
                reversed: false,
                tolerance: 0.0,
"#;
    assert!(text.contains(expected), "{text}");
    let expected = r#"        (
            id: 9,
            name: "lid",
            colour: Some((1.0, 0.0, 0.0)),
            definition: Body(
                shells: [
                    (
                        faces: [3, 4],
                        closed: false,
                    ),
                ],
            ),
        ),
    ],
)
"#;
    assert!(text.ends_with(expected), "{text}");
}

proptest! {
    #[test]
    fn a_spoilt_file_gives_an_error_or_a_model_and_never_a_panic(
        at in 0..GOOD.len(),
        length in 0..40_usize,
        new in prop_oneof![Just(String::new()), "[-0-9.e(),:\\[\\]a-zA-Z]{0,6}", Just("1e300".to_owned()), Just("NaN".to_owned())],
    ) {
        let end = (at + length).min(GOOD.len());
        let text = format!("{}{new}{}", &GOOD[..at], &GOOD[end..]);
        if let Ok(model) = Model::from_ron(&text) {
            let again = Model::from_ron(&model.to_ron()).expect("what is written reads back");
            prop_assert_eq!(again, model);
        }
    }
}

#[test]
fn an_entity_on_its_own_is_read_where_it_names_no_other() {
    let model = Model::from_ron(GOOD).unwrap();
    let text = |id: u64| ron::to_string(model.entity(EntityId::new(id)).unwrap()).unwrap();
    let lid: Entity = ron::from_str(&text(4)).unwrap();
    assert_eq!(lid, *model.entity(EntityId::new(4)).unwrap());
    let error = ron::from_str::<Entity>(&text(3)).unwrap_err();
    assert!(
        error.to_string().contains("surface is Ref(7), which only a model resolves: read the model that holds both"),
        "{error}"
    );
    let body = "(id: 9, definition: Body(shells: [(faces: [3], closed: false)]))";
    let error = ron::from_str::<Entity>(body).unwrap_err();
    assert!(error.to_string().contains("Body names entities, which only a model holds"), "{error}");
}

#[test]
fn p_curves_that_were_clamped_are_told_of_once() {
    let mut model = Model::new();
    let surface = plane(DVec3::ZERO, DVec3::X, DVec3::Y, (DVec2::ZERO, DVec2::ONE));
    let beyond = face(surface, false, vec![rectangle(DVec2::new(0.0, -6e-4), DVec2::new(0.5, 1.0))]);
    let id = model.insert_trimmed("face", beyond).unwrap();
    let told = |model: &Model| {
        let record = model.entity(id).unwrap().record().unwrap().clone();
        record.representation.unwrap().cleaning.unwrap().into_iter().map(|item| item.value).collect::<Vec<_>>()
    };
    assert_eq!(told(&model), [Cleaning::TrimClamped { share: (0.0, 6e-4) }]);
    let again = Model::from_ron(&model.to_ron()).unwrap();
    assert_eq!(again, model);
    assert_eq!(told(&again), told(&model));
}

#[test]
fn what_a_face_names_must_be_there_when_it_is_inserted() {
    let mut model = Model::new();
    let curve = CurveData {
        degree: 1,
        knots: vec![0.0, 0.0, 1.0, 1.0],
        control_points: vec![DVec3::ZERO, DVec3::X],
        weights: None,
    };
    let curve = model.insert("edge", NurbsCurve::enter(curve).unwrap().0).unwrap();
    let half = planar(&mut model, DVec3::ZERO, [DVec3::X, DVec3::Y], vec![rectangle(DVec2::ZERO, DVec2::ONE)], false);
    let before = model.clone();
    let trimming = || TrimmingData { reversed: false, tolerance: 0.0, loops: vec![rectangle(DVec2::ZERO, DVec2::ONE)] };
    for carrier in [curve, half, model.next_id()] {
        let face = TrimmedSurface { surface: Carrier::Ref(carrier), trimming: trimming() };
        let error = model.insert_trimmed("face", face).unwrap_err().to_string();
        assert!(error.starts_with(&format!("surface is Ref({carrier}), which ")), "{error}");
    }
    let mut named = trimming();
    named.loops[0].curves[2].edge = Some(half);
    let surface = plane(DVec3::ZERO, DVec3::X, DVec3::Y, (DVec2::ZERO, DVec2::ONE));
    let error = model.insert_trimmed("face", TrimmedSurface { surface: Carrier::Own(surface), trimming: named });
    assert_eq!(
        error.unwrap_err().to_string(),
        format!("loops[0].curves[2].edge is {half}, which is trimmed itself: name a curve, or leave the edge out")
    );
    assert_eq!(model, before);
}
