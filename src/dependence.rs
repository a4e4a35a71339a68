//! Which entities are made of which.

use std::collections::HashMap;

use perpend_kernel::EntityId;
use perpend_knowledge::Record;

use crate::entity::Entity;

/// Which entities are made of which, by their places in a model.
#[derive(Debug)]
pub(crate) struct Dependence {
    made_from: Vec<Vec<usize>>,
    makes: Vec<Vec<usize>>,
}

impl Dependence {
    /// Of entities whose references all resolve.
    pub(crate) fn of(entities: &[Entity], index: &HashMap<EntityId, usize>) -> Self {
        let made_from: Vec<Vec<usize>> = entities
            .iter()
            .map(|entity| {
                // a face that trims another entity follows that alone, whatever its record says of its making
                let from = match entity.carrier() {
                    Some(carrier) => vec![carrier],
                    None => entity.record.as_ref().map_or_else(Vec::new, Record::made_from),
                };
                from.iter().filter_map(|id| index.get(id).copied()).collect()
            })
            .collect();
        let mut makes = vec![Vec::new(); entities.len()];
        for (at, from) in made_from.iter().enumerate() {
            from.iter().for_each(|input| makes[*input].push(at));
        }
        Self { made_from, makes }
    }

    /// Of what an entity is made.
    pub(crate) fn made_from(&self, at: usize) -> &[usize] {
        &self.made_from[at]
    }

    /// All entities that are made of one, directly or through others, each after all of them that it is made of.
    pub(crate) fn after(&self, start: usize) -> Vec<usize> {
        let mut order = Vec::new();
        let mut met = vec![false; self.makes.len()];
        met[start] = true;
        // depth first; an entity is done after all that are made of it. The last are looked at first, so that the order is
        // that of the file where dependence leaves a choice.
        let mut open = vec![(start, self.makes[start].len())];
        while let Some((at, left)) = open.last_mut() {
            if *left == 0 {
                order.push(*at);
                open.pop();
                continue;
            }
            *left -= 1;
            let next = self.makes[*at][*left];
            if !met[next] {
                met[next] = true;
                open.push((next, self.makes[next].len()));
            }
        }
        order.pop();
        order.reverse();
        order
    }

    /// The way by which `start` would be made of itself if it were made of `inputs`: from it over what is made of it to one of
    /// the inputs; none where it would not.
    pub(crate) fn circle(&self, start: usize, inputs: &[usize]) -> Option<Vec<usize>> {
        let mut before: HashMap<usize, usize> = HashMap::new();
        let mut open = vec![start];
        let mut found = inputs.contains(&start).then_some(start);
        while let (None, Some(at)) = (found, open.pop()) {
            for next in &self.makes[at] {
                if *next != start && !before.contains_key(next) {
                    before.insert(*next, at);
                    open.push(*next);
                    if inputs.contains(next) {
                        found = Some(*next);
                        break;
                    }
                }
            }
        }
        let mut way = vec![found?];
        while let Some(at) = way.last().and_then(|at| before.get(at)) {
            way.push(*at);
        }
        way.reverse();
        Some(way)
    }

    /// Entities each of which is made of the one before it, and the first of the last.
    pub(crate) fn any_circle(&self) -> Option<Vec<usize>> {
        #[derive(Clone, Copy, PartialEq)]
        enum State {
            New,
            Open,
            Done,
        }
        let mut states = vec![State::New; self.makes.len()];
        for start in 0..self.makes.len() {
            if states[start] != State::New {
                continue;
            }
            states[start] = State::Open;
            let mut open = vec![(start, 0)];
            while let Some((at, next)) = open.last_mut() {
                let at = *at;
                let Some(following) = self.makes[at].get(*next).copied() else {
                    states[at] = State::Done;
                    open.pop();
                    continue;
                };
                *next += 1;
                match states[following] {
                    State::New => {
                        states[following] = State::Open;
                        open.push((following, 0));
                    }
                    State::Open => {
                        let way = open.iter().map(|(at, _)| *at);
                        return Some(way.skip_while(|at| *at != following).collect());
                    }
                    State::Done => {}
                }
            }
        }
        None
    }
}

/// Ids as the message of an error shows a circle of them.
pub(crate) fn shown(circle: &[EntityId]) -> String {
    let ids = circle.iter().chain(circle.first()).map(ToString::to_string);
    ids.collect::<Vec<_>>().join(" -> ")
}
