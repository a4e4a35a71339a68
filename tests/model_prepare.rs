//! Cleaning, purging and restoring the entities of a model: what their records say of it, what files keep of it, and that queries
//! go on giving the same answers.

mod common;

use common::random::Random;
use glam::DVec3;
use perpend::kernel::Spacing;
use perpend::knowledge::displacement;
use perpend::{
    Basis, Circle, Cleaning, Consent, Definition, EditError, Entity, EntityId, Frame, Item, Kind, Model, NurbsCurve,
    Operation, Trust,
};

/// A wave with more control points than it needs.
fn wave(noise: f64) -> NurbsCurve {
    let mut random = Random::new(7);
    let points = (0..60).map(|k| 0.2 * f64::from(k));
    let points = points.map(|t| DVec3::new(t, t.sin(), 0.0) + noise * random.in_cube()).collect();
    let mut knots = vec![0.0; 4];
    knots.extend((1..57).map(f64::from));
    knots.extend([57.0; 4]);
    NurbsCurve::new(3, knots, points, None).expect("valid")
}

/// A model with a wave, an arc in another form than it needs, and a line.
fn model() -> Model {
    let mut model = Model::new();
    model.insert("wave", wave(1e-4)).expect("valid");
    let arc = Circle::new(Frame::WORLD, 2.0, (0.0, 1.5)).expect("valid").to_nurbs().expect("valid");
    let arc = arc.elevate_degree(3).and_then(|arc| arc.refine(&[0.2, 0.7, 0.7])).expect("valid");
    model.insert("arc", arc).expect("valid");
    let line = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec3::ZERO, DVec3::X], None).expect("valid");
    model.insert("line", line).expect("valid");
    model
}

const WAVE: EntityId = EntityId::new(1);
const ARC: EntityId = EntityId::new(2);
const LINE: EntityId = EntityId::new(3);

fn entity(model: &Model, id: EntityId) -> &Entity {
    model.entity(id).expect("an entity")
}

fn points(model: &Model, id: EntityId) -> usize {
    entity(model, id).definition().control_points().len()
}

fn cleaning(model: &Model, id: EntityId) -> Vec<Item<Cleaning>> {
    let record = entity(model, id).record().and_then(|record| record.representation.as_ref());
    record.and_then(|part| part.cleaning.clone()).unwrap_or_default()
}

