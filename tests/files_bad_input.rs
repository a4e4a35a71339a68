//! Every way in which a file can be wrong, with the message that it gives.

use std::fmt::Write as _;
use std::fs;

use perpend::Model;
use proptest::prelude::*;

/// A model that is right; each case makes one thing of it wrong.
const GOOD: &str = r#"Model(
    format: 1,
    next_id: 9,
    entities: [
        (
            id: 4,
            name: "a ( [ \" // name",
            definition: NurbsCurve(
                degree: 2,
                knots: [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0],
                control_points: [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (2.0, 0.0, 0.0), (3.0, 1.0, 0.5)],
                weights: Some([1.0, 2.0, 3.0, 4.0]),
            ),
        ), /* a comment ( /* within [ */ one */
        (
            id: 7,
            definition: NurbsSurface(
                degree: (1, 1),
                knots: ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0]),
                control_points: [[(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(1.0, 0.0, 0.0), (1.0, 1.0, 1.0)]],
            ),
            knowledge: Some((
                revision: 3,
                classification: Some((
                    kind: (value: Line(origin: (0, 0, 0), direction: (1, 0, 0), range: (0, 1)),
                           basis: Proved(gap: 2e-16), tolerance: 1e-10, of: "fnv1a64:0123456789abcdef"),
                )),
                intent: [(operation: Rule, inputs: [4])],
                relationships: [(kind: Profile, target: 4, parameters: {"offset": Number(0.5)})],
            )),
        ),
    ],
)
"#;

