//! Models that are wrong: the message, the same from each command.

use crate::workshop::{MODEL, Workshop};

/// What every command says of a model file.
#[track_caller]
fn says(model: impl AsRef<[u8]>, said: &str) {
    let workshop = Workshop::new();
    workshop.write("model.ron", model);
    workshop.write("points.csv", "x,y,z\n1,2,3\n");
    for command in [&["check", "model.ron"][..], &["show", "model.ron"], &["project", "model.ron", "points.csv"]] {
        let run = workshop.run(command);
        run.ends(1, said);
        assert_eq!((run.out.as_str(), run.err.lines().count()), ("", 1), "one message and nothing else: {}", run.err);
    }
}

/// What is said of a model whose entity on line 2 is a curve with these fields.
#[track_caller]
fn says_of_curve(fields: &str, said: &str) {
    let model = format!("Model(format: 1, entities: [\n(id: 4, name: \"a\", definition: NurbsCurve({fields}))])");
    says(model, &format!("error: model.ron:2: entity 4: definition: {said}"));
}

/// What is said of a model whose entity on line 2 is a surface with these fields.
#[track_caller]
fn says_of_surface(fields: &str, said: &str) {
    let model = format!("Model(format: 1, entities: [\n(id: 4, name: \"a\", definition: NurbsSurface({fields}))])");
    says(model, &format!("error: model.ron:2: entity 4: definition: {said}"));
}

#[test]
fn text_that_is_no_model() {
    says(
        "",
        "error: model.ron:1: the file is empty; a model without entities is written Model(format: 1, entities: [])",
    );
    says("hello", "error: model.ron:1:");
    says("Model(format: 1, entities: [}", "error: model.ron:1:");
    says("Model(format: 1)", "lacks its field `entities`: add it");
    says("Model(format: 2, entities: [])", "error: model.ron:1: format is 2; this version reads format 1");
    says(b"Model(\n\xff", "error: model.ron:2: not UTF-8 text; a model is a RON file, saved as UTF-8");
    says(MODEL.replace("name:", "nmae:"), "error: model.ron:4:");
    says(
        MODEL.replace("NurbsCurve", "NurbsCruve"),
        "`NurbsCruve` is no Definition; there are `NurbsCurve`, `NurbsSurface`",
    );
}

#[test]
fn a_model_cut_off_anywhere() {
    let text = MODEL.trim_end();
    for length in (1..text.len()).step_by(7) {
        says(&text[..length], "error: model.ron:");
    }
    says(
        &text[..text.len() - 1],
        "the text ends before the model does; the file was cut off: restore it from its source",
    );
}

#[test]
fn deep_nesting() {
    says("(".repeat(100_000), "error: model.ron:1:");
    says(format!("Model(format: 1, entities: {}", "[".repeat(100_000)), "error: model.ron:1:");
    let knowledge = format!("knowledge: Some((intent: {}", "[(inputs: ".repeat(50_000));
    says(MODEL.replacen("name: \"edge\"", &knowledge, 1), "error: model.ron:4:");
}

#[test]
fn ids_and_references() {
    says(
        MODEL.replace("id: 7", "id: 1"),
        "entity 1: id 1 was given on line 4 already; ids are unique: give this entity a new one",
    );
    says(MODEL.replace("format: 1,", "format: 1, next_id: 7,"), "next_id is 7, but entity 7 exists");
    let related = "knowledge: Some((relationships: [(kind: Profile, target: 99)])), name: \"edge\"";
    says(
        MODEL.replace("name: \"edge\"", related),
        "error: model.ron:4: entity 1: knowledge: relationships[0].target is 99, and the model has no such entity",
    );
}

#[test]
fn a_model_that_cannot_be_read() {
    let workshop = Workshop::new();
    workshop.run(&["check", "none.ron"]).ends(1, "error: cannot read none.ron: No such file or directory");
    workshop.run(&["check", "."]).ends(1, "error: cannot read .: it is a directory; name the model's file");
}

