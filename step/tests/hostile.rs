//! Damaged and hostile files: whatever the bytes, an import gives a model or an error. No panic, no hang, no memory beyond measure.
//!
//! The small files are written by perpend's own exporter. The variable `PERPEND_MUTATIONS` says how many mutations of them are tried (by default a few thousand);
//! of the real parts, where they are beside the workspace, two hundred are tried for every hundred thousand, and at least a few.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the figures are wanted by readers")]

mod common;

use std::time::Duration;

use glam::DVec2;
use perpend::kernel::{PlaneCurve, TrimCurveData, TrimLoopData, TrimmingData};
use perpend::{
    Carrier, Cylinder, DVec3, Frame, Line, Model, NurbsSurface, Plane, QueryOptions, Shell, Sphere, Torus,
    TrimmedSurface,
};
use perpend_step::{ReadError, ReadOptions, WriteOptions, import, write};

const MUTATIONS: usize = 2_000;

/// What an import may hold beside what the test itself does, in bytes.
const MEMORY: u64 = 1 << 30;

struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }
}

fn data(curve: &PlaneCurve) -> TrimCurveData {
    TrimCurveData {
        degree: curve.degree(),
        knots: curve.knots().as_slice().to_vec(),
        points: curve.points().collect(),
        weights: curve.weights().map(<[f64]>::to_vec),
        edge: None,
    }
}

fn polygon(outer: bool, corners: &[(f64, f64)]) -> TrimLoopData {
    let corner = |k: usize| DVec2::from(corners[k % corners.len()]);
    let side = |k: usize| data(&PlaneCurve::line(corner(k), corner(k + 1)).expect("corners differ"));
    TrimLoopData { outer, curves: (0..corners.len()).map(side).collect() }
}

fn trimmed(model: &mut Model, name: &str, surface: NurbsSurface, loops: Vec<TrimLoopData>) -> perpend::EntityId {
    let trimming = TrimmingData { reversed: false, tolerance: 1e-6, loops };
    model.insert_trimmed(name, TrimmedSurface { surface: Carrier::Own(surface), trimming }).expect("a valid face")
}

/// Small models of every kind of face and curve, as STEP.
fn small_files() -> Vec<Vec<u8>> {
    let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
    let hole = [(0.3, 0.3), (0.3, 0.6), (0.6, 0.6), (0.6, 0.3)];
    let mut plate = Model::new();
    let surface = Plane::new(Frame::WORLD, (0.0, 10.0), (0.0, 10.0)).and_then(|plane| plane.to_nurbs()).expect("valid");
    let face = trimmed(&mut plate, "plate", surface, vec![polygon(true, &square), polygon(false, &hole)]);
    plate.insert_body("sheet", vec![Shell { faces: vec![face], closed: false }]).expect("a body");

    let mut round = Model::new();
    let part = [(0.1, 0.1), (0.9, 0.1), (0.9, 0.7), (0.1, 0.7)];
    let shapes = [
        Cylinder::new(Frame::WORLD, 1.5, (0.0, 4.0), (0.0, 5.0)).and_then(|shape| shape.to_nurbs()),
        Sphere::whole(Frame::WORLD, 2.0).and_then(|shape| shape.to_nurbs()),
        Torus::whole(Frame::WORLD, 3.0, 1.0).and_then(|shape| shape.to_nurbs()),
    ];
    for (k, shape) in shapes.into_iter().enumerate() {
        trimmed(&mut round, &format!("round {k}"), shape.expect("valid"), vec![polygon(true, &part)]);
    }
    round.learn_all();

    let mut free = Model::new();
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0];
    let height = |i: i32, j: i32| f64::from((i * 7 + j * 3) % 5) * 0.3;
    let net = (0..5).map(|i| (0..5).map(|j| DVec3::new(f64::from(i), f64::from(j), height(i, j))).collect()).collect();
    let weights = (0..5).map(|i| (0..5).map(|j| 1.0 + 0.1 * f64::from((i + j) % 3)).collect()).collect();
    let surface = NurbsSurface::new((3, 3), (knots.clone(), knots), net, Some(weights)).expect("valid");
    trimmed(&mut free, "free", surface.clone(), vec![polygon(true, &part)]);
    free.insert("patch", surface).expect("valid");
    free.insert("line", Line::new(DVec3::ZERO, DVec3::X).expect("valid")).expect("valid");

    [plate, round, free]
        .iter()
        .map(|model| {
            let mut text = Vec::new();
            write(model, WriteOptions { name: "part", only: None }, &mut text).expect("written to memory");
            text
        })
        .collect()
}

