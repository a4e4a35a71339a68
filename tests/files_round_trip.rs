//! A model's file gives back the model, bit for bit, and one model gives the same bytes always.

#[path = "files/random.rs"]
mod random;

use perpend::{Basis, Definition, Entity, EntityId, Kind, Model, Units};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn reading_what_was_written_is_the_identity(model in random::model()) {
        let text = model.to_ron();
        let back = Model::from_ron(&text).map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
        prop_assert_eq!(&back, &model);
        prop_assert_eq!(back.to_ron(), text);
        for (one, other) in model.entities().iter().zip(back.entities()) {
            // `==` takes -0.0 for 0.0; a fingerprint is made of bits
            prop_assert_eq!(one.definition().fingerprint(), other.definition().fingerprint());
        }
    }

    #[test]
    fn records_keep_every_bit(record in random::record()) {
        let text = ron::to_string(&record).expect("plain data");
        let back: perpend::Record = ron::from_str(&text).expect("what was written");
        prop_assert_eq!(ron::to_string(&back).expect("plain data"), text);
        prop_assert_eq!(back, record);
    }

    #[test]
    fn numbers_keep_every_bit(x in random::number()) {
        // a record's numbers are written by another hand than a definition's
        let mut model = Model::from_ron(include_str!("files/record.ron")).expect("valid");
        let mut record = model.entity(EntityId::new(2)).and_then(Entity::record).expect("a record").clone();
        record.classification.as_mut().and_then(|part| part.kind.as_mut()).expect("a kind").tolerance = x;
        model.set_record(EntityId::new(2), record).expect("valid");
        let back = Model::from_ron(&model.to_ron()).expect("valid");
        let record = back.entity(EntityId::new(2)).and_then(Entity::record).expect("a record");
        let kind = record.classification.as_ref().and_then(|part| part.kind.as_ref()).expect("a kind");
        prop_assert_eq!(kind.tolerance.to_bits(), x.to_bits());
    }

    #[test]
    fn an_application_can_hold_entities_in_its_own_files(model in random::model()) {
        // a face that names another entity is nothing without that
        let entities: Vec<Entity> = model.entities().iter().filter(|one| one.carrier().is_none()).cloned().collect();
        let text = ron::to_string(&entities).expect("plain data");
        let back: Vec<Entity> = ron::from_str(&text).expect("what was written");
        prop_assert_eq!(back, entities);
    }
}

#[test]
fn the_example_of_the_format_reads_as_it_says() {
    let model = Model::from_ron(include_str!("files/record.ron")).expect("valid");
    assert_eq!(model.units(), Units::Millimetre);
    assert_eq!(model.next_id(), EntityId::new(5));
    let ids: Vec<u64> = model.named("rim").map(|entity| entity.id().get()).collect();
    assert_eq!(ids, [1, 4]);
    let entity = model.entity(EntityId::new(2)).expect("entity 2");
    let record = entity.record().expect("a record");
    assert_eq!(record.revision, 3);
    let kind = record.classification.as_ref().and_then(|part| part.kind.as_ref()).expect("a kind");
    assert!(matches!(kind.value, Kind::Cylinder { radius: 1.5, .. }));
    assert_eq!(kind.basis, Basis::Proved { gap: 2e-16 });
    assert_eq!(
        entity.stale(),
        [
            "classification.kind",
            "representation.speed[0]",
            "representation.breaks[0]",
            "representation.irregularities[0]",
            "representation.closed"
        ]
    );
}

#[test]
fn the_layout_of_a_written_file_is_the_golden_one() {
    let model = Model::from_ron(include_str!("files/record.ron")).expect("valid");
    assert_eq!(model.to_ron(), include_str!("files/record.written.ron"));
    let net = Model::from_ron(include_str!("files/net.written.ron")).expect("valid");
    assert_eq!(net.to_ron(), include_str!("files/net.written.ron"));
    assert!(matches!(net.entities()[1].definition().as_ref(), Definition::NurbsSurface(_)));
}

#[test]
fn what_may_be_left_out_or_named_may_be() {
    let full = "Model(format: 1, units: Inch, next_id: 8, entities: [Entity(id: 7, name: \"a\", definition: NurbsCurve(degree: 1, \
                knots: [0.0, 0.0, 1.0, 1.0], control_points: [DVec3(0.0, 0.0, 0.0), DVec3(1.0, 0.0, 0.0)], weights: None), \
                knowledge: None)])";
    let model = Model::from_ron(full).expect("valid");
    let same = [
        // struct names left out, integers for floats, `weights` and `knowledge` left out, `next_id` too
        "(format: 1, units: Inch, entities: [(id: 7, name: \"a\", definition: NurbsCurve(degree: 1, knots: [0, 0, 1, 1], \
         control_points: [(0, 0, 0), (1, 0, 0)]))])",
        // another order, a byte order mark, comments anywhere
        "\u{feff}// a model\n(entities: [/* the /* only */ one */ (knowledge: None, definition: NurbsCurve(control_points: \
         [(0, 0, 0), (1, 0, 0)], knots: [0, 0, 1, 1], degree: 1), id: 7, name: r#\"a\"#,)], next_id: 8, units: Inch, format: 1,)",
    ];
    for text in same {
        assert_eq!(Model::from_ron(text).as_ref().map_err(ToString::to_string), Ok(&model), "{text}");
    }
    let empty = Model::from_ron("(format: 1, entities: [])").expect("valid");
    assert_eq!(empty, Model::new());
    assert_eq!(Model::from_ron(&empty.to_ron()), Ok(empty));
}

#[test]
fn the_id_0_is_an_id() {
    let text = include_str!("files/record.ron").replace("id: 1,\n", "id: 0,\n");
    let model = Model::from_ron(&text).expect("valid");
    assert_eq!(model.entity(EntityId::new(0)).map(Entity::name), Some("rim"));
}
