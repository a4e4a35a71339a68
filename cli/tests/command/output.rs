//! Where answers go, and what happens when they cannot go there.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::process::{Command, Stdio};

use crate::workshop::{ANSWER, Run, Workshop};

fn points(count: usize) -> String {
    let mut points = "entity,x,y,z\n".to_owned();
    for i in 0..count {
        let _ = writeln!(points, "1,{},0.25,3.5", i as f64 / 1000.0);
    }
    points
}

#[test]
fn a_file_holds_what_standard_output_would() {
    let workshop = Workshop::new();
    let to_output = workshop.project(points(100), &[]);
    let to_file = workshop.project(points(100), &["-o", "out.csv"]);
    to_file.ends(0, "100 points in ");
    assert_eq!(to_file.out, "");
    assert_eq!(workshop.read("out.csv"), to_output.out);
    assert_eq!(workshop.project(points(100), &["-o", "-"]).out, to_output.out, "`-` is standard output");
    assert_eq!(workshop.files(), ["model.ron", "out.csv", "points.csv"]);
}

#[test]
fn a_file_with_bad_rows_is_written_too() {
    let workshop = Workshop::new();
    workshop.project("entity,x,y,z\n1,1,0,3\n1,one,0,3\n", &["-o", "out.csv"]).ends(1, "points.csv:3: column x");
    assert_eq!(workshop.read("out.csv").lines().count(), 3);
}

#[test]
fn a_folder_that_is_missing_is_named_before_the_work_starts() {
    let workshop = Workshop::new();
    let run = workshop.project("no header\n", &["-o", "none/out.csv"]);
    run.ends(1, "error: cannot write none/out.csv: there is no folder none; create it first\n");
    assert!(!run.err.contains("header"), "before the points are looked at: {}", run.err);
}

#[test]
fn a_folder_in_place_of_a_file_is_named() {
    let workshop = Workshop::new();
    fs::create_dir(workshop.path("folder")).unwrap();
    let run = workshop.project(points(3), &["-o", "folder"]);
    run.ends(1, "error: cannot write folder: it is a directory; name a file in it\n");
}

#[test]
fn an_input_that_is_wrong_leaves_the_old_file() {
    let workshop = Workshop::new();
    workshop.write("out.csv", "old");
    for (points, said) in [("", "the file is empty"), ("a,b\n", "no columns")] {
        workshop.project(points, &["-o", "out.csv"]).ends(1, said);
        assert_eq!(workshop.read("out.csv"), "old");
    }
    workshop.write("model.ron", "Model(");
    workshop.project(points(3), &["-o", "out.csv"]).ends(1, "model.ron:1");
    assert_eq!(workshop.read("out.csv"), "old");
    assert_eq!(workshop.files(), ["model.ron", "out.csv", "points.csv"], "nothing is left behind");
}

#[test]
fn points_can_be_replaced_by_their_answers() {
    let workshop = Workshop::new();
    workshop.project(points(5000), &["-o", "points.csv"]).ends(0, "5000 points in ");
    assert_eq!(workshop.read("points.csv").lines().count(), 5001);
}

#[cfg(unix)]
#[test]
fn a_write_cut_off_by_a_file_size_limit_leaves_the_old_file() {
    let workshop = Workshop::new();
    workshop.write("points.csv", points(5000));
    workshop.write("out.csv", "old");
    let output = Command::new("sh")
        .args(["-c", "ulimit -f 64 && exec \"$@\"", "sh", env!("CARGO_BIN_EXE_perpend")])
        .args(["project", "model.ron", "points.csv", "-o", "out.csv"])
        .current_dir(workshop.path(""))
        .output()
        .unwrap();
    let run = Run::of(&output);
    run.ends(1, "error: cannot write out.csv: File too large (os error 27); what it held before is as it was\n");
    assert_eq!(workshop.read("out.csv"), "old");
    assert_eq!(workshop.files(), ["model.ron", "out.csv", "points.csv"], "nothing is left behind");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_standard_output_is_told() {
    let workshop = Workshop::new();
    workshop.write("points.csv", points(10));
    let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = workshop.command(&["project", "model.ron", "points.csv"]).stdout(full).output().unwrap();
    Run::of(&output).ends(1, "error: cannot write to standard output: No space left on device");
}

#[test]
fn a_closed_pipe_ends_it_quietly() {
    let workshop = Workshop::new();
    workshop.write("points.csv", points(100_000));
    for arguments in
        [&["project", "model.ron", "points.csv"][..], &["show", "model.ron", "--json"], &["check", "model.ron"]]
    {
        let mut child = workshop.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut out = BufReader::with_capacity(16, child.stdout.take().unwrap());
        if arguments[0] == "project" {
            let mut line = String::new();
            out.read_line(&mut line).unwrap();
            assert_eq!(line.trim_end(), ANSWER);
        }
        drop(out);
        let mut err = String::new();
        child.stderr.take().unwrap().read_to_string(&mut err).unwrap();
        assert_eq!((child.wait().unwrap().code(), err.as_str()), (Some(0), ""), "{arguments:?}");
    }
}

/// The most memory that a process has held so far, in KiB.
#[cfg(target_os = "linux")]
fn peak_memory(process: u32) -> u64 {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_the_points() {
    let workshop = Workshop::new();
    let mut child = workshop
        .command(&["project", "model.ron", "-", "--normals", "--threads", "2"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"x,y,z,note\n").unwrap();
    let rows = "1.25,0.5,3.75,a note that is carried through with its row\n".repeat(10_000);
    // a pipe holds little: what was written was read
    for _ in 0..3 {
        input.write_all(rows.as_bytes()).unwrap();
    }
    let early = peak_memory(child.id());
    for _ in 0..27 {
        input.write_all(rows.as_bytes()).unwrap();
    }
    let late = peak_memory(child.id());
    drop(input);
    assert!(child.wait().unwrap().success());
    // 270,000 rows more: 15 MB read, 40 MB written
    assert!(late < early + 4096, "{early} KiB after 30,000 rows, {late} KiB after 300,000");
}
