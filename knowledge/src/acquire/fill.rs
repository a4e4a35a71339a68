//! Filling a record.

use std::collections::HashSet;

use perpend_kernel::{Definition, Fingerprint};

use super::{AcquireOptions, acquire};
use crate::classification::Classification;
use crate::item::{Basis, Item};
use crate::recognise::{default_tolerance, recognise};
use crate::record::Record;
use crate::representation::Representation;

impl Record {
    /// Acquires what is absent or stale of the class and of the representation. What was declared stays as it is, stale or
    /// not: only those who stated it can say whether it still holds. Says whether anything changed.
    pub fn learn(&mut self, definition: &Definition, options: &AcquireOptions) -> bool {
        let class = self.learn_class(definition);
        self.learn_representation(definition, options) || class
    }

    /// Acquires what is stale or contradicted of the representation again ([`Record::contradictions`]). Of a list all is acquired
    /// again but what was declared and holds. Says whether anything changed.
    pub fn repair(&mut self, definition: &Definition, options: &AcquireOptions) -> bool {
        let stale = self.stale(definition.fingerprint());
        // what was done on entry cannot be acquired, and the class has a proof of its own
        let stale = stale.into_iter().filter(|field| !field.starts_with("representation.cleaning"));
        let wrong: HashSet<String> = stale
            .chain(self.contradictions(definition).into_iter().map(|wrong| wrong.field))
            .filter_map(|field| field.strip_prefix("representation.").map(str::to_owned))
            .collect();
        let Some(part) = self.representation.as_mut().filter(|_| !wrong.is_empty()) else { return false };
        let new = acquire(definition, options);
        mend_list(&mut part.speed, new.speed, "speed", &wrong);
        mend_list(&mut part.breaks, new.breaks, "breaks", &wrong);
        mend_list(&mut part.irregularities, new.irregularities, "irregularities", &wrong);
        mend(&mut part.closed, new.closed, "closed", &wrong);
        mend(&mut part.periodic, new.periodic, "periodic", &wrong);
        mend(&mut part.bounds, new.bounds, "box", &wrong);
        mend(&mut part.length, new.length, "length", &wrong);
        mend(&mut part.area, new.area, "area", &wrong);
        mend(&mut part.weights, new.weights, "weights", &wrong);
        true
    }

    fn learn_class(&mut self, definition: &Definition) -> bool {
        let of = definition.fingerprint();
        if fresh(self.classification.as_ref().and_then(|class| class.kind.as_ref()), of) {
            return false;
        }
        let class = self.classification.get_or_insert_with(Classification::default);
        class.kind = Some(recognise(definition, default_tolerance(definition)));
        true
    }

    fn learn_representation(&mut self, definition: &Definition, options: &AcquireOptions) -> bool {
        let of = definition.fingerprint();
        let old = self.representation.clone().unwrap_or_default();
        let is_curve = matches!(definition, Definition::NurbsCurve(_));
        let is_known = fresh_list(old.speed.as_ref(), of)
            && fresh_list(old.breaks.as_ref(), of)
            && fresh_list(old.irregularities.as_ref(), of)
            && fresh(old.closed.as_ref(), of)
            && fresh(old.periodic.as_ref(), of)
            && fresh(old.bounds.as_ref(), of)
            && fresh(old.weights.as_ref(), of)
            && (if is_curve { fresh(old.length.as_ref(), of) } else { fresh(old.area.as_ref(), of) });
        if is_known {
            return false;
        }
        let new = acquire(definition, options);
        self.representation = Some(Representation {
            speed: list(old.speed, new.speed, of),
            breaks: list(old.breaks, new.breaks, of),
            irregularities: list(old.irregularities, new.irregularities, of),
            closed: one(old.closed, new.closed, of),
            periodic: one(old.periodic, new.periodic, of),
            bounds: one(old.bounds, new.bounds, of),
            length: one(old.length, new.length, of),
            area: one(old.area, new.area, of),
            weights: one(old.weights, new.weights, of),
            ..old
        });
        true
    }
}

fn mend<T>(old: &mut Option<Item<T>>, new: Option<Item<T>>, name: &str, wrong: &HashSet<String>) {
    if wrong.contains(name) {
        *old = new;
    }
}

fn mend_list<T>(old: &mut Option<Vec<Item<T>>>, new: Option<Vec<Item<T>>>, name: &str, wrong: &HashSet<String>) {
    let is_wrong = |k: usize| wrong.contains(&format!("{name}[{k}]"));
    let count = old.as_ref().map_or(0, Vec::len);
    if (0..count).any(is_wrong) {
        let kept = old.take().into_iter().flatten().enumerate();
        let kept = kept.filter(|(k, item)| !is_wrong(*k) && item.basis == Basis::Declared).map(|(_, item)| item);
        *old = Some(kept.chain(new.into_iter().flatten()).collect());
    }
}

/// Whether an item is to stay.
fn stays<T>(item: &Item<T>, of: Fingerprint) -> bool {
    item.basis == Basis::Declared || !item.is_stale(of)
}

fn fresh<T>(item: Option<&Item<T>>, of: Fingerprint) -> bool {
    item.is_some_and(|item| stays(item, of))
}

/// A list of declared items alone was stated by a person; one with none, or with fresh ones, was found.
fn fresh_list<T>(items: Option<&Vec<Item<T>>>, of: Fingerprint) -> bool {
    items.is_some_and(|items| items.iter().all(|item| stays(item, of)))
}

fn one<T>(old: Option<Item<T>>, new: Option<Item<T>>, of: Fingerprint) -> Option<Item<T>> {
    if fresh(old.as_ref(), of) { old } else { new }
}

/// The old list where it stays; else the new one, after what was declared in the old one.
fn list<T>(old: Option<Vec<Item<T>>>, new: Option<Vec<Item<T>>>, of: Fingerprint) -> Option<Vec<Item<T>>> {
    if fresh_list(old.as_ref(), of) {
        return old;
    }
    let declared = old.into_iter().flatten().filter(|item| item.basis == Basis::Declared);
    Some(declared.chain(new.into_iter().flatten()).collect())
}
