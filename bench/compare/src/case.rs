//! What is asked: the entities of the test sets with their queries and true distances.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use perpend::{DVec3, Definition};
use perpend_bench::{Corpus, Row, corpora, rows};

use crate::Failure;
use crate::shape::Shape;

/// A test set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, clap::ValueEnum)]
pub(crate) enum Set {
    /// Free curves.
    Curves,
    /// Free surfaces.
    Surfaces,
    /// Planes, cylinders, cones, spheres and tori as NURBS.
    Quadrics,
    /// Circles and arcs as NURBS.
    Circles,
}

impl Set {
    /// Its name in the table.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Curves => "curves",
            Self::Surfaces => "surfaces",
            Self::Quadrics => "quadrics",
            Self::Circles => "circles",
        }
    }

    /// The name of its files, without their endings.
    pub(crate) fn file(self) -> &'static str {
        match self {
            Self::Curves => "seeds-curves",
            Self::Surfaces => "seeds-surfaces",
            Self::Quadrics => "quadrics",
            Self::Circles => "circles-table1",
        }
    }

    /// Whether its entities are surfaces.
    pub(crate) fn has_surfaces(self) -> bool {
        matches!(self, Self::Surfaces | Self::Quadrics)
    }

    /// Its entities that are asked anything.
    ///
    /// # Errors
    ///
    /// A file that cannot be read, or holds something else.
    pub(crate) fn cases(self) -> Result<Vec<Case>, Failure> {
        let folder = corpora();
        let path = folder.join(format!("{}.json", self.file()));
        let corpus: Corpus = serde_json::from_str(&read(&path)?)?;
        let truth = folder.join(format!("{}.truth.csv", self.file()));
        let mut queries: HashMap<u64, Vec<Row>> = HashMap::new();
        for row in rows(&truth).map_err(|error| format!("{}: {error}", truth.display()))? {
            queries.entry(row.entity).or_default().push(row);
        }
        let shapes = Shape::read(&folder.join(format!("{}.analytic.json", self.file())))?;
        let mut cases = Vec::new();
        for entity in &corpus.entities {
            let Some(rows) = queries.remove(&entity.id) else { continue };
            cases.push(Case {
                name: entity.name.clone(),
                definition: Arc::new(entity.definition()?),
                shape: shapes.get(&entity.id).cloned(),
                rows,
            });
        }
        Ok(cases)
    }
}

/// An entity with its queries.
#[derive(Debug)]
pub(crate) struct Case {
    /// The entity's name.
    pub(crate) name: String,
    /// Its definition.
    pub(crate) definition: Arc<Definition>,
    /// The shape that it is, where it is one.
    pub(crate) shape: Option<Shape>,
    /// The queries, with the true distances.
    pub(crate) rows: Vec<Row>,
}

impl Case {
    /// The query points of every `stride`-th row.
    pub(crate) fn points(&self, stride: usize) -> Vec<DVec3> {
        self.rows.iter().step_by(stride).map(|row| row.point).collect()
    }
}

/// A file's text.
pub(crate) fn read(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|error| {
        format!("{}: {error}; PERPEND_CORPUS names the folder of the test sets", path.display()).into()
    })
}
