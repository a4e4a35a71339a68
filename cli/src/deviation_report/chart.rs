//! The histogram and the colour bar, as pictures in the page.

use std::fmt::Write as _;

use crate::deviation_report::colours::{STOPS, colour, css};
use crate::deviation_report::number::{Decimals, grouped, round_above};
use crate::deviation_report::statistics::{Histogram, Statistics};

/// How many bars a histogram has within its limits: few enough to be seen on a narrow screen.
pub(super) const BARS: usize = 40;

/// Where the bars stand, in the picture's units.
const LEFT: f64 = 66.0;
const RIGHT: f64 = 412.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 198.0;
/// The bars of what is beyond the limits stand outside, apart from the others.
const OUTER: f64 = 12.0;
const APART: f64 = 5.0;

/// The histogram, with the mean and one standard deviation at each side of it.
pub(super) fn histogram(bars: &Histogram, statistics: Option<&Statistics>, decimals: Decimals, unit: &str) -> String {
    let limit = bars.limit;
    let x = |deviation: f64| LEFT + (deviation / limit + 1.0) / 2.0 * (RIGHT - LEFT);
    let (below, above) = statistics.map_or((0, 0), |statistics| (statistics.below, statistics.above));
    let most = bars.counts.iter().copied().chain([below, above]).max().unwrap_or(0);
    let step = round_above((most.max(1) as f64) / 4.0).max(1.0).ceil();
    let full = step * (most.max(1) as f64 / step).ceil();
    let y = |count: f64| BOTTOM - count / full * (BOTTOM - TOP);
    let mut svg = format!(
        "<svg class=\"chart\" id=\"histogram\" viewBox=\"0 0 440 244\" role=\"img\" aria-label=\"{}\">\n",
        words(bars, statistics, decimals, unit)
    );
    for tick in 0..=(full / step).round() as usize {
        let count = tick as f64 * step;
        let _ = writeln!(
            svg,
            "<path class=\"grid\" d=\"M{:.1} {at:.1}H{:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - APART - OUTER,
            RIGHT + APART + OUTER,
            LEFT - APART - OUTER - 5.0,
            y(count) + 4.0,
            grouped(count as u64),
            at = y(count),
        );
    }
    let spread = statistics.and_then(|statistics| Some((statistics.mean, statistics.deviation?)));
    if let Some((mean, deviation)) = spread {
        let [from, to] = [mean - deviation, mean + deviation].map(|at| x(at.clamp(-limit, limit)));
        let _ = writeln!(
            svg,
            "<rect class=\"spread\" x=\"{from:.1}\" y=\"{TOP}\" width=\"{:.1}\" height=\"{:.1}\"/>",
            to - from,
            BOTTOM - TOP
        );
    }
    let width = (RIGHT - LEFT) / bars.counts.len() as f64;
    let mut bar = |left: f64, width: f64, count: usize, share: f64, what: &str| {
        if count > 0 {
            let top = y(count as f64).min(BOTTOM - 1.0);
            let _ = writeln!(
                svg,
                "<rect class=\"rim\" x=\"{left:.2}\" y=\"{top:.1}\" width=\"{width:.2}\" height=\"{:.1}\" fill=\"{}\"><title>{what}: {}</title></rect>",
                BOTTOM - top,
                css(colour(share)),
                grouped(count as u64),
            );
        }
    };
    for (i, count) in bars.counts.iter().enumerate() {
        let share = |i: usize| 2.0 * i as f64 / bars.counts.len() as f64 - 1.0;
        let [from, to] = [i, i + 1].map(|i| decimals.show(share(i) * limit));
        let middle = (share(i) + share(i + 1)) / 2.0;
        bar(LEFT + i as f64 * width, width, *count, middle, &format!("{from} to {to} {unit}"));
    }
    let end = decimals.at_axis(limit);
    bar(LEFT - APART - OUTER, OUTER, below, -1.0, &format!("below -{end} {unit}"));
    bar(RIGHT + APART, OUTER, above, 1.0, &format!("above {end} {unit}"));
    let _ = writeln!(svg, "<path class=\"axis\" d=\"M{LEFT} {BOTTOM}H{RIGHT}\"/>");
    for share in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let at = x(share * limit);
        let _ = writeln!(
            svg,
            "<path class=\"axis\" d=\"M{at:.1} {BOTTOM}v4\"/><text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            BOTTOM + 17.0,
            decimals.at_axis(share * limit),
        );
    }
    if let Some(statistics) = statistics {
        let at = x(statistics.mean.clamp(-limit, limit));
        let is_right = at > (LEFT + RIGHT) / 2.0;
        let (anchor, beside) = if is_right { ("end", at - 5.0) } else { ("start", at + 5.0) };
        if statistics.mean.abs() <= limit {
            let _ = writeln!(svg, "<path class=\"mark\" d=\"M{at:.1} {:.1}V{BOTTOM}\"/>", TOP - 14.0);
        }
        let off = if statistics.mean.abs() > limit { ", off the scale" } else { "" };
        let _ = writeln!(
            svg,
            "<text class=\"strong\" x=\"{beside:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">mean {}{off}</text>",
            TOP - 6.0,
            decimals.show(statistics.mean),
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">deviation in {unit}</text>\n<text x=\"4\" y=\"14\">points</text>\n</svg>",
        (LEFT + RIGHT) / 2.0,
        BOTTOM + 38.0
    );
    svg
}

