//! Exchange of a surface's parameters.

use crate::surface::NurbsSurface;

impl NurbsSurface {
    /// The same points with u and v exchanged: the result at `(v, u)` is this surface at `(u, v)`. Exact.
    ///
    /// The normal changes its side.
    #[must_use]
    pub fn swapped(&self) -> Self {
        let (rows, columns) = (self.rows(), self.columns());
        let from = |k: usize| (k % rows) * columns + k / rows;
        Self {
            u: self.v.clone(),
            v: self.u.clone(),
            control_points: (0..rows * columns).map(|k| self.control_points[from(k)]).collect(),
            weights: self.weights().map(|w| (0..rows * columns).map(|k| w[from(k)]).collect()),
        }
    }
}
