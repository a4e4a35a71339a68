//! What is wrong with a model's file.

use std::fmt;
use std::io;
use std::path::PathBuf;

use perpend_kernel::EntityId;

use crate::body::InvalidBody;
use crate::dependence::shown;
use crate::entity::EntityError;

/// Why a model could not be read from a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The path is a directory.
    #[error("cannot read {}: it is a directory; name the model's file", path.display())]
    Directory {
        /// The path.
        path: PathBuf,
    },
    /// The file is not UTF-8.
    #[error("{}:{line}: not UTF-8 text; a model is a RON file, saved as UTF-8", path.display())]
    NotText {
        /// The file.
        path: PathBuf,
        /// The line of the first byte that is none.
        line: usize,
    },
    /// The text is no valid model.
    #[error("{}:{source}", path.display())]
    Model {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where.
        source: Box<ModelError>,
    },
}

/// Why a text is no valid model, and where. Shown as `line:column: entity: what`, as far as each is known.
#[derive(Debug, Clone, PartialEq)]
pub struct ModelError {
    /// The line, from 1: of the mistake itself, or else where the text of its entity begins.
    pub line: usize,
    /// The column, from 1, where the mistake itself was met.
    pub column: Option<usize>,
    /// Index in `entities` of the entity that is wrong.
    pub index: Option<usize>,
    /// Its id.
    pub entity: Option<EntityId>,
    /// What is wrong.
    pub problem: InvalidModel,
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.line)?;
        if let Some(column) = self.column {
            write!(f, ":{column}")?;
        }
        match (self.entity, self.index) {
            (Some(id), _) => write!(f, ": entity {id}")?,
            (None, Some(index)) => write!(f, ": entities[{index}]")?,
            (None, None) => {}
        }
        write!(f, ": {}", self.problem)
    }
}

impl std::error::Error for ModelError {}

/// What is wrong with a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidModel {
    /// There is no text.
    #[error("the file is empty; a model without entities is written Model(format: 1, entities: [])")]
    Empty,
    /// The text is not RON, or not the RON of a model.
    #[error("{message}")]
    Syntax {
        /// What was met and what was expected.
        message: String,
    },
    /// The text ends too early.
    #[error("the text ends before the model does; the file was cut off: restore it from its source")]
    CutOff,
    /// The format is not known.
    #[error("format is {found}; this version reads format 1: update perpend, or write the model again with format 1")]
    Format {
        /// The format that was found.
        found: String,
    },
    /// Two entities have one id.
    #[error("id {id} was given on line {first} already; ids are unique: give this entity a new one")]
    DuplicateId {
        /// The id.
        id: EntityId,
        /// The line where the text of the first such entity begins.
        first: usize,
    },
    /// `next_id` would give an id twice.
    #[error("next_id is {next_id}, but entity {highest} exists; it is above every id: set it to {} or leave it out", highest.get().saturating_add(1))]
    NextId {
        /// What the file says.
        next_id: u64,
        /// The highest id of the model.
        highest: EntityId,
    },
    /// The highest id leaves none for the next entity.
    #[error("id {} is the last number there is; ids are below it: give this entity a lower one", u64::MAX)]
    LastId,
    /// A record refers to an entity that does not exist.
    #[error("knowledge: {field} is {target}, and the model has no such entity: add it, or remove the reference")]
    DanglingReference {
        /// The field that holds the reference.
        field: String,
        /// The entity that is missing.
        target: EntityId,
    },
    /// Entities are made of each other in a circle.
    #[error("knowledge: intent: the entity is made of itself ({}): remove one of these inputs", shown(circle))]
    Cycle {
        /// Entities each of which is made of the one before it, and the first of the last.
        circle: Vec<EntityId>,
    },
    /// A body is refused.
    #[error("definition: {0}")]
    Body(#[from] InvalidBody),
    /// A body has what entities alone have.
    #[error("a body has no {field}: remove it")]
    BodyField {
        /// The field.
        field: &'static str,
    },
    /// An entity is refused for what it says itself.
    #[error(transparent)]
    Entity(#[from] EntityError),
}
