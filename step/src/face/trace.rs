//! Edges followed in the coordinates of a carrier.

use glam::{DVec2, DVec3};
use perpend::NurbsCurve;

use super::carrier::Carrier;

/// Places on each span of an edge's curve where it is looked at first, at least.
const STEPS: usize = 8;

/// Places on a whole edge where it is looked at first, at least.
const LEAST: usize = 16;

/// How often the way between two places is halved.
const DEPTH: usize = 40;

/// An edge is looked at in no more places than this: one along an axis has every direction from it, and none.
const MOST: usize = 4096;

/// A part of an edge in the coordinates of the carrier, or a straight join.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// The edge's index; none for a join.
    pub(super) edge: Option<usize>,
    /// Parameters of the edge's curve, in the loop's direction; of a join from 0 to 1.
    pub(super) t: Vec<f64>,
    /// The coordinates there, continuous over seams.
    pub(super) at: Vec<DVec2>,
    /// The poles where it begins and ends.
    pub(super) poles: [Option<usize>; 2],
    /// How far its edge lies off the surface, at these places.
    pub(super) off: f64,
}

impl Piece {
    /// The straight join of two places.
    pub(super) fn join(from: DVec2, to: DVec2) -> Self {
        Self { edge: None, t: vec![0.0, 1.0], at: vec![from, to], poles: [None; 2], off: 0.0 }
    }

    pub(super) fn start(&self) -> DVec2 {
        self.at[0]
    }

    pub(super) fn end(&self) -> DVec2 {
        self.at[self.at.len() - 1]
    }

    /// Moved by whole periods.
    pub(super) fn moved(mut self, by: DVec2) -> Self {
        self.at.iter_mut().for_each(|at| *at += by);
        self
    }

    /// The other way.
    pub(super) fn reversed(mut self) -> Self {
        self.t.reverse();
        self.at.reverse();
        self.poles.swap(0, 1);
        self
    }

    /// The part between two of its samples.
    pub(super) fn between(&self, first: usize, last: usize) -> Self {
        let end = self.at.len() - 1;
        Self {
            edge: self.edge,
            t: self.t[first..=last].to_vec(),
            at: self.at[first..=last].to_vec(),
            poles: [self.poles[0].filter(|_| first == 0), self.poles[1].filter(|_| last == end)],
            off: self.off,
        }
    }

    /// The coordinates at a parameter of its edge.
    pub(super) fn place(&self, carrier: &Carrier, curves: &[NurbsCurve], t: f64) -> DVec2 {
        let ascends = self.t[0] <= self.t[self.t.len() - 1];
        let after = self.t.partition_point(|x| if ascends { *x <= t } else { *x >= t });
        let i = after.clamp(1, self.t.len() - 1) - 1;
        let share = ((t - self.t[i]) / (self.t[i + 1] - self.t[i])).clamp(0.0, 1.0);
        let near = self.at[i].lerp(self.at[i + 1], share);
        if share == 0.0 || share == 1.0 {
            return near;
        }
        let Some(edge) = self.edge else { return near };
        let point = curves[edge].point(t);
        let found = carrier.beside(carrier.inverse(point, Some(near)), near);
        match carrier.pole(point) {
            // the angle there is noise
            Some(pole) if carrier.poles[pole].across == 0 => DVec2::new(found.x, near.y),
            Some(_) => DVec2::new(near.x, found.y),
            None => found,
        }
    }
}

/// An edge in the coordinates of the carrier, in one piece, or in several where it passes a pole; none where it is a pole.
pub(super) fn trace(carrier: &Carrier, curves: &[NurbsCurve], edge: usize, forward: bool) -> Vec<Piece> {
    let curve = &curves[edge];
    let spans: Vec<_> = curve.knots().spans().collect();
    let steps = STEPS.max(LEAST.div_ceil(spans.len()));
    let mut parameters = vec![curve.domain().0];
    for span in &spans {
        parameters.extend((1..=steps).map(|k| {
            if k == steps { span.end } else { span.start + (span.end - span.start) * k as f64 / steps as f64 }
        }));
    }
    if !forward {
        parameters.reverse();
    }
    let mut samples: Vec<Sample> = Vec::with_capacity(parameters.len());
    for t in parameters {
        let near = samples.iter().rev().find(|sample| sample.pole.is_none()).map(|sample| sample.at);
        let sample = Sample::new(carrier, curve, t, near);
        if let Some(before) = samples.last().copied() {
            refine(carrier, curve, before, sample, 0, &mut samples);
        }
        let near = samples.iter().rev().find(|sample| sample.pole.is_none()).map(|sample| sample.at);
        samples.push(sample.beside(carrier, near));
    }
    pieces(carrier, curve, edge, &samples)
}

