//! A page as a test reads it.

use std::collections::BTreeSet;

use serde_json::Value;

/// Elements that have no end tag.
const VOID: [&str; 4] = ["meta", "link", "input", "br"];

/// Elements whose content is text.
const RAW: [&str; 3] = ["script", "style", "title"];

pub(crate) struct Page {
    pub(crate) text: String,
}

impl Page {
    pub(crate) fn new(text: String) -> Self {
        Self { text }
    }

    /// Fails unless every element is closed where it must be, and no id stands twice.
    #[track_caller]
    pub(crate) fn is_well_formed(&self) {
        assert!(self.text.starts_with("<!doctype html>\n<html lang=\"en\">"));
        let mut rest = &self.text["<!doctype html>".len()..];
        let mut open: Vec<&str> = Vec::new();
        let mut ids = BTreeSet::new();
        while let Some(at) = rest.find('<') {
            let (tag, after) = rest[at + 1..].split_once('>').expect("a tag ends");
            let name = tag.split([' ', '\n', '/']).find(|part| !part.is_empty()).unwrap();
            rest = after;
            if tag.starts_with('/') {
                assert_eq!(open.pop(), Some(name), "before {:?}", &rest[..rest.len().min(80)]);
                continue;
            }
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
            if let Some((_, id)) = tag.split_once(" id=\"") {
                assert!(ids.insert(id.split('"').next().unwrap()), "{tag}");
            }
            if RAW.contains(&name) && !open.contains(&"svg") {
                rest = rest.split_once(&format!("</{name}>")).expect("it is closed").1;
            } else if !VOID.contains(&name) && !tag.ends_with('/') {
                open.push(name);
            }
        }
        assert_eq!(open, Vec::<&str>::new());
    }

    /// The value beside a name in the tables.
    #[track_caller]
    pub(crate) fn figure(&self, name: &str) -> &str {
        let row = format!("<tr><th scope=\"row\">{name}</th><td>");
        let (_, value) = self.text.split_once(&row).unwrap_or_else(|| panic!("no {name}"));
        value.split('<').next().unwrap()
    }

    /// The cells of the table of faces.
    pub(crate) fn faces(&self) -> Vec<Vec<String>> {
        let (_, table) = self.text.split_once("<table id=\"by-face\">").unwrap();
        let (_, body) = table.split_once("<tbody>").unwrap();
        let (body, _) = body.split_once("</tbody>").unwrap();
        let without_tags = |cell: &str| {
            let parts = cell.split('<').enumerate();
            parts.map(|(i, part)| if i == 0 { part } else { part.split_once('>').unwrap().1 }).collect::<String>()
        };
        let cells = |row: &str| {
            let cells = row.split("<td").skip(1).map(|cell| without_tags(&format!("<td{cell}")).trim().to_owned());
            cells.collect::<Vec<String>>()
        };
        body.split("<tr>").skip(1).map(cells).collect()
    }

    /// What the script reads.
    pub(crate) fn scene(&self) -> Value {
        let (_, scene) = self.text.split_once("<script type=\"application/json\" id=\"scene\">").unwrap();
        serde_json::from_str(scene.split_once("</script>").unwrap().0).unwrap()
    }

    pub(crate) fn bytes(&self, at: &str) -> Vec<u8> {
        decoded(self.scene().pointer(at).unwrap().as_str().unwrap())
    }

    pub(crate) fn doubles(&self, at: &str) -> Vec<f64> {
        self.bytes(at).chunks_exact(8).map(|bytes| f64::from_le_bytes(bytes.try_into().unwrap())).collect()
    }

    pub(crate) fn singles(&self, at: &str) -> Vec<f32> {
        self.bytes(at).chunks_exact(4).map(|bytes| f32::from_le_bytes(bytes.try_into().unwrap())).collect()
    }
}

/// The bytes of base64.
fn decoded(text: &str) -> Vec<u8> {
    let letters: String = ('A'..='Z').chain('a'..='z').chain('0'..='9').chain(['+', '/']).collect();
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for letter in text.trim_end_matches('=').chars() {
        bits = bits << 6 | letters.find(letter).expect("a letter of base64") as u32;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
            bits &= (1 << count) - 1;
        }
    }
    assert_eq!((text.len() % 4, bits), (0, 0));
    bytes
}
