//! Where the parts of a model stand in its text.
//!
//! A RON reader gives values without their places. This one gives the places of a model's fields and entities, and looks at
//! nothing else: it knows brackets, strings and comments, and takes whatever stands between them. It never fails; of a text
//! that is no RON it gives what it could make out.

use std::ops::Range;

/// Where the parts of a model stand in its text, in bytes.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Outline {
    /// Whether there is nothing but space and comments.
    pub(super) is_empty: bool,
    /// Whether the text ends inside brackets, a string or a comment.
    pub(super) is_cut_off: bool,
    /// The value of `format`.
    pub(super) format: Option<Range<usize>>,
    /// The value of `next_id`.
    pub(super) next_id: Option<Range<usize>>,
    /// The elements of `entities`.
    pub(super) entities: Vec<Element>,
}

/// Where an entity stands.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Element {
    /// Its text.
    pub(super) range: Range<usize>,
    /// The value of its `id`.
    pub(super) id: Option<Range<usize>>,
}

/// The line, from 1, of a byte of the text.
pub(super) fn line_at(text: &str, offset: usize) -> usize {
    1 + text.as_bytes()[..offset].iter().filter(|byte| **byte == b'\n').count()
}

/// The byte at a line and a column, both from 1; columns count characters.
pub(super) fn offset_at(text: &str, line: usize, column: usize) -> usize {
    let start = text.split_inclusive('\n').take(line - 1).map(str::len).sum::<usize>();
    let rest = text.get(start..).unwrap_or_default();
    start + rest.char_indices().nth(column - 1).map_or(rest.len(), |(at, _)| at)
}

impl Outline {
    /// The outline of a text.
    pub(super) fn of(text: &str) -> Self {
        let mut outline = Self { is_empty: true, ..Self::default() };
        let mut tokens = Tokens { text: text.as_bytes(), at: 0, is_cut_off: false };
        let mut depth = 0_usize;
        // The field of the model, and of the entity, whose value is being read.
        let (mut field, mut field_of_entity) = (None, None);
        let mut last_word: Option<Range<usize>> = None;
        let mut element: Option<Element> = None;
        while let Some(token) = tokens.next() {
            outline.is_empty = false;
            let in_entities = field.as_ref().is_some_and(|name: &Range<usize>| &text[name.clone()] == "entities");
            if let Token::Comma | Token::Close(_) = token
                && depth == 2
                && in_entities
            {
                outline.entities.extend(element.take());
            } else if depth >= 2
                && in_entities
                && let Some(range) = token.range(tokens.at)
            {
                let begun = element.get_or_insert(Element { range: range.clone(), id: None });
                begun.range.end = range.end;
            }
            match token {
                // an attribute before the model
                Token::Open(b'[') if depth == 0 => tokens.skip_bracket(),
                Token::Open(_) => depth += 1,
                Token::Close(_) => depth = depth.saturating_sub(1),
                Token::Comma if depth == 1 => field = None,
                Token::Comma if depth == 3 => field_of_entity = None,
                Token::Comma => {}
                Token::Colon if depth == 1 => field = last_word.take(),
                Token::Colon if depth == 3 && in_entities => field_of_entity = last_word.take(),
                Token::Colon | Token::Text(_) => {}
                Token::Word(ref range) => {
                    let is = |name: &Option<Range<usize>>, expected| {
                        name.as_ref().is_some_and(|name| &text[name.clone()] == expected)
                    };
                    if depth == 1 && is(&field, "format") {
                        outline.format.get_or_insert(range.clone());
                    } else if depth == 1 && is(&field, "next_id") {
                        outline.next_id.get_or_insert(range.clone());
                    } else if depth == 3
                        && in_entities
                        && is(&field_of_entity, "id")
                        && let Some(element) = &mut element
                    {
                        element.id.get_or_insert(range.clone());
                    }
                    last_word = Some(range.clone());
                }
            }
            if depth < 3 {
                field_of_entity = None;
            }
        }
        // one that does not end reaches past the end of the text
        outline
            .entities
            .extend(element.map(|element| Element { range: element.range.start..text.len() + 1, ..element }));
        outline.is_cut_off = depth > 0 || tokens.is_cut_off;
        outline
    }
}

/// What the outline is made of.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Open(u8),
    Close(u8),
    Comma,
    Colon,
    /// A name, a number, or anything else that is none of the others.
    Word(Range<usize>),
    /// A string or a character.
    Text(Range<usize>),
}

impl Token {
    /// Where it stands; `end` is where the text was read to.
    fn range(&self, end: usize) -> Option<Range<usize>> {
        match self {
            Self::Word(range) | Self::Text(range) => Some(range.clone()),
            _ => Some(end - 1..end),
        }
    }
}

struct Tokens<'a> {
    text: &'a [u8],
    at: usize,
    is_cut_off: bool,
}

