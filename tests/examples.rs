//! The examples: their files are what the code makes, and the code makes them alike each time.

use std::fs;
use std::path::{Path, PathBuf};

use perpend::{DVec3, Definition, Direction, EntityId, FootPoint, Model, Multiplicity, Parameter, QueryOptions};

#[path = "../examples/draw_wave/picture.rs"]
mod picture;
#[path = "../examples/draw_wave/svg.rs"]
mod svg;
#[path = "../examples/workshop/mod.rs"]
mod workshop;

const FILES: [&str; 3] = ["workshop.ron", "scan.csv", "cloud.csv"];

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples")
}

/// An empty folder of this test's own.
fn fresh_folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        fs::remove_dir_all(&folder).unwrap();
    }
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The rows of a point file below its header, as numbers.
fn rows(file: &str, header: &str) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(examples().join(file)).unwrap();
    let (first, rest) = text.split_once('\n').unwrap();
    assert_eq!(first, header, "{file}");
    rest.lines().map(|line| line.split(',').map(|number| number.parse().unwrap()).collect()).collect()
}

#[test]
fn making_the_workshop_twice_gives_the_files_of_the_repository() {
    let folders = [fresh_folder("workshop-1"), fresh_folder("workshop-2")];
    for folder in &folders {
        let model = workshop::make(folder).unwrap();
        assert_eq!(Model::read(folder.join("workshop.ron")).unwrap(), model);
    }
    for file in FILES {
        let made = fs::read(folders[0].join(file)).unwrap();
        assert_eq!(made, fs::read(folders[1].join(file)).unwrap(), "{file}: two runs differ");
        let committed = fs::read(examples().join(file)).unwrap();
        assert!(made == committed, "{file} is not what the code makes: run `cargo run --example make_workshop`");
    }
}

#[test]
fn the_workshop_is_short_and_has_what_it_promises() {
    let model = Model::read(examples().join("workshop.ron")).unwrap();
    let length = fs::metadata(examples().join("workshop.ron")).unwrap().len();
    assert!(length < 150_000, "{length} bytes are too many to read");
    for entity in model.entities() {
        assert_eq!(model.named(entity.name()).count(), 1, "{} is a name of two", entity.name());
        let classification = entity.record().and_then(|record| record.classification.as_ref()).unwrap();
        assert!(classification.origin.is_some() && !classification.destination.is_empty(), "{}", entity.name());
        assert_eq!(entity.stale(), Vec::<String>::new(), "{}", entity.name());
    }
    let surface = |name: &str| {
        let entity = model.named(name).next().unwrap();
        let Definition::NurbsSurface(surface) = entity.definition().as_ref() else { panic!("{name} is a curve") };
        surface.clone()
    };
    let pan = surface("dust pan");
    assert_eq!((pan.degree(), pan.rows(), pan.columns()), ((3, 3), 20, 14));
    // closed around, with a pole where u ends
    let handle = surface("brush handle");
    let ((_, last), (from, to)) = (handle.domain(Direction::U), handle.domain(Direction::V));
    for k in 0..=16 {
        let share = f64::from(k) / 16.0; // points at most a few hundred millimetres out: 1e-12 is their rounding
        assert!(handle.point(share * last, from).distance(handle.point(share * last, to)) < 1e-12);
        assert!(handle.point(last, from).distance(handle.point(last, from + share * (to - from))) < 1e-12);
    }
}

#[test]
fn every_point_of_the_scan_has_a_certified_answer() {
    let model = Model::read(examples().join("workshop.ron")).unwrap();
    let scan = rows("scan.csv", "entity,x,y,z");
    assert!((1_900..=2_100).contains(&scan.len()), "{} points", scan.len());
    let mut tied = 0;
    for row in &scan {
        let &[id, x, y, z] = &row[..] else { panic!("{row:?}") };
        let (id, p) = (EntityId::new(id as u64), DVec3::new(x, y, z));
        let foot = model.project(id, p).unwrap();
        certified(&foot, p, &model, id, model.entity(id).unwrap().definition().size());
        tied += usize::from(foot.multiplicity != Multiplicity::Unique);
    }
    assert!(tied >= 20, "{tied} points tie");
}

#[test]
fn every_point_of_the_cloud_has_a_certified_answer() {
    let model = Model::read(examples().join("workshop.ron")).unwrap();
    let cloud = rows("cloud.csv", "x,y,z");
    assert_eq!(cloud.len(), 1_000);
    let largest = model.entities().iter().map(|entity| entity.definition().size()).fold(0.0, f64::max);
    let mut answered = std::collections::BTreeSet::new();
    for row in &cloud {
        let p = DVec3::new(row[0], row[1], row[2]);
        let (id, foot) = model.nearest(p, &QueryOptions::default()).unwrap().unwrap();
        // the bound holds for all entities that were asked, the largest of them perhaps among them
        certified(&foot, p, &model, id, largest);
        answered.insert(id);
    }
    // four curves lie on surfaces made from them, whose answers may win
    assert!(answered.len() >= model.len() - 4, "{} entities are nearest to a point", answered.len());
}

/// Fails unless the answer keeps its promises, `size` being that of the largest entity that took part.
fn certified(foot: &FootPoint, p: DVec3, model: &Model, id: EntityId, size: f64) {
    let definition = model.entity(id).unwrap().definition();
    let reach =
        model.entities().iter().map(|entity| entity.definition().reach()).fold(0.0, f64::max) + p.abs().max_element();
    let promised = 1e-9 * size + 32.0 * f64::EPSILON * reach;
    assert!(foot.gap() >= 0.0 && foot.gap() <= promised, "{id}, {p}: gap {:e}", foot.gap());
    let there = match (definition.as_ref(), foot.parameter) {
        (Definition::NurbsCurve(curve), Parameter::Curve(u)) => curve.point(u),
        (Definition::NurbsSurface(surface), Parameter::Surface(u, v)) => surface.point(u, v),
        (_, parameter) => panic!("{id}: {parameter:?}"),
    };
    assert_eq!(there, foot.point, "{id}, {p}");
    assert!((p.distance(foot.point) - foot.distance).abs() <= 8.0 * f64::EPSILON * reach, "{id}, {p}");
}

#[test]
fn the_pictures_of_the_book_show_what_the_wave_holds() {
    let model = workshop::model().unwrap();
    let count = |text: &str, what: &str| text.matches(what).count();
    for (name, drawn) in picture::all(&model).unwrap() {
        let kept = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name)).unwrap();
        // the last digit of a coordinate may differ where sines do
        for shape in ["<polygon", "<polyline", "<circle", "<path", "<text"] {
            assert_eq!(count(&drawn, shape), count(&kept, shape), "{shape} in {name}: draw_wave draws it anew");
        }
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"), "{name}");
    }
    let pictures = picture::all(&model).unwrap();
    let coil = model.named("coil").next().unwrap();
    let definition = coil.definition();
    let wave = perpend::Wave::new(definition.clone(), perpend::WaveSettings::recommended(definition));
    let cells = &pictures.iter().find(|(name, _)| *name == "wave-cells.svg").unwrap().1;
    assert_eq!(count(cells, r#"class="point""#), wave.points().len());
}
