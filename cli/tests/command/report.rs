//! The page that `report` makes: what it holds, and what a browser makes of it.

mod browser;
mod page;

use std::fmt::Write as _;

use perpend::{DVec3, Frame, Model, Plane, Shell};

use crate::workshop::{Run, Workshop};
use page::Page;

/// Four points over the table and below it: at 0.5, -0.25, 0.25 and 0 from it, exactly.
const POINTS: &str = "x,y,z\n1,1,10.5\n2,1,9.75\n3,2,10.25\n1,3,10\n";

fn report(workshop: &Workshop, points: &str, options: &[&str]) -> Run {
    workshop.write("points.csv", points);
    workshop.run(&[&["report", "model.ron", "points.csv", "-o", "report.html"], options].concat())
}

/// The page of points that are all good.
fn page(points: &str, options: &[&str]) -> Page {
    let workshop = Workshop::new();
    report(&workshop, points, options).ends(0, "not certified:  0");
    Page::new(workshop.read("report.html"))
}

#[test]
fn the_page_is_well_formed_and_needs_nothing_else() {
    let page = page(POINTS, &["--entity", "2"]);
    page.is_well_formed();
    for reference in ["http:", "https:", "src=", "@import", "url(\"", "url('", "import(", "fetch(", "XMLHttpRequest"] {
        assert!(!page.text.contains(reference), "{reference}");
    }
    assert!(page.text.contains("default-src 'none'"), "the browser is told so too");
    assert!(page.text.contains("<title>Deviations of points.csv</title>"));
}

#[test]
fn the_statistics_are_as_counted_by_hand() {
    let page = page(POINTS, &["--entity", "2", "--scale", "0.3"]);
    // mean 0.5 / 4; squares 0.25 + 0.0625 + 0.0625; squares about the mean 2 * 0.375² + 2 * 0.125²
    let known = [
        ("points", "4"),
        ("mean", "0.1250"),
        ("standard deviation", "0.3227"),
        ("RMS", "0.3062"),
        ("minimum", "-0.2500"),
        ("maximum", "0.5000"),
        ("below -0.3", "0"),
        ("above 0.3", "1"),
        ("25 %", "-0.0625"),
        ("median", "0.1250"),
        ("99 %", "0.4925"),
        ("not certified", "0"),
        ("without a side", "0"),
        ("rows not read", "0"),
    ];
    for (name, value) in known {
        assert_eq!(page.figure(name), value, "{name}");
    }
    assert_eq!(page.faces(), [["2", "table", "4", "0.1250", "0.3062", "-0.2500", "0.5000", "1"]]);
    let bars = page.text.matches("<title>").count() - 1;
    assert_eq!(bars, 4, "three within the scale and one above it: {}", page.text);
}

#[test]
fn the_scale_is_round_where_none_is_asked_for() {
    let points = page(POINTS, &["--entity", "2"]);
    // of 0, 0.25, 0.25, 0.5 at 98 %: 0.485
    assert!(points.text.contains("The scale ends at ±0.5 mm, so that 98 % of the points lie within"));
    assert_eq!(points.scene()["limit"], 0.5);
}

#[test]
fn the_points_in_the_page_are_the_answers() {
    let workshop = Workshop::new();
    let points = "note,z,y,x\na,11.3,0.1,0.7\n\nb,8.9,-3,2\nc,0.123456789012345,1,9\n";
    report(&workshop, points, &["--entity", "2"]).ends(0, "report.html: 3 points, all drawn\n");
    let page = Page::new(workshop.read("report.html"));
    let answers = workshop.run(&["project", "model.ron", "points.csv", "--entity", "2", "--normals"]);
    let column = |name: &str| (1..=3).map(|row| answers.number(row, name)).collect::<Vec<f64>>();
    let position: Vec<f64> = (1..=3).flat_map(|row| ["x", "y", "z"].map(|axis| answers.number(row, axis))).collect();
    assert_eq!(page.doubles("/points/position"), position);
    assert_eq!(page.doubles("/points/deviation"), column("signed_distance"));
    assert_eq!(page.doubles("/points/lower_bound"), column("lower_bound"));
    assert_eq!(page.doubles("/points/line"), [2.0, 4.0, 5.0]);
    assert_eq!((page.bytes("/points/face"), page.bytes("/points/flags")), (vec![0; 12], vec![0; 3]));
}

