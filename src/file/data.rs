//! From the text of a file to a model.

use std::collections::HashMap;

use perpend_kernel::EntityId;
use perpend_knowledge::Record;
use serde::Deserialize;

use crate::dependence::Dependence;
use crate::entity::{Entity, EntityData};
use crate::file::error::{InvalidModel, ModelError};
use crate::file::outline::{Outline, line_at};
use crate::file::syntax;
use crate::model::Model;
use crate::trust::Trust;
use crate::units::Units;

/// The format that this version reads and writes.
pub(super) const FORMAT: u64 = 1;

/// A model as a file holds it, not validated.
#[derive(Debug, Deserialize)]
#[serde(rename = "Model", deny_unknown_fields)]
struct ModelData {
    #[expect(dead_code, reason = "it is looked at before the rest is read, whose form may depend on it")]
    format: u64,
    #[serde(default)]
    units: Units,
    #[serde(default, deserialize_with = "bare")]
    next_id: Option<u64>,
    entities: Vec<EntityData>,
}

/// Reads a value that is written without `Some`.
fn bare<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Option<u64>, D::Error> {
    u64::deserialize(deserializer).map(Some)
}

/// Reads and validates a model.
pub(super) fn read(text: &str, trust: Trust) -> Result<Model, ModelError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text); // a byte order mark
    let outline = Outline::of(text);
    check_format(text, &outline)?;
    let data: ModelData = ron::from_str(text).map_err(|error| syntax::explain(text, &outline, &error))?;
    let lines = Lines { text, outline };
    let mut entities: Vec<Entity> = Vec::with_capacity(data.entities.len());
    let mut ids: HashMap<EntityId, usize> = HashMap::new();
    for (index, entity) in data.entities.into_iter().enumerate() {
        let id = entity.id;
        let wrong = |problem| lines.wrong(index, id, problem);
        if let Some(first) = ids.insert(id, index) {
            return Err(wrong(InvalidModel::DuplicateId { id, first: lines.of(first) }));
        }
        if id.get() == u64::MAX {
            return Err(wrong(InvalidModel::LastId));
        }
        entities.push(Entity::settled(entity, trust).map_err(|error| wrong(error.into()))?);
    }
    for (index, entity) in entities.iter().enumerate() {
        let references = entity.record.as_ref().map_or_else(Vec::new, Record::references);
        if let Some((field, target)) = references.into_iter().find(|(_, target)| !ids.contains_key(target)) {
            return Err(lines.wrong(index, entity.id, InvalidModel::DanglingReference { field, target }));
        }
    }
    if let Some(circle) = Dependence::of(&entities, &ids).any_circle() {
        let circle_ids = circle.iter().map(|at| entities[*at].id).collect();
        return Err(lines.wrong(circle[0], entities[circle[0]].id, InvalidModel::Cycle { circle: circle_ids }));
    }
    let highest = entities.iter().map(Entity::id).max();
    let next_id = match (data.next_id, highest) {
        (Some(next_id), Some(highest)) if next_id <= highest.get() => {
            let line = lines.outline.next_id.as_ref().map_or(1, |value| line_at(text, value.start));
            let problem = InvalidModel::NextId { next_id, highest };
            return Err(ModelError { line, column: None, index: None, entity: None, problem });
        }
        (Some(next_id), _) => next_id,
        (None, highest) => highest.map_or(1, |id| id.get() + 1),
    };
    Ok(Model::from_parts(data.units, next_id, entities))
}

/// A file of another format is named as such, and not by the first thing that is new in it.
fn check_format(text: &str, outline: &Outline) -> Result<(), ModelError> {
    let at =
        |offset, problem| ModelError { line: line_at(text, offset), column: None, index: None, entity: None, problem };
    if outline.is_empty && !outline.is_cut_off {
        return Err(at(0, InvalidModel::Empty));
    }
    let Some(range) = &outline.format else { return Ok(()) };
    let found = &text[range.clone()];
    let is_number = found.bytes().all(|byte| byte.is_ascii_digit() || b".+-_".contains(&byte));
    if is_number && found.parse() != Ok(FORMAT) {
        return Err(at(range.start, InvalidModel::Format { found: found.to_owned() }));
    }
    Ok(())
}

/// Where in the text the entities stand.
struct Lines<'a> {
    text: &'a str,
    outline: Outline,
}

impl Lines<'_> {
    /// The line where the text of an entity begins.
    fn of(&self, index: usize) -> usize {
        self.outline.entities.get(index).map_or(1, |element| line_at(self.text, element.range.start))
    }

    fn wrong(&self, index: usize, id: EntityId, problem: InvalidModel) -> ModelError {
        ModelError { line: self.of(index), column: None, index: Some(index), entity: Some(id), problem }
    }
}
