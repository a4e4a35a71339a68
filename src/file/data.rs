//! From the text of a file to a model.

use std::collections::HashMap;
use std::sync::Arc;

use perpend_kernel::EntityId;
use perpend_knowledge::Record;
use serde::Deserialize;

use crate::body::{Body, check, is_colour};
use crate::dependence::Dependence;
use crate::entity::{Entity, EntityData, EntityError};
use crate::file::error::{InvalidModel, ModelError};
use crate::file::outline::{Outline, line_at};
use crate::file::syntax;
use crate::model::Model;
use crate::referent::Referent;
use crate::trimmed::InvalidTrimmedSurface;
use crate::trust::Trust;
use crate::units::Units;
use crate::written::Form;

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
    let parts = Parts::of(data.entities, trust, &lines)?;
    let Parts { entities, places, bodies } = parts;
    let ids: HashMap<EntityId, usize> = entities.iter().enumerate().map(|(at, entity)| (entity.id, at)).collect();
    for (at, entity) in entities.iter().enumerate() {
        let references = entity.record.as_ref().map_or_else(Vec::new, Record::references);
        if let Some((field, target)) = references.into_iter().find(|(_, target)| !ids.contains_key(target)) {
            return Err(lines.wrong(places[at], entity.id, InvalidModel::DanglingReference { field, target }));
        }
    }
    if let Some(circle) = Dependence::of(&entities, &ids).any_circle() {
        let circle_ids = circle.iter().map(|at| entities[*at].id).collect();
        let problem = InvalidModel::Cycle { circle: circle_ids };
        return Err(lines.wrong(places[circle[0]], entities[circle[0]].id, problem));
    }
    let highest = entities.iter().map(Entity::id).chain(bodies.iter().map(Body::id)).max();
    let next_id = match (data.next_id, highest) {
        (Some(next_id), Some(highest)) if next_id <= highest.get() => {
            let line = lines.outline.next_id.as_ref().map_or(1, |value| line_at(text, value.start));
            let problem = InvalidModel::NextId { next_id, highest };
            return Err(ModelError { line, column: None, index: None, entity: None, problem });
        }
        (Some(next_id), _) => next_id,
        (None, highest) => highest.map_or(1, |id| id.get() + 1),
    };
    Ok(Model::from_parts(data.units, next_id, entities, bodies))
}

/// What a file holds, validated.
struct Parts {
    /// In the order of the file.
    entities: Vec<Entity>,
    /// Where each of them stands in the file.
    places: Vec<usize>,
    /// In the order of the file.
    bodies: Vec<Body>,
}

impl Parts {
    /// Validates what a file holds. What names others comes after those, wherever it stands.
    fn of(data: Vec<EntityData>, trust: Trust, lines: &Lines<'_>) -> Result<Self, ModelError> {
        let mut met: HashMap<EntityId, (usize, Referent)> = HashMap::with_capacity(data.len());
        for (index, one) in data.iter().enumerate() {
            let wrong = |problem| lines.wrong(index, one.id, problem);
            if let Some((first, _)) = met.insert(one.id, (index, one.definition.referent())) {
                return Err(wrong(InvalidModel::DuplicateId { id: one.id, first: lines.of(first) }));
            }
            if one.id.get() == u64::MAX {
                return Err(wrong(InvalidModel::LastId));
            }
        }
        let referent = |id: EntityId| met.get(&id).map_or(Referent::Missing, |(_, is)| *is);
        let mut settled: Vec<Option<Entity>> = Vec::new();
        settled.resize_with(data.len(), || None);
        let (mut followers, mut bodies) = (Vec::new(), Vec::new());
        for (index, one) in data.into_iter().enumerate() {
            let id = one.id;
            let wrong = |problem| lines.wrong(index, id, problem);
            if referent(id) == Referent::Body {
                bodies.push(body(one, &referent).map_err(wrong)?);
            } else if let Some(carrier) = one.definition.carrier() {
                let is = referent(carrier);
                if is != Referent::Surface {
                    let problem = InvalidTrimmedSurface::Carrier { id: carrier, is };
                    return Err(wrong(EntityError::from(problem).into()));
                }
                followers.push((index, one));
            } else {
                let entity = Entity::settled(one, trust, &|_| None, &referent);
                settled[index] = Some(entity.map_err(|error| wrong(error.into()))?);
            }
        }
        for (index, one) in followers {
            let id = one.id;
            let carrier = |of: EntityId| {
                let (at, _) = met.get(&of)?;
                settled[*at].as_ref().map(|entity| Arc::clone(&entity.definition))
            };
            let entity = Entity::settled(one, trust, &carrier, &referent);
            settled[index] = Some(entity.map_err(|error| lines.wrong(index, id, error.into()))?);
        }
        let (places, entities) =
            settled.into_iter().enumerate().filter_map(|(index, one)| one.map(|one| (index, one))).unzip();
        Ok(Self { entities, places, bodies })
    }
}

/// Validates a body.
fn body(data: EntityData, referent: &impl Fn(EntityId) -> Referent) -> Result<Body, InvalidModel> {
    let EntityData { id, name, colour, definition, knowledge, original } = data;
    let has = [("knowledge", knowledge.is_some()), ("original", original.is_some())];
    if let Some((field, _)) = has.into_iter().find(|(_, is_there)| *is_there) {
        return Err(InvalidModel::BodyField { field });
    }
    if let Some(colour) = colour.filter(|colour| !is_colour(*colour)) {
        return Err(EntityError::Colour(colour).into());
    }
    let shells = match Form::from(definition) {
        Form::Body(shells) => shells,
        Form::Plain(_) | Form::Trimmed(..) => unreachable!("it is a body"),
    };
    check(&shells, referent)?;
    Ok(Body { id, name, shells, colour })
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
