//! Products, their representations, and how occurrences and representations stand to one another.

use std::collections::{BTreeMap, HashMap, HashSet};

use step_io::parser::{Attribute, RawEntity};

use super::entities::{Entities, Values};

/// A representation: items in a context of units.
pub(super) struct Representation {
    pub(super) items: Vec<u64>,
    pub(super) context: u64,
}

/// A relation that places one representation in another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Relation {
    pub(super) id: u64,
    /// What is mapped from the first representation into the second.
    pub(super) first: u64,
    pub(super) second: u64,
    /// The entity of the map.
    pub(super) operator: u64,
}

/// A use of a product in another one.
pub(super) struct Occurrence {
    pub(super) id: u64,
    pub(super) name: String,
    pub(super) child: u64,
    /// What places it; none where the file leaves it to mapped items, or to nothing.
    pub(super) relation: Option<Relation>,
}

/// How a file is put together. Everything is in the order of the file's numbers.
#[derive(Default)]
pub(super) struct Structure {
    pub(super) representations: BTreeMap<u64, Representation>,
    /// Product definitions and the names of their products.
    pub(super) definitions: BTreeMap<u64, String>,
    /// The representations of a product definition.
    pub(super) shapes: HashMap<u64, Vec<u64>>,
    /// The product definitions of a representation.
    owners: HashMap<u64, HashSet<u64>>,
    /// Representations of the same thing in the same place.
    linked: HashMap<u64, Vec<u64>>,
    /// Representations placed in this one, without a product between.
    pub(super) placed: HashMap<u64, Vec<Relation>>,
    /// The occurrences within a product definition.
    pub(super) occurrences: HashMap<u64, Vec<Occurrence>>,
    /// Product definitions that occur in others.
    used: HashSet<u64>,
    /// Whether parts of the assembly lie in other files.
    pub(super) refers_to_files: bool,
}

impl Structure {
    pub(super) fn of(entities: &Entities) -> Self {
        let mut structure = Self::default();
        let (mut shapes, mut defined, mut relations) = (Vec::new(), HashMap::new(), HashMap::new());
        let (mut placements, mut occurrences) = (Vec::new(), Vec::new());
        for (id, raw) in entities.iter() {
            if let Some(representation) = representation(entities, id, raw) {
                structure.representations.insert(id, representation);
                continue;
            }
            if let Some(relation) = relation(entities, id, raw) {
                relations.insert(id, relation);
                continue;
            }
            let Some(values) = entities.simple(id) else { continue };
            let pair = || Some((values.reference(0).ok()?, values.reference(1).ok()?));
            match values.keyword {
                "SHAPE_DEFINITION_REPRESENTATION" | "PROPERTY_DEFINITION_REPRESENTATION" => shapes.extend(pair()),
                "PRODUCT_DEFINITION_SHAPE" => {
                    defined.extend(values.reference(2).ok().map(|definition| (id, definition)));
                }
                "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION" => placements.extend(pair()),
                "NEXT_ASSEMBLY_USAGE_OCCURRENCE" => occurrences.push(values),
                "PRODUCT_DEFINITION" | "PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS" => {
                    structure.definitions.insert(id, product_name(entities, &values));
                }
                "DOCUMENT_FILE" => structure.refers_to_files = true,
                _ => {}
            }
        }
        structure.assign(&shapes, &defined);
        structure.relate(entities, relations, &placements, &defined, &occurrences);
        structure
    }

    /// Gives representations to their product definitions.
    fn assign(&mut self, shapes: &[(u64, u64)], defined: &HashMap<u64, u64>) {
        for (shape, representation) in shapes {
            let Some(definition) = defined.get(shape) else { continue };
            if self.definitions.contains_key(definition) && self.representations.contains_key(representation) {
                let owned = self.shapes.entry(*definition).or_default();
                if !owned.contains(representation) {
                    owned.push(*representation);
                }
                self.owners.entry(*representation).or_default().insert(*definition);
            }
        }
    }

