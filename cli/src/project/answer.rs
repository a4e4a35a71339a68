//! The rows of answers.

use std::io::Write as _;

use perpend::{EntityId, FootPoint};

use crate::names;
use crate::project::points::{Columns, Row};

/// The columns of every answer.
const ANSWER: [&str; 14] =
    ["entity", "x", "y", "z", "u", "v", "fx", "fy", "fz", "distance", "lower_bound", "place", "multiplicity", "method"];

/// The column that several answers to a row add.
const RANK: &str = "rank";

/// The columns that normals add.
const NORMALS: [&str; 4] = ["nx", "ny", "nz", "signed_distance"];

/// Writes rows of answers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout<'a> {
    pub(crate) columns: &'a Columns,
    pub(crate) normals: bool,
    /// Whether a row may have several answers.
    pub(crate) ranks: bool,
}

/// An answer, and which one of its row's it is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ranked<'a> {
    /// From 1.
    pub(crate) rank: usize,
    pub(crate) foot: &'a FootPoint,
}

/// What stands in the column `entity`.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Named<'a> {
    /// What the row itself says.
    Written(&'a [u8]),
    /// An id; none: no entity answered.
    Id(Option<EntityId>),
}

impl Layout<'_> {
    pub(crate) fn header(self) -> Vec<u8> {
        let mut out = Vec::new();
        let own: Vec<&str> = self.own().collect();
        for name in &own {
            field(&mut out, name.as_bytes());
        }
        for at in &self.columns.others {
            let mut name = self.columns.names[*at].clone();
            // `in_NAME` may be taken too
            while own.contains(&name.as_str())
                || self.columns.names.iter().enumerate().any(|(i, n)| i != *at && *n == name)
            {
                name.insert_str(0, "in_");
            }
            field(&mut out, name.as_bytes());
        }
        end_row(&mut out);
        out
    }

    /// The row of an answer; of none, with empty columns.
    pub(crate) fn row(self, out: &mut Vec<u8>, row: Row<'_>, named: Named<'_>, ranked: Option<Ranked<'_>>) {
        let foot = ranked.map(|ranked| ranked.foot);
        match named {
            Named::Written(text) => field(out, text),
            Named::Id(Some(id)) => put(out, id),
            Named::Id(None) => empty(out, 1),
        }
        for at in self.columns.point {
            field(out, row.field(at).unwrap_or_default());
        }
        match foot {
            Some(foot) => answer(out, foot),
            None => empty(out, ANSWER.len() - 4),
        }
        if self.ranks {
            match ranked {
                Some(Ranked { rank, .. }) => put(out, rank),
                None => empty(out, 1),
            }
        }
        if self.normals {
            match foot.and_then(|foot| foot.normal) {
                Some(normal) => normal.to_array().into_iter().for_each(|x| number(out, x)),
                None => empty(out, NORMALS.len() - 1),
            }
            match foot.and_then(|foot| foot.signed_distance) {
                Some(signed_distance) => number(out, signed_distance),
                None => empty(out, 1),
            }
        }
        for at in &self.columns.others {
            field(out, row.field(*at).unwrap_or_default());
        }
        end_row(out);
    }

    /// The names of the columns that are not carried through.
    fn own(self) -> impl Iterator<Item = &'static str> {
        let rank = self.ranks.then_some(RANK);
        ANSWER.into_iter().chain(rank).chain(NORMALS.into_iter().filter(move |_| self.normals))
    }
}

fn answer(out: &mut Vec<u8>, foot: &FootPoint) {
    number(out, foot.parameter.u());
    match foot.parameter.v() {
        Some(v) => number(out, v),
        None => empty(out, 1),
    }
    for x in foot.point.to_array() {
        number(out, x);
    }
    number(out, foot.distance);
    number(out, foot.lower_bound);
    put(out, names::place(foot.place));
    put(out, names::multiplicity(foot.multiplicity));
    put(out, names::method(foot.method));
}

/// A float in the shortest form that reads back to its bits.
fn number(out: &mut Vec<u8>, x: f64) {
    put(out, format_args!("{x:?}"));
}

/// A field that needs no quotes.
fn put(out: &mut Vec<u8>, value: impl std::fmt::Display) {
    write!(out, "{value},").expect("memory takes all that is written to it");
}

fn empty(out: &mut Vec<u8>, count: usize) {
    out.extend(std::iter::repeat_n(b',', count));
}

/// A field of the input, in quotes where it needs them. What is not UTF-8 in it is replaced: the output is text.
fn field(out: &mut Vec<u8>, text: &[u8]) {
    let text = String::from_utf8_lossy(text);
    if text.contains([',', '"', '\n', '\r']) {
        out.push(b'"');
        out.extend(text.replace('"', "\"\"").as_bytes());
        out.extend(b"\",");
    } else {
        out.extend(text.as_bytes());
        out.push(b',');
    }
}

/// Ends a row: its last comma becomes the end of the line.
fn end_row(out: &mut [u8]) {
    *out.last_mut().expect("a row has columns") = b'\n';
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::project::points::Points;

    fn header(input: &str, normals: bool) -> String {
        let columns = Points::new(input.as_bytes()).unwrap().header().unwrap();
        String::from_utf8(Layout { columns: &columns, normals, ranks: false }.header()).unwrap()
    }

    #[test]
    fn a_carried_column_with_the_name_of_an_output_column_gets_another_name() {
        let own = "entity,x,y,z,u,v,fx,fy,fz,distance,lower_bound,place,multiplicity,method";
        assert_eq!(header("place,x,y,z,nx,note\n", false), format!("{own},in_place,nx,note\n"));
        assert_eq!(
            header("place,x,y,z,nx,note\n", true),
            format!("{own},nx,ny,nz,signed_distance,in_place,in_nx,note\n")
        );
    }

    #[test]
    fn no_two_columns_get_one_name() {
        let header = header("in_u,x,y,z,u\n", false);
        assert!(header.ends_with(",method,in_u,in_in_u\n"), "{header}");
    }

    #[test]
    fn a_field_is_quoted_where_it_must_be() {
        let mut out = Vec::new();
        field(&mut out, b"plain text");
        field(&mut out, b"a, \"b\"\n");
        field(&mut out, b"\xb5m");
        assert_eq!(String::from_utf8(out).unwrap(), "plain text,\"a, \"\"b\"\"\n\",\u{fffd}m,");
    }
}
