//! Points that are wrong: the messages, and what is answered all the same.

use std::fmt::Write as _;

use crate::workshop::Workshop;

/// What `project` says of one bad row between two good ones. Its answers are empty, theirs are not.
#[track_caller]
fn says_of_row(bad: impl AsRef<[u8]>, said: &str) {
    let points = [b"entity,x,y,z,note\n1,1,0,3,a\n", bad.as_ref(), b"\n1,2,0,3,b\n"].concat();
    let run = Workshop::new().project(points, &[]);
    run.ends(1, said).ends(1, "bad rows:       1\n");
    let lines: Vec<&str> = run.out.lines().collect();
    assert_eq!(lines.len(), 4, "{}", run.out);
    assert!(lines[2].contains(",,,,,,,,,,"), "empty answers: {}", lines[2]);
    assert_eq!((run.number(1, "distance"), run.number(3, "distance")), (3.0, 3.0));
}

#[test]
fn a_bad_row_is_named_with_line_column_and_remedy() {
    says_of_row(
        "1,one,0,3,c",
        "points.csv:3: column x: `one` is not a number; write it as 12.5 or -1.25e1, with a point",
    );
    says_of_row(
        "1,1,\"0,5\",3,c",
        "points.csv:3: column y: `0,5` is not a number; write it as 12.5 or -1.25e1, with a point",
    );
    says_of_row("1,1,,3,c", "points.csv:3: column y: it is empty; give a number");
    says_of_row("1,1,0,NaN,c", "points.csv:3: column z: `NaN` is not finite; give a finite number");
    says_of_row("1,-inf,0,3,c", "points.csv:3: column x: `-inf` is not finite; give a finite number");
    says_of_row("1,1e999,0,3,c", "points.csv:3: column x: `1e999` is not finite; give a finite number");
    says_of_row("1,1,-1e200,3,c", "points.csv:3: column y: the coordinate is beyond ±1e75; give a smaller one");
    says_of_row("1,1,0", "points.csv:3: column z: 3 columns, the header has 5; add what is missing");
    says_of_row("1,1,0,3", "points.csv:3: column note: 4 columns, the header has 5; add what is missing");
    says_of_row(
        "1,1,0,3,c,d",
        "points.csv:3: 6 columns, the header has 5; remove what is too much, and put text with a comma in quotes",
    );
    says_of_row(
        "9,1,0,3,c",
        "points.csv:3: column entity: the model has no entity 9; correct the id: see `perpend show`",
    );
    says_of_row(",1,0,3,c", "points.csv:3: column entity: it is empty; give the id of an entity");
    says_of_row(
        "edge,1,0,3,c",
        "points.csv:3: column entity: `edge` is not an id; entities are called by id, a whole number",
    );
    says_of_row("-1,1,0,3,c", "points.csv:3: column entity: `-1` is not an id");
    says_of_row(b"1,1,0,3,\xb5m", "points.csv:3: column note: `\u{fffd}m` is not UTF-8 text; save the file as UTF-8");
    says_of_row(b"1,1,\xff,3,c", "points.csv:3: column y: `\u{fffd}` is not UTF-8 text; save the file as UTF-8");
    says_of_row(
        format!("1,1,0,{},c", "7x".repeat(1000)),
        "`7x7x7x7x7x7x7x7x7x7x7x7x7x7x7x7x7x7x7x7x…` is not a number",
    );
}

#[test]
fn a_bad_row_keeps_its_line_and_what_it_carries() {
    let run = Workshop::new().project("entity,x,y,z,note\n1, one,0,3,\"a, b\"\n9,1\n", &["--normals"]);
    run.ends(1, "");
    let lines: Vec<&str> = run.out.lines().collect();
    assert_eq!(lines[1], format!("1, one,0,3{},\"a, b\"", ",".repeat(14)));
    assert_eq!(lines[2], format!("9,1,,{},", ",".repeat(14)));
}

#[test]
fn lines_are_counted_as_an_editor_counts_them() {
    let run = Workshop::new().project("note,x,y,z\r\n\r\n\"two\r\nlines\",1,0,3\r\n\r\nbad,1,0,q\r\n", &[]);
    run.ends(1, "points.csv:6: column z: `q` is not a number");
    let run = Workshop::new().project("x,y,z\n1,\"a\nb\",0\n", &[]);
    run.ends(1, "points.csv:2: column y: `a\\nb` is not a number");
}

