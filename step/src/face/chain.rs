//! Pieces of edges joined to rings, over seams and poles.

use glam::DVec2;

use super::carrier::Carrier;
use super::trace::Piece;

/// A closed chain of pieces, each beginning where the one before it ends; closed up to whole periods.
#[derive(Debug, Clone)]
pub(super) struct Ring {
    pub(super) pieces: Vec<Piece>,
}

impl Ring {
    /// How many periods of a coordinate it runs through.
    pub(super) fn winding(&self, carrier: &Carrier, coordinate: usize) -> i64 {
        let Some(period) = carrier.periods[coordinate] else { return 0 };
        let along = self.pieces[self.pieces.len() - 1].end() - self.pieces[0].start();
        (along[coordinate] / period).round() as i64
    }

    /// The area to its left, of the polygon of its samples.
    pub(super) fn area(&self) -> f64 {
        let places: Vec<DVec2> = self.pieces.iter().flat_map(|piece| piece.at.iter().copied()).collect();
        let origin = places[0];
        let next = places.iter().cycle().skip(1);
        0.5 * places.iter().zip(next).map(|(a, b)| (*a - origin).perp_dot(*b - origin)).sum::<f64>()
    }

    /// The least and the largest of a coordinate.
    pub(super) fn extent(&self, coordinate: usize) -> (f64, f64) {
        let places = self.pieces.iter().flat_map(|piece| &piece.at);
        places.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), at| (a.min(at[coordinate]), b.max(at[coordinate])))
    }

    pub(super) fn moved(mut self, by: DVec2) -> Self {
        self.pieces = self.pieces.into_iter().map(|piece| piece.moved(by)).collect();
        self
    }

    pub(super) fn reversed(mut self) -> Self {
        self.pieces = self.pieces.into_iter().rev().map(Piece::reversed).collect();
        self
    }
}

/// The ring of a loop's pieces, given in order.
///
/// Where the loop passes a pole, the places at which it comes and goes are joined along the pole. Which way round, the rest of the loop says
/// where it passes one pole; where it passes two, the material is on its left: `left` is 1 if that is so in the carrier's coordinates, -1 if
/// it is on the right.
pub(super) fn ring(carrier: &Carrier, mut pieces: Vec<Piece>, left: f64) -> Ring {
    let count = pieces.len();
    let leaves_pole = |pieces: &[Piece], i: usize| pieces[i].poles[0].is_some();
    if let Some(first) = (0..count).find(|i| leaves_pole(&pieces, *i)) {
        pieces.rotate_left(first);
    }
    // strings between poles, each continuous
    let mut strings: Vec<Vec<Piece>> = Vec::new();
    for piece in pieces {
        match strings.last_mut() {
            Some(string) if piece.poles[0].is_none() => {
                let end = string[string.len() - 1].end();
                let by = carrier.beside(piece.start(), end) - piece.start();
                string.push(piece.moved(by));
            }
            _ => strings.push(vec![piece]),
        }
    }
    if let [first, second] = &strings[..] {
        let free = free_coordinate(carrier, first);
        if let Some(period) = carrier.periods[free] {
            let turned = |k: i32| {
                let mut by = DVec2::ZERO;
                by[free] = carrier.shift(free, second[0].start()[free], end(first)[free]) + f64::from(k) * period;
                let second = second.iter().cloned().map(|piece| piece.moved(by)).collect();
                let ring = Ring { pieces: joined(carrier, vec![first.clone(), second]) };
                (left * ring.area(), ring)
            };
            let rings: Vec<(f64, Ring)> = (-2..=2).map(turned).collect();
            // one that runs back along itself has no area but for rounding
            let none = 1e-7 * rings.iter().fold(0.0_f64, |most, (area, _)| most.max(area.abs()));
            let least = rings.into_iter().filter(|(area, _)| *area > none).min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, ring)) = least {
                return ring;
            }
        }
    }
    Ring { pieces: joined(carrier, strings) }
}

/// The coordinate along the pole where a string ends.
fn free_coordinate(carrier: &Carrier, string: &[Piece]) -> usize {
    string[string.len() - 1].poles[1].map_or(1, |pole| 1 - carrier.poles[pole].across)
}

fn end(string: &[Piece]) -> DVec2 {
    string[string.len() - 1].end()
}

/// Strings with the joins along poles between them, and between the last and the first.
fn joined(carrier: &Carrier, strings: Vec<Vec<Piece>>) -> Vec<Piece> {
    let start = strings[0][0].start();
    let starts: Vec<DVec2> = strings.iter().skip(1).map(|string| string[0].start()).chain([start]).collect();
    let mut all = Vec::new();
    for (string, next) in strings.into_iter().zip(starts) {
        let (from, pole) = (end(&string), string[string.len() - 1].poles[1]);
        all.extend(string);
        if let Some(pole) = pole {
            let pole = carrier.poles[pole];
            let (mut from, mut to) = (from, next);
            (from[pole.across], to[pole.across]) = (pole.value, pole.value);
            if from != to {
                all.push(Piece::join(from, to));
            }
        }
    }
    all
}