#[test]
fn curves_that_break_a_rule() {
    let points = "control_points: [(0, 0, 0), (1, 0, 0), (2, 1, 0)]";
    says_of_curve(
        &format!("degree: 4000000000, knots: [0, 0, 0, 1, 1, 1], {points}"),
        "degree is 4000000000; degrees from 1 to 25 are supported: lower the degree or split the entity",
    );
    says_of_curve(&format!("degree: 0, knots: [0, 1, 2, 3], {points}"), "degree is 0; degrees from 1 to 25");
    says_of_curve(&format!("degree: 26, knots: [0, 1, 2, 3], {points}"), "degree is 26; degrees from 1 to 25");
    says_of_curve(
        &format!("degree: 3, knots: [0, 0, 0, 0, 1, 1, 1], {points}"),
        "3 control points for degree 3; at least 4 are needed",
    );
    says_of_curve(
        &format!("degree: 2, knots: [0, 0, 1, 1, 1], {points}"),
        "5 knots; control points (3) + degree (2) + 1 = 6 are needed",
    );
    says_of_curve(
        &format!("degree: 2, knots: [0, 0, 0, NaN, 1, 1], {points}"),
        "knots[3] is NaN; knots are finite numbers",
    );
    says_of_curve(
        &format!("degree: 2, knots: [0, 0, 0, inf, inf, inf], {points}"),
        "knots[3] is inf; knots are finite numbers",
    );
    says_of_curve(
        &format!("degree: 2, knots: [0, 0, 0.5, 0.25, 1, 1], {points}"),
        "knots[3] is 0.25, below the knot before it (0.5); sort the knots",
    );
    says_of_curve(
        "degree: 1, knots: [0, 0, 0.5, 0.5, 1, 1], control_points: [(0, 0, 0), (1, 0, 0), (2, 1, 0), (3, 1, 0)]",
        "the knot 0.5 has multiplicity 2, above the degree 1: the entity has a gap there; split it into two entities",
    );
    says_of_curve(
        &format!("degree: 1, knots: [0, 0, 0, 1, 1], {points}"),
        "the end knot 0 has multiplicity 3; degree + 1 = 2 is the most",
    );
    says_of_curve(
        &format!("degree: 2, knots: [1, 1, 1, 1, 1, 1], {points}"),
        "the domain is the single value 1; the last knot must exceed the first",
    );
    says_of_curve(
        "degree: 1, knots: [0, 0, 1, 1], control_points: [(0, 0, 0), (1, NaN, 0)]",
        "control_points[1] is (1.0, NaN, 0.0); coordinates are finite and within ±1e70",
    );
    says_of_curve(
        "degree: 1, knots: [0, 0, 1, 1], control_points: [(0, 0, -inf), (1, 0, 0)]",
        "control_points[0] is (0.0, 0.0, -inf); coordinates are finite and within ±1e70",
    );
    says_of_curve(
        "degree: 1, knots: [0, 0, 1, 1], control_points: [(1, 1, 1), (1, 1, 1)]",
        "all control points are equal",
    );
    let weighted =
        |weights: &str| format!("degree: 2, knots: [0, 0, 0, 1, 1, 1], {points}, weights: Some([{weights}])");
    says_of_curve(&weighted("1, 0, 1"), "weights[1] is 0; weights are positive and finite");
    says_of_curve(&weighted("1, 1, -0.5"), "weights[2] is -0.5; weights are positive and finite");
    says_of_curve(&weighted("NaN, 1, 1"), "weights[0] is NaN; weights are positive and finite");
    says_of_curve(&weighted("1, inf, 1"), "weights[1] is inf; weights are positive and finite");
    says_of_curve(&weighted("1, 1"), "2 weights for 3 control points; give one weight each, or leave the weights out");
}

#[test]
fn surfaces_that_break_a_rule() {
    let net = "control_points: [[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0)]]";
    let knots = "knots: ([0, 0, 1, 1], [0, 0, 1, 1])";
    says_of_surface(
        &format!("degree: (1, 4000000000), {knots}, {net}"),
        "v degree is 4000000000; degrees from 1 to 25",
    );
    says_of_surface(
        &format!("degree: (2, 1), {knots}, {net}"),
        "2 control points for u degree 2; at least 3 are needed",
    );
    says_of_surface(
        &format!("degree: (1, 1), knots: ([0, 0, 1, 1], [0, 0, 1]), {net}"),
        "3 v knots; control points (2) + degree (1) + 1 = 4 are needed",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, control_points: [[(0, 0, 0), (0, 1, 0)], [(1, 0, 0)]]"),
        "control_points[1] has 1 entries, control_points[0] has 2; all rows of the net are equally long",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, control_points: []"),
        "0 control points for u degree 1; at least 2 are needed",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, control_points: [[], []]"),
        "0 control points for v degree 1; at least 2 are needed",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, {}", net.replace("(1, 1, 0)", "(1, 1, inf)")),
        "control_points[1][1] is (1.0, 1.0, inf); coordinates are finite and within ±1e70",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, {net}, weights: Some([[1, 1], [1, 0]])"),
        "weights[1][1] is 0; weights are positive and finite",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, {net}, weights: Some([[1, 1], [1]])"),
        "3 weights for 4 control points; give one weight each, or leave the weights out",
    );
    says_of_surface(
        &format!("degree: (1, 1), {knots}, {net}, weights: Some([[1, 1, 1], [1]])"),
        "weights[0] has 3 entries, control_points[0] has 2; all rows of the net are equally long",
    );
}
