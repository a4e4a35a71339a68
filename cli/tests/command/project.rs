//! What `project` answers.

use std::fmt::Write as _;

use crate::workshop::{ANSWER, Workshop};

#[test]
fn each_row_is_answered_by_the_entity_that_it_names() {
    let run = Workshop::new().project("entity,x,y,z\n1,1,0,3\n2,1,2,12.5\n1,7,4,0\n", &[]);
    run.ends(0, "3 points in ");
    assert_eq!(run.rows().len(), 4);
    assert_eq!(run.out.lines().next(), Some(ANSWER));
    let known = [
        (1, ["1", "1", "0", "3", "0.25", "", "1.0", "0.0", "0.0", "3.0"], "interior"),
        (2, ["2", "1", "2", "12.5", "0.25", "0.5", "1.0", "2.0", "10.0", "2.5"], "interior"),
        (3, ["1", "7", "4", "0", "1.0", "", "4.0", "0.0", "0.0", "5.0"], "end"),
    ];
    for (row, fields, place) in known {
        assert_eq!(run.rows()[row][..10], fields);
        assert_eq!(run.field(row, "place"), place);
        assert_eq!((run.field(row, "multiplicity"), run.field(row, "method")), ("unique", "analytic"));
        let (distance, lower_bound) = (run.number(row, "distance"), run.number(row, "lower_bound"));
        // the default gap is 1e-9 times the size, which is below 6 for both
        assert!(lower_bound <= distance && distance - lower_bound <= 6e-9, "{lower_bound} {distance}");
    }
}

#[test]
fn one_entity_can_answer_all_rows() {
    let run = Workshop::new().project("x,y,z\n1,0,3\n1,0,9\n", &["--entity", "1"]);
    run.ends(0, "");
    assert_eq!((run.field(1, "entity"), run.field(2, "entity")), ("1", "1"));
    assert_eq!((run.number(1, "distance"), run.number(2, "distance")), (3.0, 9.0));
}

#[test]
fn without_an_entity_the_nearest_of_the_model_answers() {
    let run = Workshop::new().project("x,y,z\n1,0,3\n1,1,9\n0,23,0\n", &[]);
    run.ends(0, "");
    let entities = [1, 2, 3].map(|row| run.field(row, "entity"));
    assert_eq!(entities, ["1", "2", "7"]);
    assert_eq!((run.number(1, "distance"), run.number(2, "distance")), (3.0, 1.0));
}

#[test]
fn ties_and_continua_are_told() {
    let workshop = Workshop::new();
    // the parabola y = x², and a whole circle
    let weight = std::f64::consts::FRAC_1_SQRT_2;
    workshop.write(
        "model.ron",
        format!(
            "Model(format: 1, entities: [
                (id: 2, definition: NurbsCurve(degree: 2, knots: [0, 0, 0, 1, 1, 1],
                    control_points: [(-2, 4, 0), (0, -4, 0), (2, 4, 0)])),
                (id: 7, definition: NurbsCurve(degree: 2, knots: [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
                    control_points: [(1, 20, 0), (1, 21, 0), (0, 21, 0), (-1, 21, 0), (-1, 20, 0), (-1, 19, 0), (0, 19, 0),
                        (1, 19, 0), (1, 20, 0)],
                    weights: Some([1, {weight}, 1, {weight}, 1, {weight}, 1, {weight}, 1]))),
            ])"
        ),
    );
    let run = workshop.project("entity,x,y,z\n2,0,2,0\n7,0,20,5\n2,0,-1,0\n", &[]);
    run.ends(0, "tied:           1, continuum 1\n");
    assert_eq!([1, 2, 3].map(|row| run.field(row, "multiplicity")), ["tied", "continuum", "unique"]);
}

#[test]
fn normals_come_with_the_sign_of_their_side() {
    let run = Workshop::new().project("entity,x,y,z\n2,1,2,12.5\n2,1,2,8\n1,1,0,3\n", &["--normals"]);
    run.ends(0, "");
    assert_eq!(run.out.lines().next(), Some(format!("{ANSWER},nx,ny,nz,signed_distance").as_str()));
    assert_eq!(run.rows()[1][14..], ["0.0", "0.0", "1.0", "2.5"]);
    assert_eq!(run.rows()[2][14..], ["0.0", "0.0", "1.0", "-2.0"]);
    assert_eq!(run.rows()[3][14..], ["", "", "", ""], "a curve has no normal");
}

