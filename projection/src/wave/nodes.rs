//! Parameters at which a direction is looked at before anything is known of its lengths.

use perpend_kernel::KnotVector;

/// The most nodes of one direction: a definition with more spans is looked at less closely than each span deserves.
const MOST: usize = 1 << 16;

/// Both ends of a range and parameters between them, ascending: every knot, and between knots as many as the degree has bends.
pub(super) fn nodes(knots: &KnotVector, (from, to): (f64, f64)) -> Vec<f64> {
    let between = if knots.degree() == 1 { 1 } else { 2 * knots.degree() };
    let mut nodes = vec![from];
    for span in knots.spans() {
        let (start, end) = (span.start.max(from), span.end.min(to));
        if start < end {
            nodes.extend((1..=between).map(|k| start + (end - start) * (k as f64 / between as f64)));
        }
    }
    if let Some(last) = nodes.last_mut().filter(|last| **last != from) {
        *last = to;
    } else {
        nodes.push(to);
    }
    nodes.dedup();
    thinned(nodes, MOST)
}

/// At most so many of a list, evenly chosen, both ends among them.
pub(super) fn thinned(nodes: Vec<f64>, most: usize) -> Vec<f64> {
    if nodes.len() <= most {
        return nodes;
    }
    let last = nodes.len() - 1;
    (0..most).map(|k| nodes[k * last / (most - 1)]).collect()
}
