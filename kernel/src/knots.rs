//! Knot vectors: clamped, non-decreasing, in the convention of The NURBS Book.
//!
//! A knot vector of degree `p` over `n` control points has `n + p + 1` knots; the first and the last are repeated
//! `p + 1` times. Span `i` is the half-open interval `[U_i, U_{i+1})`; the last one is closed.

use crate::invalid::{Along, InvalidDefinition};

/// The highest degree of a definition. Evaluation keeps its working memory on the stack, sized by this.
pub const MAX_DEGREE: usize = 25;

/// Interior knots up to this number are looked at one by one when a span is sought.
const FEW: usize = 8;

/// A clamped knot vector with its degree.
#[derive(Debug, Clone, PartialEq)]
pub struct KnotVector {
    degree: usize,
    knots: Vec<f64>,
    /// The first and the last parameter, beside the knots: every evaluation asks for them.
    domain: (f64, f64),
    /// How many interior knots lie in the buckets before each of those that cut the domain evenly; empty where the knots are few.
    buckets: Vec<u32>,
    /// Buckets per parameter.
    density: f64,
}

/// A non-empty knot span `[start, end]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Index `i` of the knot at which it starts: the span's control points are `i - degree ..= i`.
    pub index: usize,
    /// The parameter at which it starts.
    pub start: f64,
    /// The parameter at which it ends.
    pub end: f64,
}

/// An interior knot value with its multiplicity: continuity drops there to order `degree - multiplicity`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Break {
    /// The parameter.
    pub at: f64,
    /// How often the knot occurs, 1 to the degree.
    pub multiplicity: usize,
}

impl KnotVector {
    /// A clamped knot vector over `points` control points.
    ///
    /// # Errors
    ///
    /// Any count, order, multiplicity or range that the convention does not allow; ends that are not clamped are
    /// refused here (definitions clamp them first, see [`crate::clamp`]).
    pub fn new(degree: usize, knots: Vec<f64>, points: usize, along: Along) -> Result<Self, InvalidDefinition> {
        check_order(degree, &knots, points, along)?;
        let vector = Self::of(degree, knots);
        let (first, last) = vector.domain();
        for (knot, multiplicity) in vector.distinct() {
            if knot == first || knot == last {
                if multiplicity != degree + 1 {
                    return Err(InvalidDefinition::EndMultiplicity { along, knot, multiplicity, degree });
                }
            } else if multiplicity > degree {
                return Err(InvalidDefinition::InteriorMultiplicity { along, knot, multiplicity, degree });
            }
        }
        Ok(vector)
    }

    fn of(degree: usize, knots: Vec<f64>) -> Self {
        let domain = (knots[degree], knots[knots.len() - degree - 1]);
        let interior = knots.len() - 2 * (degree + 1);
        let mut vector = Self { degree, knots, domain, buckets: Vec::new(), density: 0.0 };
        if interior > FEW {
            vector.density = interior as f64 / (domain.1 - domain.0);
            let mut buckets = vec![0; interior + 2];
            for knot in vector.interior() {
                buckets[vector.bucket(*knot) + 1] += 1;
            }
            for k in 1..buckets.len() {
                buckets[k] += buckets[k - 1];
            }
            vector.buckets = buckets;
        }
        vector
    }

    /// The knots inside the domain.
    #[inline]
    fn interior(&self) -> &[f64] {
        &self.knots[self.degree + 1..self.knots.len() - self.degree - 1]
    }

    /// The bucket of a parameter of the domain, at most the number of interior knots: it never falls where the parameter rises, since neither
    /// a rounded difference nor a rounded product does.
    #[inline]
    fn bucket(&self, u: f64) -> usize {
        ((u - self.domain.0) * self.density) as usize
    }

    /// The knots of one Bézier segment over `[start, end]`: each end `degree + 1` times.
    pub(crate) fn bezier(degree: usize, start: f64, end: f64) -> Self {
        let mut knots = vec![start; degree + 1];
        knots.extend(std::iter::repeat_n(end, degree + 1));
        Self::of(degree, knots)
    }

