//! Typed access to the entities of a file, with a budget for how often they may be used.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use step_io::parser::{Attribute, RawEntity, RawEntityPart};

use crate::source::NotUnderstood;

/// How deep references of one kind are followed: curves of curves, surfaces of surfaces, assemblies of assemblies. Real files stay below 20.
pub(super) const MAX_DEPTH: usize = 100;

/// A part of a file that was understood, or what was not.
pub(super) type Understood<T> = Result<T, NotUnderstood>;

/// Why the reading as a whole must end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Halt {
    /// It was told to stop.
    Stopped,
    /// The budget is spent at this entity.
    Spent(u64),
    /// No more may be kept at this entity.
    Full(u64),
}

/// The entities of a file.
pub(super) struct Entities {
    all: BTreeMap<u64, RawEntity>,
    /// How many entities and control points may still be read, each as often as it is used.
    budget: Cell<u64>,
    /// How many pieces of bodies may still be kept.
    room: Cell<u64>,
    halt: Cell<Option<Halt>>,
    stop: Arc<AtomicBool>,
}

impl Entities {
    pub(super) fn new(all: BTreeMap<u64, RawEntity>, budget: u64, room: u64, stop: Arc<AtomicBool>) -> Self {
        Self { all, budget: Cell::new(budget), room: Cell::new(room), halt: Cell::new(None), stop }
    }

    /// All entities in the order of their numbers.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u64, &RawEntity)> {
        self.all.iter().map(|(id, raw)| (*id, raw))
    }

    /// Pays for work at an entity; an error once the reading must end, which [`halt`](Self::halt) then tells from others.
    pub(super) fn spend(&self, id: u64, pieces: usize) -> Understood<()> {
        let left = self.budget.get().checked_sub(pieces as u64);
        if self.halt.get().is_none() {
            if left.is_none() {
                self.halt.set(Some(Halt::Spent(id)));
            } else if self.stop.load(Ordering::Relaxed) {
                self.halt.set(Some(Halt::Stopped));
            }
        }
        self.budget.set(left.unwrap_or(0));
        if self.halt.get().is_some() { Err(self.refuse(id, "the reading ended here".to_owned())) } else { Ok(()) }
    }

    /// Pays for what is kept of an entity; an error once there is no room left, and the reading must end.
    pub(super) fn keep(&self, id: u64, pieces: usize) -> Understood<()> {
        self.spend(id, pieces)?;
        let left = self.room.get().checked_sub(pieces as u64);
        self.room.set(left.unwrap_or(0));
        if left.is_some() {
            return Ok(());
        }
        self.halt.set(Some(Halt::Full(id)));
        Err(self.refuse(id, "the reading ended here".to_owned()))
    }

    /// Why the reading as a whole must end, if it must.
    pub(super) fn halt(&self) -> Option<Halt> {
        self.halt.get()
    }

    /// What an entity is, in the file's terms.
    pub(super) fn keyword(&self, id: u64) -> String {
        match self.all.get(&id) {
            Some(RawEntity::Simple { name, .. }) => name.clone(),
            Some(RawEntity::Complex { parts, .. }) => {
                parts.iter().map(|part| part.name.as_str()).collect::<Vec<_>>().join("+")
            }
            None => "(absent)".to_owned(),
        }
    }

    /// Whether an entity is of a kind, alone or among others.
    pub(super) fn is(&self, id: u64, kinds: &[&str]) -> bool {
        match self.all.get(&id) {
            Some(RawEntity::Simple { name, .. }) => kinds.contains(&name.as_str()),
            Some(RawEntity::Complex { parts, .. }) => parts.iter().any(|part| kinds.contains(&part.name.as_str())),
            None => false,
        }
    }

    /// An entity of one keyword, with all its values.
    pub(super) fn simple(&self, id: u64) -> Option<Values<'_>> {
        match self.all.get(&id) {
            Some(RawEntity::Simple { name, attributes, .. }) => Some(Values { id, keyword: name, list: attributes }),
            _ => None,
        }
    }

    /// An entity of one keyword among these.
    pub(super) fn simple_of(&self, id: u64, kinds: &[&str]) -> Option<Values<'_>> {
        self.simple(id).filter(|values| kinds.contains(&values.keyword))
    }

    /// The values of one kind in an entity of several keywords.
    pub(super) fn part(&self, id: u64, kind: &str) -> Option<Values<'_>> {
        self.parts(id).iter().find(|part| part.name == kind).map(|part| Values {
            id,
            keyword: &part.name,
            list: &part.attributes,
        })
    }

    /// All kinds of an entity of several keywords.
    pub(super) fn parts(&self, id: u64) -> &[RawEntityPart] {
        match self.all.get(&id) {
            Some(RawEntity::Complex { parts, .. }) => parts,
            _ => &[],
        }
    }

    /// An entity that was left out.
    pub(super) fn refuse(&self, id: u64, reason: String) -> NotUnderstood {
        NotUnderstood { entity: id, keyword: self.keyword(id), reason }
    }

    /// An entity whose kind is not one that may stand there.
    pub(super) fn unexpected(&self, id: u64, expected: &str) -> NotUnderstood {
        let reason = if self.all.contains_key(&id) {
            format!("this kind is not read as {expected}")
        } else {
            format!("the file lacks this entity, which stands for {expected}")
        };
        self.refuse(id, reason)
    }
}

