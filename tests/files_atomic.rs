//! Files are written whole or not at all.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use perpend::{AtomicFile, CurveData, DVec3, Model};

/// A folder of its own for a test, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("perpend-atomic-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// What is in it, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("a folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A model whose file has about 40 bytes a point.
fn model(points: usize) -> Model {
    let count = points as f64;
    let knots = (0..points).map(|k| k as f64 / count);
    let curve = CurveData {
        degree: 1,
        knots: [0.0].into_iter().chain(knots).chain([(count - 1.0) / count]).collect(),
        control_points: (0..points).map(|k| DVec3::new(k as f64, (k as f64).sin(), (k as f64).cos())).collect(),
        weights: None,
    };
    let mut model = Model::new();
    model.insert("long", curve).expect("a valid curve");
    model
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).expect("a file")
}

#[test]
fn a_model_is_written_and_read_back() {
    let folder = Folder::new("back");
    let path = folder.path("model.ron");
    for points in [2, 5_000, 3] {
        model(points).write(&path).expect("a place to write");
        assert_eq!(Model::read(&path).expect("a model"), model(points));
        assert_eq!(text(&path), model(points).to_ron());
        assert_eq!(folder.names(), ["model.ron"]);
    }
}

#[test]
fn until_it_is_committed_the_old_file_stands() {
    let folder = Folder::new("commit");
    let path = folder.path("out.csv");
    fs::write(&path, "old").expect("a place to write");
    let mut file = AtomicFile::create(&path).expect("a place to write");
    file.write_all(&[b'x'; 100_000]).expect("room");
    file.flush().expect("room");
    assert_eq!(text(&path), "old");
    assert_eq!(folder.names().len(), 2);
    file.commit().expect("room");
    assert_eq!(text(&path).len(), 100_000);
    assert_eq!(folder.names(), ["out.csv"]);
}

#[test]
fn a_file_given_up_leaves_nothing() {
    let folder = Folder::new("given-up");
    let path = folder.path("out.csv");
    let mut file = AtomicFile::create(&path).expect("a place to write");
    file.write_all(b"half").expect("room");
    drop(file);
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn two_writers_of_one_file_do_not_mix() {
    let folder = Folder::new("two");
    let path = folder.path("out.csv");
    let mut one = AtomicFile::create(&path).expect("a place to write");
    let mut other = AtomicFile::create(&path).expect("a place to write");
    one.write_all(b"one").expect("room");
    other.write_all(b"other").expect("room");
    one.commit().expect("room");
    assert_eq!(text(&path), "one");
    other.commit().expect("room");
    assert_eq!(text(&path), "other");
}

#[test]
fn where_nothing_can_be_written_the_error_says_why() {
    let folder = Folder::new("refused");
    let message = |path: &Path| model(2).write(path).expect_err("no place to write").to_string();
    let missing = folder.path("no/such/out.ron");
    assert_eq!(
        message(&missing),
        format!(
            "cannot write {}: there is no folder {}; create it first",
            missing.display(),
            folder.path("no/such").display()
        )
    );
    assert_eq!(
        message(&folder.0),
        format!("cannot write {}: it is a directory; name a file in it", folder.0.display())
    );
    let kept = folder.path("kept.ron");
    fs::write(&kept, "old").expect("a place to write");
    let mut permissions = fs::metadata(&kept).expect("a file").permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&kept, permissions).expect("a file of ours");
    assert_eq!(
        message(&kept),
        format!("cannot write {}: it is read-only; make it writable or name another file", kept.display())
    );
    assert_eq!(text(&kept), "old");
    let within = kept.join("out.ron");
    assert!(message(&within).starts_with(&format!("cannot write {}: ", within.display())));
    assert_eq!(folder.names(), ["kept.ron"]);
}