/// Writes and reads the model, which gives it back.
fn through_a_file(model: &Model) -> Model {
    let text = model.to_ron();
    let back = Model::from_ron(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(&back, model);
    assert_eq!(back.to_ron(), text);
    back
}

#[test]
fn cleaning_is_recorded_and_the_class_stays() {
    let mut model = model();
    let mut record = entity(&model, ARC).record().cloned().unwrap_or_default();
    let kind = perpend::knowledge::recognise(entity(&model, ARC).definition(), 1e-9);
    assert!(matches!(kind.value, Kind::Circle { .. }));
    record.classification.get_or_insert_default().kind = Some(kind);
    model.set_record(ARC, record).expect("valid");
    let before = entity(&model, ARC).definition().as_ref().clone();
    let done = model.clean(ARC).expect("an entity");
    assert_eq!(points(&model, ARC), 3);
    let now = entity(&model, ARC);
    assert_eq!((now.revision(), now.stale(), now.original()), (1, Vec::new(), None));
    let of = now.definition().fingerprint();
    let items = cleaning(&model, ARC);
    assert_eq!(items.iter().map(|item| item.value.clone()).collect::<Vec<_>>(), done.steps);
    assert!(items.iter().all(|item| item.basis == Basis::Proved { gap: done.deviation } && item.of == of));
    assert!(
        matches!(&done.steps[..], [Cleaning::RemovedKnots { knots, .. }, Cleaning::ReducedDegree { from: 5, .. }, ..] if *knots == [0.2, 0.7, 0.7])
    );
    let kind = now.record().and_then(|record| record.classification.as_ref()?.kind.clone()).expect("a class");
    assert!(matches!(kind.value, Kind::Circle { radius, .. } if (radius - 2.0).abs() < 1e-12) && kind.of == of);
    assert_eq!(displacement(&before, now.definition()), Some(done.deviation));
    through_a_file(&model);
    // once is enough
    let text = model.to_ron();
    assert_eq!(model.clean(ARC).expect("an entity").steps, []);
    assert_eq!(model.to_ron(), text);
}

#[test]
fn what_needs_no_preparation_is_left_alone() {
    let mut model = model();
    let text = model.to_ron();
    assert_eq!(model.clean(LINE).expect("an entity").steps, []);
    assert_eq!(model.purge(LINE, Consent::within(0.1)).expect("an entity").steps, []);
    assert_eq!(model.to_ron(), text);
}

#[test]
fn cleaning_changes_no_answer() {
    let mut random = Random::new(31_020);
    let plain = model();
    let mut cleaned = plain.clone();
    let moved = cleaned.clean(ARC).expect("an entity").deviation;
    for _ in 0..300 {
        let p = random.power(-2.0, 1.0) * random.in_cube();
        let (a, b) = (plain.project(ARC, p).expect("finite"), cleaned.project(ARC, p).expect("finite"));
        let gaps = (a.distance - a.lower_bound) + (b.distance - b.lower_bound);
        assert!((a.distance - b.distance).abs() <= moved + gaps, "{p}: {} and {}", a.distance, b.distance);
    }
}

#[test]
fn purging_keeps_the_original_and_restoring_gives_it_back() {
    let mut model = model();
    let before = model.to_ron();
    let original = entity(&model, WAVE).definition().clone();
    let done = model.purge(WAVE, Consent::within(1e-2)).expect("an entity");
    assert!(points(&model, WAVE) < 40 && done.deviation <= 1e-2, "{} points", points(&model, WAVE));
    let now = entity(&model, WAVE);
    assert_eq!(now.revision(), 1);
    assert_eq!(now.original().map(|kept| kept.definition().fingerprint()), Some(original.fingerprint()));
    let items = cleaning(&model, WAVE);
    assert!(items.iter().all(|item| item.tolerance == 1e-2 && item.basis == Basis::Proved { gap: done.deviation }));
    let mut model = through_a_file(&model);
    model.restore(WAVE).expect("an original");
    assert_eq!(entity(&model, WAVE).original(), None);
    // all but the count of edits is as it was, byte for byte
    let mut record = entity(&model, WAVE).record().cloned().expect("a record");
    assert_eq!(record.revision, 2);
    record.revision = 0;
    assert_eq!(record, perpend::Record::default());
    let text =
        model.to_ron().replace("            knowledge: Some((\n                revision: 2,\n            )),\n", "");
    assert_eq!(text, before);
    assert_eq!(model.restore(WAVE), Err(EditError::NoOriginal { id: WAVE }));
}

#[test]
fn purging_and_restoring_what_is_made_of_each_other_gives_all_back() {
    let mut model = Model::new();
    let points = (0..20).map(|k| DVec3::new(5.0 + (0.8 * f64::from(k)).sin(), 0.0, f64::from(k))).collect();
    let through = Operation::Interpolation { degree: (3, 0), points, columns: 0, spacing: Spacing::ChordLength };
    let profile = model.make("profile", through, &[]).expect("valid");
    let turned = Operation::Revolve { origin: DVec3::ZERO, axis: DVec3::Z, angle: 6.0 };
    let vase = model.make("vase", turned, &[profile]).expect("valid");
    let before = model.clone();
    let ids = [profile, vase];
    for order in [ids, [vase, profile]] {
        for back in [ids, [vase, profile]] {
            let mut model = before.clone();
            for id in order {
                let within = if id == profile { 0.5 } else { 30.0 };
                assert!(!model.purge(id, Consent::within(within)).expect("an entity").steps.is_empty());
            }
            let mut model = through_a_file(&model);
            for id in back {
                model.restore(id).expect("an original");
                assert_eq!(model.replay(vase).expect("made").is_overridden, entity(&model, vase).original().is_some());
            }
            for id in ids {
                assert_eq!(entity(&model, id).definition(), entity(&before, id).definition(), "{order:?}, {back:?}");
                assert_eq!(model.replay(id).expect("made").drift.proven, 0.0);
            }
        }
    }
}

#[test]
fn a_purged_entity_is_restored_to_what_its_inputs_give_today() {
    let mut model = Model::new();
    let circle =
        |radius: f64| Operation::CircleByCentre { centre: DVec3::ZERO, axis: DVec3::Z, radius, xdir: Some(DVec3::X) };
    let rim = model.make("rim", circle(2.0), &[]).expect("valid");
    let pipe = model.make("pipe", Operation::Extrude { vector: DVec3::Z }, &[rim]).expect("valid");
    model.purge(pipe, Consent::within(2.5)).expect("an entity");
    assert!(entity(&model, pipe).original().is_some());
    assert_eq!(model.edit(rim, circle(3.0)), Ok(vec![rim]), "what was purged is kept");
    model.restore(pipe).expect("an original");
    assert_eq!(model.replay(pipe).expect("made").drift.proven, 0.0);
    let foot = model.project(pipe, DVec3::new(4.0, 0.0, 0.5)).expect("finite");
    assert!((foot.distance - 1.0).abs() < 1e-9);
    assert_eq!(model.edit(rim, circle(1.0)), Ok(vec![rim, pipe]));
}

#[test]
fn what_was_known_of_the_original_comes_back_with_it() {
    let mut model = model();
    let mut record = entity(&model, ARC).record().cloned().unwrap_or_default();
    record.classification.get_or_insert_default().kind =
        Some(perpend::knowledge::recognise(entity(&model, ARC).definition(), 1e-9));
    record.classification.get_or_insert_default().destination = vec!["turning".to_owned()];
    model.set_record(ARC, record.clone()).expect("valid");
    assert!(!model.purge(ARC, Consent::within(1e-6)).expect("an entity").steps.is_empty());
    let mut model = through_a_file(&model);
    model.restore(ARC).expect("an original");
    let restored = entity(&model, ARC).record().cloned().expect("a record");
    assert_eq!(restored, perpend::Record { revision: 2, ..record });
}

#[test]
fn repeated_purges_do_not_add_up() {
    let mut model = model();
    let original = entity(&model, WAVE).definition().as_ref().clone();
    let mut fewest = usize::MAX;
    for tolerance in [1e-3, 1e-2, 1e-2, 1e-2, 0.1, 1e-3] {
        let done = model.purge(WAVE, Consent::within(tolerance)).expect("an entity");
        let now = entity(&model, WAVE).definition();
        let total = displacement(&original, now).expect("one domain");
        assert!(total <= tolerance && total == done.deviation, "{total:e} of {tolerance:e}");
        fewest = fewest.min(now.control_points().len());
        model.clean(WAVE).expect("an entity");
        let cleaned = entity(&model, WAVE).definition();
        assert!(displacement(&original, cleaned).is_some_and(|total| total <= tolerance));
        through_a_file(&model);
    }
    assert!(fewest < 20, "{fewest} control points");
    assert!(points(&model, WAVE) > fewest, "a smaller tolerance takes knots back");
    // too small for anything: the original
    model.purge(WAVE, Consent::within(1e-300)).expect("an entity");
    assert_eq!(entity(&model, WAVE).definition().fingerprint(), original.fingerprint());
    assert_eq!(entity(&model, WAVE).original(), None);
}

#[test]
fn an_original_that_was_dropped_is_gone() {
    let mut model = model();
    model.purge(WAVE, Consent::within(1e-2)).expect("an entity");
    let purged = entity(&model, WAVE).definition().fingerprint();
    model.drop_original(WAVE).expect("an original");
    assert_eq!((entity(&model, WAVE).original(), entity(&model, WAVE).definition().fingerprint()), (None, purged));
    assert_eq!(model.restore(WAVE), Err(EditError::NoOriginal { id: WAVE }));
    assert_eq!(model.drop_original(WAVE), Err(EditError::NoOriginal { id: WAVE }));
    through_a_file(&model);
    // it goes with its successor too
    let mut model = self::model();
    model.purge(WAVE, Consent::within(1e-2)).expect("an entity");
    model.replace(WAVE, wave(0.0)).expect("valid");
    assert_eq!(entity(&model, WAVE).original(), None);
}

#[test]
fn edits_that_make_no_sense_change_nothing() {
    let mut model = model();
    let text = model.to_ron();
    let missing = EntityId::new(99);
    assert_eq!(model.clean(missing), Err(EditError::UnknownEntity { id: missing }));
    assert_eq!(model.purge(missing, Consent::within(1.0)), Err(EditError::UnknownEntity { id: missing }));
    assert_eq!(model.restore(missing), Err(EditError::UnknownEntity { id: missing }));
    assert_eq!(model.drop_original(missing), Err(EditError::UnknownEntity { id: missing }));
    assert_eq!(model.drop_original(WAVE), Err(EditError::NoOriginal { id: WAVE }));
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = model.purge(WAVE, Consent::within(tolerance)).expect_err("no tolerance").to_string();
        assert!(refused.starts_with("entity 1: the tolerance is"), "{refused}");
    }
    assert_eq!(model.to_ron(), text);
}

