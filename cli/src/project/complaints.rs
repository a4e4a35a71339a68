//! Rows that are wrong, named as they come.

use indicatif::ProgressBar;

use crate::project::query::Complaint;
use crate::project::source::Source;
use crate::report::{counted, say};

/// How many bad rows are named one by one.
const NAMED: u64 = 20;

/// Names bad rows on standard error: the first few one by one, the others as a count.
pub(crate) struct Complaints<'a> {
    source: Source<'a>,
    bar: &'a ProgressBar,
    /// How many there have been.
    count: u64,
}

impl<'a> Complaints<'a> {
    pub(crate) fn new(source: Source<'a>, bar: &'a ProgressBar) -> Self {
        Self { source, bar, count: 0 }
    }

    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    pub(crate) fn take(&mut self, complaint: &Complaint) {
        if self.count < NAMED {
            self.bar.suspend(|| say(format_args!("{}:{complaint}", self.source)));
        }
        self.count += 1;
    }

    /// Tells how many were not named.
    pub(crate) fn finish(&self) {
        let unnamed = self.count.saturating_sub(NAMED);
        if unnamed > 0 {
            say(format_args!("{}: and {} like these", self.source, counted(unnamed, "other bad row")));
        }
    }
}
