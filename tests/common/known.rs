//! Records of all that can be known, and of less.

use perpend::knowledge::AcquireOptions;
use perpend::{Definition, EditError, Model, Record};
use serde_json::Value;

/// A definition alone in its model, with this record.
pub fn with_record(definition: &Definition, record: Option<Record>) -> Result<Model, EditError> {
    let mut model = Model::new();
    let id = model.insert("known", definition.clone()).expect("valid");
    if let Some(record) = record {
        model.set_record(id, record)?;
    }
    Ok(model)
}

/// All that is learned of a definition: its class, and how its parametrisation behaves.
pub fn known(definition: &Definition) -> Record {
    let mut record = Record::default();
    assert!(record.learn(definition, &AcquireOptions::default()), "of nothing, all is learned");
    record
}

/// The record without each of its items in turn, with the name of what it lacks: a part, a field of a part, an entry of a list.
pub fn without_each_item(record: &Record) -> Vec<(String, Record)> {
    let json = serde_json::to_value(record).expect("a record has a form in JSON");
    let mut less = Vec::new();
    let mut keep = |name: String, json: Value| {
        let record = serde_json::from_value(json).unwrap_or_else(|e| panic!("without {name}: {e}"));
        less.push((name, record));
    };
    let fields =
        |json: &Value| -> Vec<String> { json.as_object().map_or_else(Vec::new, |part| part.keys().cloned().collect()) };
    for part in ["classification", "representation"] {
        if json[part].is_null() {
            continue;
        }
        let mut bare = json.clone();
        bare[part].take();
        keep(part.to_owned(), bare);
        for field in fields(&json[part]) {
            let name = format!("{part}.{field}");
            if let Some(list) = json[part][&field].as_array() {
                for k in 0..list.len() {
                    let mut bare = json.clone();
                    bare[part][&field].as_array_mut().expect("a list").remove(k);
                    keep(format!("{name}[{k}]"), bare);
                }
            }
            let mut bare = json.clone();
            bare[part].as_object_mut().expect("a part").remove(&field);
            keep(name, bare);
        }
    }
    less
}
