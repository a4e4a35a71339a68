//! Entities and queries as the files of the test sets hold them.

use std::path::{Path, PathBuf};
use std::str::{FromStr, Split};

use glam::DVec3;
use perpend_kernel::{Definition, InvalidDefinition, NurbsCurve, NurbsSurface};
use serde::Deserialize;

use crate::Failure;

/// A set of entities with queries, as files of the test corpora hold them.
#[derive(Debug, Deserialize)]
pub struct Corpus {
    /// Its entities.
    pub entities: Vec<CorpusEntity>,
}

/// An entity of a corpus.
#[derive(Debug, Deserialize)]
pub struct CorpusEntity {
    /// Its id.
    pub id: u64,
    /// Its name.
    pub name: String,
    #[serde(flatten)]
    data: Data,
}

#[derive(Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Data {
    Curve {
        degree: usize,
        knots: Vec<f64>,
        points: Vec<DVec3>,
        weights: Option<Vec<f64>>,
    },
    Surface {
        degree_u: usize,
        degree_v: usize,
        knots_u: Vec<f64>,
        knots_v: Vec<f64>,
        points: Vec<Vec<DVec3>>,
        weights: Option<Vec<Vec<f64>>>,
    },
}

impl CorpusEntity {
    /// The entity's definition.
    ///
    /// # Errors
    ///
    /// The first rule that it breaks.
    pub fn definition(&self) -> Result<Definition, InvalidDefinition> {
        Ok(match &self.data {
            Data::Curve { degree, knots, points, weights } => {
                NurbsCurve::new(*degree, knots.clone(), points.clone(), weights.clone())?.into()
            }
            Data::Surface { degree_u, degree_v, knots_u, knots_v, points, weights } => {
                let knots = (knots_u.clone(), knots_v.clone());
                NurbsSurface::new((*degree_u, *degree_v), knots, points.clone(), weights.clone())?.into()
            }
        })
    }
}

/// A query of a corpus with its true distance.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// The entity that is asked.
    pub entity: u64,
    /// The query point.
    pub point: DVec3,
    /// Its distance, or the best known.
    pub distance: f64,
}

/// Reads the rows of a file with the columns `entity,x,y,z,distance` in front.
///
/// # Errors
///
/// What the file system says, or the first line that is no row.
pub fn rows(path: &Path) -> Result<Vec<Row>, Failure> {
    each_line(path, |fields| {
        let (entity, point) = asked(fields)?;
        Ok(Row { entity, point, distance: next(fields)? })
    })
}

/// Reads what a file with the columns `entity,x,y,z` in front asks: an entity, and a point.
///
/// # Errors
///
/// What the file system says, or the first line that asks nothing.
pub fn points(path: &Path) -> Result<Vec<(u64, DVec3)>, Failure> {
    each_line(path, asked)
}

/// What is read of each line but the header, from its fields.
fn each_line<T>(path: &Path, read: impl Fn(&mut Split<'_, char>) -> Result<T, Failure>) -> Result<Vec<T>, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let line =
        |line: &str| read(&mut line.split(',')).map_err(|error| format!("{}: {error}: {line}", path.display()).into());
    text.lines().skip(1).map(line).collect()
}

fn asked(fields: &mut Split<'_, char>) -> Result<(u64, DVec3), Failure> {
    Ok((next(fields)?, DVec3::new(next(fields)?, next(fields)?, next(fields)?)))
}

fn next<T: FromStr<Err: std::error::Error + 'static>>(fields: &mut Split<'_, char>) -> Result<T, Failure> {
    Ok(fields.next().ok_or("too few columns")?.parse()?)
}

impl Corpus {
    /// Reads a file of entities.
    ///
    /// # Errors
    ///
    /// What the file system says, or what breaks the format.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let file = std::fs::File::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let read = serde_json::from_reader(std::io::BufReader::new(file));
        Ok(read.map_err(|error| format!("{}: {error}", path.display()))?)
    }
}

/// The folder of the test corpora: `tests/data` of the workspace, or what the environment variable `PERPEND_CORPUS` names.
#[must_use]
pub fn corpora() -> PathBuf {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data");
    std::env::var_os("PERPEND_CORPUS").map_or(workspace, PathBuf::from)
}

/// The folder of the real models, each in a folder of its own: what the environment variable `PERPEND_REAL` names, or `real` in the folder that
/// `PERPEND_SHARED` names, by default `shared` beside the workspace.
#[must_use]
pub fn real_models() -> PathBuf {
    let shared = || {
        let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
        std::env::var_os("PERPEND_SHARED").map_or(beside, PathBuf::from).join("real")
    };
    std::env::var_os("PERPEND_REAL").map_or_else(shared, PathBuf::from)
}
