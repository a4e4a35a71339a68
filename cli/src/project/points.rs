//! The points: CSV, read in batches, so that memory does not grow with the file.
//!
//! RFC 4180, and what programs make of it: lines end in LF, CRLF or CR; blank lines count as none; a field may have spaces
//! around it, also before its opening quote; a quote within a field that does not begin with one stands for itself.

use std::fmt::Write as _;
use std::io::{self, BufRead, BufReader, Read};

use crate::report::{counted, shown};

/// How long one row may be. A quote that is never closed would swallow the rest of the file.
const LONGEST_ROW: usize = 1 << 20;

/// How much text a batch holds before it counts as full.
const BATCH_TEXT: usize = 1 << 22;

/// Why the points cannot be used at all.
#[derive(Debug, thiserror::Error)]
pub(crate) enum PointsError {
    #[error("cannot read the points: {0}")]
    Read(#[from] io::Error),
    #[error("it is a directory; name a CSV file")]
    Directory,
    #[error("the file is empty; its first line names the columns: x,y,z or entity,x,y,z")]
    Empty,
    #[error("the file is UTF-16 text; save it as UTF-8")]
    Utf16,
    #[error("the header is not UTF-8 text; save the file as UTF-8")]
    HeaderNotUtf8 { line: u64 },
    #[error("a quote in the header is not closed; close it, or write it twice to mean itself")]
    OpenHeader { line: u64 },
    #[error("the header has {missing}; found {found}. {remedy}")]
    MissingColumns { line: u64, missing: String, found: String, remedy: &'static str },
    #[error("columns {first} and {second} are both named `{name}`; rename or remove one")]
    DuplicateColumn { line: u64, name: String, first: usize, second: usize },
    #[error(
        "the row that begins here does not end within {} bytes; a quote in it is not closed: close it, or write it twice to mean itself",
        LONGEST_ROW
    )]
    EndlessRow { line: u64 },
}

/// Reads rows.
pub(crate) struct Points<R> {
    input: BufReader<R>,
    /// The line of the next byte, from 1.
    line: u64,
    after_carriage_return: bool,
}

/// Rows, kept in memory that is used again.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    /// The fields of all rows, one after the other, without quotes.
    text: Vec<u8>,
    /// Where each field ends in `text`; it begins where the one before it ends.
    ends: Vec<usize>,
    rows: Vec<Span>,
}

/// Which fields are a row's.
#[derive(Debug, Clone, Copy)]
struct Span {
    line: u64,
    first: usize,
    count: usize,
    is_unclosed: bool,
}

/// A row of the file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'a> {
    batch: &'a Batch,
    span: Span,
}

/// The columns of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Columns {
    /// Where x, y and z stand.
    pub(crate) point: [usize; 3],
    /// Where the entity stands, if there is such a column.
    pub(crate) entity: Option<usize>,
    /// The others, in their order.
    pub(crate) others: Vec<usize>,
    /// The names of all columns.
    pub(crate) names: Vec<String>,
}

/// What the last byte was a part of.
#[derive(Clone, Copy, PartialEq)]
enum State {
    /// Nothing, or space before a field.
    Start,
    Plain,
    Quoted,
    /// A quote in a quoted field: its end, or the first of two that mean one.
    Quote,
}

impl PointsError {
    /// The line, where one is wrong.
    pub(crate) fn line(&self) -> Option<u64> {
        match self {
            Self::Read(_) | Self::Directory | Self::Empty | Self::Utf16 => None,
            Self::HeaderNotUtf8 { line }
            | Self::OpenHeader { line }
            | Self::MissingColumns { line, .. }
            | Self::DuplicateColumn { line, .. }
            | Self::EndlessRow { line } => Some(*line),
        }
    }
}

impl<R: Read> Points<R> {
    /// Skips a byte order mark.
    pub(crate) fn new(mut input: R) -> Result<Points<impl Read>, PointsError> {
        let mut head = Vec::new();
        input.by_ref().take(3).read_to_end(&mut head)?;
        if head.starts_with(&[0xff, 0xfe]) || head.starts_with(&[0xfe, 0xff]) {
            return Err(PointsError::Utf16);
        }
        if head == "\u{feff}".as_bytes() {
            head.clear();
        }
        let input = BufReader::with_capacity(1 << 16, io::Cursor::new(head).chain(input));
        Ok(Points { input, line: 1, after_carriage_return: false })
    }

    /// Reads the header.
    pub(crate) fn header(&mut self) -> Result<Columns, PointsError> {
        let mut batch = Batch::default();
        self.read(&mut batch, 1)?;
        batch.rows().next().map_or(Err(PointsError::Empty), Columns::of)
    }

