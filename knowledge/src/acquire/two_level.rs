//! The parametrisation factor as Piegl et al. 2008, §5 estimate it.

use super::bernstein::{Form, Side, rational_hodograph};
use super::source::Source;

/// The estimate of the parametrisation factor in the first parameter by two levels of refinement.
///
/// The derivative of each Bézier piece is written as a quotient of degree `2p`, numerator and denominator are halved twice in
/// each parameter, and the quotients of their coefficients are taken for the speeds. It is no bound: the coefficients'
/// quotients reach beyond the speeds, so it is never below the factor that they were exact for.
pub(crate) fn estimate(source: &Source) -> f64 {
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    for piece in source.pieces() {
        let width = piece.to.0 - piece.from.0;
        let w = piece.form.map(|c| c.w);
        let pair = (rational_hodograph(&piece.form).raised(2), w.product(&w, |a, b| a * b));
        for (n, w2) in quarters(quarters(vec![pair], Side::First), Side::Second) {
            for (n, w2) in n.coefficients.iter().zip(&w2.coefficients) {
                let speed = n.length() / w2 / width;
                (least, greatest) = (least.min(speed), greatest.max(speed));
            }
        }
    }
    if greatest > 0.0 { (greatest - least) / greatest } else { 1.0 }
}

type Pair = (Form<glam::DVec3>, Form<f64>);

fn quarters(pairs: Vec<Pair>, side: Side) -> Vec<Pair> {
    let is_there = |pair: &Pair| side == Side::First || pair.1.degree.1 > 0;
    if !pairs.iter().all(is_there) {
        return pairs;
    }
    let halves = |(n, w2): Pair| {
        let (n, w2) = (n.halves(side), w2.halves(side));
        [(n.0, w2.0), (n.1, w2.1)]
    };
    pairs.into_iter().flat_map(halves).flat_map(halves).collect()
}
