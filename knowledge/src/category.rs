//! What a parametrisation factor is called, and which settings it chooses.

use serde::{Deserialize, Serialize};

/// A class of parametrisations, with the settings of the decomposition that it chooses.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Category {
    /// The largest parametrisation factor of the class, itself included.
    pub upper: f64,
    /// What the class is called.
    pub name: String,
    /// The largest distance between points of the decomposition, as a share of the arc length; above 0, at most 1.
    pub tolerance: f64,
    /// The least distance between them, as a share of the tolerance; above 0, at most 1. The nearer to 1, the more uniform.
    pub jitter: f64,
}

/// The classes of parametrisation factors, in ascending order: data, which an application may replace.
///
/// The default is the table of Piegl et al. 2008, §5.
///
/// ```
/// use perpend_knowledge::{Categories, Category};
///
/// let class = |upper, name: &str, tolerance| Category { upper, name: name.into(), tolerance, jitter: 0.6 };
/// let milling = Categories::new(vec![class(0.3, "even", 0.1), class(1.0, "uneven", 0.01)])?;
/// assert_eq!(milling.of(0.3).name, "even");
/// assert_eq!(Categories::default().of(0.3).name, "nearly non-uniform");
/// # Ok::<(), perpend_knowledge::InvalidCategories>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<Category>", into = "Vec<Category>")]
pub struct Categories(Vec<Category>);

/// Why a table of categories is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidCategories {
    /// An upper limit is not above the one before.
    #[error("categories[{index}].upper is {upper}; upper limits are positive and ascend: sort the table")]
    Order {
        /// Which category.
        index: usize,
        /// Its upper limit.
        upper: f64,
    },
    /// Factors up to 1 have no class.
    #[error("the last upper limit is {last}; parametrisation factors reach 1: end the table with a category up to 1")]
    End {
        /// The last upper limit; 0 where there is no category.
        last: f64,
    },
    /// A setting is out of its range.
    #[error("categories[{index}].{setting} is {value}; it is a share: give it a value above 0, at most 1")]
    Setting {
        /// Which category.
        index: usize,
        /// Which setting.
        setting: &'static str,
        /// Its value.
        value: f64,
    },
}

impl Default for Categories {
    fn default() -> Self {
        let row = |upper, name: &str, tolerance, jitter| Category { upper, name: name.to_owned(), tolerance, jitter };
        Self(vec![
            row(0.2, "nearly uniform", 0.2, 0.5),
            row(0.4, "nearly non-uniform", 0.1, 0.6),
            row(0.7, "non-uniform", 0.05, 0.7),
            row(1.0, "highly non-uniform", 0.01, 0.8),
        ])
    }
}

impl Categories {
    /// A table of an application's own.
    ///
    /// # Errors
    ///
    /// The first rule that it breaks: upper limits ascend from above 0 and the last is at least 1; settings are shares.
    pub fn new(categories: Vec<Category>) -> Result<Self, InvalidCategories> {
        let mut last = 0.0;
        for (index, category) in categories.iter().enumerate() {
            let upper = category.upper;
            if !(upper.is_finite() && upper > last) {
                return Err(InvalidCategories::Order { index, upper });
            }
            for (setting, value) in [("tolerance", category.tolerance), ("jitter", category.jitter)] {
                if !(value > 0.0 && value <= 1.0) {
                    return Err(InvalidCategories::Setting { index, setting, value });
                }
            }
            last = upper;
        }
        if last < 1.0 {
            return Err(InvalidCategories::End { last });
        }
        Ok(Self(categories))
    }

    /// The categories, ascending.
    #[must_use]
    pub fn as_slice(&self) -> &[Category] {
        &self.0
    }

    /// The category of a parametrisation factor: the first that reaches it, and the last for what is above 1.
    #[must_use]
    pub fn of(&self, factor: f64) -> &Category {
        let last = self.0.len() - 1;
        self.0.iter().find(|category| factor <= category.upper).unwrap_or(&self.0[last])
    }
}

impl TryFrom<Vec<Category>> for Categories {
    type Error = InvalidCategories;

    fn try_from(categories: Vec<Category>) -> Result<Self, Self::Error> {
        Self::new(categories)
    }
}

impl From<Categories> for Vec<Category> {
    fn from(categories: Categories) -> Self {
        categories.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn upper_limits_belong_to_their_category() {
        let table = Categories::default();
        assert_eq!(
            [0.0, 0.2, 0.4, 0.7, 1.0].map(|factor| table.of(factor).name.as_str()),
            ["nearly uniform", "nearly uniform", "nearly non-uniform", "non-uniform", "highly non-uniform"]
        );
        assert_eq!(table.of(0.2_f64.next_up()).name, "nearly non-uniform");
        assert_eq!((table.of(0.3).tolerance, table.of(0.3).jitter), (0.1, 0.6));
        assert_eq!(Categories::new(table.as_slice().to_vec()), Ok(table));
    }

    #[test]
    fn a_table_that_breaks_a_rule_is_refused() {
        let row = |upper, tolerance, jitter| Category { upper, name: String::new(), tolerance, jitter };
        let refused = |rows: Vec<Category>| Categories::new(rows).expect_err("a broken rule");
        assert_eq!(refused(Vec::new()), InvalidCategories::End { last: 0.0 });
        assert_eq!(refused(vec![row(0.9, 0.1, 0.5)]), InvalidCategories::End { last: 0.9 });
        let twice = vec![row(0.5, 0.1, 0.5), row(0.5, 0.1, 0.5)];
        assert_eq!(refused(twice), InvalidCategories::Order { index: 1, upper: 0.5 });
        assert!(matches!(refused(vec![row(f64::NAN, 0.1, 0.5)]), InvalidCategories::Order { index: 0, .. }));
        let share = InvalidCategories::Setting { index: 0, setting: "tolerance", value: 0.0 };
        assert_eq!(refused(vec![row(1.0, 0.0, 0.5)]), share);
        assert!(refused(vec![row(1.0, 0.1, 1.5)]).to_string().contains("jitter is 1.5"));
    }
}