/// A place of an edge.
#[derive(Debug, Clone, Copy)]
struct Sample {
    t: f64,
    point: DVec3,
    at: DVec2,
    pole: Option<usize>,
}

impl Sample {
    fn new(carrier: &Carrier, curve: &NurbsCurve, t: f64, near: Option<DVec2>) -> Self {
        let point = curve.point(t);
        Self { t, point, at: carrier.inverse(point, near), pole: carrier.pole(point) }.beside(carrier, near)
    }

    fn beside(mut self, carrier: &Carrier, near: Option<DVec2>) -> Self {
        if let Some(near) = near {
            self.at = carrier.beside(self.at, near);
        }
        self
    }
}

/// Adds places between two whose coordinates are too far apart to be followed over a seam.
fn refine(carrier: &Carrier, curve: &NurbsCurve, a: Sample, b: Sample, depth: usize, out: &mut Vec<Sample>) {
    if a.pole.is_some() || b.pole.is_some() || depth > DEPTH || out.len() > MOST {
        return;
    }
    let step = carrier.beside(b.at, a.at) - a.at;
    let far = (0..2).any(|k| carrier.periods[k].is_some_and(|period| step[k].abs() > period / 7.0));
    if !far || a.point.distance(b.point) <= carrier.pole_tolerance {
        return;
    }
    let middle = Sample::new(carrier, curve, 0.5 * (a.t + b.t), Some(a.at));
    refine(carrier, curve, a, middle, depth + 1, out);
    out.push(middle);
    refine(carrier, curve, middle, b, depth + 1, out);
}

/// Parts at poles.
fn pieces(carrier: &Carrier, curve: &NurbsCurve, edge: usize, samples: &[Sample]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut i = 0;
    while i < samples.len() {
        if samples[i].pole.is_some() {
            i += 1;
            continue;
        }
        let end = (i..samples.len()).find(|k| samples[*k].pole.is_some()).unwrap_or(samples.len());
        let mut piece = Piece { edge: Some(edge), t: Vec::new(), at: Vec::new(), poles: [None; 2], off: 0.0 };
        if i > 0 {
            let (t, at) = at_pole(carrier, curve, &samples[i - 1], &samples[i]);
            piece.t.push(t);
            piece.at.push(at);
            piece.poles[0] = samples[i - 1].pole;
        }
        let off = samples[i..end].iter().map(|sample| carrier.point(sample.at).distance(sample.point));
        piece.off = off.fold(0.0, f64::max);
        piece.t.extend(samples[i..end].iter().map(|sample| sample.t));
        for sample in &samples[i..end] {
            let at = piece.at.last().map_or(sample.at, |before| carrier.beside(sample.at, *before));
            piece.at.push(at);
        }
        if end < samples.len() {
            let (t, at) = at_pole(carrier, curve, &samples[end], &samples[end - 1]);
            piece.t.push(t);
            piece.at.push(at);
            piece.poles[1] = samples[end].pole;
        }
        pieces.push(piece);
        i = end;
    }
    pieces
}

/// The place where an edge meets a pole, in the direction from which it comes.
fn at_pole(carrier: &Carrier, curve: &NurbsCurve, pole: &Sample, before: &Sample) -> (f64, DVec2) {
    // as near as the direction can be told
    let (mut inner, mut outer) = (pole.t, before.t);
    for _ in 0..60 {
        let middle = 0.5 * (inner + outer);
        let from_pole = curve.point(middle).distance(pole.point);
        if from_pole <= 8.0 * carrier.pole_tolerance {
            inner = middle;
        } else {
            outer = middle;
        }
    }
    let near = carrier.beside(carrier.inverse(curve.point(outer), Some(before.at)), before.at);
    let found = carrier.poles[pole.pole.expect("a sample at a pole")];
    let mut at = near;
    at[found.across] = found.value;
    (pole.t, at)
}
