//! The text of an exchange structure: entities by number, numbers, strings (ISO 10303-21).

use std::fmt::Write as _;
use std::io::{self, Write};

/// The number of an entity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Id(pub(super) usize);

impl std::fmt::Display for Id {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.0)
    }
}

/// The data section under way. Every entity is written after those that it refers to.
#[derive(Debug)]
pub(super) struct Text<W> {
    out: W,
    last: usize,
}

impl<W: Write> Text<W> {
    pub(super) fn new(out: W) -> Self {
        Self { out, last: 0 }
    }

    /// Writes an entity, as `PRODUCT('a','',$,(#3))`.
    pub(super) fn add(&mut self, entity: std::fmt::Arguments<'_>) -> io::Result<Id> {
        self.last += 1;
        writeln!(self.out, "#{}={entity};", self.last)?;
        Ok(Id(self.last))
    }

    /// Writes a line that is no entity.
    pub(super) fn line(&mut self, line: &str) -> io::Result<()> {
        writeln!(self.out, "{line}")
    }
}

/// A number that reads back bit for bit: the shortest digits that do, with the point that the standard wants.
pub(super) fn real(x: f64) -> String {
    let size = x.abs();
    if size == 0.0 || (1e-4..1e15).contains(&size) {
        let mut text = x.to_string();
        if !text.contains('.') {
            text.push('.');
        }
        return text;
    }
    let text = format!("{x:e}");
    let (digits, exponent) = text.split_once('e').expect("finite numbers are written with an exponent");
    let point = if digits.contains('.') { "" } else { "." };
    format!("{digits}{point}E{exponent}")
}

/// Items in parentheses.
pub(super) fn list<T>(items: impl IntoIterator<Item = T>, text: impl Fn(T) -> String) -> String {
    let items: Vec<String> = items.into_iter().map(text).collect();
    format!("({})", items.join(","))
}

/// A string: apostrophes and backslashes doubled, what is not ASCII by its code.
pub(super) fn string(text: &str) -> String {
    let mut out = String::from("'");
    for letter in text.chars() {
        match letter {
            '\'' => out.push_str("''"),
            '\\' => out.push_str("\\\\"),
            ' '..='~' => out.push(letter),
            _ if (letter as u32) < 0x1_0000 => {
                let _ = write!(out, "\\X2\\{:04X}\\X0\\", letter as u32);
            }
            _ => {
                let _ = write!(out, "\\X4\\{:08X}\\X0\\", letter as u32);
            }
        }
    }
    out.push('\'');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_a_point_and_keep_their_bits() {
        for (x, text) in [
            (0.0, "0."),
            (-0.0, "-0."),
            (1.0, "1."),
            (-0.1, "-0.1"),
            (1e300, "1.E300"),
            (1.5e-7, "1.5E-7"),
            (123456789012345.0, "123456789012345."),
        ] {
            assert_eq!(real(x), text);
        }
        for x in [f64::MIN_POSITIVE, f64::MAX, 1.0 / 3.0, 2.0_f64.sqrt() * 1e-9, 5e-324] {
            assert_eq!(real(x).parse::<f64>().map(f64::to_bits), Ok(x.to_bits()));
        }
    }

    #[test]
    fn strings_escape_what_the_standard_reserves() {
        assert_eq!(
            string("it's a \\ lid, Ø 5 µm, 🔩"),
            "'it''s a \\\\ lid, \\X2\\00D8\\X0\\ 5 \\X2\\00B5\\X0\\m, \\X4\\0001F529\\X0\\'"
        );
    }
}