#[test]
fn a_file_of_bad_rows_is_not_read_out_in_full() {
    let mut points = "x,y,z\n".to_owned();
    for i in 0..10_000 {
        let _ = writeln!(points, "{i},{i},{}", if i < 100 { "bad" } else { "0" });
    }
    let run = Workshop::new().project(&points, &[]);
    run.ends(1, "points.csv: and 80 other bad rows like these\n").ends(1, "bad rows:       100\n");
    assert_eq!(run.err.matches("is not a number").count(), 20);
    assert_eq!(run.rows().len(), 10_001);
    assert!(run.rows()[101..].iter().all(|row| !row[9].is_empty()), "the rest is answered");
}

#[test]
fn a_quote_that_is_not_closed_does_not_swallow_rows_in_silence() {
    let run = Workshop::new().project("x,y,z,note\n1,0,3,fine\n1,0,3,\"5 pipe\n1,0,3,lost\n", &[]);
    run.ends(1, "points.csv:3: column note: the file ends within a quoted field; close the quote, or write it twice to mean itself");
    assert_eq!(run.number(1, "distance"), 3.0);
    let mut points = "x,y,z,note\n1,0,3,\"open\n".to_owned();
    points.push_str(&"1,0,3,lost\n".repeat(200_000));
    let run = Workshop::new().project(&points, &[]);
    run.ends(
        1,
        "points.csv:2: the row that begins here does not end within 1048576 bytes; a quote in it is not closed",
    );
}

/// What `project` says of points that it cannot use at all; nothing is answered.
#[track_caller]
fn says_of_file(points: impl AsRef<[u8]>, said: &str) {
    let run = Workshop::new().project(points, &[]);
    run.ends(1, said);
    assert_eq!(run.out, "");
}

#[test]
fn a_header_that_cannot_be_used_is_named_with_what_was_found() {
    let empty = "error: points.csv: the file is empty; its first line names the columns: x,y,z or entity,x,y,z";
    says_of_file("", empty);
    says_of_file("\u{feff}", empty);
    says_of_file("\n \r\n\n", empty);
    says_of_file(
        "a,b,x\n1,2,3\n",
        "error: points.csv:1: the header has no columns `y`, `z`; found `a`, `b`, `x`. Name the columns x,y,z or entity,x,y,z, in lower case and in any order",
    );
    says_of_file(
        "\n\nX,Y,Z\n1,2,3\n",
        "points.csv:3: the header has no columns `x`, `y`, `z`; found `X`, `Y`, `Z`. Name the columns",
    );
    says_of_file("x,y\n1,2\n", "the header has no column `z`; found `x`, `y`.");
    says_of_file("1.5,2,3\n4,5,6\n", "This looks like a point: put a header before it, x,y,z or entity,x,y,z");
    says_of_file("x;y;z\n1;2;3\n", "found `x;y;z`. Separate columns with commas: x,y,z or entity,x,y,z");
    says_of_file("a,b,c,d,e,f,g,h,i,j\n", "found `a`, `b`, `c`, `d`, `e`, `f`, `g`, `h` and 2 others.");
    says_of_file("x,y,z,x\n1,2,3,4\n", "points.csv:1: columns 1 and 4 are both named `x`; rename or remove one");
    says_of_file("x,y,z,a, a\n", "points.csv:1: columns 4 and 5 are both named `a`; rename or remove one");
    says_of_file("x,y,\"z\n1,2,3\n", "points.csv:1: a quote in the header is not closed; close it");
    says_of_file(
        format!("x,y,{}\n", "zz".repeat(1000)),
        "found `x`, `y`, `zzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzzz…`.",
    );
    says_of_file(b"x,y,z,\xff\n", "points.csv:1: the header is not UTF-8 text; save the file as UTF-8");
    says_of_file(b"\xff\xfex\0,\0y\0", "points.csv: the file is UTF-16 text; save it as UTF-8");
}

#[test]
fn points_that_cannot_be_read_are_named() {
    let workshop = Workshop::new();
    workshop
        .run(&["project", "model.ron", "none.csv"])
        .ends(1, "error: none.csv: cannot read the points: No such file");
    workshop.run(&["project", "model.ron", "."]).ends(1, "error: .: it is a directory; name a CSV file");
}

#[test]
fn an_entity_that_is_not_there_is_named_with_those_that_are() {
    let run = Workshop::new().project("x,y,z\n1,2,3\n", &["--entity", "3"]);
    run.ends(1, "error: model.ron: no entity has the id 3; its ids are 1, 2, 7");
}

#[test]
fn a_model_without_entities_cannot_answer() {
    let workshop = Workshop::new();
    workshop.write("model.ron", "Model(format: 1, entities: [])");
    workshop
        .project("x,y,z\n1,2,3\n", &[])
        .ends(1, "error: model.ron: the model has no entities, so nothing is nearest: add one");
}