    /// For results of algorithms that keep a valid vector valid.
    pub(crate) fn trusted(degree: usize, knots: Vec<f64>) -> Self {
        debug_assert!(
            Self::new(degree, knots.clone(), knots.len() - degree - 1, Along::Curve).is_ok(),
            "an algorithm of this crate made an invalid knot vector: {knots:?} of degree {degree}"
        );
        Self::of(degree, knots)
    }

    /// The degree.
    #[must_use]
    #[inline]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All knots, repeated ones included.
    #[must_use]
    #[inline]
    pub fn as_slice(&self) -> &[f64] {
        &self.knots
    }

    /// How many control points the vector carries.
    #[must_use]
    #[inline]
    pub fn point_count(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// The first and the last parameter.
    #[must_use]
    #[inline]
    pub fn domain(&self) -> (f64, f64) {
        self.domain
    }

    /// The parameter of the domain nearest to `u`.
    #[must_use]
    #[inline]
    pub fn clamp(&self, u: f64) -> f64 {
        let (first, last) = self.domain();
        // comparisons that a processor has as one instruction each, unlike `max` and `min` with their rule for NaN; here that becomes the first
        let above = if u > first { u } else { first };
        if above < last { above } else { last }
    }

    /// Index of the non-empty span that holds `u`; parameters outside the domain belong to its first or last span.
    #[must_use]
    #[inline]
    pub fn find_span(&self, u: f64) -> usize {
        if u >= self.domain.1 {
            return self.point_count() - 1; // the knots after it are all the last one, so this span is not empty
        }
        if self.buckets.is_empty() {
            // in steps, not by counting: which way they go the processor guesses, mostly right, and works on meanwhile
            let mut span = self.degree;
            while self.knots[span + 1] <= u {
                span += 1;
            }
            return span;
        }
        // all knots of the buckets before that of `u` are below it, and none of the buckets after
        let bucket = self.bucket(u);
        let (start, end) = (self.buckets[bucket] as usize, self.buckets[bucket + 1] as usize);
        let inside = &self.interior()[start..end];
        let passed = if inside.len() <= FEW {
            inside.iter().map(|knot| usize::from(*knot <= u)).sum()
        } else {
            inside.partition_point(|knot| *knot <= u)
        };
        self.degree + start + passed
    }

    /// Every distinct knot with its multiplicity, in ascending order.
    pub fn distinct(&self) -> impl Iterator<Item = (f64, usize)> + '_ {
        self.knots.chunk_by(|a, b| a == b).map(|run| (run[0], run.len()))
    }

    /// The interior knots with their multiplicities, in ascending order.
    pub fn breaks(&self) -> impl Iterator<Item = Break> + '_ {
        let (first, last) = self.domain();
        self.distinct()
            .filter(move |(knot, _)| *knot > first && *knot < last)
            .map(|(at, multiplicity)| Break { at, multiplicity })
    }

    /// The non-empty spans, in ascending order.
    pub fn spans(&self) -> impl Iterator<Item = Span> + '_ {
        (self.degree..self.point_count()).filter(|i| self.knots[*i] < self.knots[i + 1]).map(|index| Span {
            index,
            start: self.knots[index],
            end: self.knots[index + 1],
        })
    }

    /// How often `u` occurs among the knots; 0 where it is none.
    #[must_use]
    pub fn multiplicity(&self, u: f64) -> usize {
        self.knots.partition_point(|knot| *knot <= u) - self.knots.partition_point(|knot| *knot < u)
    }
}

