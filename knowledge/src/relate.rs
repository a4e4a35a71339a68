//! Operations as relationships: what an entity is to those that it was made of, with all that running the operation needs.

use std::collections::BTreeMap;

use perpend_kernel::{Direction, EntityId};

use crate::intent::Intent;
use crate::operation::Operation;
use crate::relationship::{Relation, Relationship, Value};

/// The parameter that names the operation.
const OPERATION: &str = "operation";
/// The parameter that says which input it is, where there are several.
const PLACE: &str = "place";

impl Intent {
    /// The relationships to the entities that the step worked on, with all parameters that running it again needs.
    #[must_use]
    pub fn relationships(&self) -> Vec<Relationship> {
        let (kind, mut parameters) = edge(&self.operation);
        parameters.insert(OPERATION.to_owned(), Value::Text(self.operation.name().to_owned()));
        let several = self.inputs.len() > 1;
        let one = |(place, target): (usize, &EntityId)| {
            let mut parameters = parameters.clone();
            if several {
                parameters.insert(PLACE.to_owned(), Value::Number(place as f64));
            }
            Relationship { kind: kind.clone(), target: *target, parameters, checked: None }
        };
        self.inputs.iter().enumerate().map(one).collect()
    }
}

impl Relationship {
    /// Whether the relationship says which operation it belongs to.
    #[must_use]
    pub fn is_of_operation(&self) -> bool {
        self.parameters.contains_key(OPERATION)
    }
}

