//! Signs and differences of a scalar Bernstein net, and its halves.
//!
//! A net of degree `(m, n)` has `m + 1` rows of `n + 1` coefficients. Rows lie [`stride`](Layout::stride) apart, a multiple of the lanes, and are filled
//! up with their last coefficient: extremes and differences of whole rows may then be taken lane by lane, the same at every level of the processor. A
//! polynomial in one variable is one row, whichever variable it is. A few numbers follow the last row, so that a row may be read from a little behind
//! its start.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x4};

/// Lanes of a vector.
pub(super) const LANES: usize = 4;

/// Degrees of a net in s and t; of a net in one variable the other one is 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Layout {
    pub m: usize,
    pub n: usize,
}

impl Layout {
    /// The degree from row to row: 0 for a net in one variable.
    pub(super) fn down(self) -> usize {
        if self.n == 0 { 0 } else { self.m }
    }

    /// The degree along the rows.
    pub(super) fn along(self) -> usize {
        if self.n == 0 { self.m } else { self.n }
    }

    /// How far rows are apart: at least one lane is left over, as the degree of a square is even.
    pub(super) fn stride(self) -> usize {
        (self.along() + 1).next_multiple_of(LANES)
    }

    /// The numbers that the rows take up.
    pub(super) fn rows_len(self) -> usize {
        (self.down() + 1) * self.stride()
    }

    /// All numbers of a net.
    pub(super) fn len(self) -> usize {
        self.rows_len() + LANES
    }

    /// Where the coefficient of row `i` and column `j` lies; of a net in one variable, that of index `i + j`.
    pub(super) fn at(self, i: usize, j: usize) -> usize {
        if self.n == 0 || self.m == 0 { i + j } else { i * self.stride() + j }
    }

    /// The four corners: where each lies, and whether it is at the end in s and in t. One for each that differs.
    pub(super) fn corners(self) -> impl Iterator<Item = (usize, bool, bool)> {
        let ends = [(false, false), (false, true), (true, false), (true, true)];
        ends.into_iter()
            .filter(move |(s, t)| (self.m > 0 || !s) && (self.n > 0 || !t))
            .map(move |(s, t)| (self.at(if s { self.m } else { 0 }, if t { self.n } else { 0 }), s, t))
    }

    /// Fills every row up with its last coefficient.
    pub(super) fn pad(self, g: &mut [f64]) {
        let along = self.along();
        for row in g[..self.rows_len()].chunks_exact_mut(self.stride()) {
            let last = row[along];
            row[along + 1..].fill(last);
        }
    }
}

/// Degrees of a net in two variables that loops may know beforehand.
pub(super) trait Extent: Copy {
    /// The degree from row to row.
    fn m(self) -> usize;
    /// The degree along the rows.
    fn n(self) -> usize;

    /// How far rows are apart.
    #[inline(always)]
    fn stride(self) -> usize {
        (self.n() + 1).next_multiple_of(LANES)
    }

    /// The numbers that the rows take up.
    #[inline(always)]
    fn rows_len(self) -> usize {
        (self.m() + 1) * self.stride()
    }
}

/// Degrees that are known when the program is built.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fixed<const M: usize, const N: usize>;

impl<const M: usize, const N: usize> Extent for Fixed<M, N> {
    #[inline(always)]
    fn m(self) -> usize {
        M
    }

    #[inline(always)]
    fn n(self) -> usize {
        N
    }
}

/// Any degrees: of a net in one variable, one row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Any(pub Layout);

impl Extent for Any {
    #[inline(always)]
    fn m(self) -> usize {
        self.0.down()
    }

    #[inline(always)]
    fn n(self) -> usize {
        self.0.along()
    }
}

/// Calls a function that is generic over [`Extent`] with the usual degrees known beforehand.
macro_rules! with_extent {
    ($layout:expr, $extent:ident => $call:expr) => {
        match $layout {
            Layout { m: 6, n: 6 } => {
                let $extent = $crate::hierarchy::net::Fixed::<6, 6>;
                $call
            }
            Layout { m: 4, n: 4 } => {
                let $extent = $crate::hierarchy::net::Fixed::<4, 4>;
                $call
            }
            layout => {
                let $extent = $crate::hierarchy::net::Any(layout);
                $call
            }
        }
    };
}
pub(super) use with_extent;