/// The values of an entity.
#[derive(Clone, Copy)]
pub(super) struct Values<'a> {
    pub(super) id: u64,
    pub(super) keyword: &'a str,
    list: &'a [Attribute],
}

impl<'a> Values<'a> {
    pub(super) fn get(&self, index: usize) -> Option<&'a Attribute> {
        self.list.get(index)
    }

    /// This entity, left out for what its value is not.
    fn wanted<T>(&self, index: usize, what: &str) -> Understood<T> {
        Err(self.refuse(format!("value {} is not {what}", index + 1)))
    }

    pub(super) fn refuse(&self, reason: String) -> NotUnderstood {
        NotUnderstood { entity: self.id, keyword: self.keyword.to_owned(), reason }
    }

    pub(super) fn reference(&self, index: usize) -> Understood<u64> {
        match self.get(index) {
            Some(Attribute::EntityRef(id)) => Ok(*id),
            _ => self.wanted(index, "a reference to an entity"),
        }
    }

    pub(super) fn real(&self, index: usize) -> Understood<f64> {
        self.get(index).and_then(real).map_or_else(|| self.wanted(index, "a number"), Ok)
    }

    /// A number above zero.
    pub(super) fn positive(&self, index: usize) -> Understood<f64> {
        let value = self.real(index)?;
        if value > 0.0 { Ok(value) } else { self.wanted(index, &format!("positive: it is {value}")) }
    }

    pub(super) fn count(&self, index: usize) -> Understood<usize> {
        match self.get(index) {
            Some(Attribute::Integer(value)) => usize::try_from(*value).or_else(|_| self.wanted(index, "a count")),
            _ => self.wanted(index, "a count"),
        }
    }

    pub(super) fn flag(&self, index: usize) -> Understood<bool> {
        match self.get(index) {
            Some(Attribute::Enum(value)) if value == "T" => Ok(true),
            Some(Attribute::Enum(value)) if value == "F" => Ok(false),
            _ => self.wanted(index, ".T. or .F."),
        }
    }

    /// A text; the empty one where there is none.
    pub(super) fn text(&self, index: usize) -> &'a str {
        match self.get(index) {
            Some(Attribute::String(text)) => text.trim(),
            _ => "",
        }
    }

    pub(super) fn list(&self, index: usize) -> Understood<&'a [Attribute]> {
        match self.get(index) {
            Some(Attribute::List(list)) => Ok(list),
            _ => self.wanted(index, "a list"),
        }
    }

    pub(super) fn references(&self, index: usize) -> Understood<Vec<u64>> {
        self.references_of(index, self.list(index)?)
    }

    pub(super) fn references_of(&self, index: usize, list: &[Attribute]) -> Understood<Vec<u64>> {
        list.iter()
            .map(|value| match value {
                Attribute::EntityRef(id) => Ok(*id),
                _ => self.wanted(index, "a list of references"),
            })
            .collect()
    }

    pub(super) fn reals(&self, index: usize) -> Understood<Vec<f64>> {
        self.reals_of(index, self.list(index)?)
    }

    pub(super) fn reals_of(&self, index: usize, list: &[Attribute]) -> Understood<Vec<f64>> {
        list.iter().map(|value| real(value).map_or_else(|| self.wanted(index, "a list of numbers"), Ok)).collect()
    }

    pub(super) fn counts(&self, index: usize) -> Understood<Vec<usize>> {
        let count = |value: &Attribute| match value {
            Attribute::Integer(value) => usize::try_from(*value).ok(),
            _ => None,
        };
        let list = self.list(index)?;
        list.iter().map(|value| count(value).map_or_else(|| self.wanted(index, "a list of counts"), Ok)).collect()
    }

    /// A list of lists.
    pub(super) fn rows(&self, index: usize) -> Understood<Vec<&'a [Attribute]>> {
        let list = self.list(index)?;
        list.iter()
            .map(|row| match row {
                Attribute::List(row) => Ok(row.as_slice()),
                _ => self.wanted(index, "a list of lists"),
            })
            .collect()
    }
}

/// A number, with or without the name of its kind.
pub(super) fn real(value: &Attribute) -> Option<f64> {
    match value {
        Attribute::Real(value) => Some(*value),
        Attribute::Integer(value) => Some(*value as f64),
        Attribute::Typed { value, .. } => match &**value {
            Attribute::Real(value) => Some(*value),
            Attribute::Integer(value) => Some(*value as f64),
            _ => None,
        },
        _ => None,
    }
}