    /// Reads the next rows, at most `count`; none are left where there are none then.
    pub(crate) fn read(&mut self, batch: &mut Batch, count: usize) -> Result<(), PointsError> {
        batch.text.clear();
        batch.ends.clear();
        batch.rows.clear();
        while batch.rows.len() < count && batch.text.len() < BATCH_TEXT {
            if !self.row(batch)? {
                break;
            }
        }
        Ok(())
    }

    /// Reads one row, or meets the end of the file: false.
    fn row(&mut self, batch: &mut Batch) -> Result<bool, PointsError> {
        let (start, first) = (batch.text.len(), batch.ends.len());
        let mut line = self.line;
        let mut state = State::Start;
        let mut was_quoted = false;
        loop {
            let bytes = match self.input.fill_buf() {
                Ok(bytes) => bytes,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error.into()),
            };
            if bytes.is_empty() {
                if batch.ends.len() == first && !was_quoted && batch.text[start..].iter().all(u8::is_ascii_whitespace) {
                    batch.text.truncate(start);
                    return Ok(false);
                }
                batch.end_row(line, first, state == State::Quoted);
                return Ok(true);
            }
            let mut used = 0;
            let mut is_complete = false;
            for &byte in bytes {
                used += 1;
                let is_second_of_crlf = byte == b'\n' && self.after_carriage_return;
                self.after_carriage_return = byte == b'\r';
                let ends_line = matches!(byte, b'\n' | b'\r') && !is_second_of_crlf;
                self.line += u64::from(ends_line);
                match (state, byte) {
                    (State::Quoted, b'"') => state = State::Quote,
                    (State::Quoted, _) => batch.text.push(byte),
                    (State::Quote, b'"') => {
                        batch.text.push(byte);
                        state = State::Quoted;
                    }
                    (_, b'\n') if is_second_of_crlf => {}
                    (_, b'\n' | b'\r') => {
                        let is_blank = batch.ends.len() == first
                            && !was_quoted
                            && batch.text[start..].iter().all(u8::is_ascii_whitespace);
                        if !is_blank {
                            is_complete = true;
                            break;
                        }
                        batch.text.truncate(start);
                        line = self.line;
                        state = State::Start;
                    }
                    (_, b',') => {
                        batch.ends.push(batch.text.len());
                        state = State::Start;
                    }
                    (State::Start, b'"') => {
                        let field = batch.ends.last().copied().unwrap_or(0).max(start);
                        batch.text.truncate(field); // the space before it
                        state = State::Quoted;
                        was_quoted = true;
                    }
                    (State::Start, b' ' | b'\t') => batch.text.push(byte),
                    (State::Start | State::Plain | State::Quote, _) => {
                        batch.text.push(byte);
                        state = State::Plain;
                    }
                }
            }
            self.input.consume(used);
            if is_complete {
                batch.end_row(line, first, false);
                return Ok(true);
            }
            if batch.text.len() + batch.ends.len() - start - first > LONGEST_ROW {
                return Err(PointsError::EndlessRow { line });
            }
        }
    }
}

impl Batch {
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(crate) fn row(&self, index: usize) -> Row<'_> {
        Row { batch: self, span: self.rows[index] }
    }

    fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        self.rows.iter().map(|span| Row { batch: self, span: *span })
    }

    fn end_row(&mut self, line: u64, first: usize, is_unclosed: bool) {
        self.ends.push(self.text.len());
        self.rows.push(Span { line, first, count: self.ends.len() - first, is_unclosed });
    }
}

impl<'a> Row<'a> {
    /// The line on which it begins, from 1.
    pub(crate) fn line(self) -> u64 {
        self.span.line
    }

    /// How many fields it has.
    pub(crate) fn len(self) -> usize {
        self.span.count
    }

    /// Whether the file ends within a quoted field.
    pub(crate) fn is_unclosed(self) -> bool {
        self.span.is_unclosed
    }

    /// A field as it was written, without quotes.
    pub(crate) fn field(self, index: usize) -> Option<&'a [u8]> {
        (index < self.span.count).then(|| {
            let at = self.span.first + index;
            let start = if at == 0 { 0 } else { self.batch.ends[at - 1] };
            &self.batch.text[start..self.batch.ends[at]]
        })
    }

    pub(crate) fn fields(self) -> impl Iterator<Item = &'a [u8]> {
        (0..self.span.count).filter_map(move |index| self.field(index))
    }
}