#[inline(always)]
pub(super) fn load<S: Simd>(simd: S, g: &[f64], at: usize) -> f64x4<S> {
    f64x4::from_slice(simd, &g[at..at + LANES])
}

/// The lanes that begin `by` before `at`, zeros where that is before the net.
#[inline(always)]
pub(super) fn before<S: Simd>(simd: S, g: &[f64], at: usize, by: usize) -> f64x4<S> {
    if at >= by {
        return load(simd, g, at - by);
    }
    let mut lanes = [0.0; LANES];
    lanes[by..].copy_from_slice(&g[..LANES - by]);
    f64x4::simd_from(simd, lanes)
}

#[inline(always)]
pub(super) fn least_lane<S: Simd>(x: f64x4<S>) -> f64 {
    let smaller = |a: f64, b: f64| if b < a { b } else { a };
    smaller(smaller(x[0], x[1]), smaller(x[2], x[3]))
}

/// The indices of the lanes that begin at `from`.
#[inline(always)]
pub(super) fn indices<S: Simd>(simd: S, from: usize) -> f64x4<S> {
    f64x4::simd_from(simd, [0.0, 1.0, 2.0, 3.0]) + from as f64
}

/// The least of `f` over the chunks of `0..len`.
#[inline(always)]
fn least_of<S: Simd>(simd: S, len: usize, f: impl Fn(usize) -> f64x4<S>) -> f64 {
    let mut low = f64x4::splat(simd, f64::INFINITY);
    let mut at = 0;
    while at < len {
        low = low.min(f(at));
        at += LANES;
    }
    least_lane(low)
}

