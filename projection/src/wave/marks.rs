//! Marks that tell what a wave has met.

/// Which segments the wave of this query has met: a segment is registered with many cells, and looked at once.
///
/// The marks are kept from query to query and never cleared: each query has a stamp of its own, and a mark with another stamp is none.
#[derive(Debug, Default)]
pub(crate) struct Marks {
    stamp: u32,
    met: Vec<u32>,
}

impl Marks {
    /// Begins a query over so many segments.
    pub(super) fn begin(&mut self, segments: usize) {
        if self.met.len() < segments {
            self.met.resize(segments, 0);
        }
        self.stamp = self.stamp.wrapping_add(1);
        if self.stamp == 0 {
            self.met.fill(0);
            self.stamp = 1;
        }
    }

    /// Marks a segment; whether it was unmarked.
    pub(super) fn meet(&mut self, segment: u32) -> bool {
        let mark = &mut self.met[segment as usize];
        let new = *mark != self.stamp;
        *mark = self.stamp;
        new
    }
}