/// A mutation: of bytes, of tokens, of lines.
fn mutated(text: &[u8], random: &mut Random) -> Vec<u8> {
    const NUMBERS: [&str; 16] = [
        "0.",
        "-1.",
        "1.E308",
        "-1.E308",
        "1.E-308",
        "1.E999",
        "0.1E-20",
        "99999999999",
        "-2147483649",
        "$",
        "*",
        "()",
        "(1.,2.)",
        "NAN",
        "''",
        ".T.",
    ];
    let mut text = text.to_vec();
    for _ in 0..=random.below(3) {
        let at = random.below(text.len());
        match random.below(9) {
            0 => text[at] = random.next() as u8,
            1 => {
                text.truncate(at);
                return text;
            }
            2 => {
                let end = (at + 1 + random.below(40)).min(text.len());
                text.drain(at..end);
            }
            3 => {
                let end = (at + 1 + random.below(400)).min(text.len());
                let copy = text[at..end].to_vec();
                let to = random.below(text.len());
                text.splice(to..to, copy);
            }
            4 | 5 => replace_token(
                &mut text,
                at,
                random,
                |byte| byte.is_ascii_digit() || b".-+E".contains(&byte),
                |random| NUMBERS[random.below(NUMBERS.len())].to_owned(),
            ),
            6 | 7 => {
                if let Some(hash) = text[at..].iter().position(|byte| *byte == b'#') {
                    let number = 1 + random.below(400);
                    replace_token(
                        &mut text,
                        at + hash + 1,
                        random,
                        |byte| byte.is_ascii_digit(),
                        |_| number.to_string(),
                    );
                }
            }
            _ => replace_token(
                &mut text,
                at,
                random,
                |byte| byte.is_ascii_uppercase() || byte == b'_',
                |random| {
                    [
                        "PLANE",
                        "CIRCLE",
                        "EDGE_LOOP",
                        "ADVANCED_FACE",
                        "TOROIDAL_SURFACE",
                        "B_SPLINE_SURFACE",
                        "LINE",
                        "",
                    ][random.below(8)]
                    .to_owned()
                },
            ),
        }
        if text.is_empty() {
            return text;
        }
    }
    text
}

/// Puts something in place of the run of such bytes around a place.
fn replace_token(
    text: &mut Vec<u8>,
    at: usize,
    random: &mut Random,
    is_part: impl Fn(u8) -> bool,
    new: impl Fn(&mut Random) -> String,
) {
    let Some(first) = text[at..].iter().position(|byte| is_part(*byte)).map(|step| at + step) else { return };
    let start = text[..first].iter().rposition(|byte| !is_part(*byte)).map_or(0, |before| before + 1);
    let end = text[first..].iter().position(|byte| !is_part(*byte)).map_or(text.len(), |step| first + step);
    let new = new(random);
    text.splice(start..end, new.into_bytes());
}

/// What became of imports.
#[derive(Debug, Default)]
struct Counts {
    models: usize,
    partial: usize,
    refused: usize,
    too_slow: usize,
}

