//! A definition as strips of Bézier pieces, about the middle of its box.

use std::sync::OnceLock;

use glam::{DVec3, DVec4};
use perpend_kernel::bezier::{Extraction, extraction};
use perpend_kernel::{Definition, Direction, KnotVector, Span, cartesian, homogeneous};

use super::bernstein::{Form, Side};

/// A definition in homogeneous form, moved so that the middle of its box is the origin: differences of points then keep their
/// digits however far from the origin the definition lies.
#[derive(Debug, Clone)]
pub(crate) struct Source {
    knots: KnotVector,
    /// The knots of the second parameter; a curve has none.
    across: Option<KnotVector>,
    net: Vec<DVec4>,
    /// What was taken from every point.
    pub middle: DVec3,
    /// Whether the weights differ.
    pub rational: bool,
    /// The largest distance of a control point from the middle.
    pub reach: f64,
    /// The smallest weight where the largest is 1.
    pub lightest: f64,
    /// A curve's pieces: at a high degree, extracting them costs more than what is done with them.
    extracted: OnceLock<Vec<Piece>>,
}

/// The most coefficients that are kept extracted.
const KEPT: usize = 4_000_000;

/// A Bézier piece over a box of parameters; a curve's second parameter is 0.
#[derive(Debug, Clone)]
pub(crate) struct Piece {
    pub form: Form<DVec4>,
    pub from: (f64, f64),
    pub to: (f64, f64),
}

impl Source {
    pub(crate) fn of(definition: &Definition) -> Self {
        let middle = definition.control_box().centre();
        let points = definition.control_points();
        let weights = definition.weights();
        let rational = weights.is_some_and(|w| w.iter().any(|x| *x != w[0]));
        // the largest is 1: products of weights stay far from overflow
        let largest = weights.map_or(1.0, |w| w.iter().copied().fold(0.0, f64::max));
        let weight = |k: usize| if rational { weights.map_or(1.0, |w| w[k] / largest) } else { 1.0 };
        let net = points.iter().enumerate().map(|(k, p)| homogeneous(*p - middle, weight(k))).collect();
        let lightest = (0..points.len()).map(weight).fold(1.0, f64::min);
        let reach = points.iter().map(|p| (*p - middle).length()).fold(0.0, f64::max);
        let (knots, across) = match definition {
            Definition::NurbsCurve(curve) => (curve.knots().clone(), None),
            Definition::NurbsSurface(surface) => {
                (surface.knots(Direction::U).clone(), Some(surface.knots(Direction::V).clone()))
            }
        };
        Self { knots, across, net, middle, rational, reach, lightest, extracted: OnceLock::new() }
    }

    /// The surface with its parameters exchanged.
    pub(crate) fn turned(&self) -> Self {
        let Some(across) = &self.across else { return self.clone() };
        let (rows, columns) = (self.knots.point_count(), across.point_count());
        let net = (0..columns).flat_map(|j| (0..rows).map(move |i| self.net[i * columns + j])).collect();
        Self { knots: across.clone(), across: Some(self.knots.clone()), net, extracted: OnceLock::new(), ..*self }
    }

    /// The knots of the first parameter.
    pub(crate) fn knots(&self) -> &KnotVector {
        &self.knots
    }

    /// The degrees; 0 for the second parameter of a curve.
    pub(crate) fn degree(&self) -> (usize, usize) {
        (self.knots.degree(), self.across.as_ref().map_or(0, KnotVector::degree))
    }

    /// Whether all control points lie in one plane, up to rounding.
    pub(crate) fn is_planar(&self) -> bool {
        let points = || self.net.iter().map(|c| cartesian(*c));
        let farthest = |from: DVec3| {
            points()
                .map(|p| p - from)
                .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
                .unwrap_or(DVec3::ZERO)
        };
        let start = cartesian(self.net[0]);
        let along = farthest(start).normalize_or_zero();
        let aside = |p: DVec3| (p - start) - along * (p - start).dot(along);
        let far = points().map(aside).max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let normal = along.cross(far.unwrap_or(DVec3::ZERO));
        let Some(normal) = normal.try_normalize() else { return true };
        points().all(|p| {
            (p - start).dot(normal).abs() <= 64.0 * f64::EPSILON * (self.reach + self.middle.abs().max_element())
        })
    }

    /// How many pieces the strip of one span has.
    pub(crate) fn strip_length(&self) -> usize {
        self.across.as_ref().map_or(1, |knots| knots.spans().count())
    }

    /// The extraction matrices of the second parameter's spans: what all strips share.
    pub(crate) fn columns(&self) -> Vec<(Span, Extraction)> {
        match &self.across {
            None => vec![(Span { index: 0, start: 0.0, end: 0.0 }, Extraction::of_a_point())],
            Some(knots) => knots.spans().map(|span| (span, extraction(knots, span))).collect(),
        }
    }

    /// The pieces over one span of the first parameter.
    pub(crate) fn strip(&self, span: Span, columns: &[(Span, Extraction)]) -> Vec<Piece> {
        if self.across.is_some() || self.net.len() * (self.knots.degree() + 1) > KEPT {
            return self.extract(span, columns);
        }
        let all = self.extracted.get_or_init(|| self.knots.spans().flat_map(|s| self.extract(s, columns)).collect());
        let at = all.partition_point(|piece| piece.from.0 < span.start);
        all[at..at + 1].to_vec()
    }

    fn extract(&self, span: Span, columns: &[(Span, Extraction)]) -> Vec<Piece> {
        let ((p, q), count) = (self.degree(), self.across.as_ref().map_or(1, KnotVector::point_count));
        let matrix = extraction(&self.knots, span);
        let mut rows = vec![DVec4::ZERO; (p + 1) * count];
        for (row, coefficients) in rows.chunks_mut(count).zip(matrix.rows()) {
            for (k, c) in coefficients.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                let from = (span.index - p + k) * count;
                for (sum, point) in row.iter_mut().zip(&self.net[from..from + count]) {
                    *sum += *c * *point;
                }
            }
        }
        let piece = |(over, matrix): &(Span, Extraction)| {
            let mut coefficients = Vec::with_capacity((p + 1) * (q + 1));
            for row in rows.chunks(count) {
                let row = &row[over.index - q..=over.index];
                coefficients.extend(
                    matrix.rows().map(|c| c.iter().zip(row).fold(DVec4::ZERO, |sum, (c, point)| sum + *c * *point)),
                );
            }
            Piece {
                form: Form { degree: (p, q), coefficients },
                from: (span.start, over.start),
                to: (span.end, over.end),
            }
        };
        columns.iter().map(piece).collect()
    }

    /// All pieces, strip by strip.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let columns = self.columns();
        self.knots.spans().flat_map(move |span| self.strip(span, &columns))
    }
}

impl Piece {
    /// The lower and the upper half.
    pub(crate) fn halves(self, side: Side) -> (Self, Self) {
        let (mut to, mut from) = (self.to, self.from);
        match side {
            Side::First => (to.0, from.0) = halfway(self.from.0, self.to.0),
            Side::Second => (to.1, from.1) = halfway(self.from.1, self.to.1),
        }
        let (lower, upper) = self.form.halves(side);
        (Self { form: lower, from: self.from, to }, Self { form: upper, from, to: self.to })
    }

    /// The control points.
    pub(crate) fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.form.coefficients.iter().map(|c| cartesian(*c))
    }
}

/// The middle of a range, twice.
pub(crate) fn halfway(from: f64, to: f64) -> (f64, f64) {
    let middle = 0.5 * from + 0.5 * to;
    (middle, middle)
}
