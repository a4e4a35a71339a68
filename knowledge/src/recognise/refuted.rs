//! Why a stated class is not believed.

/// Why a stated class is not believed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refuted {
    /// The class is one of the other kind of definitions.
    #[error("a {class} is stated of a {definition}: remove the statement, or have it acquired again")]
    WrongDefinition {
        /// The stated class.
        class: &'static str,
        /// The kind of the definition.
        definition: &'static str,
    },
    /// A parameter breaks the conventions.
    #[error("{field} {expected}: correct it, or have the class acquired again")]
    Malformed {
        /// The parameter.
        field: &'static str,
        /// What holds for it.
        expected: &'static str,
    },
    /// The definition is farther from the stated shape than was asked.
    #[error("{}", deviates(*measured, *bound, *tolerance))]
    Deviates {
        /// The largest distance from the shape that was met at points of the definition; none where the class is of other definitions.
        measured: Option<f64>,
        /// The proven bound of the deviation; none where the definition is not built as such a shape is.
        bound: Option<f64>,
        /// What was asked.
        tolerance: f64,
    },
}

impl Refuted {
    /// The deviation: measured where it could be, else its bound.
    #[must_use]
    pub fn deviation(&self) -> Option<f64> {
        match self {
            Self::Deviates { measured, bound, tolerance } => {
                measured.filter(|m| m > tolerance).or(*bound).or(*measured)
            }
            _ => None,
        }
    }
}

fn deviates(measured: Option<f64>, bound: Option<f64>, tolerance: f64) -> String {
    let far = match (measured, bound) {
        (Some(measured), Some(bound)) if measured <= tolerance => format!(
            "points of the definition are within {measured:.3e} of it, but it is proven within {bound:.3e} only: its ranges end \
             elsewhere than the definition, or that is not built as one; this is"
        ),
        (Some(measured), Some(bound)) => {
            format!("the definition is {measured:.3e} from it (proven: at most {bound:.3e})")
        }
        (Some(measured), None) => format!("the definition is {measured:.3e} from it, and is not built as one"),
        (None, Some(bound)) => format!("the definition is proven within {bound:.3e} of it only"),
        (None, None) => "the definition is not built as one".to_owned(),
    };
    format!("{far}, more than {tolerance:.3e}: correct it, or have the class acquired again")
}