#[test]
fn beyond_the_maximum_distance_answers_are_empty() {
    let workshop = Workshop::new();
    let run = workshop.project("entity,x,y,z,note\n1,1,0,3,far\n1,1,0,2,near\n", &["--max-distance", "2.5"]);
    run.ends(0, "beyond maximum: 1");
    assert_eq!(run.rows()[1], ["1", "1", "0", "3", "", "", "", "", "", "", "", "", "", "", "far"]);
    assert_eq!(run.number(2, "distance"), 2.0);
    let run = workshop.project("x,y,z\n1,0,3\n", &["--max-distance", "2.5"]);
    assert_eq!(run.rows()[1], ["", "1", "0", "3", "", "", "", "", "", "", "", "", "", ""], "no entity answered");
}

#[test]
fn the_gap_is_as_wide_as_asked() {
    let workshop = Workshop::new();
    let points = "entity,x,y,z\n7,0.3,20.2,0.5\n7,5,21,3\n2,9,9,9\n";
    let run = workshop.project(points, &["--gap", "0.25"]);
    run.ends(0, "not certified:  0");
    for row in 1..=3 {
        let gap = run.number(row, "distance") - run.number(row, "lower_bound");
        assert!((0.0..=0.25 + 1e-12).contains(&gap), "{gap}");
    }
}

#[test]
fn a_gap_that_cannot_be_reached_is_counted_as_not_certified() {
    // the squares that the proof works with leave more than nothing, and rounding allows for 32 ulps only
    let workshop = Workshop::new();
    let mut points = "entity,x,y,z\n".to_owned();
    for i in 0..50 {
        let _ = writeln!(points, "7,{},{},0.1", 0.01 * f64::from(i), 20.0 + 0.02 * f64::from(i));
    }
    let run = workshop.project(points, &["--gap", "0"]);
    let gaps = (1..=50).map(|row| run.number(row, "distance") - run.number(row, "lower_bound"));
    let allowed = |row: usize| 32.0 * f64::EPSILON * (22.0 + run.number(row, "y"));
    let missed = gaps.enumerate().filter(|(i, gap)| *gap > allowed(i + 1)).count();
    run.ends(0, &format!("not certified:  {missed}\n"));
}

#[test]
fn columns_may_stand_in_any_order_and_the_others_are_carried_through() {
    let run = Workshop::new().project("z,note,y,distance,x,entity\n3.00,\"a, b\",0,9.9,1e0,1\n", &[]);
    run.ends(0, "");
    let lines: Vec<&str> = run.out.lines().collect();
    assert_eq!(lines[0], format!("{ANSWER},note,in_distance"));
    assert!(lines[1].starts_with("1,1e0,0,3.00,0.25,,1.0,0.0,0.0,3.0,"), "as it was written: {}", lines[1]);
    assert!(lines[1].ends_with(",\"a, b\",9.9"), "{}", lines[1]);
}

#[test]
fn headers_may_have_spaces_quotes_a_mark_and_any_line_end() {
    let workshop = Workshop::new();
    let plain = workshop.project("entity,x,y,z\n1,1,0,3\n1,2,0,3\n", &[]);
    assert_eq!(plain.rows().len(), 3);
    for points in [
        "\u{feff}entity,x,y,z\n1,1,0,3\n1,2,0,3\n",
        "\u{feff}\"entity\",\"x\",\"y\",\"z\"\r\n1,1,0,3\r\n1,2,0,3\r\n",
        " entity , x,y , z\n1,1,0,3\n1,2,0,3",
        "entity, \"x\", \"y\", \"z\"\n\n1,1,0,3\n\n\n1,2,0,3\n\n",
        "entity,x,y,z\r1,1,0,3\r1,2,0,3\r",
        "\"entity\",x,\"y\",z\n\"1\",\"1\",\"0\",\"3\"\n1,2,0,3\n",
        "entity,x,y,z\n1,1,0,3,,\n1,2,0,3,\n",
    ] {
        let run = workshop.project(points, &[]);
        run.ends(0, "");
        assert_eq!(run.out, plain.out, "{points:?}");
    }
    let spaced = workshop.project("entity,x,y,z\n 1, 1,0 ,3\n", &[]);
    assert_eq!(spaced.rows()[1][..10], [" 1", " 1", "0 ", "3", "0.25", "", "1.0", "0.0", "0.0", "3.0"]);
}

#[test]
fn a_header_alone_gives_a_header() {
    let run = Workshop::new().project("x,y,z,note\n", &[]);
    run.ends(0, "0 points in ");
    assert_eq!(run.out, format!("{ANSWER},note\n"));
}

#[test]
fn a_minus_means_standard_input() {
    let workshop = Workshop::new();
    let run = workshop.run_with(&["project", "model.ron", "-"], b"entity,x,y,z\n1,1,0,3\n1,one,0,3\n");
    run.ends(1, "standard input:3: column x: `one` is not a number");
    assert_eq!(run.number(1, "distance"), 3.0);
}

