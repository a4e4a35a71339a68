//! The ranges of a parameter over which an entity is smooth.

/// A parameter's domain, cut where a tangent may turn or vanish; on closed entities its ends are one.
#[derive(Debug, Clone)]
pub(super) struct Track {
    domain: (f64, f64),
    /// Inside the domain, ascending.
    cuts: Vec<f64>,
    /// Whether the last parameter runs smoothly into the first one.
    wraps: bool,
}

impl Track {
    pub(super) fn new(domain: (f64, f64), mut cuts: Vec<f64>, wraps: bool) -> Self {
        cuts.retain(|cut| *cut > domain.0 && *cut < domain.1);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        Self { domain, cuts, wraps }
    }

    pub(super) fn cuts(&self) -> &[f64] {
        &self.cuts
    }

    pub(super) fn domain(&self) -> (f64, f64) {
        self.domain
    }

    /// Whether an end of the domain is where the entity ends.
    pub(super) fn is_end(&self, u: f64) -> bool {
        !self.wraps && (u == self.domain.0 || u == self.domain.1)
    }

    /// The smooth range that holds a parameter of the domain; at a cut, the one above it or the one below. On a track that wraps it may go on beyond
    /// the domain, and has no end where nothing is cut.
    pub(super) fn part(&self, u: f64, below: bool) -> (f64, f64) {
        let next = self.cuts.partition_point(|cut| if below { *cut < u } else { *cut <= u });
        let (first, last) = self.domain;
        let period = last - first;
        let (none, low, high) = match (self.cuts.first(), self.cuts.last()) {
            (Some(least), Some(greatest)) if self.wraps => (false, greatest - period, least + period),
            _ if self.wraps => (true, f64::NEG_INFINITY, f64::INFINITY),
            _ => (true, first, last),
        };
        if none && self.cuts.is_empty() {
            return (low, high);
        }
        let from = if next > 0 { self.cuts[next - 1] } else { low };
        let to = if next < self.cuts.len() { self.cuts[next] } else { high };
        (from, to)
    }

    /// The smooth range on the other side of a border of a part, and the border's parameter in its terms; none at an end of the entity.
    pub(super) fn beyond(&self, border: f64, above: bool) -> Option<(f64, (f64, f64))> {
        let border = self.wrap(border);
        self.cuts.contains(&border).then(|| (border, self.part(border, !above)))
    }

    /// The parameter of the domain that is meant: on a track that wraps, what lies beyond one end comes in at the other.
    pub(super) fn wrap(&self, u: f64) -> f64 {
        let (first, last) = self.domain;
        if self.wraps && !(first..=last).contains(&u) {
            let period = last - first;
            return (first + (u - first).rem_euclid(period)).clamp(first, last);
        }
        u.max(first).min(last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_ends_at_cuts_and_goes_on_over_a_smooth_seam() {
        let open = Track::new((0.0, 4.0), vec![3.0, 1.0, 4.0], false);
        assert_eq!(
            [0.0, 0.5, 1.0, 2.0, 4.0].map(|u| open.part(u, false)),
            [(0.0, 1.0), (0.0, 1.0), (1.0, 3.0), (1.0, 3.0), (3.0, 4.0)]
        );
        assert_eq!(open.part(1.0, true), (0.0, 1.0));
        assert_eq!(open.beyond(1.0, false), Some((1.0, (0.0, 1.0))));
        assert_eq!(open.beyond(4.0, true), None);
        assert_eq!([-1.0, 5.0].map(|u| open.wrap(u)), [0.0, 4.0]);
        let ring = Track::new((0.0, 4.0), vec![1.0, 3.0], true);
        assert_eq!([0.5, 2.0, 3.5].map(|u| ring.part(u, false)), [(-1.0, 1.0), (1.0, 3.0), (3.0, 5.0)]);
        assert_eq!(ring.beyond(5.0, true), Some((1.0, (1.0, 3.0))));
        assert_eq!(ring.beyond(-1.0, false), Some((3.0, (1.0, 3.0))));
        let whole = Track::new((0.0, 4.0), Vec::new(), true);
        assert_eq!(whole.part(2.0, false), (f64::NEG_INFINITY, f64::INFINITY));
        assert_eq!([-1.0, 9.0, 4.0].map(|u| whole.wrap(u)), [3.0, 1.0, 4.0]);
    }
}