/// What is replaced in `GOOD`, by what, and the message.
const CASES: &[(&str, &str, &str)] = &[
    // the RON itself
    ("format: 1,", "format: 1;", "2:14: expected comma; correct the RON here"),
    (
        "knots: [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0],",
        "knots: [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0,",
        "11:17: entity 4: expected float; correct the RON here",
    ),
    ("degree: 2,", "degree 2,", "9:23: entity 4: expected colon; correct the RON here"),
    ("degree: 2,", "degree: 2.5,", "9:26: entity 4: expected comma; correct the RON here"),
    ("degree: 2,", "degree: -2,", "9:26: entity 4: the number is outside the range of its field: correct it"),
    (
        "degree: 2,",
        "degree: 99999999999999999999,",
        "9:25: entity 4: the number is outside the range of its field: correct it",
    ),
    (
        "(3.0, 1.0, 0.5)",
        "(3.0, 1.0)",
        "11:94: entity 4: expected a sequence of 3 f64 values but found 2 elements instead; correct the RON here",
    ),
    ("(3.0, 1.0, 0.5)", "(3.0, 1.0, 0.5, 1.0)", "11:101: entity 4: expected closing `)`; correct the RON here"),
    ("(3.0, 1.0, 0.5)", "(3.0, one, 0.5)", "11:91: entity 4: expected float; correct the RON here"),
    (
        "weights: Some([1.0, 2.0, 3.0, 4.0])",
        "weights: [1.0, 2.0, 3.0, 4.0]",
        "12:25: entity 4: expected `None` or a value in `Some(…)`",
    ),
    ("            id: 7,\n", "            id: \"7\",\n", "16:16: entities[1]: expected integer; correct the RON here"),
    ("    ],\n)\n", "    ],\n)\n)", "33:2: text after the end of the model: remove it; a file holds one model"),
    ("Model(", "Modell(", "1:1: expected struct `Model` but found `Modell`; correct the RON here"),
    // fields and variants
    (
        "next_id: 9",
        "nextid: 9",
        "3:5: `Model` has no field `nextid`; its fields are `format`, `units`, `next_id`, `entities`",
    ),
    ("            id: 7,\n", "", "30:9: entities[1]: `Entity` lacks its field `id`: add it"),
    (
        "            id: 7,\n",
        "            id: 7,\n            id: 7,\n",
        "17:13: entity 7: `Entity` has its field `id` twice: remove one",
    ),
    (
        "            id: 7,\n",
        "            id: 7,\n            color: 3,\n",
        "17:13: entity 7: `Entity` has no field `color`; its fields are `id`, `name`, `colour`, `definition`, `knowledge`, `original`",
    ),
    ("                degree: 2,\n", "", "12:13: entity 4: `NurbsCurve` lacks its field `degree`: add it"),
    (
        "                degree: 2,\n",
        "                degree: 2, periodic: true,\n",
        "9:28: entity 4: `NurbsCurve` has no field `periodic`; its fields are `degree`, `knots`, `control_points`, `weights`",
    ),
    (
        "NurbsCurve(",
        "BezierCurve(",
        "8:25: entity 4: `BezierCurve` is no Definition; there are `NurbsCurve`, `NurbsSurface`, `TrimmedSurface`, `Body`",
    ),
    (
        "next_id: 9,",
        "units: Parsec,",
        "3:12: `Parsec` is no Units; there are `Nanometre`, `Micrometre`, `Millimetre`, `Centimetre`, `Metre`, `Kilometre`, `Inch`, `Foot`",
    ),
    (
        "revision: 3,",
        "revision: 3, secret: 1,",
        "23:30: entity 7: `Record` has no field `secret`; its fields are `revision`, `classification`, `representation`, `intent`, `relationships`",
    ),
    (
        "Profile",
        "Cousin",
        "29:40: entity 7: `Cousin` is no Relation; there are `Definition`, `Boundary`, `Profile`, `Axis`, `Rail`, `Section`, `Offset`, `FittedTo`, `IsoCurveOf`, `PartOf`, `CopyOf`, `Other`",
    ),
    (
        "Line(origin",
        "Rectangle(origin",
        "25:35: entity 7: `Rectangle` is no Kind; there are `Line`, `Circle`, `Ellipse`, `Plane`, `Sphere`, `Cylinder`, `Cone`, `Torus`, `Ruled`, `Revolution`, `Extrusion`, `FreeForm`",
    ),
    (
        "\"fnv1a64:0123456789abcdef\"",
        "\"sha1:0123\"",
        "26:78: entity 7: \"sha1:0123\" is no fingerprint; one is written as fnv1a64: and 16 hexadecimal digits; correct the RON here",
    ),
    (
        "    entities: [",
        "    things: [",
        "4:5: `Model` has no field `things`; its fields are `format`, `units`, `next_id`, `entities`",
    ),
    // the model
    (
        "format: 1,",
        "format: 2,",
        "2: format is 2; this version reads format 1: update perpend, or write the model again with format 1",
    ),
    (
        "format: 1,",
        "format: 1.0,",
        "2: format is 1.0; this version reads format 1: update perpend, or write the model again with format 1",
    ),
    ("format: 1,", "", "33:1: `Model` lacks its field `format`: add it"),
    (
        "next_id: 9",
        "next_id: 7",
        "3: next_id is 7, but entity 7 exists; it is above every id: set it to 8 or leave it out",
    ),
    ("id: 7,", "id: 4,", "15: entity 4: id 4 was given on line 5 already; ids are unique: give this entity a new one"),
    (
        "id: 7,",
        "id: 18446744073709551615,",
        "15: entity 18446744073709551615: id 18446744073709551615 is the last number there is; ids are below it: give this entity a lower one",
    ),
    (
        "target: 4",
        "target: 5",
        "15: entity 7: knowledge: relationships[0].target is 5, and the model has no such entity: add it, or remove the reference",
    ),
    (
        "inputs: [4]",
        "inputs: [7, 12]",
        "15: entity 7: knowledge: intent[0].inputs[1] is 12, and the model has no such entity: add it, or remove the reference",
    ),
    // definitions
    (
        "degree: 2,",
        "degree: 4000000000,",
        "5: entity 4: definition: degree is 4000000000; degrees from 1 to 25 are supported: lower the degree or split the entity",
    ),
    (
        "degree: 2,",
        "degree: 0,",
        "5: entity 4: definition: degree is 0; degrees from 1 to 25 are supported: lower the degree or split the entity",
    ),
    (
        "degree: 2,",
        "degree: 3,",
        "5: entity 4: definition: 7 knots; control points (4) + degree (3) + 1 = 8 are needed",
    ),
    (
        "(3.0, 1.0, 0.5)",
        "(3.0, inf, 0.5)",
        "5: entity 4: definition: control_points[3] is (3.0, inf, 0.5); coordinates are finite and within ±1e70",
    ),
    (
        "(3.0, 1.0, 0.5)",
        "(NaN, 1.0, -inf)",
        "5: entity 4: definition: control_points[3] is (NaN, 1.0, -inf); coordinates are finite and within ±1e70",
    ),
    (
        "(3.0, 1.0, 0.5)",
        "(3.0, 1e999, 0.5)",
        "5: entity 4: definition: control_points[3] is (3.0, inf, 0.5); coordinates are finite and within ±1e70",
    ),
    (
        "1.0, 2.0, 2.0, 2.0]",
        "1.0, 2.0, 2.0]",
        "5: entity 4: definition: 6 knots; control points (4) + degree (2) + 1 = 7 are needed",
    ),
    (
        "1.0, 2.0, 2.0, 2.0]",
        "1.0, 0.5, 2.0, 2.0]",
        "5: entity 4: definition: knots[4] is 0.5, below the knot before it (1); sort the knots",
    ),
    (
        "1.0, 2.0, 2.0, 2.0]",
        "1.0, 2.0, inf, 2.0]",
        "5: entity 4: definition: knots[5] is inf; knots are finite numbers",
    ),
    (
        "1.0, 2.0, 2.0, 2.0]",
        "0.0, 2.0, 2.0, 2.0]",
        "5: entity 4: definition: the end knot 0 has multiplicity 4; degree + 1 = 3 is the most: remove the surplus knots and their control points",
    ),
    (
        "0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]",
        "0, 0, 0, 0, 0, 0, 0]",
        "5: entity 4: definition: the domain is the single value 0; the last knot must exceed the first",
    ),
    (
        "[1.0, 2.0, 3.0, 4.0]",
        "[1.0, 2.0, 3.0]",
        "5: entity 4: definition: 3 weights for 4 control points; give one weight each, or leave the weights out",
    ),
    (
        "[1.0, 2.0, 3.0, 4.0]",
        "[1.0, 2.0, 0.0, 4.0]",
        "5: entity 4: definition: weights[2] is 0; weights are positive and finite",
    ),
    (
        "[1.0, 2.0, 3.0, 4.0]",
        "[1.0, 2.0, NaN, 4.0]",
        "5: entity 4: definition: weights[2] is NaN; weights are positive and finite",
    ),
    (
        "(1.0, 1.0, 1.0)]]",
        "]]",
        "15: entity 7: definition: control_points[1] has 1 entries, control_points[0] has 2; all rows of the net are equally long",
    ),
    (
        "(1.0, 0.0, 0.0), (1.0, 1.0, 1.0)",
        "(0.0, 0.0, inf), (1.0, 1.0, 1.0)",
        "15: entity 7: definition: control_points[1][0] is (0.0, 0.0, inf); coordinates are finite and within ±1e70",
    ),
    (
        "[(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(1.0, 0.0, 0.0), (1.0, 1.0, 1.0)]",
        "[], []",
        "15: entity 7: definition: 0 control points for v degree 1; at least 2 are needed: add control points or lower the degree",
    ),
    (
        "[(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(1.0, 0.0, 0.0), (1.0, 1.0, 1.0)]",
        "",
        "15: entity 7: definition: 0 control points for u degree 1; at least 2 are needed: add control points or lower the degree",
    ),
    (
        "[(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(1.0, 0.0, 0.0), (1.0, 1.0, 1.0)]",
        "[(1, 1, 1), (1, 1, 1)], [(1, 1, 1), (1, 1, 1)]",
        "15: entity 7: definition: all control points are equal (or within 1e-70); an entity has an extent",
    ),
    // records
    (
        "tolerance: 1e-10",
        "tolerance: NaN",
        "15: entity 7: knowledge: classification.kind.tolerance is NaN; numbers of a record are finite: correct it, or leave the item out",
    ),
    (
        "gap: 2e-16",
        "gap: inf",
        "15: entity 7: knowledge: classification.kind.basis.gap is inf; numbers of a record are finite: correct it, or leave the item out",
    ),
    (
        "range: (0, 1)",
        "range: (0, -inf)",
        "15: entity 7: knowledge: classification.kind.value.range[1] is -inf; numbers of a record are finite: correct it, or leave the item out",
    ),
    (
        "Number(0.5)",
        "Number(NaN)",
        "15: entity 7: knowledge: relationships[0].parameters[\"offset\"] is NaN; numbers of a record are finite: correct it, or leave the item out",
    ),
];