    fn relate(
        &mut self,
        entities: &Entities,
        mut relations: HashMap<u64, (u64, u64, Option<u64>)>,
        placements: &[(u64, u64)],
        defined: &HashMap<u64, u64>,
        occurrences: &[Values<'_>],
    ) {
        let mut of_occurrence = HashMap::new();
        for (id, shape) in placements {
            // the relation serves the occurrence, and must not place the representation once more
            if let (Some((first, second, Some(operator))), Some(occurrence)) =
                (relations.remove(id), defined.get(shape))
            {
                of_occurrence.entry(*occurrence).or_insert(Relation { id: *id, first, second, operator });
            }
        }
        for values in occurrences {
            let (Ok(parent), Ok(child)) = (values.reference(3), values.reference(4)) else { continue };
            if !(self.definitions.contains_key(&parent) && self.definitions.contains_key(&child)) {
                continue;
            }
            self.used.insert(child);
            // one kernel writes the path of its own tree where there is no name
            let name = Some(values.text(1)).filter(|name| !name.is_empty() && !name.starts_with("=>"));
            let name = name.map_or_else(|| self.definitions[&child].clone(), str::to_owned);
            let relation = of_occurrence.get(&values.id).copied();
            self.occurrences.entry(parent).or_default().push(Occurrence { id: values.id, name, child, relation });
        }
        let mut rest: Vec<_> = relations.into_iter().collect();
        rest.sort_unstable_by_key(|(id, _)| *id);
        for (id, (first, second, operator)) in rest {
            match operator {
                Some(operator) => {
                    self.placed.entry(second).or_default().push(Relation { id, first, second, operator });
                }
                None if entities.is(id, &["SHAPE_REPRESENTATION_RELATIONSHIP"]) => {
                    self.linked.entry(first).or_default().push(second);
                    self.linked.entry(second).or_default().push(first);
                }
                None => {}
            }
        }
    }

    /// Product definitions that occur in no other.
    pub(super) fn roots(&self) -> Vec<u64> {
        self.definitions.keys().copied().filter(|definition| !self.used.contains(definition)).collect()
    }

    /// The representations of a product definition, with those that stand for the same thing and belong to no other product.
    pub(super) fn shapes_of(&self, definition: u64) -> Vec<u64> {
        self.with_linked(self.shapes.get(&definition).cloned().unwrap_or_default(), Some(definition))
    }

    /// Representations with those that are linked to them and belong to no product, or to this one.
    pub(super) fn with_linked(&self, mut found: Vec<u64>, definition: Option<u64>) -> Vec<u64> {
        let mut seen: HashSet<u64> = found.iter().copied().collect();
        let mut next = 0;
        while next < found.len() {
            for other in self.linked.get(&found[next]).into_iter().flatten() {
                let foreign =
                    self.owners.get(other).is_some_and(|owners| definition.is_none_or(|own| !owners.contains(&own)));
                if !foreign && seen.insert(*other) {
                    found.push(*other);
                }
            }
            next += 1;
        }
        found
    }
}

/// A representation of any kind: a name, items, and a context.
fn representation(entities: &Entities, id: u64, raw: &RawEntity) -> Option<Representation> {
    let values = match raw {
        RawEntity::Simple { name, .. } if name.contains("REPRESENTATION") => entities.simple(id)?,
        RawEntity::Complex { .. } => entities.part(id, "REPRESENTATION")?,
        RawEntity::Simple { .. } => return None,
    };
    if !matches!(values.get(0), Some(Attribute::String(_) | Attribute::Unset)) {
        return None;
    }
    Some(Representation { items: values.references(1).ok()?, context: values.reference(2).ok()? })
}

/// A relation of two representations, and the map between them where there is one.
fn relation(entities: &Entities, id: u64, raw: &RawEntity) -> Option<(u64, u64, Option<u64>)> {
    match raw {
        RawEntity::Simple { name, .. } if name.contains("REPRESENTATION_RELATIONSHIP") => {
            let values = entities.simple(id)?;
            let operator = if name.ends_with("WITH_TRANSFORMATION") { values.reference(4).ok() } else { None };
            Some((values.reference(2).ok()?, values.reference(3).ok()?, operator))
        }
        RawEntity::Complex { .. } => {
            let values = entities.part(id, "REPRESENTATION_RELATIONSHIP")?;
            let operator = entities.part(id, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION");
            let operator = operator.and_then(|values| values.reference(0).ok());
            Some((values.reference(2).ok()?, values.reference(3).ok()?, operator))
        }
        RawEntity::Simple { .. } => None,
    }
}

/// The name of the product of a definition, or its identifier.
fn product_name(entities: &Entities, definition: &Values<'_>) -> String {
    let product = definition
        .reference(2)
        .ok()
        .and_then(|formation| entities.simple(formation))
        .and_then(|formation| formation.reference(2).ok())
        .and_then(|product| entities.simple_of(product, &["PRODUCT"]));
    let Some(product) = product else { return String::new() };
    let name = product.text(1);
    if name.is_empty() { product.text(0).to_owned() } else { name.to_owned() }
}
