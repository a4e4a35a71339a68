//! The plan of an entity: what the dispatcher chooses, what it says of it, and that no record changes an answer.

use std::f64::consts::TAU;

use perpend::{
    AcquireOptions, Basis, Categories, Category, Circle, Classification, CurveData, Cylinder, DVec3, EntityId, Frame,
    Item, Kind, Method, Model, QueryOptions, Record, Representation,
};
use perpend_knowledge::Irregularity;

fn frame() -> Frame {
    Frame::new(DVec3::new(1.0, 2.0, 3.0), DVec3::Z, DVec3::X).expect("a frame")
}

fn rim() -> Circle {
    Circle { frame: frame(), radius: 2.5, sweep: (0.0, TAU) }
}

/// A cubic that crosses itself.
fn ribbon() -> CurveData {
    let point = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    CurveData {
        degree: 3,
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
        control_points: vec![point(0.0, 2.0), point(-1.0, 0.0), point(1.0, 1.0), point(-0.75, 1.625)],
        weights: None,
    }
}

fn with(definition: impl perpend::IntoDefinition) -> (Model, EntityId) {
    let mut model = Model::new();
    let id = model.insert("it", definition).expect("valid");
    (model, id)
}

fn item<T>(model: &Model, id: EntityId, value: T, basis: Basis) -> Item<T> {
    let of = model.entity(id).expect("an entity").definition().fingerprint();
    Item { value, basis, tolerance: 1e-9, of }
}

fn stating(kind: Item<Kind>) -> Record {
    let classification = Classification { kind: Some(kind), ..Classification::default() };
    Record { classification: Some(classification), ..Record::default() }
}

fn points() -> impl Iterator<Item = DVec3> {
    (0..60).map(|k| {
        let k = f64::from(k);
        DVec3::new((1.7 * k).sin(), (2.3 * k).cos(), (0.9 * k).sin()) * (0.2 * k) + DVec3::new(1.0, 2.0, 3.0)
    })
}

/// Both models answer every point within each other's bounds.
fn agree(a: (&Model, EntityId), b: (&Model, EntityId)) {
    for p in points() {
        let [a, b] = [a, b].map(|(model, id)| model.project(id, p).expect("a good point"));
        assert!(a.lower_bound <= b.distance && b.lower_bound <= a.distance, "{p}: {a:?}, {b:?}");
    }
}

#[test]
fn a_shape_that_was_made_here_has_a_closed_form_and_says_why() {
    let (model, id) = with(rim());
    let plan = model.explain(id).expect("an entity");
    assert_eq!(plan.method, Method::Analytic);
    let reason = &plan.reasons[0];
    assert_eq!((reason.item.as_str(), reason.basis), ("classification.kind", Some(Basis::Defined)));
    assert!(reason.effect.contains("a circle has a closed form"), "{}", reason.effect);
    assert_eq!(plan.settings.gap, 1e-9 * model.entity(id).expect("an entity").definition().size());
}

#[test]
fn a_class_that_nobody_stated_is_acquired() {
    let (known, known_id) = with(rim());
    let bare = known.entity(known_id).expect("an entity").definition().as_ref().clone();
    let (model, id) = with(bare);
    let plan = model.explain(id).expect("an entity");
    assert_eq!(plan.method, Method::Analytic);
    assert!(matches!(plan.reasons[0].basis, Some(Basis::Proved { gap }) if gap < 1e-12), "{:?}", plan.reasons);
    assert!(plan.reasons[0].effect.contains("acquired"), "{}", plan.reasons[0].effect);
    agree((&model, id), (&known, known_id));
}

#[test]
fn a_free_form_is_answered_by_the_hierarchy() {
    let (model, id) = with(ribbon());
    let plan = model.explain(id).expect("an entity");
    assert_eq!(plan.method, Method::Hierarchy);
    assert!(plan.reasons[0].effect.contains("no special shape was proved"), "{}", plan.reasons[0].effect);
}

#[test]
fn a_class_that_is_false_or_stale_is_not_believed_and_changes_no_answer() {
    let (truth, truth_id) = with(rim());
    let mut frames = Vec::new();
    for basis in [Basis::Defined, Basis::Proved { gap: 0.0 }, Basis::Declared] {
        let (mut model, id) = with(rim());
        let lie =
            Kind::Circle { centre: frame().centre, axis: DVec3::Z, xdir: DVec3::X, radius: 2.4, sweep: (0.0, TAU) };
        let stated = item(&model, id, lie, basis);
        model.set_record(id, stating(stated)).expect("finite");
        let plan = model.explain(id).expect("an entity");
        assert!(plan.reasons[0].effect.contains("not believed"), "{:?}", plan.reasons);
        assert!(plan.reasons[0].effect.contains("1.000e-1"), "the measured deviation: {:?}", plan.reasons);
        assert_eq!(plan.method, Method::Analytic, "the class was acquired again");
        agree((&model, id), (&truth, truth_id));
        frames.push(model.project(id, DVec3::ZERO).expect("a good point"));
    }
    assert!(frames.windows(2).all(|pair| pair[0] == pair[1]));

    let (mut model, id) = with(ribbon());
    let mut stale = item(&model, id, Kind::FreeForm, Basis::Declared);
    stale.of = truth.entity(truth_id).expect("an entity").definition().fingerprint();
    model.set_record(id, stating(stale)).expect("finite");
    let plan = model.explain(id).expect("an entity");
    assert!(plan.reasons[0].effect.contains("another definition"), "{:?}", plan.reasons);
}

