//! The page: one file that needs nothing else.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use perpend::EntityId;

use crate::deviation_report::chart::{self, BARS};
use crate::deviation_report::colours::{colour, css};
use crate::deviation_report::number::{Decimals, grouped, round_above};
use crate::deviation_report::scene::{Part, Scene};
use crate::deviation_report::statistics::{Histogram, PERCENTS, Statistics, percentile};
use crate::deviation_report::survey::Survey;
use crate::report::rounded;

const PAGE: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

/// The share of the points that a scale of its own choosing holds, in percent.
const WITHIN_SCALE: f64 = 98.0;

/// What a page tells.
pub(super) struct Report<'a> {
    pub(super) title: String,
    /// The files' names.
    pub(super) model: String,
    pub(super) points: String,
    pub(super) unit: &'static str,
    pub(super) part: &'a Part,
    pub(super) survey: &'a Survey,
    /// The rows that could not be read.
    pub(super) bad: u64,
    /// Where the colours end, if that was asked for.
    pub(super) scale: Option<f64>,
    /// The size of what is drawn.
    pub(super) size: f64,
}

impl Report<'_> {
    /// The page's text.
    pub(super) fn page(&self) -> String {
        let mut deviations = self.survey.deviations();
        let limit = self.scale.unwrap_or_else(|| robust_limit(&deviations, self.size));
        let decimals = Decimals::up_to(limit);
        let statistics = Statistics::of(&mut deviations, limit);
        let histogram = Histogram::of(&deviations, limit, BARS);
        let scene = Scene::new(self.part, &self.survey.drawn, self.unit, limit, decimals);
        let part = |name: &str| match name {
            "version" => env!("CARGO_PKG_VERSION").to_owned(),
            "title" => escaped(&self.title),
            "style" => STYLE.to_owned(),
            "script" => SCRIPT.to_owned(),
            "scene" => scene.json(),
            "unit" => self.unit.to_owned(),
            "summary" => self.summary(),
            "picture" => escaped(&format!(
                "{} with the points of {} in the colours of their deviations",
                self.model, self.points
            )),
            "bar" => chart::colour_bar(limit, decimals, self.unit),
            "drawn" => self.drawn(),
            "histogram" => chart::histogram(&histogram, statistics.as_ref(), decimals, self.unit),
            "histogram-note" => self.histogram_note(limit, decimals),
            "statistics" => self.statistics(statistics.as_ref(), limit, decimals),
            "faces" => self.faces(limit, decimals),
            "meaning" => MEANING.to_owned(),
            other => unreachable!("the page has no place {other}"),
        };
        filled(PAGE, part)
    }

    fn summary(&self) -> String {
        let count: usize = self.survey.of_entity.values().map(Vec::len).sum();
        let noun = if count == 1 { "point" } else { "points" };
        format!("{} {noun} of {} against {}", grouped(count as u64), escaped(&self.points), escaped(&self.model))
    }

    /// What is in the picture, and what is not.
    fn drawn(&self) -> String {
        let points = &self.survey.drawn;
        let kept = grouped(points.points.len() as u64);
        let which = match points.every {
            1 => format!("All {kept} points are drawn"),
            every => format!("{kept} points are drawn, one of {}; the figures hold for all", grouped(every)),
        };
        format!(
            "{which}. The surfaces are drawn with {} triangles, within {} {}.",
            grouped(self.part.triangles as u64),
            rounded(self.part.error),
            self.unit
        )
    }

    fn histogram_note(&self, limit: f64, decimals: Decimals) -> String {
        let end = decimals.at_axis(limit);
        let why = if self.scale.is_some() {
            "as asked".to_owned()
        } else {
            format!("so that {WITHIN_SCALE} % of the points lie within")
        };
        format!(
            "The scale ends at ±{end} {}, {why}; the bars at the ends hold what is beyond. The band is one standard deviation wide at each side of the mean.",
            self.unit
        )
    }

    fn statistics(&self, statistics: Option<&Statistics>, limit: f64, decimals: Decimals) -> String {
        let show = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| decimals.show(value));
        let of = |value: fn(&Statistics) -> f64| show(statistics.map(value));
        let count = |value: fn(&Statistics) -> usize| grouped(statistics.map_or(0, value) as u64);
        let end = decimals.at_axis(limit);
        let measures = [
            ("points".to_owned(), count(|s| s.count)),
            ("mean".to_owned(), of(|s| s.mean)),
            ("standard deviation".to_owned(), show(statistics.and_then(|s| s.deviation))),
            ("RMS".to_owned(), of(|s| s.rms)),
            ("minimum".to_owned(), of(|s| s.min)),
            ("maximum".to_owned(), of(|s| s.max)),
            (format!("below -{end}"), count(|s| s.below)),
            (format!("above {end}"), count(|s| s.above)),
        ];
        let percents = PERCENTS.iter().enumerate().map(|(i, percent)| {
            let name = if *percent == 50.0 { "median".to_owned() } else { format!("{percent} %") };
            (name, show(statistics.map(|s| s.percentiles[i])))
        });
        let proof = [
            ("not certified", self.survey.uncertified),
            ("without a side", self.survey.without_side),
            ("rows not read", self.bad),
        ];
        let gap = ("largest gap".to_owned(), format!("{:.2e}", self.survey.largest_gap));
        let proof = proof.map(|(name, count)| (name.to_owned(), grouped(count))).into_iter().chain([gap]);
        format!(
            "<div class=\"pairs\">\n{}{}</div>\n<h2>Proof</h2>\n{}",
            pairs("measures", "Measures", measures),
            pairs("percentiles", "Percentiles", percents),
            pairs("proof", "Proof", proof)
        )
    }

    fn faces(&self, limit: f64, decimals: Decimals) -> String {
        let names: BTreeMap<EntityId, &str> = self.part.names().collect();
        let mut html = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table of the faces\">\n<table id=\"by-face\">\n<thead><tr>".to_owned();
        for name in ["Id", "Name", "Points", "Mean", "RMS", "Min", "Max", "Out of scale"] {
            let _ = write!(html, "<th scope=\"col\">{name}</th>");
        }
        html.push_str("</tr></thead>\n<tbody>\n");
        for (id, deviations) in &self.survey.of_entity {
            let Some(of) = Statistics::of(&mut deviations.clone(), limit) else {
                continue;
            };
            let _ = write!(
                html,
                "<tr><td>{id}</td><td>{}</td><td data-value=\"{count}\">{}</td>",
                escaped(names.get(id).copied().unwrap_or_default()),
                grouped(of.count as u64),
                count = of.count,
            );
            let _ = write!(
                html,
                "<td data-value=\"{:?}\"><span class=\"chip\" style=\"background:{}\"></span>{}</td>",
                of.mean,
                css(colour(of.mean / limit)),
                decimals.show(of.mean)
            );
            for value in [of.rms, of.min, of.max] {
                let _ = write!(html, "<td data-value=\"{value:?}\">{}</td>", decimals.show(value));
            }
            let outside = of.below + of.above;
            let _ = writeln!(html, "<td data-value=\"{outside}\">{}</td></tr>", grouped(outside as u64));
        }
        html.push_str("</tbody>\n</table>\n</div>\n");
        let unasked = names.keys().filter(|id| !self.survey.of_entity.contains_key(id)).count();
        if unasked > 0 {
            let noun = if unasked == 1 { "entity is" } else { "entities are" };
            let _ = writeln!(html, "<p class=\"note\">{} {noun} nearest to no point.</p>", grouped(unasked as u64));
        }
        html
    }
}

