//! Drawings of space: a camera without perspective, and shapes that are painted from back to front.

use std::fmt::Write;

use perpend::DVec3;

/// Which way a drawing looks at space; up is z.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Camera {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
}

impl Camera {
    /// From an azimuth around z and an elevation over the horizon, in degrees.
    pub(crate) fn new(azimuth: f64, elevation: f64) -> Self {
        let ((sa, ca), (se, ce)) = (azimuth.to_radians().sin_cos(), elevation.to_radians().sin_cos());
        let towards = DVec3::new(ca * ce, sa * ce, se);
        let right = DVec3::new(-sa, ca, 0.0);
        Self { right, up: towards.cross(right), towards }
    }

    fn at(self, p: DVec3) -> (f64, f64) {
        (p.dot(self.right), -p.dot(self.up))
    }

    /// How far a point lies towards the one who looks.
    pub(crate) fn depth(self, p: DVec3) -> f64 {
        p.dot(self.towards)
    }

    /// How bright a surface with this normal is, from 0 to 1, lit from over the left shoulder.
    pub(crate) fn light(self, normal: DVec3) -> f64 {
        let lamp = (self.towards + 0.6 * self.up - 0.5 * self.right).normalize();
        normal.normalize_or_zero().dot(lamp).abs()
    }
}

/// A rectangle of a drawing, with a caption, in which a part of space is shown.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Panel {
    camera: Camera,
    scale: f64,
    offset: (f64, f64),
}

/// A drawing of some panels side by side.
#[derive(Debug)]
pub(crate) struct Drawing {
    height: f64,
    width: f64,
    body: String,
}

/// Room about a panel, and for its caption.
const MARGIN: f64 = 14.0;
const CAPTION: f64 = 22.0;

impl Drawing {
    pub(crate) fn new(height: f64) -> Self {
        Self { height, width: 0.0, body: String::new() }
    }

    /// Adds a panel that shows the points, as wide as they need at a height of the drawing, at most `widest`.
    pub(crate) fn panel(
        &mut self,
        camera: Camera,
        points: impl Iterator<Item = DVec3>,
        widest: f64,
        caption: &str,
    ) -> Panel {
        let (mut low, mut high) = ((f64::MAX, f64::MAX), (f64::MIN, f64::MIN));
        for (x, y) in points.map(|p| camera.at(p)) {
            (low, high) = ((low.0.min(x), low.1.min(y)), (high.0.max(x), high.1.max(y)));
        }
        let room = self.height - 2.0 * MARGIN - CAPTION;
        let scale = (room / (high.1 - low.1)).min((widest - 2.0 * MARGIN) / (high.0 - low.0));
        let width = scale * (high.0 - low.0) + 2.0 * MARGIN;
        let offset =
            (self.width + MARGIN - scale * low.0, MARGIN + 0.5 * (room - scale * (high.1 - low.1)) - scale * low.1);
        let _ = writeln!(
            self.body,
            r#"<text x="{:.1}" y="{:.1}" text-anchor="middle">{caption}</text>"#,
            self.width + 0.5 * width,
            self.height - 10.0
        );
        self.width += width;
        Panel { camera, scale, offset }
    }

    /// A closed polygon.
    pub(crate) fn polygon(&mut self, panel: Panel, points: &[DVec3], style: &str) {
        self.shape("polygon", panel, points, style);
    }

    /// An open line.
    pub(crate) fn line(&mut self, panel: Panel, points: &[DVec3], style: &str) {
        self.shape("polyline", panel, points, style);
    }

    fn shape(&mut self, kind: &str, panel: Panel, points: &[DVec3], style: &str) {
        let points: Vec<String> = points
            .iter()
            .map(|p| {
                let (x, y) = panel.at(*p);
                format!("{x:.1},{y:.1}")
            })
            .collect();
        let _ = writeln!(self.body, r#"<{kind} points="{}" {style}/>"#, points.join(" "));
    }

    /// A dot of a radius in pixels.
    pub(crate) fn dot(&mut self, panel: Panel, p: DVec3, radius: f64, style: &str) {
        let (x, y) = panel.at(p);
        let _ = writeln!(self.body, r#"<circle cx="{x:.1}" cy="{y:.1}" r="{radius}" {style}/>"#);
    }

    /// A cross of a half width in pixels.
    pub(crate) fn cross(&mut self, panel: Panel, p: DVec3, half: f64, style: &str) {
        let (x, y) = panel.at(p);
        let (a, b, side) = (x - half, y - half, 2.0 * half);
        let _ = writeln!(self.body, r#"<path d="M{a:.1},{b:.1}l{side},{side}m0-{side}l-{side},{side}" {style}/>"#);
    }

    /// The text of the file.
    pub(crate) fn finish(self) -> String {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w:.0} {h:.0}\" width=\"{w:.0}\" height=\"{h:.0}\" \
             font-family=\"sans-serif\" font-size=\"13\" fill=\"#333\" stroke-width=\"0.6\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
             <style>path.point{{fill:none;stroke:#b3261e;stroke-width:.9}}.rim{{fill:none;stroke:#8a94a3;stroke-width:.35}}</style>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{body}</svg>\n",
            w = self.width,
            h = self.height,
            body = self.body
        )
    }
}

impl Panel {
    fn at(self, p: DVec3) -> (f64, f64) {
        let (x, y) = self.camera.at(p);
        (self.offset.0 + self.scale * x, self.offset.1 + self.scale * y)
    }

    pub(crate) fn camera(self) -> Camera {
        self.camera
    }
}