#[test]
fn the_part_in_the_page_is_the_surface_with_its_edges() {
    let page = page(POINTS, &["--entity", "2"]);
    let centre: Vec<f64> = page.scene()["centre"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert_eq!(centre, [2.0, 2.0, 10.0]);
    let vertices = page.singles("/part/vertices");
    assert_eq!(vertices.len(), 12, "a flat table needs its corners alone");
    assert!(vertices.chunks(3).all(|corner| corner[0].abs() == 2.0 && corner[1].abs() == 2.0 && corner[2] == 0.0));
    assert!(page.singles("/part/normals").chunks(3).all(|normal| normal == [0.0, 0.0, 1.0]));
    assert_eq!(page.bytes("/part/triangles").len(), 2 * 3 * 4);
    assert_eq!(page.scene()["faces"].to_string(), r#"[{"colour":null,"first":0,"id":2,"indices":6,"name":"table"}]"#);
    let edges = page.singles("/edges");
    let length = |ends: &[f32]| (ends[0] - ends[3]).abs() + (ends[1] - ends[4]).abs();
    assert_eq!((edges.len() / 6, edges.chunks(6).map(length).sum::<f32>()), (4, 16.0), "all around, no diagonal");
}

#[test]
fn a_finer_chord_gives_more_of_a_curve() {
    let workshop = Workshop::new();
    let model = workshop.read("model.ron").replace("0.0001", "0.7");
    workshop.write("model.ron", model);
    let segments = |chord: &str| {
        report(&workshop, "x,y,z\n1,20,0\n", &["--entity", "7", "--chord", chord]).ends(0, "");
        Page::new(workshop.read("report.html")).singles("/edges").len() / 6
    };
    assert!(segments("0.001") >= 2 * segments("0.1"));
}

#[test]
fn without_an_entity_the_nearest_answers_and_curves_have_no_side() {
    let page = page("x,y,z\n1,0,0.5\n1,1,9\n", &[]);
    assert_eq!((page.figure("points"), page.figure("without a side")), ("2", "1"));
    let faces = page.faces();
    assert_eq!(faces.iter().map(|row| row[0].as_str()).collect::<Vec<_>>(), ["1", "2"]);
    assert_eq!(page.doubles("/points/deviation"), [0.5, -1.0]);
    assert_eq!(page.bytes("/points/flags"), [1, 0]);
    assert!(page.text.contains("1 entity is nearest to no point."));
}

/// A cube of size 2 about the origin, as a closed body: entities 1 to 6, and body 7.
fn cube() -> Workshop {
    let mut model = Model::new();
    let faces = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]).map(|axis| {
        let frame = Frame::about(axis, axis).unwrap();
        model.insert("side", Plane::new(frame, (-1.0, 1.0), (-1.0, 1.0)).unwrap()).unwrap()
    });
    let faces = faces.collect();
    model.insert_body("cube", vec![Shell { faces, closed: true }]).unwrap();
    let workshop = Workshop::new();
    model.write(workshop.path("model.ron")).unwrap();
    workshop
}

#[test]
fn a_closed_body_tells_inside_from_outside_beyond_its_edges_too() {
    let workshop = cube();
    let points = "x,y,z\n0.5,0,0\n4,5,0.5\n2,3,3\n0,0,1.25\n";
    let deviations = [-0.5, 5.0, 3.0, 0.25];
    for options in [&["--body", "7"][..], &[]] {
        report(&workshop, points, options).ends(0, "");
        let page = Page::new(workshop.read("report.html"));
        assert_eq!(page.doubles("/points/deviation"), deviations, "{options:?}");
        assert_eq!((page.figure("without a side"), page.scene()["faces"].as_array().unwrap().len()), ("0", 6));
    }
    report(&workshop, points, &["--body", "3"]).ends(1, "model.ron: no body has the id 3; its bodies are 7");
    report(&workshop, points, &["--body", "7", "--entity", "1"]).ends(2, "cannot be used with");
    report(&workshop, "entity,x,y,z\n1,0,0,0\n", &["--body", "7"]).ends(2, "leave out one of them");
}