fn message(text: &str) -> String {
    match Model::from_ron(text) {
        Ok(_) => "no error".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_mistake_is_named_with_its_place_and_remedy() {
    assert_eq!(message(GOOD), "no error");
    let mut wrong = String::new();
    for (from, to, expected) in CASES {
        assert_eq!(GOOD.matches(from).count(), 1, "{from} stands in the text once");
        let found = message(&GOOD.replace(from, to));
        if found != *expected {
            writeln!(wrong, "{from:?} -> {to:?}\n  gives    {found}\n  expected {expected}").expect("memory");
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}

fn read(name: &str, bytes: &[u8]) -> String {
    let folder = std::env::temp_dir().join(format!("perpend-bad-input-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join(name);
    fs::write(&path, bytes).expect("a temporary file");
    let message = Model::read(&path).expect_err("a bad file").to_string();
    fs::remove_file(&path).expect("a temporary file");
    message.replace(&folder.display().to_string(), "FOLDER")
}

#[test]
fn a_file_that_is_no_text_is_named_with_the_line() {
    assert_eq!(
        read("latin1.ron", b"Model(\n    // caf\xe9\n)"),
        "FOLDER/latin1.ron:2: not UTF-8 text; a model is a RON file, saved as UTF-8"
    );
    assert_eq!(
        read("zeros.ron", &[0; 40]),
        "FOLDER/zeros.ron:1:1: expected opening `(` for struct `Model`; correct the RON here"
    );
}

#[test]
fn an_empty_file_is_named_so() {
    let remedy = "the file is empty; a model without entities is written Model(format: 1, entities: [])";
    assert_eq!(read("empty.ron", b""), format!("FOLDER/empty.ron:1: {remedy}"));
    assert_eq!(message(" \n // nothing but /* a comment\n"), format!("1: {remedy}"));
}

#[test]
fn a_file_that_does_not_exist_or_is_a_folder_is_named_so() {
    let folder = std::env::temp_dir();
    let message = |path: &std::path::Path| Model::read(path).expect_err("no model").to_string();
    assert_eq!(message(&folder), format!("cannot read {}: it is a directory; name the model's file", folder.display()));
    let missing = folder.join("perpend-no-such-model.ron");
    let found = message(&missing);
    assert!(found.starts_with(&format!("cannot read {}: ", missing.display())), "{found}");
}

#[test]
fn a_file_that_was_cut_off_is_named_so() {
    let whole = GOOD.trim_end();
    let cut_off = "the text ends before the model does; the file was cut off: restore it from its source";
    let mut named = 0;
    let mut count = 0;
    for end in (1..whole.len()).filter(|end| whole.is_char_boundary(*end)) {
        let found = message(&whole[..end]);
        assert_ne!(found, "no error", "cut off at byte {end}");
        named += usize::from(found.ends_with(cut_off));
        count += 1;
    }
    // the rest end before the first bracket or within a number, which is named as no number
    assert!(named * 100 > count * 98, "{named} of {count}");
    assert_eq!(message("/* a comment that does not end"), format!("1:3: {cut_off}"));
    assert_eq!(read("cut.ron", &whole.as_bytes()[..300]), format!("FOLDER/cut.ron:11:56: entity 4: {cut_off}"));
}

#[test]
fn deep_nesting_is_an_error_and_not_the_end_of_the_stack() {
    for bracket in ["(", "[", "{", "Some(", "/*", "r#", "\"", "'", "#![", "NurbsCurve("] {
        let deep = bracket.repeat(200_000);
        for text in [deep.clone(), GOOD.replace("Rule", &deep), GOOD.replace("1.0, 2.0, 3.0, 4.0", &deep)] {
            assert_ne!(message(&text), "no error", "{bracket}");
        }
    }
}

#[test]
fn a_long_list_of_nothing_costs_no_more_than_its_text() {
    // a degree of four thousand million asks for nothing of that size
    let text = GOOD.replace("degree: (1, 1)", "degree: (4000000000, 18446744073709551615)");
    assert_eq!(
        message(&text),
        "15: entity 7: definition: u degree is 4000000000; degrees from 1 to 25 are supported: lower the degree or split the entity"
    );
    let many = "[],".repeat(300_000);
    let text = GOOD.replace("[(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(1.0, 0.0, 0.0), (1.0, 1.0, 1.0)]", &many);
    assert!(message(&text).starts_with("15: entity 7: definition: "), "{}", message(&text));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2_000, ..ProptestConfig::default() })]

    #[test]
    fn a_spoilt_file_gives_an_error_or_a_model_and_never_a_panic(
        at in any::<prop::sample::Index>(),
        length in 0..40_usize,
        with in prop_oneof![
            "\\PC{0,6}",
            prop::sample::select(vec!["(", ")", "[", "]", "{", "}", "\"", "'", "/*", "*/", "//", "r#\"", "\\", ",", ":", "-", "inf", "e9", "\u{0}"])
                .prop_map(str::to_owned),
        ],
    ) {
        let letters: Vec<char> = GOOD.chars().collect();
        let from = at.index(letters.len());
        let to = (from + length).min(letters.len());
        let text: String = letters[..from].iter().copied().chain(with.chars()).chain(letters[to..].iter().copied()).collect();
        match Model::from_ron(&text) {
            Ok(model) => prop_assert_eq!(Model::from_ron(&model.to_ron()), Ok(model)),
            Err(error) => {
                prop_assert!(error.line >= 1 && error.line <= text.lines().count() + 1);
                prop_assert!(error.to_string().len() > 10);
            }
        }
    }

    #[test]
    fn any_text_at_all_gives_an_error(text in "(\\PC|[\\[\\](){},:\"'/*#r\\n]){0,60}") {
        prop_assert!(Model::from_ron(&text).is_err());
    }
}
