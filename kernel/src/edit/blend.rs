//! Combinations of control points: a row of the matrix of an edit.

use glam::{DVec3, DVec4};

use crate::homogeneous::{cartesian, homogeneous};

/// Non-negative shares, adding up to 1, of consecutive control points.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Blend {
    first: usize,
    shares: Vec<f64>,
}

impl Blend {
    /// Shares of the points `first`, `first + 1`, …; zeros at both ends are dropped.
    pub(crate) fn new(first: usize, shares: &[f64]) -> Self {
        let skip = shares.iter().take_while(|share| **share == 0.0).count();
        let end = shares.iter().rposition(|share| *share != 0.0).map_or(skip, |last| last + 1);
        Self { first: first + skip, shares: shares[skip..end].to_vec() }
    }

    /// The control point that belongs to `arguments`, ascending and `p` of them, once they all are knots: the blossom there.
    ///
    /// In the refined vector they must be consecutive. The knots that are missing are inserted by Boehm's formula (The NURBS
    /// Book, equation 5.15), each step a convex combination whose two quotients are formed separately; so each share has
    /// a relative error of at most about `5 p u`, `u = 2⁻⁵³`. Only knots near the arguments are touched.
    pub(crate) fn blossom(p: usize, knots: &[f64], arguments: &[f64]) -> Self {
        debug_assert_eq!(arguments.len(), p, "a blossom has as many arguments as the degree");
        let reach = 2 * p + 2;
        let low = knots.partition_point(|k| *k <= arguments[0]).saturating_sub(reach);
        let high = (knots.partition_point(|k| *k < arguments[p - 1]) + reach).min(knots.len());
        let mut window = knots[low..high].to_vec();
        let mut inserted = Vec::new();
        for run in arguments.chunk_by(|a, b| a == b) {
            let present = window.iter().filter(|k| **k == run[0]).count();
            for _ in present..run.len() {
                let at = window.partition_point(|k| *k <= run[0]);
                window.insert(at, run[0]);
                inserted.push(at);
            }
        }
        // from the right: where a knot outside the domain's clamped ends has degree + 1 copies, the span after it is meant
        let last = window
            .windows(p + 2)
            .rposition(|w| w[1..=p] == *arguments)
            .expect("the arguments of a blossom are consecutive in the refined knots");
        // going back over the insertions, the point is a combination of ever more points `..= last`
        let mut shares = vec![1.0];
        for at in inserted.into_iter().rev() {
            let knot = window.remove(at);
            let mut next = vec![0.0; shares.len() + 1];
            for (m, share) in shares.iter().enumerate().filter(|(_, share)| **share != 0.0) {
                let j = last + 1 + m - shares.len();
                if j + p < at {
                    next[m + 1] += share;
                } else if j >= at {
                    next[m] += share;
                } else {
                    let (a, b) = (window[j], window[j + p]);
                    next[m + 1] += (knot - a) / (b - a) * share;
                    next[m] += (b - knot) / (b - a) * share;
                }
            }
            shares = next;
        }
        let skip = shares.iter().take_while(|share| **share == 0.0).count();
        Self::new(low + last + 1 + skip - shares.len(), &shares[skip..])
    }

    /// The mean of blends, each taken as often as its count says; `counts` add up to `total`.
    pub(crate) fn mean(blends: &[(Self, usize)], total: usize) -> Self {
        let first = blends.iter().map(|(blend, _)| blend.first).min().unwrap_or(0);
        let end = blends.iter().map(|(blend, _)| blend.first + blend.shares.len()).max().unwrap_or(0);
        let mut sum = vec![0.0; end - first];
        for (blend, count) in blends {
            for (sum, share) in sum[blend.first - first..].iter_mut().zip(&blend.shares) {
                *sum += *count as f64 * share;
            }
        }
        sum.iter_mut().for_each(|share| *share /= total as f64);
        Self::new(first, &sum)
    }

    /// The first place, and the shares from there on.
    pub(crate) fn row(&self) -> (usize, Vec<f64>) {
        (self.first, self.shares.clone())
    }

    /// The combination of homogeneous points.
    pub(crate) fn of_homogeneous(&self, net: &[DVec4]) -> DVec4 {
        self.shares.iter().zip(&net[self.first..]).map(|(share, point)| *share * *point).sum()
    }

    /// The point and weight that this blends from a net; `at` gives the place of a control point in it.
    ///
    /// A share of the whole copies the point with its bits.
    pub(crate) fn of(&self, points: &[DVec3], weights: Option<&[f64]>, at: impl Fn(usize) -> usize) -> (DVec3, f64) {
        let weight = |k: usize| weights.map_or(1.0, |w| w[at(k)]);
        if self.shares == [1.0] {
            return (points[at(self.first)], weight(self.first));
        }
        let shares = self.shares.iter().enumerate().map(|(k, share)| (self.first + k, *share));
        if weights.is_none() {
            return (shares.map(|(k, share)| share * points[at(k)]).sum(), 1.0);
        }
        let sum = shares.map(|(k, share)| share * homogeneous(points[at(k)], weight(k))).sum::<DVec4>();
        (cartesian(sum), sum.w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_knot_of_the_vector_is_its_own_point() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0];
        for i in 0..7 {
            assert_eq!(Blend::blossom(3, &knots, &knots[i + 1..i + 4]), Blend { first: i, shares: vec![1.0] });
        }
    }

    #[test]
    fn shares_are_non_negative_and_add_up_to_one() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0 + 1e-9, 2.0, 7.0, 7.0, 7.0, 7.0];
        for arguments in [[0.5; 3], [0.0, 0.0, 0.5], [1.0, 1.0, 1.0], [1.0 + 1e-9, 2.0, 2.0], [2.0, 2.0, 3.0], [6.9; 3]]
        {
            let blend = Blend::blossom(3, &knots, &arguments);
            assert!(blend.shares.iter().all(|share| *share >= 0.0));
            assert!((blend.shares.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
    }
}
