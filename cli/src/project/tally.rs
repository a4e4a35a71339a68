//! What a run has come to.

use std::collections::BTreeMap;
use std::time::Duration;

use perpend::{EntityId, FootPoint, Model, Multiplicity};

use crate::names;
use crate::report::{counted, rounded, say};

/// Counts over rows.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Tally {
    pub(crate) rows: u64,
    pub(crate) bad: u64,
    pub(crate) beyond: u64,
    pub(crate) largest_gap: f64,
    pub(crate) uncertified: u64,
    pub(crate) tied: u64,
    pub(crate) continuum: u64,
    pub(crate) methods: BTreeMap<&'static str, u64>,
}

/// Which answers count as certified: those whose bounds are no farther apart than `gap`, rounding aside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Certified {
    gap: f64,
    /// The largest |coordinate| of what was asked.
    reach: f64,
}

impl Certified {
    /// For answers of one entity.
    pub(crate) fn of_entity(model: &Model, id: EntityId, gap: Option<f64>) -> Option<Self> {
        let definition = model.entity(id)?.definition();
        Some(Self::new(definition.size(), definition.reach(), gap))
    }

    /// For answers of a whole model.
    pub(crate) fn of_model(model: &Model, gap: Option<f64>) -> Self {
        let reach = model.entities().iter().map(|entity| entity.definition().reach()).fold(0.0, f64::max);
        Self::new(model.size(), reach, gap)
    }

    fn new(size: f64, reach: f64, gap: Option<f64>) -> Self {
        Self { gap: gap.unwrap_or(1e-9 * size), reach }
    }

    /// Whether this answer is certified; `coordinate` is the query point's largest |coordinate|.
    pub(crate) fn holds(self, foot: &FootPoint, coordinate: f64) -> bool {
        foot.gap() <= self.gap + 32.0 * f64::EPSILON * (self.reach + coordinate)
    }
}

impl Tally {
    pub(crate) fn answer(&mut self, foot: &FootPoint, coordinate: f64, certified: Certified) {
        self.largest_gap = self.largest_gap.max(foot.gap());
        self.uncertified += u64::from(!certified.holds(foot, coordinate));
        self.tied += u64::from(foot.multiplicity == Multiplicity::Tied);
        self.continuum += u64::from(foot.multiplicity == Multiplicity::Continuum);
        *self.methods.entry(names::method(foot.method)).or_default() += 1;
    }

    pub(crate) fn add(&mut self, other: &Self) {
        self.rows += other.rows;
        self.bad += other.bad;
        self.beyond += other.beyond;
        self.largest_gap = self.largest_gap.max(other.largest_gap);
        self.uncertified += other.uncertified;
        self.tied += other.tied;
        self.continuum += other.continuum;
        for (method, count) in &other.methods {
            *self.methods.entry(method).or_default() += count;
        }
    }

    /// Tells the user.
    pub(crate) fn report(&self, unit: &str, reading: Duration, projecting: Duration) {
        let seconds = projecting.as_secs_f64();
        let rate = self.rows as f64 / seconds.max(1e-9);
        say(format_args!(
            "{} in {seconds:.3} s: {rate:.0} points/s (and {:.3} s to read the model)",
            counted(self.rows, "point"),
            reading.as_secs_f64(),
        ));
        say(format_args!("largest gap:    {} {unit}", rounded(self.largest_gap)));
        let methods: Vec<String> = self.methods.iter().map(|(method, count)| format!("{method} {count}")).collect();
        say(format_args!(
            "answered by:    {}",
            if methods.is_empty() { "none".to_owned() } else { methods.join(", ") }
        ));
        say(format_args!("not certified:  {}", self.uncertified));
        say(format_args!("tied:           {}, continuum {}", self.tied, self.continuum));
        say(format_args!("beyond maximum: {}", self.beyond));
        say(format_args!("bad rows:       {}", self.bad));
    }
}
