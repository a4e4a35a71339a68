//! From a row to a query, or to a complaint.

use std::fmt;

use perpend::{DVec3, EntityId, Model};

use crate::project::points::{Columns, Row};
use crate::report::{counted, shown};

/// What a row asks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Asked {
    /// The entity that the row names.
    pub(crate) entity: Option<EntityId>,
    /// The query point.
    pub(crate) point: DVec3,
}

/// What is wrong with a row.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Complaint {
    /// The line on which the row begins.
    line: u64,
    /// The column that is wrong, if it is one.
    column: Option<String>,
    /// What is wrong, and how to mend it.
    problem: String,
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.line)?;
        if let Some(column) = &self.column {
            write!(f, "column {}: ", shown(column.as_bytes()))?;
        }
        f.write_str(&self.problem)
    }
}

/// The query of a row.
pub(crate) fn read(row: Row<'_>, columns: &Columns, model: &Model) -> Result<Asked, Complaint> {
    let wrong = |column: Option<usize>, problem: String| Complaint {
        line: row.line(),
        column: column.map(|at| columns.names[at].clone()),
        problem,
    };
    let count = columns.names.len();
    if row.is_unclosed() {
        let problem =
            "the file ends within a quoted field; close the quote, or write it twice to mean itself".to_owned();
        return Err(wrong(Some(row.len().min(count) - 1), problem));
    }
    if row.len() < count {
        let problem = format!("{}, the header has {count}; add what is missing", counted(row.len() as u64, "column"));
        return Err(wrong(Some(row.len()), problem));
    }
    // empty columns at the end, as spreadsheets leave them, say nothing
    if row.fields().skip(count).any(|field| !field.trim_ascii().is_empty()) {
        let problem = format!(
            "{} columns, the header has {count}; remove what is too much, and put text with a comma in quotes",
            row.len()
        );
        return Err(wrong(None, problem));
    }
    for (at, field) in row.fields().take(count).enumerate() {
        if std::str::from_utf8(field).is_err() {
            return Err(wrong(Some(at), format!("`{}` is not UTF-8 text; save the file as UTF-8", shown(field))));
        }
    }
    let text = |at: usize| row.field(at).and_then(|field| std::str::from_utf8(field).ok()).unwrap_or_default().trim();
    let mut point = DVec3::ZERO;
    for (axis, at) in columns.point.into_iter().enumerate() {
        point[axis] = number(text(at)).map_err(|problem| wrong(Some(at), problem))?;
    }
    let entity = match columns.entity {
        None => None,
        Some(at) => Some(entity(text(at), model).map_err(|problem| wrong(Some(at), problem))?),
    };
    Ok(Asked { entity, point })
}

impl Complaint {
    /// What is refused of a row that reads well, by no fault of a column.
    pub(crate) fn refused(row: Row<'_>, problem: String) -> Self {
        Self { line: row.line(), column: None, problem }
    }

    /// What the solver refuses of a row that reads well: a coordinate out of its range.
    pub(crate) fn out_of_range(row: Row<'_>, columns: &Columns, point: DVec3, problem: String) -> Self {
        let axis = point.abs().max_position();
        Self { line: row.line(), column: Some(columns.names[columns.point[axis]].clone()), problem }
    }
}

fn number(text: &str) -> Result<f64, String> {
    if text.is_empty() {
        return Err("it is empty; give a number".to_owned());
    }
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("`{}` is not finite; give a finite number", shown(text.as_bytes()))),
        Err(_) => {
            Err(format!("`{}` is not a number; write it as 12.5 or -1.25e1, with a point", shown(text.as_bytes())))
        }
    }
}

fn entity(text: &str, model: &Model) -> Result<EntityId, String> {
    if text.is_empty() {
        return Err("it is empty; give the id of an entity".to_owned());
    }
    let id = text.parse().map(EntityId::new).map_err(|_| {
        format!(
            "`{}` is not an id; entities are called by id, a whole number: see `perpend show`",
            shown(text.as_bytes())
        )
    })?;
    match model.entity(id) {
        Some(_) => Ok(id),
        None => Err(format!("the model has no entity {id}; correct the id: see `perpend show`")),
    }
}