/// The least coefficient.
pub(super) fn least(level: Level, g: &[f64], layout: Layout) -> f64 {
    dispatch!(level, simd => with_extent!(layout, extent => {
        let g = &g[..extent.rows_len()];
        least_of(simd, g.len(), #[inline(always)] |at| load(simd, g, at))
    }))
}

/// The largest coefficient.
pub(super) fn most(level: Level, g: &[f64], layout: Layout) -> f64 {
    -dispatch!(level, simd => least_of(simd, layout.rows_len(), #[inline(always)] |at| -load(simd, g, at)))
}

/// The largest |coefficient|.
pub(super) fn largest(level: Level, g: &[f64], layout: Layout) -> f64 {
    -dispatch!(level, simd => least_of(simd, layout.rows_len(), #[inline(always)] |at| -load(simd, g, at).abs()))
}

/// An edge of a net in two variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Edge {
    /// The first or the last row.
    Row { last: bool },
    /// The first or the last column.
    Column { last: bool },
}

/// Every edge of a net.
pub(super) const EDGES: [Edge; 4] =
    [Edge::Row { last: false }, Edge::Row { last: true }, Edge::Column { last: false }, Edge::Column { last: true }];

/// An edge that holds a coefficient of at most `holds`, and above which everything else stays but for `given` at most; with how far it stays above:
/// negative where it falls below.
pub(super) fn edge_below(level: Level, g: &[f64], layout: Layout, holds: f64, given: f64) -> Option<(Edge, f64)> {
    dispatch!(level, simd => with_extent!(layout, extent => find_edge(simd, g, extent, holds, given)))
}

#[inline(always)]
fn find_edge<S: Simd>(simd: S, g: &[f64], extent: impl Extent, holds: f64, given: f64) -> Option<(Edge, f64)> {
    let (stride, g) = (extent.stride(), &g[..extent.rows_len()]);
    for last in [false, true] {
        let start = if last { extent.m() * stride } else { 0 };
        if least_of(
            simd,
            stride,
            #[inline(always)]
            |at| load(simd, g, start + at),
        ) <= holds
        {
            let above = rows_above(simd, g, extent, last);
            if above >= -given {
                return Some((Edge::Row { last }, above));
            }
        }
    }
    for last in [false, true] {
        let at = if last { extent.n() } else { 0 };
        if (0..=extent.m()).any(
            #[inline(always)]
            |i| g[i * stride + at] <= holds,
        ) {
            let above = columns_above(simd, g, extent, last, -given);
            if above >= -given {
                return Some((Edge::Column { last }, above));
            }
        }
    }
    None
}

/// How far everything else stays above an edge: the least difference, negative where it falls below.
pub(super) fn above(level: Level, g: &[f64], layout: Layout, edge: Edge) -> f64 {
    dispatch!(level, simd => match edge {
        Edge::Row { last } => rows_above(simd, g, Any(layout), last),
        Edge::Column { last } => columns_above(simd, g, Any(layout), last, f64::NEG_INFINITY),
    })
}

#[inline(always)]
fn rows_above<S: Simd>(simd: S, g: &[f64], extent: impl Extent, last: bool) -> f64 {
    let stride = extent.stride();
    let (edge, from) = if last { (extent.m() * stride, 0) } else { (0, stride) };
    let mut low = f64x4::splat(simd, f64::INFINITY);
    let mut column = 0;
    while column < stride {
        let held = load(simd, g, edge + column);
        for row in 0..extent.m() {
            low = low.min(load(simd, g, from + row * stride + column) - held);
        }
        column += LANES;
    }
    least_lane(low)
}

/// May stop early, with some value below `enough`, once it falls below that.
#[inline(always)]
fn columns_above<S: Simd>(simd: S, g: &[f64], extent: impl Extent, last: bool, enough: f64) -> f64 {
    let (stride, edge) = (extent.stride(), if last { extent.n() } else { 0 });
    let infinity = f64x4::splat(simd, f64::INFINITY);
    let mut low = infinity;
    for i in 0..=extent.m() {
        let held = g[i * stride + edge];
        let mut column = 0;
        while column < stride {
            let index = indices(simd, column);
            // the edge itself, and what fills up the row, is no other column
            let other = if last { index.simd_lt(edge as f64) } else { index.simd_gt(0.0) };
            low = low.min(other.select(load(simd, g, i * stride + column) - held, infinity));
            column += LANES;
        }
        if least_lane(low) < enough {
            break;
        }
    }
    least_lane(low)
}

/// The edge as a net in one variable, in place of the net.
pub(super) fn take_edge(g: &mut [f64], layout: Layout, edge: Edge) -> Layout {
    let reduced = match edge {
        Edge::Row { last } => {
            if last {
                g.copy_within(layout.rows_len() - layout.stride()..layout.rows_len(), 0);
            }
            Layout { m: 0, n: layout.n }
        }
        Edge::Column { last } => {
            let column = if last { layout.n } else { 0 };
            for i in 0..=layout.m {
                g[i] = g[i * layout.stride() + column];
            }
            Layout { m: layout.m, n: 0 }
        }
    };
    reduced.pad(g);
    reduced
}

/// The least second differences `g[i] - 2 g[i + 1] + g[i + 2]` from row to row and along the rows, and the largest |mixed difference|
/// `g[i][j] - g[i + 1][j] - g[i][j + 1] + g[i + 1][j + 1]`, of a net of two variables. Of one in one variable, the second is what there is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Differences {
    pub down: f64,
    pub along: f64,
    pub mixed: f64,
}

#[inline(always)]
pub(super) fn differences<S: Simd>(simd: S, g: &[f64], extent: impl Extent) -> Differences {
    let (stride, rows, columns) = (extent.stride(), extent.m(), extent.n() as f64);
    let g = &g[..extent.rows_len() + LANES];
    let (infinity, zero) = (f64x4::splat(simd, f64::INFINITY), f64x4::splat(simd, 0.0));
    let (mut down, mut along, mut mixed) = (infinity, infinity, zero);
    let mut column = 0;
    while column < stride {
        let index = indices(simd, column);
        let (first, second) = (index.simd_lt(columns), index.simd_le(columns - 2.0));
        let (mut here, mut right) = (load(simd, g, column), load(simd, g, column + 1));
        let mut above = zero;
        for i in 0..=rows {
            let next = load(simd, g, i * stride + column + 2);
            along = along.min(second.select(here - right * 2.0 + next, infinity));
            if i < rows {
                let at = (i + 1) * stride + column;
                let (below, across) = (load(simd, g, at), load(simd, g, at + 1));
                mixed = mixed.max(first.select((here - right) - (below - across), zero).abs());
                if i > 0 {
                    down = down.min(above - here * 2.0 + below);
                }
                (above, here, right) = (here, below, across);
            }
        }
        column += LANES;
    }
    Differences { down: least_lane(down), along: least_lane(along), mixed: -least_lane(-mixed) }
}

/// Whether the net varies more in s than in t, by second differences and degrees.
pub(super) fn bends_more_in_s(level: Level, g: &[f64], layout: Layout) -> bool {
    let Layout { m, n } = layout;
    if m == 0 || n == 0 {
        return n == 0;
    }
    dispatch!(level, simd => with_extent!(layout, extent => {
        let (down, along) = bends(simd, g, extent);
        down * (m * m) as f64 > along * (n * n) as f64
    }))
}

/// The largest |second differences| from row to row and along the rows.
#[inline(always)]
fn bends<S: Simd>(simd: S, g: &[f64], extent: impl Extent) -> (f64, f64) {
    let (stride, columns) = (extent.stride(), extent.n() as f64);
    let g = &g[..extent.rows_len() + LANES];
    let zero = f64x4::splat(simd, 0.0);
    let (mut down, mut along) = (zero, zero);
    let mut column = 0;
    while column < stride {
        let second = indices(simd, column).simd_le(columns - 2.0);
        for i in 0..=extent.m() {
            let at = i * stride + column;
            let here = load(simd, g, at);
            let bend = here - load(simd, g, at + 1) * 2.0 + load(simd, g, at + 2);
            along = along.max(second.select(bend.abs(), zero));
            if i + 2 <= extent.m() {
                down = down.max((here - load(simd, g, at + stride) * 2.0 + load(simd, g, at + 2 * stride)).abs());
            }
        }
        column += LANES;
    }
    (-least_lane(-down), -least_lane(-along))
}

/// Halves the net in s or in t: `low` keeps the first half, `high` takes the second.
pub(super) fn halve(level: Level, low: &mut [f64], high: &mut [f64], layout: Layout, in_s: bool) {
    if in_s && layout.n > 0 {
        dispatch!(level, simd => with_extent!(layout, extent => halve_down(simd, low, high, extent)));
        return;
    }
    dispatch!(level, _simd => with_extent!(layout, extent => halve_along(low, high, extent)));
    layout.pad(low);
    layout.pad(high);
}

#[inline(always)]
fn halve_down<S: Simd>(simd: S, low: &mut [f64], high: &mut [f64], extent: impl Extent) {
    let (m, stride, len) = (extent.m(), extent.stride(), extent.rows_len());
    let (low, high) = (&mut low[..len], &mut high[..len]);
    let mut column = 0;
    while column < stride {
        let last = m * stride + column;
        load(simd, low, last).store_slice(&mut high[last..last + LANES]);
        for k in 1..=m {
            let mut here = load(simd, low, last);
            for i in (k..=m).rev() {
                let (at, above) = (i * stride + column, load(simd, low, (i - 1) * stride + column));
                ((here + above) * 0.5).store_slice(&mut low[at..at + LANES]);
                here = above;
            }
            let at = (m - k) * stride + column;
            load(simd, low, last).store_slice(&mut high[at..at + LANES]);
        }
        column += LANES;
    }
}

#[inline(always)]
fn halve_along(low: &mut [f64], high: &mut [f64], extent: impl Extent) {
    let (degree, stride, len) = (extent.n(), extent.stride(), extent.rows_len());
    for (low, high) in low[..len].chunks_exact_mut(stride).zip(high[..len].chunks_exact_mut(stride)) {
        high[degree] = low[degree];
        for k in 1..=degree {
            for j in (k..=degree).rev() {
                low[j] = 0.5 * (low[j] + low[j - 1]);
            }
            high[degree - k] = low[degree];
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A net in its layout, from its coefficients in rows.
    pub(in super::super) fn laid_out(layout: Layout, coefficients: &[f64]) -> Vec<f64> {
        let mut g = vec![0.0; layout.len()];
        for (at, x) in coefficients.iter().enumerate() {
            g[layout.at(at / (layout.n + 1), at % (layout.n + 1))] = *x;
        }
        layout.pad(&mut g);
        g
    }

    /// Every level that this processor has.
    pub(in super::super) fn levels() -> Vec<Level> {
        vec![Level::baseline(), Level::new()]
    }

    #[test]
    fn differences_edges_and_halves_agree_with_their_definitions() {
        for (m, n) in [(4, 6), (2, 2), (6, 2), (8, 10), (0, 6), (6, 0), (14, 0), (0, 2)] {
            let layout = Layout { m, n };
            let plain: Vec<f64> = (0..(m + 1) * (n + 1)).map(|i| f64::from((i * i * 7 % 23) as u32) - 5.0).collect();
            let at = |i: usize, j: usize| plain[i * (n + 1) + j];
            let g = laid_out(layout, &plain);
            let low = plain.iter().copied().fold(f64::INFINITY, f64::min);
            let high = plain.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let mut expected = Differences { down: f64::INFINITY, along: f64::INFINITY, mixed: 0.0 };
            for i in 0..=m {
                for j in 0..=n {
                    if i + 2 <= m {
                        let second = at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j);
                        let least = if n == 0 { &mut expected.along } else { &mut expected.down };
                        *least = least.min(second);
                    }
                    if j + 2 <= n {
                        expected.along = expected.along.min(at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2));
                    }
                    if i < m && j < n {
                        let mixed = at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1);
                        expected.mixed = expected.mixed.max(mixed.abs());
                    }
                }
            }
            for level in levels() {
                assert_eq!((least(level, &g, layout), most(level, &g, layout)), (low, high));
                assert_eq!(largest(level, &g, layout), high.max(-low));
                assert_eq!(dispatch!(level, simd => differences(simd, &g, Any(layout))), expected, "{m} {n}");
            }
            if m > 0 && n > 0 {
                for edge in EDGES {
                    let on_edge = |i: usize, j: usize| match edge {
                        Edge::Row { last } => i == if last { m } else { 0 },
                        Edge::Column { last } => j == if last { n } else { 0 },
                    };
                    let held = |i: usize, j: usize| match edge {
                        Edge::Row { last } => at(if last { m } else { 0 }, j),
                        Edge::Column { last } => at(i, if last { n } else { 0 }),
                    };
                    let pairs = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
                    let others = pairs.filter(|(i, j)| !on_edge(*i, *j)).map(|(i, j)| at(i, j) - held(i, j));
                    let expected = others.fold(f64::INFINITY, f64::min);
                    for level in levels() {
                        assert_eq!(above(level, &g, layout, edge), expected);
                    }
                    let mut taken = g.clone();
                    let reduced = take_edge(&mut taken, layout, edge);
                    let along: Vec<f64> = match edge {
                        Edge::Row { .. } => (0..=n).map(|j| held(0, j)).collect(),
                        Edge::Column { .. } => (0..=m).map(|i| held(i, 0)).collect(),
                    };
                    assert_eq!(taken[..=reduced.along()], along);
                }
            }
            for in_s in [false, true] {
                if (in_s && m == 0) || (!in_s && n == 0) {
                    continue;
                }
                let (mut low, mut high) = (g.clone(), vec![0.0; g.len()]);
                halve(Level::new(), &mut low, &mut high, layout, in_s);
                let degree = if in_s { m } else { n };
                let index = |k: usize, other: usize| if in_s { layout.at(k, other) } else { layout.at(other, k) };
                for other in 0..=if in_s { n } else { m } {
                    let line: Vec<f64> = (0..=degree).map(|k| g[index(k, other)]).collect();
                    // the halves keep the ends and meet in the middle
                    assert_eq!((low[index(0, other)], high[index(degree, other)]), (line[0], line[degree]));
                    let scale = f64::from(2_u32.pow(degree as u32));
                    let terms = line.iter().enumerate().map(|(k, x)| x * perpend_kernel::binomial(degree, k) / scale);
                    let middle: f64 = terms.sum();
                    assert!((low[index(degree, other)] - middle).abs() < 1e-13);
                    assert_eq!(low[index(degree, other)], high[index(0, other)]);
                }
            }
        }
    }
}
