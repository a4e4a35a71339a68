//! Says what a RON reader found wrong, in words for the writer of a model.

use perpend_kernel::EntityId;
use ron::Error;
use ron::error::SpannedError;

use crate::file::error::{InvalidModel, ModelError};
use crate::file::outline::{Outline, offset_at};

/// The error of a RON reader, as one of a model.
pub(super) fn explain(text: &str, outline: &Outline, error: &SpannedError) -> ModelError {
    let at = error.span.start;
    let offset = offset_at(text, at.line, at.col);
    let index = outline.entities.iter().position(|element| element.range.contains(&offset));
    let id = index.and_then(|index| outline.entities[index].id.clone()).and_then(|range| text[range].parse().ok());
    ModelError {
        line: at.line,
        column: Some(at.col),
        index,
        entity: id.map(EntityId::new),
        problem: problem(text, outline, offset, error),
    }
}

fn problem(text: &str, outline: &Outline, offset: usize, error: &SpannedError) -> InvalidModel {
    if outline.is_cut_off && meets_end(text, offset, error) {
        return InvalidModel::CutOff;
    }
    let message = match &error.code {
        Error::NoSuchStructField { expected, found, outer } => {
            format!("{} has no field `{found}`; its fields are {}", name(outer.as_deref()), list(expected))
        }
        Error::MissingStructField { field, outer } => {
            format!("{} lacks its field `{field}`: add it", name(outer.as_deref()))
        }
        Error::DuplicateStructField { field, outer } => {
            format!("{} has its field `{field}` twice: remove one", name(outer.as_deref()))
        }
        Error::NoSuchEnumVariant { expected, found, outer } => {
            format!("`{found}` is no {}; there are {}", outer.as_deref().unwrap_or("variant"), list(expected))
        }
        Error::ExpectedOption => "expected `None` or a value in `Some(…)`".to_owned(),
        Error::IntegerOutOfBounds => "the number is outside the range of its field: correct it".to_owned(),
        Error::TrailingCharacters => "text after the end of the model: remove it; a file holds one model".to_owned(),
        other => {
            let message = other.to_string();
            let mut letters = message.chars();
            let first = letters.next().map(|c| c.to_ascii_lowercase());
            format!("{}{}; correct the RON here", first.into_iter().collect::<String>(), letters.as_str())
        }
    };
    InvalidModel::Syntax { message }
}

/// Whether an error comes from the end of the text: nothing, or one word that was cut short, is left.
fn meets_end(text: &str, offset: usize, error: &SpannedError) -> bool {
    let is_unfinished = matches!(error.code, Error::Eof | Error::ExpectedStringEnd | Error::UnclosedBlockComment);
    let ends_there = offset_at(text, error.span.end.line, error.span.end.col) >= text.trim_end().len();
    let is_word = || !text[offset..].trim().contains(|c: char| c.is_whitespace() || "()[]{},:\"".contains(c));
    is_unfinished || ends_there || is_word()
}

/// What a struct is called in messages.
fn name(outer: Option<&str>) -> String {
    outer.map_or_else(|| "this".to_owned(), |name| format!("`{name}`"))
}

fn list(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
