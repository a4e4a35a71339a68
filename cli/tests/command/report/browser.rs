//! The page in Chromium, where there is one; elsewhere these tests say that they skipped.
#![allow(clippy::print_stderr, reason = "a test that skips says so")]

use std::process::{Command, Stdio};

use super::{POINTS, report};
use crate::workshop::Workshop;

/// What the page has become after its script ran, at this size of the window; none without a browser.
fn shown(workshop: &Workshop, file: &str, size: &str) -> Option<String> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let is_there = |name: &&str| {
        let version = Command::new(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
        version.is_ok_and(|status| status.success())
    };
    let Some(browser) = names.into_iter().find(is_there) else {
        eprintln!("skipped: there is no {}", names.join(", no "));
        return None;
    };
    let output = Command::new(browser)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
        ])
        .args(["--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update"])
        .args(["--disable-sync", "--virtual-time-budget=8000", "--dump-dom"])
        .arg(format!("--window-size={size}"))
        .arg(format!("--user-data-dir={}", workshop.path("profile").display()))
        .arg(format!("file://{}", workshop.path(file).display()))
        .output()
        .unwrap();
    Some(String::from_utf8(output.stdout).unwrap())
}

/// A page of the table with these points and this scale, and with a script of the test's own at its end.
fn page(points: &str, scale: &str, script: &str) -> Workshop {
    let workshop = Workshop::new();
    report(&workshop, points, &["--entity", "2", "--scale", scale]).ends(0, "");
    let page = workshop.read("report.html");
    let with_script = page.replace("</body>", &format!("<script>{script}</script></body>"));
    workshop.write("report.html", with_script);
    workshop
}

/// The start tag of the document, as the script left it.
fn root(dom: &str) -> &str {
    let (_, root) = dom.split_once("<html").expect("a document");
    root.split('>').next().unwrap()
}

#[test]
fn the_script_draws_all_points_and_triangles() {
    let Some(dom) = shown(&page(POINTS, "0.5", ""), "report.html", "1200,900") else { return };
    let root = root(&dom);
    for said in ["data-state=\"drawn\"", "data-points=\"4\"", "data-triangles=\"2\""] {
        assert!(root.contains(said), "{said} in {root}");
    }
    assert!(dom.contains("<p id=\"message\" hidden=\"\">"));
}

/// Counts the picture's pixels that are reddish, bluish and any, and tells them in the document.
const COUNT: &str = "
    {
      const canvas = document.getElementById('canvas');
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [canvas.width, canvas.height];
      const context = copy.getContext('2d');
      context.drawImage(canvas, 0, 0);
      const { data } = context.getImageData(0, 0, copy.width, copy.height);
      const found = { red: 0, blue: 0, any: 0 };
      for (let i = 0; i < data.length; i += 4) {
        found.any += data[i + 3] > 0;
        found.red += data[i + 3] > 0 && data[i] > data[i + 2] + 60;
        found.blue += data[i + 3] > 0 && data[i + 2] > data[i] + 60;
      }
      Object.entries(found).forEach(([name, count]) => { document.documentElement.dataset[name] = count; });
    }";

/// A number that the test's script left in the document.
fn number(root: &str, name: &str) -> u64 {
    let (_, value) = root.split_once(&format!("data-{name}=\"")).unwrap_or_else(|| panic!("no {name} in {root}"));
    value.split('"').next().unwrap().parse().unwrap()
}

#[test]
fn the_picture_shows_the_part_and_the_points_in_their_colours() {
    let Some(dom) = shown(&page("x,y,z\n1,1,10.5\n3,3,10.5\n", "0.5", COUNT), "report.html", "1200,900") else {
        return;
    };
    let found = ["red", "blue", "any"].map(|name| number(root(&dom), name));
    assert!(found[0] > 40 && found[1] == 0 && found[2] > 20_000, "two points above the table: {found:?}");
    let dom = shown(&page("x,y,z\n1,1,9.96\n", "0.04", COUNT), "report.html", "400,800").expect("it was there before");
    let found = ["red", "blue", "any"].map(|name| number(root(&dom), name));
    assert!(found[0] == 0 && found[1] > 20 && found[2] > 2000, "one point just below it, seen all the same: {found:?}");
}

/// Moves a pointer over the picture until something is told, and stops there.
const HOVER: &str = "
    (() => {
      const canvas = document.getElementById('canvas');
      const box = canvas.getBoundingClientRect();
      for (let y = 4; y < box.height; y += 8) {
        for (let x = 4; x < box.width; x += 8) {
          canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: box.left + x, clientY: box.top + y, pointerId: 1, pointerType: 'mouse' }));
          if (!document.getElementById('tip').hidden) return;
        }
      }
    })();";

#[test]
fn a_point_under_the_pointer_is_told() {
    let Some(dom) = shown(&page("x,y,z\n\n2.25,1.5,10.375\n", "0.5", HOVER), "report.html", "500,700") else { return };
    let (_, tip) = dom.split_once("id=\"tip\"").expect("a place for what is told");
    let tip = tip.split_once("</div>").unwrap().0;
    assert!(!tip.contains("hidden"), "{tip}");
    for said in ["+0.37500 mm", "<dd>3</dd>", "<dd>2.25</dd>", "<dd>1.5</dd>", "<dd>10.375</dd>", "<dd>2 table</dd>"] {
        assert!(tip.contains(said), "{said} in {tip}");
    }
}

#[test]
fn without_webgl_the_page_says_so_and_keeps_its_figures() {
    let workshop = Workshop::new();
    report(&workshop, POINTS, &["--entity", "2"]).ends(0, "");
    let without =
        "<script>HTMLCanvasElement.prototype.getContext = () => null;</script><script type=\"application/json\"";
    let page = workshop.read("report.html").replacen("<script type=\"application/json\"", without, 1);
    workshop.write("report.html", page);
    let Some(dom) = shown(&workshop, "report.html", "1200,900") else { return };
    assert!(root(&dom).contains("data-state=\"failed\""));
    assert!(dom.contains("<p id=\"message\">The picture needs WebGL 2, which this browser does not give."));
    assert!(dom.contains("id=\"histogram\"") && dom.contains("<th scope=\"row\">mean</th><td>0.1250</td>"));
}
