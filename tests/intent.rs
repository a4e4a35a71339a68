//! Design intent: entities made by operations say so, can be made again, and are when what they are made of changes.

mod common;

#[path = "intent/cycles.rs"]
mod cycles;
#[path = "intent/deviation.rs"]
mod deviation;
#[path = "intent/edits.rs"]
mod edits;
#[path = "intent/offsets.rs"]
mod offsets;
#[path = "intent/operations.rs"]
mod operations;
#[path = "intent/overridden.rs"]
mod overridden;
#[path = "intent/random_edits.rs"]
mod random_edits;
#[path = "intent/stated.rs"]
mod stated;
#[path = "intent/workshop.rs"]
mod workshop;

use perpend::{DVec3, EntityId, Frame, Model, Operation, Record};

/// A model of one entity of every operation that perpend runs: the ids with the operations.
fn everything() -> (Model, Vec<(EntityId, Operation)>) {
    use perpend::kernel::Spacing;
    use perpend::{Circle, Cone, Cylinder, Direction, Ellipse, Line, Plane, Sphere, Torus};
    let frame = Frame::new(DVec3::new(1.0, -2.0, 0.5), DVec3::new(1.0, 2.0, 2.0), DVec3::Z).expect("a frame");
    let whole = (0.0, std::f64::consts::TAU);
    let mut model = Model::new();
    let mut made: Vec<(EntityId, Operation)> = Vec::new();
    let mut make = |operation: Operation, inputs: &[EntityId]| {
        let id = model.make(operation.name(), operation.clone(), inputs).expect("it can be made");
        made.push((id, operation));
        id
    };
    let line = make(Line::new(DVec3::ZERO, DVec3::new(3.0, 1.0, 0.0)).expect("valid").into(), &[]);
    let circle = make(Operation::CircleByCentre { centre: DVec3::X, axis: DVec3::Y, radius: 2.0, xdir: None }, &[]);
    let turned = make(Circle::whole(frame, 1.5).expect("valid").into(), &[]);
    let arc = make(Circle::new(frame, 2.5, (0.3, 2.0)).expect("valid").into(), &[]);
    let (start, through, end) = (DVec3::X, DVec3::new(0.0, 1.0, 0.2), DVec3::NEG_X);
    make(Operation::ArcByPoints { start, through, end }, &[]);
    make(Ellipse::new(frame, (2.0, 0.7), (0.1, 4.0)).expect("valid").into(), &[]);
    let plane = make(Plane::new(frame, (-1.0, 2.0), (0.0, 3.0)).expect("valid").into(), &[]);
    let cylinder = make(Cylinder::new(frame, 1.5, (0.0, 4.0), whole).expect("valid").into(), &[]);
    make(Cone::new(frame, (0.5, 2.0), (0.0, 3.0), (0.0, 4.0)).expect("valid").into(), &[]);
    make(Sphere::whole(frame, 2.0).expect("valid").into(), &[]);
    let torus = make(Torus::whole(frame, 3.0, 1.0).expect("valid").into(), &[]);
    let points: Vec<DVec3> = [(0.0, 0.0), (1.0, 0.7), (2.0, -0.4), (3.0, 1.0), (4.0, 0.0)]
        .map(|(x, z)| DVec3::new(1.0 + x, 0.0, z))
        .to_vec();
    let curve = Operation::Interpolation { degree: (3, 0), points, columns: 0, spacing: Spacing::Centripetal };
    let curve = make(curve, &[]);
    let points = (0..20).map(|k| {
        let (x, y) = (f64::from(k / 5), f64::from(k % 5));
        DVec3::new(x, y, (x * y).sin())
    });
    let (points, spacing) = (points.collect(), Spacing::ChordLength);
    make(Operation::Interpolation { degree: (2, 3), points, columns: 5, spacing }, &[]);
    make(Operation::Extrude { vector: DVec3::new(0.0, 0.3, 2.0) }, &[curve]);
    make(Operation::Revolve { origin: DVec3::ZERO, axis: DVec3::Z, angle: 4.0 }, &[curve]);
    make(Operation::Rule, &[line, arc]);
    make(Operation::Loft { degree: 2 }, &[circle, turned, line, arc]);
    make(Operation::Offset { distance: 0.25, normal: None }, &[cylinder]);
    make(Operation::Offset { distance: -0.25, normal: None }, &[torus]);
    make(Operation::Offset { distance: 0.5, normal: Some(DVec3::Z) }, &[line]);
    make(Operation::IsoCurve { direction: Direction::V, at: 0.3 }, &[cylinder]);
    make(Operation::Split { direction: Direction::V, range: (0.2, 0.9) }, &[plane]);
    make(Operation::Split { direction: Direction::U, range: (0.0, 0.4) }, &[circle]);
    let columns = (DVec3::new(0.0, 1.0, 0.0), DVec3::new(-1.0, 0.0, 0.0), DVec3::Z);
    make(Operation::Transform { columns, translation: DVec3::new(5.0, 5.0, 5.0) }, &[torus]);
    (model, made)
}

fn record(model: &Model, id: EntityId) -> &Record {
    model.entity(id).and_then(|entity| entity.record()).expect("a record")
}

fn number(id: u64) -> EntityId {
    EntityId::new(id)
}
