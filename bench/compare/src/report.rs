//! From what was measured to the tables.

use crate::case::{Case, Set};
use crate::judgement::Judgement;
use crate::rivals::{ELEMENTARY, ELEMENTARY_BARE, RECOGNISED, REFERENCE};
use crate::run::Measured;
use crate::table::Table;

/// What was measured of a set.
pub(crate) struct Outcome<'a> {
    pub(crate) set: Set,
    pub(crate) cases: &'a [Case],
    /// The contenders' names, in the table's order.
    pub(crate) names: &'a [String],
    pub(crate) measured: &'a [Measured],
}

impl Outcome<'_> {
    /// What was measured of the contender of this name, entity by entity.
    fn of(&self, name: &str) -> Vec<&Measured> {
        self.measured.iter().filter(|measured| self.names[measured.contender] == name).collect()
    }

    /// What a set is called, and what it is made of.
    pub(crate) fn title(&self) -> String {
        let rows: usize = self.cases.iter().map(|case| case.rows.len()).sum();
        format!("{} ({}): {} entities, {rows} queries", self.set.name(), self.set.file(), self.cases.len())
    }

    /// A row for every contender, those that are absent among them.
    pub(crate) fn table(&self, absent: &[(String, String)]) -> Table {
        let mut table = Table::new(&[
            "contender",
            "judged",
            "timed",
            "µs/query",
            "min to max",
            "× hierarchy",
            "slowest entity",
            "setup µs",
            "longest",
            "heap KiB",
            "largest",
            "right %",
            "none",
            "worst error",
            "wrong/false/open",
        ]);
        let reference = self.of(REFERENCE);
        for name in self.names {
            let all = self.of(name);
            if !all.is_empty() {
                table.push(self.row(name, &all, &reference));
            }
        }
        for (name, reason) in absent {
            let mut row = vec![String::new(); 15];
            row[0] = format!("{name}: {reason}");
            table.push(row);
        }
        table
    }

    fn row(&self, name: &str, all: &[&Measured], reference: &[&Measured]) -> Vec<String> {
        let mean = |of: &dyn Fn(&Measured) -> f64| geometric_mean(all.iter().map(|measured| of(measured)));
        let judgement = all.iter().fold(Judgement::default(), |sum, measured| sum.and(measured.judgement));
        let slowest = all.iter().max_by(|a, b| a.fastest().total_cmp(&b.fastest())).expect("a row has an entity");
        let ratio = |measured: &&Measured| {
            let beside = reference.iter().find(|other| other.case == measured.case)?;
            Some(measured.fastest() / beside.fastest())
        };
        let ratios: Option<Vec<f64>> = all.iter().map(ratio).collect();
        let heaps: Option<Vec<f64>> = all.iter().map(|measured| Some(measured.heap? as f64 / 1024.0)).collect();
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let setups: Vec<f64> = all.iter().map(|measured| measured.setup).collect();
        let unanswered = match (judgement.unanswered, judgement.aborted) {
            (none, 0) => none.to_string(),
            (none, aborted) => format!("{none}, {aborted} aborted"),
        };
        let counts = format!("{} / {} / {}", judgement.wrong, judgement.false_bounds, judgement.uncertified);
        vec![
            self.label(name, all),
            judgement.rows.to_string(),
            all.iter().map(|measured| measured.timed).sum::<usize>().to_string(),
            figure(mean(&Measured::median)),
            format!("{} to {}", figure(mean(&Measured::fastest)), figure(mean(&Measured::slowest))),
            ratios.map_or(absent(), |ratios| figure(geometric_mean(ratios.into_iter()))),
            format!("{} ({})", figure(slowest.fastest()), self.cases[slowest.case].name),
            figure(geometric_mean(setups.iter().copied())),
            figure(largest(&setups)),
            heaps.as_ref().map_or(absent(), |heaps| figure(geometric_mean(heaps.iter().copied()))),
            heaps.as_ref().map_or(absent(), |heaps| figure(largest(heaps))),
            percentage(judgement.right, judgement.rows),
            unanswered,
            format!("{:.0e}", judgement.worst),
            if judgement.has_bounds { counts } else { absent() },
        ]
    }

    /// The name, with the measured chord error of what stands for the entities, or how many of the entities it has.
    fn label(&self, name: &str, all: &[&Measured]) -> String {
        let chord_error = all.iter().filter_map(|measured| measured.chord_error).reduce(f64::max);
        let measured = chord_error.map_or(String::new(), |error| format!(" (measured {error:.1e})"));
        let part = if all.len() < self.cases.len() { format!(" ({} entities)", all.len()) } else { String::new() };
        format!("{name}{measured}{part}")
    }

    /// Kind by kind, perpend's recognised query beside OpenCASCADE on its own shape; none where one of them did not run.
    pub(crate) fn elementary(&self) -> Option<Table> {
        let rows = [RECOGNISED, REFERENCE, ELEMENTARY_BARE, ELEMENTARY];
        let measured = rows.map(|name| self.of(name));
        if measured.iter().any(Vec::is_empty) {
            return None;
        }
        let mut table = Table::new(&[
            "kind",
            "perpend, recognised µs",
            "hierarchy µs",
            "OCCT GeomAPI alone µs",
            "right %",
            "× recognised",
            "OCCT with edges µs",
            "right %",
            "× recognised",
        ]);
        let mut kinds: Vec<&str> = self.cases.iter().filter_map(|case| Some(case.shape.as_ref()?.kind)).collect();
        kinds.dedup();
        for kind in kinds {
            let of_kind = |measured: &&&Measured| {
                self.cases[measured.case].shape.as_ref().is_some_and(|shape| shape.kind == kind)
            };
            let [recognised, hierarchy, bare, edges] =
                measured.each_ref().map(|all| all.iter().filter(of_kind).copied().collect::<Vec<_>>());
            let mean = |all: &[&Measured]| geometric_mean(all.iter().map(|measured| measured.median()));
            let fastest = |all: &[&Measured]| geometric_mean(all.iter().map(|measured| measured.fastest()));
            let right = |all: &[&Measured]| {
                let sum = all.iter().fold(Judgement::default(), |sum, measured| sum.and(measured.judgement));
                percentage(sum.right, sum.rows)
            };
            table.push(vec![
                kind.to_owned(),
                figure(mean(&recognised)),
                figure(mean(&hierarchy)),
                figure(mean(&bare)),
                right(&bare),
                figure(fastest(&bare) / fastest(&recognised)),
                figure(mean(&edges)),
                right(&edges),
                figure(fastest(&edges) / fastest(&recognised)),
            ]);
        }
        Some(table)
    }
}

fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value.ln(), count + 1));
    (sum / f64::from(count)).exp()
}

/// Three figures, or all before the point.
fn figure(value: f64) -> String {
    let decimals = match value {
        v if v < 1.0 => 3,
        v if v < 10.0 => 2,
        v if v < 100.0 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

/// A share of a count, rounded down: 100 is all.
fn percentage(part: usize, whole: usize) -> String {
    format!("{:.2}", (part as f64 / whole as f64 * 1e4).floor() / 1e2)
}

fn absent() -> String {
    "n/a".to_owned()
}