impl Tokens<'_> {
    fn next(&mut self) -> Option<Token> {
        self.skip_space();
        let start = self.at;
        let byte = *self.text.get(start)?;
        self.at += 1;
        Some(match byte {
            b'(' | b'[' | b'{' => Token::Open(byte),
            b')' | b']' | b'}' => Token::Close(byte),
            b',' => Token::Comma,
            b':' => Token::Colon,
            b'"' => {
                self.skip_string();
                Token::Text(start..self.at)
            }
            b'\'' => {
                self.skip_character();
                Token::Text(start..self.at)
            }
            b'r' if self.skip_raw_string() => Token::Text(start..self.at),
            b'b' if self.text[self.at..].starts_with(b"r") => {
                self.at += 1;
                if !self.skip_raw_string() {
                    self.skip_word();
                }
                Token::Word(start..self.at)
            }
            b'b' if self.text[self.at..].starts_with(b"\"") => {
                self.at += 1;
                self.skip_string();
                Token::Text(start..self.at)
            }
            _ => {
                self.skip_word();
                Token::Word(start..self.at)
            }
        })
    }

    fn skip_word(&mut self) {
        let ends = |byte: &u8| b"()[]{},:\"'/ \t\r\n".contains(byte);
        let rest = &self.text[self.at..];
        self.at += rest.iter().position(ends).unwrap_or(rest.len());
    }

    /// Space and comments.
    fn skip_space(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            if rest.starts_with(b"//") {
                self.at += rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
            } else if rest.starts_with(b"/*") {
                self.skip_block_comment();
            } else if rest.first().is_some_and(u8::is_ascii_whitespace) {
                self.at += 1;
            } else {
                return;
            }
        }
    }

    /// Block comments nest.
    fn skip_block_comment(&mut self) {
        let mut depth = 0_usize;
        while self.at < self.text.len() {
            let rest = &self.text[self.at..];
            if rest.starts_with(b"/*") {
                depth += 1;
                self.at += 2;
            } else if rest.starts_with(b"*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else {
                self.at += 1;
            }
        }
        self.is_cut_off = true;
    }

    /// After the opening quote.
    fn skip_string(&mut self) {
        while let Some(byte) = self.text.get(self.at) {
            self.at += 1;
            match byte {
                b'"' => return,
                b'\\' => self.at = (self.at + 1).min(self.text.len()),
                _ => {}
            }
        }
        self.is_cut_off = true;
    }

    /// After the opening quote: one character, perhaps escaped. A quote that does not close within that stands for itself.
    fn skip_character(&mut self) {
        let rest = &self.text[self.at..];
        let from = if rest.first() == Some(&b'\\') { 2 } else { 1 };
        let longest = rest.len().min(12); // '\u{10ffff}'
        if let Some(end) = (from..longest).find(|i| rest[*i] == b'\'') {
            self.at += end + 1;
        }
    }

    /// After `r`: hashes, a quote, and all up to a quote with as many hashes. False, and nothing skipped, for anything else.
    fn skip_raw_string(&mut self) -> bool {
        let rest = &self.text[self.at..];
        let hashes = rest.iter().take_while(|byte| **byte == b'#').count();
        if rest.get(hashes) != Some(&b'"') {
            return false;
        }
        let mut at = self.at + hashes + 1;
        while let Some(quote) = self.text[at..].iter().position(|byte| *byte == b'"') {
            at += quote + 1;
            let closing = self.text[at..].iter().take(hashes).take_while(|byte| **byte == b'#').count();
            if closing == hashes {
                self.at = at + hashes;
                return true;
            }
        }
        self.at = self.text.len();
        self.is_cut_off = true;
        true
    }

    /// After an opening bracket: all up to its end.
    fn skip_bracket(&mut self) {
        let mut depth = 1_usize;
        while depth > 0 {
            match self.next() {
                Some(Token::Open(_)) => depth += 1,
                Some(Token::Close(_)) => depth -= 1,
                Some(_) => {}
                None => {
                    self.is_cut_off = true;
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texts of the entities and of their ids.
    fn entities(text: &str) -> Vec<(&str, Option<&str>)> {
        let elements = Outline::of(text).entities;
        elements.into_iter().map(|e| (&text[e.range], e.id.map(|id| &text[id]))).collect()
    }

    #[test]
    fn entities_are_found_among_comments_and_strings() {
        let text = r####"#![enable(implicit_some)] // entities: [
            Model(format: 1, /* entities: [ /* (id: 9) */ ( */ entities: [
                (id: 1, name: "] ) \" (id: 2)", knowledge: (entities: [(id: 3)])), // (id: 4),
                Entity(name: r#"" ) "#, knowledge: ('"', '\'', b"(", br##"" )"##, id: 5), id: 6,),
                (name: r##"("# ( "##, r#id: 7),
                (id : /* 8 */ 9),
            ], next_id: 12)"####;
        let found = entities(text);
        let ids: Vec<Option<&str>> = found.iter().map(|(_, id)| *id).collect();
        assert_eq!(ids, [Some("1"), Some("6"), None, Some("9")]);
        for ((element, _), start) in found.iter().zip(["(id: 1,", "Entity(", "(name: r##", "(id : "]) {
            assert!(element.starts_with(start) && element.ends_with(')'), "{element}");
        }
        let outline = Outline::of(text);
        assert_eq!(outline.format.map(|range| &text[range]), Some("1"));
        assert_eq!(outline.next_id.map(|range| &text[range]), Some("12"));
        assert!(!outline.is_cut_off && !outline.is_empty);
    }

    #[test]
    fn what_is_cut_off_or_empty_is_seen() {
        for text in ["(", "(entities: [(id: 1)", "\"abc", "/* /* */", "(a: r#\"b\")", "['x', {", "(b\"c)"] {
            assert!(Outline::of(text).is_cut_off, "{text}");
        }
        for text in ["", " \n\t", "// nothing", "/* no /* thing */ */"] {
            let outline = Outline::of(text);
            assert!(outline.is_empty && !outline.is_cut_off, "{text}");
        }
        assert!(!Outline::of("()").is_empty);
    }

    #[test]
    fn places_and_bytes_agree() {
        let text = "a\n\u{e9}b\n\nc";
        for (offset, (line, column)) in
            [(0, (1, 1)), (2, (2, 1)), (4, (2, 2)), (5, (2, 3)), (6, (3, 1)), (7, (4, 1)), (8, (4, 2))]
        {
            assert_eq!(offset_at(text, line, column), offset, "{line}:{column}");
            assert_eq!(line_at(text, offset), line);
        }
        assert_eq!(offset_at(text, 9, 9), text.len());
    }
}