#[test]
fn the_deviation_of_a_class_widens_the_bound_and_hands_over_where_it_is_too_wide() {
    let kind = |radius: f64| Kind::Circle {
        centre: frame().centre,
        axis: DVec3::Z,
        xdir: DVec3::X,
        radius,
        sweep: (0.0, TAU),
    };
    let (mut model, id) = with(rim());
    let mut stated = item(&model, id, kind(2.5 + 1e-4), Basis::Declared);
    stated.tolerance = 1e-3;
    model.set_record(id, stating(stated)).expect("finite");
    let (method, effect) = {
        let plan = model.explain(id).expect("an entity");
        (plan.method, plan.reasons[0].effect.clone())
    };
    assert_eq!(method, Method::Hierarchy, "{effect}");
    assert!(effect.contains("more than the gap"), "{effect}");
    let truth = with(rim());
    let mut handed_over = 0;
    for p in points() {
        let ask = |gap: f64| {
            let options = QueryOptions { gap: Some(gap), method: Some(Method::Analytic), ..QueryOptions::default() };
            model.project_with(id, p, &options).expect("a good point").expect("no limit")
        };
        let real = truth.0.project(truth.1, p).expect("a good point");
        let (wide, narrow) = (ask(1e-2), ask(1e-6));
        assert_eq!(wide.method, Method::Analytic, "{p}");
        assert!(narrow.gap() <= 1e-6 * (1.0 + 1e-9), "{p}: {narrow:?}");
        handed_over += usize::from(narrow.method == Method::Hierarchy);
        for foot in [wide, narrow] {
            assert!(foot.lower_bound <= real.distance && real.lower_bound <= foot.distance, "{p}: {foot:?}, {real:?}");
        }
    }
    assert!(handed_over > 50, "{handed_over} of 60; at the centre the deviation makes the bound exact");
}

#[test]
fn cusps_and_loops_of_the_record_cut_the_pieces_and_change_no_answer() {
    let (plain, plain_id) = with(ribbon());
    for places in [(0.3, 0.8), (0.0, 1.0), (-3.0, 0.5)] {
        let (mut model, id) = with(ribbon());
        let found = item(&model, id, Irregularity::Loop { from: places.0, to: places.1, gap: 0.0 }, Basis::Declared);
        let part = Representation { irregularities: Some(vec![found]), ..Representation::default() };
        model.set_record(id, Record { representation: Some(part), ..Record::default() }).expect("finite");
        let inner: Vec<f64> = [places.0, places.1].into_iter().filter(|u| *u > 0.0 && *u < 1.0).collect();
        let plan = model.explain(id).expect("an entity");
        assert_eq!(plan.settings.cuts, inner);
        let named = plan.reasons.iter().any(|reason| reason.item == "representation.irregularities[0]");
        assert_eq!(named, !inner.is_empty());
        agree((&model, id), (&plain, plain_id));
    }
}

#[test]
fn a_query_may_name_its_method() {
    let sleeve = Cylinder { frame: frame(), radius: 2.0, height: (0.0, 5.0), sweep: (0.0, TAU) };
    let (model, id) = with(sleeve);
    let (free, free_id) = with(ribbon());
    for p in points() {
        let ask = |model: &Model, id, method| {
            let options = QueryOptions { method, ..QueryOptions::default() };
            model.project_with(id, p, &options).expect("a good point").expect("no limit")
        };
        let [planned, proved] = [None, Some(Method::Hierarchy)].map(|method| ask(&model, id, method));
        assert_eq!((planned.method, proved.method), (Method::Analytic, Method::Hierarchy), "{p}");
        assert!(planned.lower_bound <= proved.distance && proved.lower_bound <= planned.distance, "{p}");
        let missing = ask(&free, free_id, Some(Method::Analytic));
        assert_eq!(missing.method, Method::Hierarchy, "a free form has no closed form");
    }
}

#[test]
fn a_plan_is_made_once_and_anew_after_an_edit() {
    let (mut model, id) = with(rim());
    let before = model.explain(id).expect("an entity").clone();
    for p in points() {
        model.project(id, p).expect("a good point");
    }
    assert_eq!(&before, model.explain(id).expect("an entity"));
    model.replace(id, ribbon()).expect("valid");
    assert_eq!(model.explain(id).expect("an entity").method, Method::Hierarchy);
    assert!(model.explain(EntityId::new(99)).is_err());
}

#[test]
fn what_is_learned_is_in_the_plan() {
    let (mut model, id) = with(ribbon());
    assert_eq!(model.explain(id).expect("an entity").settings.decomposition, []);
    model.learn(id).expect("an entity");
    let plan = model.explain(id).expect("an entity");
    let [part] = plan.settings.decomposition.as_slice() else { panic!("one direction: {plan:?}") };
    let speed =
        &model.entity(id).and_then(|e| e.record()?.representation.as_ref()?.speed.as_ref()).expect("learned")[0];
    let category = speed.value.category.as_ref().expect("named");
    assert_eq!((part.tolerance, part.jitter), (category.tolerance, category.jitter));
    assert_eq!(plan.settings.cuts.len(), 2, "the loop's two parameters: {plan:?}");
    let (plain, plain_id) = with(ribbon());
    agree((&model, id), (&plain, plain_id));

    let own = Category { upper: 1.0, name: "ours".to_owned(), tolerance: 0.25, jitter: 0.9 };
    let options =
        AcquireOptions { categories: Categories::new(vec![own]).expect("a table"), ..AcquireOptions::default() };
    let (mut model, id) = with(ribbon());
    model.learn_with(id, &options).expect("an entity");
    let plan = model.explain(id).expect("an entity");
    assert_eq!(
        (plan.settings.decomposition[0].category.as_str(), plan.settings.decomposition[0].jitter),
        ("ours", 0.9)
    );
}
