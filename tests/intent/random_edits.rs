//! 10,000 random rounds of editing, rebuilding and asking: every invariant holds after each.

use std::collections::BTreeSet;
use std::sync::Arc;

use perpend::kernel::Spacing;
use perpend::{
    Circle, CurveData, DVec3, Definition, Direction, EditError, Effect, EntityId, Frame, Line, Model, Operation,
    Parameter, QueryOptions, RebuildError, Record,
};

use crate::common::random::Random;

/// Numbers that no operation makes anything of, and some that may pass.
const HOSTILE: [f64; 7] = [f64::NAN, f64::INFINITY, 1e300, -1.0, 0.0, 9e69, 1e-200];

fn frame(random: &mut Random) -> Frame {
    Frame::new(5.0 * random.in_cube(), random.direction(), random.direction()).unwrap_or(Frame::WORLD)
}

/// A length; one time in twelve none.
fn length(random: &mut Random) -> f64 {
    if random.chance(0.08) { random.pick(&HOSTILE) } else { random.between(0.5, 4.0) }
}

/// An operation that takes so many inputs.
fn operation(random: &mut Random, inputs: usize) -> Operation {
    let spread = |random: &mut Random, count: usize| (0..count).map(|_| 4.0 * random.in_cube()).collect::<Vec<_>>();
    match inputs {
        0 => match random.count(0, 4) {
            0 => Line { start: 4.0 * random.in_cube(), end: 4.0 * random.in_cube() }.into(),
            1 => {
                let Frame { centre, axis, xdir } = frame(random);
                Operation::CircleByCentre { centre, axis, radius: length(random), xdir: Some(xdir) }
            }
            2 => {
                let [start, through, end] = [0; 3].map(|_| 3.0 * random.in_cube());
                Operation::ArcByPoints { start, through, end }
            }
            3 => {
                let sweep = (0.0, random.between(0.2, 7.0));
                Circle { frame: frame(random), radius: length(random), sweep }.into()
            }
            _ => {
                let points = spread(random, 5);
                Operation::Interpolation { degree: (3, 0), points, columns: 0, spacing: Spacing::Centripetal }
            }
        },
        1 => match random.count(0, 5) {
            0 => Operation::Extrude { vector: length(random) * random.direction() },
            1 => {
                let (origin, axis) = (6.0 * random.direction(), random.direction());
                Operation::Revolve { origin, axis, angle: length(random) }
            }
            2 => Operation::IsoCurve {
                direction: random.pick(&[Direction::U, Direction::V]),
                at: random.between(-0.2, 1.2),
            },
            3 => {
                let from = random.between(-0.1, 0.6);
                let direction = random.pick(&[Direction::U, Direction::V]);
                Operation::Split { direction, range: (from, from + random.between(-0.1, 0.5)) }
            }
            4 => Operation::Offset {
                distance: 0.2 * length(random),
                normal: random.chance(0.5).then(|| random.direction()),
            },
            _ => {
                let (x, turned) = (random.direction(), random.direction());
                let z = x.cross(turned).normalize_or(DVec3::Z);
                Operation::Transform { columns: (x, z.cross(x), z), translation: length(random) * random.direction() }
            }
        },
        2 => Operation::Rule,
        _ => Operation::Loft { degree: random.count(1, 3) as u32 },
    }
}

fn data(random: &mut Random) -> CurveData {
    let control_points = (0..4).map(|_| 4.0 * random.in_cube()).collect();
    let weights = random
        .chance(0.3)
        .then(|| vec![1.0, random.between(0.2, 3.0), if random.chance(0.1) { -1.0 } else { 1.0 }, 1.0]);
    CurveData { degree: 3, knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], control_points, weights }
}

/// What a round did.
#[derive(Debug, Clone, PartialEq)]
enum Outcome {
    /// These changed, the first by itself, the others since they are made of it.
    Changed(Vec<EntityId>),
    Added(EntityId),
    Removed(EntityId),
    Refused,
}

fn id(model: &Model, random: &mut Random) -> EntityId {
    model.entities()[random.count(0, model.len() - 1)].id()
}

fn steps(model: &Model, id: EntityId) -> usize {
    let record = model.entity(id).and_then(|entity| entity.record());
    record.and_then(Record::making).and_then(|making| making.last().map(|step| step.inputs.len())).unwrap_or_default()
}

fn round(model: &mut Model, random: &mut Random) -> Outcome {
    let rebuilt = |result: Result<Vec<EntityId>, RebuildError>| match result {
        Ok(changed) => Outcome::Changed(changed),
        Err(_) => Outcome::Refused,
    };
    match random.count(0, 9) {
        0..=3 => {
            let id = id(model, random);
            let inputs = steps(model, id);
            let operation = operation(random, inputs);
            rebuilt(model.edit(id, operation))
        }
        4 => {
            let (id, inputs) = (id(model, random), random.count(0, 2));
            let (operation, inputs) = (operation(random, inputs), inputs_of(model, random, inputs));
            rebuilt(model.remake(id, operation, &inputs))
        }
        5 => {
            let at = id(model, random);
            let before: Vec<_> = model.entities().iter().map(|entity| Arc::clone(entity.definition())).collect();
            let replaced = if random.chance(0.5) {
                model.replace(at, data(random))
            } else {
                model.replace(at, Line { start: 4.0 * random.in_cube(), end: 4.0 * random.in_cube() })
            };
            match replaced {
                Ok(()) => {
                    let others = model
                        .entities()
                        .iter()
                        .zip(&before)
                        .filter(|(entity, before)| entity.id() != at && !Arc::ptr_eq(entity.definition(), before));
                    let changed = std::iter::once(at).chain(others.map(|(entity, _)| entity.id()));
                    Outcome::Changed(changed.collect())
                }
                Err(EditError::Definition { .. } | EditError::Rebuild(_)) => Outcome::Refused,
                Err(error) => panic!("{error}"),
            }
        }
        6 => {
            let id = id(model, random);
            rebuilt(model.rebuild(id))
        }
        7 | 8 if model.len() < 24 => {
            let inputs = random.pick(&[0, 1, 1, 1, 2, 3]);
            let (operation, inputs) = (operation(random, inputs), inputs_of(model, random, inputs));
            model.make("made", operation, &inputs).map_or(Outcome::Refused, Outcome::Added)
        }
        _ => {
            let id = id(model, random);
            if model.len() < 8 {
                return Outcome::Refused;
            }
            model.remove(id).map_or(Outcome::Refused, |_| Outcome::Removed(id))
        }
    }
}