impl Columns {
    fn of(header: Row<'_>) -> Result<Self, PointsError> {
        let line = header.line();
        if header.is_unclosed() {
            return Err(PointsError::OpenHeader { line });
        }
        let names: Option<Vec<String>> =
            header.fields().map(|name| Some(std::str::from_utf8(name).ok()?.trim().to_owned())).collect();
        let names = names.ok_or(PointsError::HeaderNotUtf8 { line })?;
        for (second, name) in names.iter().enumerate() {
            if let Some(first) = names[..second].iter().position(|other| other == name) {
                let (first, second) = (first + 1, second + 1);
                return Err(PointsError::DuplicateColumn { line, name: shown(name.as_bytes()), first, second });
            }
        }
        let place = |wanted: &str| names.iter().position(|name| name == wanted);
        let (Some(x), Some(y), Some(z)) = (place("x"), place("y"), place("z")) else {
            return Err(missing_columns(line, &names));
        };
        let entity = place("entity");
        let others = (0..names.len()).filter(|at| ![Some(x), Some(y), Some(z), entity].contains(&Some(*at))).collect();
        Ok(Self { point: [x, y, z], entity, others, names })
    }
}

/// Says what the header lacks, and guesses why.
fn missing_columns(line: u64, names: &[String]) -> PointsError {
    const SHOWN: usize = 8;
    let missing: Vec<String> = ["x", "y", "z"]
        .iter()
        .filter(|wanted| !names.iter().any(|name| name == *wanted))
        .map(|wanted| format!("`{wanted}`"))
        .collect();
    let noun = if missing.len() == 1 { "column" } else { "columns" };
    let mut found =
        names.iter().take(SHOWN).map(|name| format!("`{}`", shown(name.as_bytes()))).collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN {
        let _ = write!(found, " and {}", counted((names.len() - SHOWN) as u64, "other"));
    }
    let remedy = if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        "This looks like a point: put a header before it, x,y,z or entity,x,y,z"
    } else if names.len() == 1 && names[0].contains([';', '\t', ' ']) {
        "Separate columns with commas: x,y,z or entity,x,y,z"
    } else {
        "Name the columns x,y,z or entity,x,y,z, in lower case and in any order"
    };
    PointsError::MissingColumns { line, missing: format!("no {noun} {}", missing.join(", ")), found, remedy }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives one byte at a time, as a slow pipe may.
    struct Dripping<'a>(&'a [u8]);

    impl Read for Dripping<'_> {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            let count = out.len().min(self.0.len()).min(1);
            out[..count].copy_from_slice(&self.0[..count]);
            self.0 = &self.0[count..];
            Ok(count)
        }
    }

    type Rows = Vec<(u64, Vec<String>)>;

    fn read(input: impl Read) -> Rows {
        let mut points = Points::new(input).unwrap();
        let (mut batch, mut rows) = (Batch::default(), Vec::new());
        loop {
            points.read(&mut batch, 2).unwrap();
            if batch.len() == 0 {
                return rows;
            }
            let text = |field| String::from_utf8(<[u8]>::to_vec(field)).unwrap();
            rows.extend(batch.rows().map(|row| (row.line(), row.fields().map(text).collect())));
        }
    }

    #[test]
    fn rows_are_the_same_however_the_bytes_arrive() {
        let text = "\u{feff}a,b\r\n1,\"x, \"\"y\"\"\n\",3\n\n  \r\n\"\"\n ,\r, \"q\" \n\r\nlast";
        let expected = [
            (1, vec!["a", "b"]),
            (2, vec!["1", "x, \"y\"\n", "3"]),
            (6, vec![""]),
            (7, vec![" ", ""]),
            (8, vec!["", "q "]),
            (10, vec!["last"]),
        ];
        let expected: Rows =
            expected.into_iter().map(|(line, row)| (line, row.into_iter().map(str::to_owned).collect())).collect();
        assert_eq!(read(text.as_bytes()), expected);
        assert_eq!(read(Dripping(text.as_bytes())), expected);
    }

    #[test]
    fn a_quote_within_a_plain_field_stands_for_itself() {
        assert_eq!(read(&b"5\" pipe,\"6\"\" pipe\"\n"[..]), [(1, vec!["5\" pipe".to_owned(), "6\" pipe".to_owned()])]);
    }

    #[test]
    fn a_row_that_never_ends_is_refused_before_it_fills_the_memory() {
        let endless = io::Cursor::new(&b"x,y,z\n1,2,3\n\"4"[..]).chain(io::repeat(b','));
        let mut points = Points::new(endless).unwrap();
        points.header().unwrap();
        let refused = points.read(&mut Batch::default(), 4096).unwrap_err();
        assert!(matches!(refused, PointsError::EndlessRow { line: 3 }), "{refused}");
    }

    #[test]
    fn the_header_says_which_columns_are_which() {
        let columns = Points::new(&b" z ,\"y\",note, entity,x\n"[..]).unwrap().header().unwrap();
        assert_eq!((columns.point, columns.entity, columns.others), ([4, 1, 0], Some(3), vec![2]));
    }
}