fn edge(operation: &Operation) -> (Relation, BTreeMap<String, Value>) {
    let (kind, parameters): (Relation, Vec<(&str, Value)>) = match operation {
        Operation::Extrude { vector } => (Relation::Profile, vec![("vector", Value::Point(*vector))]),
        Operation::Revolve { origin, axis, angle } => (
            Relation::Profile,
            vec![("origin", Value::Point(*origin)), ("axis", Value::Point(*axis)), ("angle", Value::Number(*angle))],
        ),
        Operation::Rule => (Relation::Rail, Vec::new()),
        Operation::Loft { degree } => (Relation::Section, vec![("degree", Value::Number(f64::from(*degree)))]),
        Operation::Offset { distance, normal } => {
            let mut parameters = vec![("distance", Value::Number(*distance))];
            parameters.extend(normal.map(|normal| ("normal", Value::Point(normal))));
            (Relation::Offset, parameters)
        }
        Operation::IsoCurve { direction, at } => {
            (Relation::IsoCurveOf, vec![("direction", name(*direction)), ("at", Value::Number(*at))])
        }
        Operation::Split { direction, range } => {
            (Relation::PartOf, vec![("direction", name(*direction)), ("range", Value::Numbers(vec![range.0, range.1]))])
        }
        Operation::Transform { columns, translation } => (
            Relation::CopyOf,
            vec![
                ("x", Value::Point(columns.0)),
                ("y", Value::Point(columns.1)),
                ("z", Value::Point(columns.2)),
                ("translation", Value::Point(*translation)),
            ],
        ),
        Operation::Approximation { degree, points, tolerance } => (
            Relation::FittedTo,
            vec![
                ("degree", Value::Numbers(vec![f64::from(degree.0), f64::from(degree.1)])),
                ("points", Value::Number(*points as f64)),
                ("tolerance", Value::Number(*tolerance)),
            ],
        ),
        Operation::Other { name } => (Relation::Other(name.clone()), Vec::new()),
        // all others take no entities
        _ => (Relation::Definition, Vec::new()),
    };
    (kind, parameters.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
}

fn name(direction: Direction) -> Value {
    Value::Text(match direction {
        Direction::U => "U".to_owned(),
        Direction::V => "V".to_owned(),
    })
}

/// The operation and the inputs of which relationships speak; none where they do not name one, or not all of its parameters.
pub(crate) fn operation(relationships: &[Relationship]) -> Option<(Operation, Vec<EntityId>)> {
    let mut edges: Vec<&Relationship> = relationships.iter().filter(|edge| edge.is_of_operation()).collect();
    let place = |edge: &Relationship| match edge.parameters.get(PLACE) {
        Some(Value::Number(place)) => *place,
        _ => 0.0,
    };
    edges.sort_by(|a, b| place(a).total_cmp(&place(b)));
    let first = edges.first()?;
    let alike = |edge: &&Relationship| {
        let own = |edge: &Relationship| {
            let mut parameters = edge.parameters.clone();
            parameters.remove(PLACE);
            parameters
        };
        edge.kind == first.kind && own(edge) == own(first)
    };
    let is_one =
        edges.iter().all(alike) && (edges.len() == 1 || edges.windows(2).all(|two| place(two[0]) < place(two[1])));
    let operation = read(first).filter(|_| is_one)?;
    Some((operation, edges.iter().map(|edge| edge.target).collect()))
}

fn read(edge: &Relationship) -> Option<Operation> {
    let parameter = |name: &str| edge.parameters.get(name);
    let point = |name: &str| match parameter(name)? {
        Value::Point(point) => Some(*point),
        _ => None,
    };
    let number = |name: &str| match parameter(name)? {
        Value::Number(number) => Some(*number),
        _ => None,
    };
    let pair = |name: &str| match parameter(name)? {
        Value::Numbers(numbers) => <[f64; 2]>::try_from(numbers.as_slice()).ok().map(|[a, b]| (a, b)),
        _ => None,
    };
    let direction = || match parameter("direction")? {
        Value::Text(name) if name == "U" => Some(Direction::U),
        Value::Text(name) if name == "V" => Some(Direction::V),
        _ => None,
    };
    let Some(Value::Text(name)) = parameter(OPERATION) else { return None };
    Some(match (name.as_str(), &edge.kind) {
        ("Extrude", Relation::Profile) => Operation::Extrude { vector: point("vector")? },
        ("Revolve", Relation::Profile) => {
            Operation::Revolve { origin: point("origin")?, axis: point("axis")?, angle: number("angle")? }
        }
        ("Rule", Relation::Rail) => Operation::Rule,
        ("Loft", Relation::Section) => Operation::Loft { degree: count(number("degree")?)? },
        ("Offset", Relation::Offset) => Operation::Offset { distance: number("distance")?, normal: point("normal") },
        ("IsoCurve", Relation::IsoCurveOf) => Operation::IsoCurve { direction: direction()?, at: number("at")? },
        ("Split", Relation::PartOf) => Operation::Split { direction: direction()?, range: pair("range")? },
        ("Transform", Relation::CopyOf) => Operation::Transform {
            columns: (point("x")?, point("y")?, point("z")?),
            translation: point("translation")?,
        },
        ("Approximation", Relation::FittedTo) => {
            let degree = pair("degree")?;
            Operation::Approximation {
                degree: (count(degree.0)?, count(degree.1)?),
                points: number("points")? as u64,
                tolerance: number("tolerance")?,
            }
        }
        ("Other", Relation::Other(name)) => Operation::Other { name: name.clone() },
        _ => return None,
    })
}

/// A number that is a count.
fn count(number: f64) -> Option<u32> {
    let whole = number as u32;
    (f64::from(whole) == number).then_some(whole)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn relationships_hold_all_that_running_the_operation_needs() {
        let (x, y, z) = (DVec3::new(0.5, 1.0, -2.0), DVec3::Y, DVec3::Z);
        let operations = [
            (Operation::Extrude { vector: x }, 1),
            (Operation::Revolve { origin: x, axis: y, angle: 0.1 }, 1),
            (Operation::Rule, 2),
            (Operation::Loft { degree: 3 }, 5),
            (Operation::Offset { distance: -0.25, normal: None }, 1),
            (Operation::Offset { distance: 0.25, normal: Some(z) }, 1),
            (Operation::IsoCurve { direction: Direction::V, at: 0.3 }, 1),
            (Operation::Split { direction: Direction::U, range: (0.1, 0.7) }, 1),
            (Operation::Transform { columns: (x, y, z), translation: -x }, 1),
            (Operation::Approximation { degree: (3, 2), points: 1000, tolerance: 0.01 }, 3),
            (Operation::Other { name: "fillet".to_owned() }, 2),
        ];
        for (operation, count) in operations {
            let inputs: Vec<EntityId> = (0..count).map(|k| EntityId::new(7 + (3 * k) % 5)).collect();
            let mut edges = Intent::new(operation.clone(), &inputs).relationships();
            assert_eq!(super::operation(&edges), Some((operation.clone(), inputs.clone())), "{operation:?}");
            edges.reverse();
            assert_eq!(super::operation(&edges), Some((operation, inputs)));
        }
    }

    #[test]
    fn relationships_that_lack_a_parameter_or_contradict_each_other_are_no_operation() {
        let inputs = [EntityId::new(1), EntityId::new(2)];
        let mut edges = Intent::new(Operation::Loft { degree: 1 }, &inputs).relationships();
        edges[1].parameters.insert("degree".to_owned(), Value::Number(2.0));
        assert_eq!(operation(&edges), None);
        let mut edges = Intent::new(Operation::Extrude { vector: DVec3::X }, &inputs[..1]).relationships();
        edges[0].parameters.remove("vector");
        assert_eq!(operation(&edges), None);
        assert_eq!(operation(&[]), None);
    }
}