#[test]
fn a_file_with_a_bad_original_is_refused() {
    let mut model = model();
    model.purge(WAVE, Consent::within(1e-2)).expect("an entity");
    let text = model.to_ron();
    let refused = |from: &str, to: &str| {
        let at = text.find("original: Some((").expect("an original");
        let (head, tail) = text.split_at(at);
        assert!(tail.contains(from), "{from} in {tail}");
        let error = Model::from_ron(&format!("{head}{}", tail.replacen(from, to, 1))).expect_err("no original");
        assert_eq!(error.entity, Some(WAVE));
        error.to_string()
    };
    let says = |said: String, expected: &str| assert!(said.contains(expected), "{said}");
    let first =
        format!("{:?}", entity(&model, WAVE).original().expect("kept").definition().control_points()[0].to_array());
    let first = first.replace('[', "(").replace(']', ")");
    says(refused("degree: 3", "degree: 0"), "original: definition: degree is 0");
    says(refused(&first, "(NaN, 0.0, 0.0)"), "original: definition: control_points[0]");
    says(
        refused("57.0, 57.0, 57.0, 57.0", "58.0, 58.0, 58.0, 58.0"),
        "original: it is of another kind or over another",
    );
    let kept = "definition: NurbsCurve(";
    let stated = format!("knowledge: Some((intent: [(operation: Rule, inputs: [99])])),\n{kept}");
    says(refused(kept, &stated), "original: knowledge holds classification.kind and representation alone");
    let of = "fnv1a64:0000000000000000";
    let number = format!("length: (value: inf, basis: Declared, tolerance: 0.0, of: \"{of}\")");
    let number = format!("knowledge: Some((representation: Some(({number})))),\n{kept}");
    says(refused(kept, &number), "original: knowledge: representation.length.value is inf");
    says(refused(kept, &format!("colour: 3,\n{kept}")), "has no field `colour`");
    // another wave than the one that was purged: the stated deviation is a lie
    says(refused(&first, "(0.5, 0.0, 0.0)"), "is proven within");
    let (head, tail) = text.split_at(text.find("original: Some((").expect("an original"));
    let lie = format!("{head}{}", tail.replacen(&first, "(0.5, 0.0, 0.0)", 1));
    let repaired = Model::from_ron_with(&lie, Trust::Repair).expect("repaired");
    let original = entity(&repaired, WAVE).original().expect("an original").definition().clone();
    let proven = displacement(&original, entity(&repaired, WAVE).definition()).expect("one domain");
    assert!(proven > 0.4 && cleaning(&repaired, WAVE).iter().all(|item| item.basis == Basis::Proved { gap: proven }));
}

#[test]
fn surfaces_and_files_of_applications_keep_originals() {
    let mut model = Model::new();
    let row = |i: u32| -> Vec<DVec3> {
        let height = |j: u32| (0.2 * f64::from(i)).sin() * (0.3 * f64::from(j)).cos();
        (0..20).map(|j| DVec3::new(f64::from(i), f64::from(j), height(j))).collect()
    };
    let knots = || {
        let mut all = vec![0.0; 3];
        all.extend((1..18).map(f64::from));
        all.extend([18.0; 3]);
        all
    };
    let surface =
        perpend::NurbsSurface::new((2, 2), (knots(), knots()), (0..20).map(row).collect(), None).expect("valid");
    let id = model.insert("hill", surface).expect("valid");
    let done = model.purge(id, Consent::within(0.1)).expect("an entity");
    assert!(points(&model, id) < 300 && done.steps.len() == 2, "{:?}", done.steps);
    through_a_file(&model);
    let text = ron::to_string(entity(&model, id)).expect("plain data");
    let back: Entity = ron::from_str(&text).expect("what was written");
    assert_eq!(&back, entity(&model, id));
    let original: &Definition = back.original().expect("an original").definition();
    assert_eq!(original.control_points().len(), 400);
}
