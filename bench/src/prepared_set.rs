//! The entities of a set, made ready, with the rows that ask them.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use perpend_projection::Prepared;

use crate::Failure;
use crate::corpus::{Corpus, Row, rows};

/// An entity of a set, made ready.
#[derive(Debug, Clone)]
pub struct PreparedEntity {
    /// Its id in the set.
    pub id: u64,
    /// Its name.
    pub name: String,
    /// What queries need of it.
    pub prepared: Arc<Prepared>,
    /// The queries with their distances.
    pub rows: Vec<Row>,
}

/// Reads the entities of a file that the rows of another ask, in the order of the former.
///
/// # Errors
///
/// What the file system says, or the first thing in a file that is no entity or row.
pub fn prepared_set(entities: &Path, queries: &Path) -> Result<Vec<PreparedEntity>, Failure> {
    let mut asked: HashMap<u64, Vec<Row>> = HashMap::new();
    for row in rows(queries)? {
        asked.entry(row.entity).or_default().push(row);
    }
    let mut all = Vec::new();
    for entity in Corpus::read(entities)?.entities {
        if let Some(rows) = asked.remove(&entity.id) {
            let definition = entity.definition().map_err(|error| format!("{}: {error}", entity.name))?;
            let prepared = Arc::new(Prepared::new(Arc::new(definition), None));
            all.push(PreparedEntity { id: entity.id, name: entity.name, prepared, rows });
        }
    }
    Ok(all)
}