#[test]
fn floats_are_written_so_that_they_read_back() {
    let workshop = Workshop::new();
    let mut points = "x,y,z\n".to_owned();
    for i in 1..200 {
        let x = 0.037 * f64::from(i);
        let _ = writeln!(points, "{},{},{}", x, 20.0 + x.sin(), x.cos() / 3.0);
    }
    let run = workshop.project(points, &["--entity", "7"]);
    let model = perpend::Model::read(workshop.path("model.ron")).unwrap();
    for row in 1..200 {
        let [x, y, z] = ["x", "y", "z"].map(|column| run.number(row, column));
        let foot = model.project(perpend::EntityId::new(7), perpend::DVec3::new(x, y, z)).unwrap();
        let written =
            ["u", "fx", "fy", "fz", "distance", "lower_bound"].map(|column| run.number(row, column).to_bits());
        let point = foot.point;
        let known = [foot.parameter.u(), point.x, point.y, point.z, foot.distance, foot.lower_bound].map(f64::to_bits);
        assert_eq!(written, known);
    }
}

/// 6,000 rows over three entities, in no order.
fn many_points() -> String {
    let mut points = "entity,x,y,z\n".to_owned();
    let mut state = 1_u64;
    let mut random = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1_u32 << 31)
    };
    for _ in 0..6000 {
        let entity = [1, 2, 7][(random() * 3.0) as usize];
        let _ =
            writeln!(points, "{entity},{},{},{}", 9.0 * random() - 3.0, 30.0 * random() - 4.0, 15.0 * random() - 2.0);
    }
    points
}

#[test]
fn answers_do_not_depend_on_threads() {
    let workshop = Workshop::new();
    let named = many_points();
    let nearest: String = named.lines().fold(String::new(), |text, line| text + line.split_once(',').unwrap().1 + "\n");
    for points in [named, nearest] {
        let one = workshop.project(&points, &["--threads", "1", "--normals"]);
        one.ends(0, "6000 points in ");
        assert_eq!(one.rows().len(), 6001);
        for threads in ["2", "3", "4"] {
            let more = workshop.project(&points, &["--threads", threads, "--normals"]);
            assert!(more.out == one.out, "{threads} threads");
        }
    }
}

#[test]
fn the_summary_counts() {
    let run = Workshop::new().project("entity,x,y,z\n1,1,0,3\n2,1,0,3\n1,1,0,99\n3,1,0,3\n", &["--max-distance", "50"]);
    run.ends(1, "4 points in ");
    for line in [
        "largest gap:    ",
        "answered by:    analytic 2\n",
        "not certified:  0\n",
        "beyond maximum: 1\n",
        "bad rows:       1\n",
    ] {
        assert!(run.err.contains(line), "{line} in {}", run.err);
    }
    assert!(!run.err.contains('\r') && !run.err.contains('\u{1b}'), "no bar without a terminal: {:?}", run.err);
}

#[test]
fn usage_errors_name_the_remedy() {
    let workshop = Workshop::new();
    workshop.write("points.csv", "x,y,z\n1,2,3\n");
    let project = |options: &[&str]| workshop.run(&[&["project", "model.ron", "points.csv"], options].concat());
    project(&["--method", "sextant"]).ends(2, "[possible values: analytic, hierarchy,");
    project(&["--method", "hierarchy"]).ends(0, "answered by:    hierarchy 1");
    project(&["--gap", "-1"]).ends(2, "it is a length in the model's unit: a finite number, at least 0");
    project(&["--max-distance", "nan"]).ends(2, "it is a length in the model's unit: a finite number, at least 0");
    project(&["--threads", "0"]).ends(2, "0 is not in 1..=1024");
    project(&["--entity", "rim"]).ends(2, "entities are called by id, a whole number: see `perpend show`");
    project(&["-o", "model.ron"]).ends(2, "model.ron is the model; it would be lost: give another file to -o");
    project(&["--colour"]).ends(2, "unexpected argument '--colour'");
    workshop.run(&["projekt"]).ends(2, "unrecognized subcommand 'projekt'");
    workshop.run(&["project", "model.ron"]).ends(2, "<POINTS>");
    workshop.run(&[]).ends(2, "Usage: perpend");
    let two = workshop.project("entity,x,y,z\n1,1,2,3\n", &["--entity", "1"]);
    two.ends(2, "points.csv has a column `entity`, and --entity names one too: leave out one of them");
    assert_eq!(two.out, "");
}

#[test]
fn the_help_says_what_an_engineer_needs() {
    let workshop = Workshop::new();
    let help = workshop.run(&["project", "--help"]);
    help.ends(0, "");
    for text in ["no point of the entity is nearer", "model's unit", "Example:", "Exit codes:", "signed_distance"] {
        assert!(help.out.contains(text), "{text}");
    }
    let version = workshop.run(&["--version"]);
    assert_eq!(version.out, format!("perpend {}\n", env!("CARGO_PKG_VERSION")));
}
