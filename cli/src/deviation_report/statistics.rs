//! What the deviations of many points come to.

/// The percentiles that are told.
pub(super) const PERCENTS: [f64; 7] = [1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0];

/// Of one number and more.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Statistics {
    pub(super) count: usize,
    pub(super) mean: f64,
    /// The root of the mean square.
    pub(super) rms: f64,
    /// The standard deviation of a sample, with n - 1; of one number there is none.
    pub(super) deviation: Option<f64>,
    pub(super) min: f64,
    pub(super) max: f64,
    /// Of [`PERCENTS`], between two numbers by their share (type 7 of Hyndman and Fan, Sample quantiles in statistical packages, The
    /// American Statistician 50, 1996).
    pub(super) percentiles: [f64; 7],
    /// How many are below `-limit`.
    pub(super) below: usize,
    /// How many are above `limit`.
    pub(super) above: usize,
}

impl Statistics {
    /// Of these numbers, which are put in order; none of no number.
    pub(super) fn of(numbers: &mut [f64], limit: f64) -> Option<Self> {
        numbers.sort_unstable_by(f64::total_cmp);
        let (min, max) = (*numbers.first()?, *numbers.last()?);
        let count = numbers.len();
        let n = count as f64;
        let mean = (numbers.iter().sum::<f64>() / n).clamp(min, max);
        let squares: f64 = numbers.iter().map(|x| (x - mean) * (x - mean)).sum();
        Some(Self {
            count,
            mean,
            rms: (numbers.iter().map(|x| x * x).sum::<f64>() / n).sqrt(),
            deviation: (count > 1).then(|| (squares / (n - 1.0)).sqrt()),
            min,
            max,
            percentiles: PERCENTS.map(|percent| percentile(numbers, percent)),
            below: numbers.partition_point(|x| *x < -limit),
            above: count - numbers.partition_point(|x| *x <= limit),
        })
    }
}

/// Of numbers in ascending order, of which there is one at least.
pub(super) fn percentile(ascending: &[f64], percent: f64) -> f64 {
    let at = (ascending.len() - 1) as f64 * percent / 100.0;
    let low = at.floor() as usize;
    let high = (low + 1).min(ascending.len() - 1);
    ascending[low] + (ascending[high] - ascending[low]) * (at - low as f64)
}

/// How many numbers lie in each of equally wide parts of `[-limit, limit]`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Histogram {
    pub(super) limit: f64,
    pub(super) counts: Vec<usize>,
}

impl Histogram {
    pub(super) fn of(numbers: &[f64], limit: f64, bins: usize) -> Self {
        let mut counts = vec![0; bins];
        for x in numbers.iter().filter(|x| x.abs() <= limit) {
            let at = (x / limit + 1.0) / 2.0 * bins as f64;
            counts[(at as usize).min(bins - 1)] += 1;
        }
        Self { limit, counts }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_counted_by_hand() {
        let mut numbers = [3.0, -1.0, 2.0, 0.0, 6.0];
        let found = Statistics::of(&mut numbers, 2.0).unwrap();
        assert_eq!((found.count, found.mean, found.min, found.max), (5, 2.0, -1.0, 6.0));
        assert_eq!((found.below, found.above), (0, 2), "the limit itself is within");
        assert_eq!(found.rms, 10.0_f64.sqrt());
        assert_eq!(found.deviation, Some(7.5_f64.sqrt()));
        // -1, 0, 2, 3, 6: at 0.04, 0.2, 1, 2, 3, 3.8, 3.96 of 4
        let known = [-0.96, -0.8, 0.0, 2.0, 3.0, 5.4, 5.88];
        for (found, known) in found.percentiles.iter().zip(known) {
            assert!((found - known).abs() < 1e-14, "{found} {known}");
        }
    }

    #[test]
    fn few_numbers_have_what_they_can_have() {
        assert_eq!(Statistics::of(&mut [], 1.0), None);
        let one = Statistics::of(&mut [-3.0], 1.0).unwrap();
        assert_eq!((one.deviation, one.percentiles, one.below), (None, [-3.0; 7], 1));
        let alike = Statistics::of(&mut [0.1; 10], 1.0).unwrap();
        assert_eq!((alike.mean, alike.deviation), (0.1, Some(0.0)));
    }

    #[test]
    fn bins_hold_what_is_within_the_limit() {
        let numbers = [-2.0, -1.9, -1.0, -0.1, 0.0, 0.1, 1.0, 2.0, 2.1, -7.0];
        assert_eq!(Histogram::of(&numbers, 2.0, 4).counts, [2, 2, 2, 2]);
    }
}
