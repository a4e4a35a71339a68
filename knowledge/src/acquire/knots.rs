//! Knots that nearly coincide, and spans that are very small.

use perpend_kernel::{Aabb, Direction};

use super::options::AcquireOptions;
use super::source::{Piece, Source};
use crate::representation::Irregularity;

/// Near knots of the first parameter, which is `direction`.
pub(super) fn near(source: &Source, direction: Direction, options: &AcquireOptions) -> Vec<Irregularity> {
    let (first, last) = source.knots().domain();
    let spans = source.knots().spans().count();
    let apart = |from: f64, to: f64| (0.5 * to - 0.5 * from) / (0.5 * last - 0.5 * first);
    source
        .knots()
        .spans()
        .map(|span| (span.start, apart(span.start, span.end)))
        .filter(|(_, apart)| apart * spans as f64 <= options.near_knots)
        .map(|(at, apart)| Irregularity::NearKnots { direction, at, apart })
        .collect()
}

/// The strip of a span as a tiny span, where it is one of several and below `least`.
pub(super) fn tiny(strip: &[Piece], direction: Direction, least: f64) -> Option<Irregularity> {
    let extent = Aabb::around(strip.iter().flat_map(Piece::points)).diagonal();
    (extent <= least).then(|| Irregularity::TinySpan { direction, at: strip[0].from.0, extent })
}