#[test]
fn a_file_in_the_current_folder_needs_no_folder_in_its_path() {
    let name = format!("perpend-atomic-{}.ron", std::process::id());
    let result = model(2).write(&name);
    let written = text(Path::new(&name));
    fs::remove_file(&name).expect("the file");
    result.expect("a place to write");
    assert_eq!(written, model(2).to_ron());
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::os::unix::process::ExitStatusExt;
    use std::process::{Command, ExitStatus};

    use super::*;

    #[test]
    fn the_permissions_of_the_old_file_are_kept() {
        let folder = Folder::new("permissions");
        let path = folder.path("out.ron");
        for mode in [0o600, 0o664, 0o755] {
            fs::write(&path, "old").expect("a place to write");
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).expect("a file of ours");
            model(2).write(&path).expect("a place to write");
            assert_eq!(fs::metadata(&path).expect("a file").permissions().mode() & 0o777, mode);
        }
    }

    #[test]
    fn a_link_stays_and_its_file_is_replaced() {
        let folder = Folder::new("links");
        fs::create_dir(folder.path("deep")).expect("a place to write");
        fs::write(folder.path("deep/real.ron"), "old").expect("a place to write");
        symlink("deep/real.ron", folder.path("link.ron")).expect("a place to write");
        symlink("link.ron", folder.path("link-to-link.ron")).expect("a place to write");
        symlink("deep/new.ron", folder.path("dangling.ron")).expect("a place to write");
        symlink("round.ron", folder.path("round.ron")).expect("a place to write");
        model(2).write(folder.path("link-to-link.ron")).expect("a place to write");
        assert_eq!(text(&folder.path("deep/real.ron")), model(2).to_ron());
        model(3).write(folder.path("dangling.ron")).expect("a place to write");
        assert_eq!(text(&folder.path("deep/new.ron")), model(3).to_ron());
        for link in ["link.ron", "link-to-link.ron", "dangling.ron"] {
            assert!(fs::symlink_metadata(folder.path(link)).expect("a link").is_symlink(), "{link}");
        }
        let message = model(2).write(folder.path("round.ron")).expect_err("no file").to_string();
        assert!(message.contains("too many symbolic links"), "{message}");
        assert_eq!(folder.names(), ["dangling.ron", "deep", "link-to-link.ron", "link.ron", "round.ron"]);
    }

    #[test]
    fn a_device_is_written_and_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        model(2).write("/dev/null").expect("it takes everything");
        assert!(fs::metadata("/dev/null").expect("a device").file_type().is_char_device());
    }

    /// Runs this very test in a child that may write no file above 8 KiB, with `before` said to its shell first.
    fn limited(test: &str, before: &str, path: &Path) -> ExitStatus {
        let program = std::env::current_exe().expect("a test is a program");
        Command::new("sh")
            .args(["-c", &format!("{before} ulimit -f 16; exec \"$0\" --exact {test}")])
            .arg(program)
            .env("PERPEND_WRITE", path)
            .output()
            .expect("a shell")
            .status
    }

    /// In the child: writes a file that is too large, and the message that this gives beside it.
    fn write_too_much() -> bool {
        let Some(path) = std::env::var_os("PERPEND_WRITE") else { return false };
        let path = PathBuf::from(path);
        let message = model(5_000).write(&path).expect_err("the limit").to_string();
        fs::write(path.with_extension("message"), message).expect("a short file");
        true
    }

    #[test]
    fn a_write_that_meets_a_limit_says_so_and_leaves_the_old_file() {
        if write_too_much() {
            return;
        }
        let folder = Folder::new("limit");
        let path = folder.path("model.ron");
        model(3).write(&path).expect("a place to write");
        // ignored, the signal of the limit becomes an error of the write
        let name = "unix::a_write_that_meets_a_limit_says_so_and_leaves_the_old_file";
        let status = limited(name, "trap '' XFSZ;", &path);
        assert!(status.success(), "{status}");
        assert_eq!(Model::read(&path).expect("the old file"), model(3));
        assert_eq!(folder.names(), ["model.message", "model.ron"]);
        let message = text(&folder.path("model.message"));
        assert!(message.starts_with(&format!("cannot write {}: File too large", path.display())), "{message}");
        assert!(message.ends_with("; what it held before is as it was"), "{message}");
    }

    #[test]
    fn a_process_that_dies_while_it_writes_leaves_the_old_file() {
        if write_too_much() {
            return;
        }
        let folder = Folder::new("killed");
        let path = folder.path("model.ron");
        model(3).write(&path).expect("a place to write");
        let status = limited("unix::a_process_that_dies_while_it_writes_leaves_the_old_file", "", &path);
        // where whoever runs the tests ignores the signal, it cannot be had back, and the write fails as above
        assert!(status.signal().is_some() || folder.path("model.message").exists(), "{status}");
        assert_eq!(Model::read(&path).expect("the old file"), model(3));
    }
}