const MEANING: &str = "\
A deviation is the distance from a measured point to the nearest point of the model, positive on the side of the surface's normal and negative \
behind it, or, of a closed body, positive outside and negative inside; of curves, and where a surface has no normal, it has no side and is \
positive. No point of the model is nearer than the lower \
bound, which is proven, rounding included: the true distance lies between the two. An answer is not certified where they are farther apart \
than 1e-9 of the model's size. The standard deviation is that of a sample, with n - 1; percentiles are interpolated. Made by perpend.";

/// A limit that most points lie within, a round number; for points of which most have no deviation, a share of the size.
fn robust_limit(deviations: &[f64], size: f64) -> f64 {
    let mut sizes: Vec<f64> = deviations.iter().map(|deviation| deviation.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let least = if size > 0.0 { 1e-9 * size } else { 1e-9 };
    let wanted = if sizes.is_empty() { least } else { percentile(&sizes, WITHIN_SCALE) };
    round_above(wanted.max(least))
}

/// A table of names and values.
fn pairs(id: &str, caption: &str, rows: impl IntoIterator<Item = (String, String)>) -> String {
    let mut html = format!("<table id=\"{id}\" aria-label=\"{caption}\"><tbody>\n");
    for (name, value) in rows {
        let _ = writeln!(html, "<tr><th scope=\"row\">{name}</th><td>{value}</td></tr>");
    }
    html.push_str("</tbody></table>\n");
    html
}

/// The template with its places `{{name}}` filled.
fn filled(template: &str, part: impl Fn(&str) -> String) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        let (name, after) = after.split_once("}}").expect("a place in the page ends");
        page.push_str(before);
        page.push_str(&part(name));
        rest = after;
    }
    page + rest
}

/// Text as it stands in HTML, also within quotes.
fn escaped(text: &str) -> String {
    let mut html = String::new();
    for letter in text.chars() {
        match letter {
            '&' => html.push_str("&amp;"),
            '<' => html.push_str("&lt;"),
            '>' => html.push_str("&gt;"),
            '"' => html.push_str("&quot;"),
            letter => html.push(letter),
        }
    }
    html
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_holds_most_points_and_is_never_nothing() {
        let mut deviations: Vec<f64> = (0..=98).map(|i| f64::from(i) * 0.01 - 0.49).collect();
        deviations.push(1e6);
        assert_eq!(robust_limit(&deviations, 1.0), 0.5);
        assert_eq!(robust_limit(&[0.0; 5], 90.0), 1e-7);
        assert!(robust_limit(&[], 0.0) > 0.0);
    }

    #[test]
    fn text_cannot_become_markup() {
        assert_eq!(escaped("<b a=\"1\">&"), "&lt;b a=&quot;1&quot;&gt;&amp;");
        assert_eq!(filled("a{{x}}b{{y}}", |name| name.repeat(2)), "axxbyy");
    }
}