fn try_import(bytes: Vec<u8>, options: &ReadOptions, counts: &mut Counts) {
    let kept = bytes.clone();
    let failed = |what: &str| {
        let path = std::env::temp_dir().join("perpend-hostile.step");
        let _ = std::fs::write(&path, &kept);
        panic!("{what}; the file is kept as {}", path.display());
    };
    match import(bytes, options) {
        Ok(import) => {
            counts.models += 1;
            counts.partial += usize::from(!import.not_understood.is_empty());
            if let Some(inner) = import.not_understood.iter().find(|left| left.reason.contains("within perpend")) {
                failed(&format!("building {inner} failed"));
            }
            // what was imported can be asked
            match import.model.nearest(DVec3::new(0.3, 0.2, 0.1), &QueryOptions::default()) {
                Ok(Some((_, foot))) if !(foot.distance.is_finite() && foot.lower_bound <= foot.distance) => {
                    failed("an answer is no number");
                }
                Ok(_) => {}
                Err(error) => failed(&format!("the model cannot be asked: {error}")),
            }
        }
        Err(ReadError::Failed { message }) => failed(&format!("the reader failed: {message}")),
        Err(ReadError::TooSlow { .. }) => counts.too_slow += 1,
        Err(error) => {
            counts.refused += 1;
            assert!(!error.to_string().is_empty());
        }
    }
}

/// The most memory that this process has held, where the system tells.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| kilobytes << 10)
}

fn mutations() -> usize {
    std::env::var("PERPEND_MUTATIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(MUTATIONS)
}

#[test]
fn mutations_of_small_files_give_models_or_errors() {
    let files = small_files();
    let options = ReadOptions { max_time: Duration::from_secs(20), ..ReadOptions::default() };
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let mut counts = Counts::default();
    for file in &files {
        try_import(file.clone(), &options, &mut counts);
    }
    // the free curve of one is listed: only faces and their edges are imported
    assert_eq!((counts.models, counts.partial), (files.len(), 1), "unharmed files are understood");
    for k in 0..mutations() {
        try_import(mutated(&files[k % files.len()], &mut random), &options, &mut counts);
    }
    eprintln!("{counts:?}, peak {:?}", peak());
    assert_eq!(counts.too_slow, 0, "a small file takes no 20 seconds");
    assert!(
        counts.models > 3 && counts.refused > 0 && counts.partial > 0,
        "the mutations are neither harmless nor hopeless: {counts:?}"
    );
    assert!(peak().is_none_or(|peak| peak < MEMORY), "the most memory held: {:?}", peak());
}

#[test]
fn one_weight_beyond_all_digits_loses_one_face() {
    let free = small_files().pop().expect("the file of free surfaces");
    let whole = import(free.clone(), &ReadOptions::default()).expect("a valid file");
    let text = String::from_utf8(free).expect("text");
    let at = text.find("RATIONAL_B_SPLINE_SURFACE((").expect("a rational surface");
    let number = at + text[at..].find(|c: char| c.is_ascii_digit()).expect("a weight");
    let end = number + text[number..].find(',').expect("more weights");
    let harmed = format!("{}1.E70{}", &text[..number], &text[end..]);
    let import = import(harmed.into_bytes(), &ReadOptions::default()).expect("a file with one bad surface");
    assert_eq!(import.faces, whole.faces - 1);
    assert!(import.not_understood.iter().any(|left| left.reason.contains("weights")), "{:?}", import.not_understood);
}

#[test]
fn mutations_of_real_files_give_models_or_errors() {
    let Some(folder) = common::real() else { return };
    let names = [
        "aero-assembly/original.step",
        "as1-assembly/original.stp",
        "iea15mw-blade/original.stp",
        "nist-ftc-06/original.step",
        "odri-lower-leg/original.step",
        "tigl-nacelle/original.stp",
    ];
    let files: Vec<Vec<u8>> = names.iter().map(|name| std::fs::read(folder.join(name)).expect("a part")).collect();
    let options = ReadOptions { max_time: Duration::from_secs(60), ..ReadOptions::default() };
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut counts = Counts::default();
    for k in 0..(mutations() / 500).max(12) {
        try_import(mutated(&files[k % files.len()], &mut random), &options, &mut counts);
    }
    eprintln!("{counts:?}, peak {:?}", peak());
    assert_eq!(counts.too_slow, 0, "a file of a few megabytes takes no minute");
}