/// What holds for every knot vector, clamped or not: degree, counts, finite and non-decreasing knots, a domain.
pub(crate) fn check_order(degree: usize, knots: &[f64], points: usize, along: Along) -> Result<(), InvalidDefinition> {
    if !(1..=MAX_DEGREE).contains(&degree) {
        return Err(InvalidDefinition::Degree { along, degree });
    }
    if points <= degree {
        return Err(InvalidDefinition::TooFewPoints { along, points, degree });
    }
    if knots.len() != points + degree + 1 {
        return Err(InvalidDefinition::KnotCount { along, found: knots.len(), points, degree });
    }
    if let Some(index) = knots.iter().position(|knot| !knot.is_finite()) {
        return Err(InvalidDefinition::NonFiniteKnot { along, index, value: knots[index] });
    }
    if let Some(index) = (1..knots.len()).find(|i| knots[*i] < knots[i - 1]) {
        return Err(InvalidDefinition::DecreasingKnots {
            along,
            index,
            previous: knots[index - 1],
            knot: knots[index],
        });
    }
    let (first, last) = (knots[degree], knots[points]);
    if first == last {
        return Err(InvalidDefinition::EmptyDomain { along, knot: first });
    }
    if !(knots[knots.len() - 1] - knots[0] <= 1e100 && last - first >= 1e-100) {
        return Err(InvalidDefinition::KnotRange { along, first, last });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vector(degree: usize, knots: &[f64]) -> KnotVector {
        KnotVector::new(degree, knots.to_vec(), knots.len() - degree - 1, Along::Curve).expect("valid knots")
    }

    #[test]
    fn every_parameter_lies_in_the_span_that_is_found_for_it() {
        let knots = vector(2, &[0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0]);
        for (u, span) in [(-1.0, 2), (0.0, 2), (0.5, 2), (1.0, 3), (1.5, 3), (2.0, 5), (2.9, 5), (3.0, 5), (4.0, 5)] {
            assert_eq!(knots.find_span(u), span, "u = {u}");
        }
    }

    #[test]
    fn spans_among_many_knots_are_those_of_a_search_through_all() {
        // close together, far apart, repeated, and some in one bucket
        let mut inside: Vec<f64> = (0..40).map(|k| 1.0 + f64::from(k * k) / 1600.0).collect();
        inside.extend((0..30).map(|k| 7.0 + 1e-9 * f64::from(k / 2)));
        let knots: Vec<f64> = [vec![-3.0; 4], inside, vec![50.0; 4]].concat();
        let knots = vector(3, &knots);
        let beside = knots.as_slice().iter().flat_map(|knot| [knot.next_down(), *knot, knot.next_up()]);
        for u in beside.chain((0..500).map(|k| -4.0 + 0.11 * f64::from(k))) {
            let last = knots.spans().take_while(|span| span.start <= u).last();
            let expected = last.map_or(3, |span| span.index);
            assert_eq!(knots.find_span(u), expected, "u = {u}");
        }
    }

    #[test]
    fn breaks_and_spans_leave_out_the_ends_and_the_empty() {
        let knots = vector(2, &[0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0]);
        assert_eq!(
            knots.breaks().collect::<Vec<_>>(),
            [Break { at: 1.0, multiplicity: 1 }, Break { at: 2.0, multiplicity: 2 }]
        );
        assert_eq!(knots.spans().map(|s| s.index).collect::<Vec<_>>(), [2, 3, 5]);
    }

    #[test]
    fn bad_knots_are_named() {
        let new = |degree, knots: &[f64], points| KnotVector::new(degree, knots.to_vec(), points, Along::Curve);
        let message = |result: Result<KnotVector, InvalidDefinition>| result.expect_err("invalid").to_string();
        assert!(message(new(0, &[0.0, 1.0], 1)).contains("degree is 0"));
        assert!(message(new(26, &[0.0; 54], 27)).contains("degree is 26"));
        assert!(message(new(2, &[0.0; 4], 1)).contains("1 control points"));
        assert!(message(new(1, &[0.0, 0.0, 1.0], 2)).contains("3 knots"));
        assert!(message(new(1, &[0.0, f64::NAN, 1.0, 1.0], 2)).contains("knots[1] is NaN"));
        assert!(message(new(1, &[0.0, 1.0, 0.5, 1.0], 2)).contains("knots[2] is 0.5"));
        assert!(message(new(1, &[1.0; 4], 2)).contains("single value 1"));
        assert!(message(new(1, &[0.0, 0.0, 0.5, 0.5, 1.0, 1.0], 4)).contains("multiplicity 2"));
        assert!(message(new(1, &[0.0, 0.5, 1.0, 1.0], 2)).contains("multiplicity"));
    }
}
