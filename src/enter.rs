//! What can enter a model.

use perpend_kernel::clamp::Entry;
use perpend_kernel::{
    CurveData, Definition, DefinitionData, Direction, InvalidDefinition, NurbsCurve, NurbsSurface, SurfaceData,
};
use perpend_knowledge::{Basis, Cleaning, Intent, Item, Kind, Operation, Record};

/// What can enter a model: a definition, data that become one if they are valid, or an analytic shape, which enters as its
/// exact NURBS form.
pub trait IntoDefinition {
    /// The definition, with what its entry tells of it.
    ///
    /// # Errors
    ///
    /// The first rule that the data break.
    fn enter(self) -> Result<Entered, InvalidDefinition>;
}

/// A definition that enters a model, with what its entry tells of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Entered {
    /// The definition.
    pub definition: Definition,
    /// What had to be done on entry.
    pub entry: Entry,
    /// The class of an analytic shape.
    pub kind: Option<Kind>,
    /// The operation that makes an analytic shape.
    pub operation: Option<Operation>,
}

impl Entered {
    /// Adds to the record what the entry tells: the class, the operation, and what had to be done.
    pub(crate) fn note(&self, record: &mut Option<Record>) {
        let of = self.definition.fingerprint();
        if let Some(kind) = &self.kind {
            // far above the rounding of the exact form, and what recognition accepts
            let tolerance = 1e-10 * self.definition.size();
            let item = Item { value: kind.clone(), basis: Basis::Defined, tolerance, of };
            record.get_or_insert_default().classification.get_or_insert_default().kind = Some(item);
        }
        if let Some(operation) = &self.operation {
            let record = record.get_or_insert_default();
            let step = Intent { of: Some(of), ..Intent::new(operation.clone(), &[]) };
            record.relationships.retain(|edge| !edge.is_of_operation());
            match record.intent.last_mut().filter(|last| gives_way(last, operation)) {
                Some(last) => *last = Intent { operation: step.operation, of: step.of, ..last.clone() },
                None => record.intent.push(step),
            }
        } else if let Some(record) = record
            && record.making().is_some_and(|making| making.is_by_data())
            && let Some(last) = record.intent.last_mut()
        {
            // data that were entered make way for data
            last.of = last.of.map(|_| of);
        }
        for (direction, clamped) in [Direction::U, Direction::V].into_iter().zip(self.entry.clamped) {
            if clamped {
                let value = Cleaning::Clamped { direction };
                let item = Item { value, basis: Basis::Defined, tolerance: 0.0, of };
                let representation = record.get_or_insert_default().representation.get_or_insert_default();
                let cleaning = representation.cleaning.get_or_insert_default();
                if !cleaning.contains(&item) {
                    cleaning.push(item);
                }
            }
        }
    }
}

/// Whether a step can be overwritten by one of another operation that takes no entities: nothing that it says is lost.
fn gives_way(step: &Intent, operation: &Operation) -> bool {
    let says_nothing = step.alternatives.is_empty() && step.decision.is_empty();
    step.inputs.is_empty() && (says_nothing || step.operation.name() == operation.name())
}

impl From<Definition> for Entered {
    fn from(definition: Definition) -> Self {
        Self { definition, entry: Entry::default(), kind: None, operation: None }
    }
}

impl IntoDefinition for Definition {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        Ok(self.into())
    }
}

impl IntoDefinition for NurbsCurve {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        Definition::from(self).enter()
    }
}

impl IntoDefinition for NurbsSurface {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        Definition::from(self).enter()
    }
}

impl IntoDefinition for DefinitionData {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let (definition, entry) = Self::enter(self)?;
        Ok(Entered { entry, ..definition.into() })
    }
}

impl IntoDefinition for CurveData {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        IntoDefinition::enter(DefinitionData::NurbsCurve(self))
    }
}

impl IntoDefinition for SurfaceData {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        IntoDefinition::enter(DefinitionData::NurbsSurface(self))
    }
}