/// The histogram in words.
fn words(bars: &Histogram, statistics: Option<&Statistics>, decimals: Decimals, unit: &str) -> String {
    let Some(statistics) = statistics else {
        return "Histogram of no points".to_owned();
    };
    format!(
        "Histogram of {} deviations: from {} to {} {unit}, mean {}, half of them between {} and {}; {} beyond {} {unit}",
        grouped(statistics.count as u64),
        decimals.show(statistics.min),
        decimals.show(statistics.max),
        decimals.show(statistics.mean),
        decimals.show(statistics.percentiles[2]),
        decimals.show(statistics.percentiles[4]),
        grouped((statistics.below + statistics.above) as u64),
        decimals.at_axis(bars.limit),
    )
}

/// The colour bar.
pub(super) fn colour_bar(limit: f64, decimals: Decimals, unit: &str) -> String {
    const FROM: f64 = 42.0;
    const TO: f64 = 222.0;
    let mut svg = format!(
        "<svg class=\"chart\" viewBox=\"0 0 96 250\" role=\"img\" aria-label=\"Colours: blue at {end} below the surface, cream on it, red at {end} {unit} above it\">\n<defs><linearGradient id=\"colours\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">\n",
        end = decimals.at_axis(limit),
    );
    for (i, stop) in STOPS.iter().enumerate() {
        let share = i as f64 / (STOPS.len() - 1) as f64;
        let _ = writeln!(svg, "<stop offset=\"{share}\" stop-color=\"{}\"/>", css(*stop));
    }
    let _ = writeln!(
        svg,
        "</linearGradient></defs>\n<text class=\"strong\" x=\"12\" y=\"18\">{unit}</text>\n\
         <path d=\"M12 {FROM}l8 -11l8 11z\" fill=\"{}\" class=\"rim\"/><path d=\"M12 {TO}l8 11l8 -11z\" fill=\"{}\" class=\"rim\"/>\n\
         <rect x=\"12\" y=\"{FROM}\" width=\"16\" height=\"{}\" fill=\"url(#colours)\" class=\"rim\"/>",
        css(STOPS[STOPS.len() - 1]),
        css(STOPS[0]),
        TO - FROM,
    );
    for share in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let at = (FROM + TO) / 2.0 - share * (TO - FROM) / 2.0;
        let sign = if share > 0.0 { "+" } else { "" };
        let _ = writeln!(
            svg,
            "<path class=\"axis\" d=\"M28 {at}h4\"/><text x=\"36\" y=\"{}\">{sign}{}</text>",
            at + 4.0,
            decimals.at_axis(share * limit)
        );
    }
    svg.push_str("</svg>\n");
    svg
}