fn inputs_of(model: &Model, random: &mut Random, count: usize) -> Vec<EntityId> {
    (0..count).map(|_| if random.chance(0.03) { EntityId::new(1 << 40) } else { id(model, random) }).collect()
}

/// Fails unless an answer keeps its promises.
fn ask(model: &Model, id: EntityId, p: DVec3) {
    let definition = model.entity(id).expect("known").definition();
    let foot = model.project(id, p).expect("a valid query");
    let promised = 1e-9 * definition.size() + 32.0 * f64::EPSILON * (definition.reach() + p.abs().max_element());
    assert!(foot.gap() >= 0.0 && foot.gap() <= promised, "{id}: gap {:e} of {promised:e}", foot.gap());
    let there = match (definition.as_ref(), foot.parameter) {
        (Definition::NurbsCurve(curve), Parameter::Curve(u)) => curve.point(u),
        (Definition::NurbsSurface(surface), Parameter::Surface(u, v)) => surface.point(u, v),
        (_, parameter) => panic!("{parameter:?}"),
    };
    assert_eq!(there, foot.point);
}

/// What holds for every model, whatever was done to it.
fn check(model: &Model) {
    for entity in model.entities() {
        assert_eq!(entity.stale(), Vec::<String>::new());
        let Some(record) = entity.record() else { continue };
        assert_eq!(record.validate(), Ok(()));
        for (field, target) in record.references() {
            assert!(model.entity(target).is_some(), "{field} is {target}");
        }
        // what is made is what making it gives, unless it was replaced by hand
        if let Ok(replay) = model.replay(entity.id())
            && !replay.is_overridden
        {
            assert_eq!(&replay.definition, entity.definition().as_ref(), "entity {}", entity.id());
            assert_eq!(replay.drift.proven, 0.0);
        }
    }
}

#[test]
fn ten_thousand_rounds_keep_every_invariant() {
    let mut random = Random::new(2013);
    let mut model = Model::new();
    while model.len() < 6 {
        let _ = model.make("first", operation(&mut random, 0), &[]);
    }
    let mut given: BTreeSet<EntityId> = model.entities().iter().map(|entity| entity.id()).collect();
    let (mut rebuilt, mut refused, mut overridden) = (0, 0, 0);
    for k in 0..10_000 {
        let before = model.clone();
        let outcome = round(&mut model, &mut random);
        match &outcome {
            Outcome::Refused => {
                refused += 1;
                assert_eq!(model, before, "round {k}");
                if refused % 4 == 0 {
                    assert_eq!(model.to_ron(), before.to_ron(), "round {k}: byte for byte");
                }
                for (entity, before) in model.entities().iter().zip(before.entities()) {
                    assert!(Arc::ptr_eq(entity.definition(), before.definition()), "round {k}");
                }
            }
            Outcome::Changed(changed) => {
                rebuilt += changed.len() - 1;
                let listed = before.impact(changed[0]).expect("known");
                for entity in model.entities() {
                    let old = before.entity(entity.id()).expect("nothing was added");
                    let is_changed = changed.contains(&entity.id());
                    assert_eq!(entity.revision(), old.revision() + u64::from(is_changed), "round {k}: {}", entity.id());
                    assert!(is_changed || Arc::ptr_eq(entity.definition(), old.definition()), "round {k}");
                }
                // all that changed was listed as what an edit would touch; what was replaced by hand is as it was
                for id in &changed[1..] {
                    assert!(listed.iter().any(|one| one.id == *id && one.effect == Effect::Rebuilt), "round {k}: {id}");
                }
                overridden += listed.iter().filter(|one| one.effect == Effect::Overridden).count();
                for id in changed {
                    ask(&model, *id, 6.0 * random.in_cube());
                }
            }
            Outcome::Added(id) => {
                assert!(given.insert(*id), "round {k}: the id {id} was given before");
                ask(&model, *id, 6.0 * random.in_cube());
            }
            Outcome::Removed(id) => assert!(model.entity(*id).is_none()),
        }
        assert!(model.next_id() >= before.next_id());
        if k % 20 == 0 {
            check(&model);
            let foot = model.nearest(6.0 * random.in_cube(), &QueryOptions::default()).expect("a valid query");
            assert!(foot.is_some());
        }
        if k % 500 == 0 {
            let read = Model::from_ron(&model.to_ron()).expect("what was edited can be read");
            assert_eq!(read, model);
        }
    }
    check(&model);
    assert!(rebuilt > 1_000 && refused > 1_000 && overridden > 100, "{rebuilt} {refused} {overridden}");
}
