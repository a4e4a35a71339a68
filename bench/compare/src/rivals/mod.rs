//! The contenders, one file each.

mod curvo;
mod native;
mod occt;
mod parry;
mod perpend;
mod sisl;
mod truck;

pub(crate) use occt::{ELEMENTARY, ELEMENTARY_BARE};
pub(crate) use perpend::{RECOGNISED, REFERENCE};

use crate::contender::Contender;

/// Who takes part.
pub(crate) struct Roster {
    /// Those that are here, in the order of the table.
    pub(crate) present: Vec<Box<dyn Contender>>,
    /// The names of those that are not, with what keeps them away.
    pub(crate) absent: Vec<(String, String)>,
}

impl Roster {
    /// All contenders; native ones are compiled where their libraries are installed.
    pub(crate) fn gather() -> Self {
        let mut present = perpend::contenders();
        present.extend(truck::contenders());
        present.extend(curvo::contenders());
        present.extend(parry::contenders());
        let mut absent = Vec::new();
        for (name, native) in [("OCCT (OpenCASCADE)", occt::contenders()), ("SISL", sisl::contenders())] {
            match native {
                Ok(contenders) => present.extend(contenders),
                Err(reason) => absent.push((name.to_owned(), reason)),
            }
        }
        Self { present, absent }
    }
}
