//! The lines of knots of one direction, and its seam.

use perpend_kernel::{Definition, Direction};

use super::continuity::{self, Joint, Terms};
use super::found::{Found, measured, proved};
use super::options::AcquireOptions;
use super::source::{Piece, Source};
use super::{Break, Irregularity, ends, knots};
use crate::item::Basis;

/// What was found at the lines of knots of one direction.
#[derive(Debug, Clone, Default)]
pub(super) struct Joints {
    pub breaks: Vec<(Break, Basis, f64)>,
    /// Creases, tiny spans, the seam.
    pub irregularities: Vec<Found>,
    /// The parameters of the creases, ascending.
    pub creases: Vec<f64>,
    /// The largest distance between corresponding points of start and end.
    pub gap: f64,
    pub is_closed: bool,
    pub is_periodic: bool,
}

/// Looks at every line of knots of the first parameter of `source`, which is `direction`.
pub(super) fn of(definition: &Definition, direction: Direction, source: &Source, options: &AcquireOptions) -> Joints {
    let terms =
        Terms { definition, direction, rational: source.rational, reach: source.reach, tolerance: options.continuity };
    let columns = source.columns();
    let (p, q) = source.degree();
    let multiplicities: Vec<(f64, usize)> = source.knots().breaks().map(|b| (b.at, b.multiplicity)).collect();
    // the Taylor series of a pair of pieces and one order of their difference
    let cost = 4.0 * ((p + 1) * (p + 1) * (q + 1)) as f64 + 4.0 * ((p + 1) * (q + 1) * (q + 1)) as f64;
    let is_dear = cost * (multiplicities.len() * columns.len()) as f64 > options.work as f64;
    let least = options.tiny_span * definition.size();
    let mut joints = Joints::default();
    let (mut first, mut before): (Option<Vec<Piece>>, Option<Vec<Piece>>) = (None, None);
    for (k, span) in source.knots().spans().enumerate() {
        let strip = source.strip(span, &columns);
        if !multiplicities.is_empty()
            && let Some(tiny) = knots::tiny(&strip, direction, least)
        {
            joints.irregularities.push(proved(tiny, rounding(definition, p + q), least));
        }
        if let Some(before) = &before {
            let (at, multiplicity) = multiplicities[k - 1];
            let promised = p - multiplicity;
            if promised > 0 && is_dear {
                // what the knots promise is known without a look
                let (c, g) = (promised as u32, promised as u32);
                let value = Break { direction, at, c, g, c_within: 0.0, g_within: 0.0 };
                joints.breaks.push((value, Basis::Proved { gap: 0.0 }, options.continuity));
            } else {
                joints.note(&continuity::joint(before, &strip, Some(promised), terms), direction, at, options);
            }
        }
        if first.is_none() {
            first = Some(strip.clone());
        }
        before = Some(strip);
    }
    if let Some((last, first)) = before.zip(first) {
        joints.close(definition, &last, &first, terms, options);
    }
    joints
}

/// What rounding may move a point of the definition by.
fn rounding(definition: &Definition, degrees: usize) -> f64 {
    16.0 * (degrees + 4) as f64 * f64::EPSILON * definition.reach()
}

impl Joints {
    fn note(&mut self, joint: &Joint, direction: Direction, at: f64, options: &AcquireOptions) {
        if !joint.jumps {
            return;
        }
        let value = Break {
            direction,
            at,
            c: joint.c.max(0) as u32,
            g: joint.g.max(0) as u32,
            c_within: joint.c_within,
            g_within: joint.g_within,
        };
        self.breaks.push((value, basis(joint), options.continuity));
        let turn = joint.turn;
        if joint.g == 0 && turn.angle > options.continuity {
            let value = Irregularity::Crease { direction, at, angle: turn.angle };
            let make = if turn.is_proven { proved } else { measured };
            self.irregularities.push(make(value, turn.error, options.continuity));
            self.creases.push(at);
        }
    }

    /// Compares the last strip with the first one.
    fn close(
        &mut self,
        definition: &Definition,
        last: &[Piece],
        first: &[Piece],
        terms: Terms,
        options: &AcquireOptions,
    ) {
        let same = options.coincidence * definition.size();
        let direction = terms.direction;
        let exact = ends::gap(definition, direction);
        if exact.is_some_and(|gap| gap > same) && !terms.rational {
            self.gap = exact.unwrap_or(0.0);
            return;
        }
        let joint = continuity::joint(last, first, None, terms);
        self.gap = exact.map_or(joint.gap, |gap| gap.min(joint.gap.max(gap)));
        // a surface whose opposite edges are one and the same point is not closed by it
        if self.gap > same || ends::poles(definition, same).iter().any(|pole| pole.direction == direction) {
            return;
        }
        self.is_closed = true;
        self.is_periodic = joint.c >= 1;
        // ends that are one are continuous of order 0 at least, within the coincidence
        let order = (joint.c.max(0) as u32, joint.g.max(0) as u32);
        let value = Irregularity::Seam { direction, gap: self.gap, order: Some(order) };
        let within = joint.c_within.max(joint.g_within).max(self.gap);
        let make = if joint.is_proven { proved } else { measured };
        self.irregularities.push(make(value, within, same.max(options.continuity)));
    }
}

fn basis(joint: &Joint) -> Basis {
    let within = joint.c_within.max(joint.g_within);
    if joint.is_proven { Basis::Proved { gap: within } } else { Basis::Measured { error: within } }
}