#[test]
fn each_row_may_name_its_entity() {
    let page = page("entity,x,y,z\n2,1,1,0\n1,1,1,0\n", &[]);
    assert_eq!(page.doubles("/points/deviation"), [-10.0, 1.0]);
}

#[test]
fn of_many_points_some_are_drawn_and_all_counted() {
    let mut points = "x,y,z\n".to_owned();
    for i in 0..1000 {
        let _ = writeln!(points, "1,1,{}", 10.0 + f64::from(i) / 1000.0);
    }
    let page = page(&points, &["--entity", "2", "--most-points", "300"]);
    let lines = page.doubles("/points/line");
    assert_eq!(lines, (0..250).map(|i| f64::from(2 + 4 * i)).collect::<Vec<f64>>());
    assert_eq!((page.figure("points"), page.figure("maximum")), ("1,000", "0.999"));
    assert!(page.text.contains("250 points are drawn, one of 4; the figures hold for all"));
}

#[test]
fn bad_rows_are_named_and_the_others_drawn() {
    let workshop = Workshop::new();
    let run = report(&workshop, "x,y,z\n1,1,10.5\n1,one,10\n1,1,1e80\n2,1,9.75\n", &["--entity", "2"]);
    run.ends(1, "points.csv:3: column y: `one` is not a number; write it as 12.5 or -1.25e1, with a point\n");
    run.ends(1, "points.csv:4: column z: the coordinate is beyond ±1e75; give a smaller one\n");
    run.ends(1, "bad rows:       2\n");
    let page = Page::new(workshop.read("report.html"));
    assert_eq!((page.figure("points"), page.figure("rows not read")), ("2", "2"));
    assert_eq!(page.doubles("/points/line"), [2.0, 5.0]);
}

#[test]
fn no_points_are_a_page_too() {
    let page = page("x,y,z\n", &[]);
    page.is_well_formed();
    assert_eq!((page.figure("points"), page.figure("mean")), ("0", "–"));
}

#[test]
fn names_and_titles_cannot_become_markup() {
    let workshop = Workshop::new();
    let model = workshop.read("model.ron").replace("\"table\"", "\"</script><script>alert(1)</script> & <b>\"");
    workshop.write("model.ron", model);
    report(&workshop, POINTS, &["--title", "<i>\"Tom\" & Jerry</i>"]).ends(0, "");
    let page = Page::new(workshop.read("report.html"));
    page.is_well_formed();
    assert_eq!(page.scene()["faces"][1]["name"], "</script><script>alert(1)</script> & <b>");
    assert!(page.text.contains("<h1>&lt;i&gt;&quot;Tom&quot; &amp; Jerry&lt;/i&gt;</h1>"));
    assert!(!page.text.contains("<script>alert"));
}

#[test]
fn what_cannot_be_done_leaves_the_old_page() {
    let workshop = Workshop::new();
    workshop.write("report.html", "old");
    report(&workshop, "", &[]).ends(1, "the file is empty");
    report(&workshop, POINTS, &["--entity", "3"]).ends(1, "no entity has the id 3; its ids are 1, 2, 7");
    report(&workshop, "entity,x,y,z\n2,1,1,1\n", &["--entity", "2"]).ends(2, "leave out one of them");
    report(&workshop, POINTS, &["--scale", "0"]).ends(2, "a finite number above 0");
    report(&workshop, POINTS, &["--chord", "-1"]).ends(2, "a finite number above 0");
    report(&workshop, POINTS, &["--most-points", "0"]).ends(2, "--most-points");
    assert_eq!(workshop.read("report.html"), "old");
    for input in ["model.ron", "points.csv"] {
        let before = workshop.read(input);
        let run = workshop.run(&["report", "model.ron", "points.csv", "-o", input]);
        run.ends(2, &format!("error: {input} is an input; it would be lost: give another file to -o\n"));
        assert_eq!(workshop.read(input), before);
    }
    workshop
        .run(&["report", "model.ron", "points.csv", "-o", "none/report.html"])
        .ends(1, "there is no folder none; create it first");
    assert_eq!(workshop.files(), ["model.ron", "points.csv", "report.html"]);
}
