//! Why a command ends early, and with which exit code.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use perpend::{BodyError, EditError, EntityId, Model, QueryError, ReadError, ReplayError, WriteError};

use crate::project::points::PointsError;

/// Why a command ends early.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CommandError {
    #[error(transparent)]
    Model(#[from] ReadError),
    #[error("{}: no entity has the id {id}; {known}", model.display())]
    UnknownEntity { model: PathBuf, id: EntityId, known: String },
    #[error("{}: no body has the id {id}; {known}", model.display())]
    UnknownBody { model: PathBuf, id: EntityId, known: String },
    #[error("{}: {source}", model.display())]
    Body { model: PathBuf, source: BodyError },
    #[error("{}: {id} is a body, which has no definition of its own: name one of its faces ({faces}, …)", model.display())]
    IsBody { model: PathBuf, id: EntityId, faces: String },
    #[error("{}: {source}", model.display())]
    Replay { model: PathBuf, source: ReplayError },
    #[error("{}: the model has no entities, so nothing is nearest: add one", model.display())]
    NoEntities { model: PathBuf },
    #[error("{name}{}: {problem}", problem.line().map_or_else(String::new, |line| format!(":{line}")))]
    Points { name: String, problem: PointsError },
    #[error("{}: {source}", model.display())]
    Edit { model: PathBuf, source: EditError },
    #[error("{}: {source}", part.display())]
    Import { part: PathBuf, source: perpend_step::ReadError },
    #[error(transparent)]
    Query(#[from] QueryError),
    #[error(transparent)]
    Output(#[from] WriteError),
    #[error("cannot write to standard output: {0}")]
    StandardOutput(io::Error),
    #[error("cannot start the worker threads: {0}; ask for fewer with --threads")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error("{name} has a column `entity`, and --{option} {}: leave out one of them", if *option == "entity" { "names one too" } else { "asks the whole model" })]
    TwoEntities { name: String, option: &'static str },
    #[error("{} is the model; it would be lost: give another file to -o", path.display())]
    OutputIsModel { path: PathBuf },
    #[error("{} is an input; it would be lost: give another file to -o", path.display())]
    OutputIsInput { path: PathBuf },
    #[error("{}: no ending that names a format: name it .step, .stp, .obj, .stl or .json, or give --format", path.display())]
    UnknownFormat { path: PathBuf },
    #[error("{option} means nothing to {format}: leave it out")]
    IdleOption { option: &'static str, format: &'static str },
    #[error("{}: {what}, and {format} holds {holds}: nothing to write", model.display())]
    NothingToWrite { model: PathBuf, what: String, format: &'static str, holds: &'static str },
    #[error("{}: entity {id}: {limit} are too few for the chord error {chord:?}: --chord {reached:?} would do", model.display())]
    ChordTooSmall { model: PathBuf, id: EntityId, limit: String, chord: f64, reached: f64 },
    #[error("{}: the chord error {chord:?} takes more than {most} triangles: {remedy}", model.display())]
    TooManyTriangles { model: PathBuf, chord: f64, most: usize, remedy: String },
}

impl CommandError {
    /// The entity of this id is not in the model.
    pub(crate) fn unknown_entity(path: PathBuf, model: &Model, id: EntityId) -> Self {
        match model.body(id) {
            Some(body) => {
                let faces = body.faces().take(3).map(|face| face.to_string()).collect::<Vec<_>>().join(", ");
                Self::IsBody { model: path, id, faces }
            }
            None => Self::UnknownEntity { model: path, id, known: known_ids(model) },
        }
    }

    /// No body of the model has this id.
    pub(crate) fn unknown_body(path: PathBuf, model: &Model, id: EntityId) -> Self {
        const SHOWN: usize = 10;
        let ids: Vec<String> = model.bodies().iter().take(SHOWN).map(|body| body.id().to_string()).collect();
        let known = match model.bodies().len() {
            0 => "it has no bodies".to_owned(),
            count if count <= SHOWN => format!("its bodies are {}", ids.join(", ")),
            count => format!("its bodies are {} and {} more", ids.join(", "), count - SHOWN),
        };
        Self::UnknownBody { model: path, id, known }
    }

    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Self::TwoEntities { .. }
            | Self::OutputIsModel { .. }
            | Self::OutputIsInput { .. }
            | Self::UnknownFormat { .. }
            | Self::IdleOption { .. } => ExitCode::from(2),
            _ => ExitCode::FAILURE,
        }
    }

    /// Whether the reader of the output has gone, which is its right.
    pub(crate) fn is_closed_pipe(&self) -> bool {
        match self {
            Self::StandardOutput(source) | Self::Output(WriteError::Io { source, .. }) => {
                source.kind() == io::ErrorKind::BrokenPipe
            }
            _ => false,
        }
    }
}

/// The ids of a model, in words; of many, the first few.
pub(crate) fn known_ids(model: &Model) -> String {
    const SHOWN: usize = 10;
    let ids: Vec<String> = model.entities().iter().take(SHOWN).map(|entity| entity.id().to_string()).collect();
    match model.len() {
        0 => "it has no entities".to_owned(),
        count if count <= SHOWN => format!("its ids are {}", ids.join(", ")),
        count => format!("its ids are {} and {} more: see `perpend show`", ids.join(", "), count - SHOWN),
    }
}

#[cfg(test)]
mod tests {
    use perpend::{CurveData, DVec3};

    use super::*;

    #[test]
    fn of_many_ids_the_first_few_are_named() {
        let mut model = Model::new();
        assert_eq!(known_ids(&model), "it has no entities");
        for _ in 0..12 {
            let line = CurveData {
                degree: 1,
                knots: vec![0.0, 0.0, 1.0, 1.0],
                control_points: vec![DVec3::ZERO, DVec3::X],
                weights: None,
            };
            model.insert("line", line).unwrap();
        }
        assert_eq!(known_ids(&model), "its ids are 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 2 more: see `perpend show`");
    }
}
