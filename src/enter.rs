//! What can enter a model.

use perpend_kernel::clamp::Entry;
use perpend_kernel::{
    CurveData, Definition, DefinitionData, Direction, InvalidDefinition, NurbsCurve, NurbsSurface, SurfaceData,
};
use perpend_knowledge::{Basis, Cleaning, Item, Record};

/// What can enter a model: a definition, or data that become one if they are valid.
pub trait IntoDefinition {
    /// Validates the data, and says what had to be done on entry.
    ///
    /// # Errors
    ///
    /// The first rule that the data break.
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition>;
}

impl IntoDefinition for Definition {
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        Ok((self, Entry::default()))
    }
}

impl IntoDefinition for NurbsCurve {
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        Ok((self.into(), Entry::default()))
    }
}

impl IntoDefinition for NurbsSurface {
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        Ok((self.into(), Entry::default()))
    }
}

impl IntoDefinition for DefinitionData {
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        Self::enter(self)
    }
}

impl IntoDefinition for CurveData {
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        DefinitionData::NurbsCurve(self).enter()
    }
}

impl IntoDefinition for SurfaceData {
    fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        DefinitionData::NurbsSurface(self).enter()
    }
}

/// Notes in the record what was done to the defining data on their way in.
pub(crate) fn note(entry: Entry, definition: &Definition, record: &mut Option<Record>) {
    for (direction, clamped) in [Direction::U, Direction::V].into_iter().zip(entry.clamped) {
        if clamped {
            let value = Cleaning::Clamped { direction };
            let item = Item { value, basis: Basis::Defined, tolerance: 0.0, of: definition.fingerprint() };
            let representation = record.get_or_insert_default().representation.get_or_insert_default();
            let cleaning = representation.cleaning.get_or_insert_default();
            if !cleaning.contains(&item) {
                cleaning.push(item);
            }
        }
    }
}
