//! Triangles of NURBS surfaces and trimmed faces, and polylines of NURBS curves, within a chord error.
//!
//! [`tessellate`] gives a [`Mesh`], [`polyline`] a [`Polyline`]; [`obj`] and [`stl`] write them. The chord error is a length, and it is
//! proven: [`Mesh::error`] and [`Polyline::error`] are computed from control points, not from samples.
//!
//! # The bound of a surface
//!
//! The domain is cut into cells that lie in one Bézier piece each, and every triangle lies in one cell. For a point `x` of a triangle
//! with corners `v_i` and barycentric weights `λ_i`, Taylor's formula about `x` gives
//!
//! ```text
//! |Σ λ_i S(v_i) - S(x)| <= 1/2 Σ λ_i (du_i² |S_uu| + 2 |du_i dv_i| |S_uv| + dv_i² |S_vv|)
//!                       <= 1/8 (h_u² |S_uu| + 2 h_u h_v |S_uv| + h_v² |S_vv|)
//! ```
//!
//! with the bounds of the second derivatives over the cell and its sides `h_u`, `h_v`: `Σ λ_i du_i²` is the variance of a variable within
//! an interval of that length, at most `h_u² / 4`, and the mixed term follows by Cauchy and Schwarz. The triangle may have any shape. The
//! derivatives are bounded by differences of the cell's own control points, for rational pieces through the quotient rule. (For right
//! triangles the bound is that of Filip, Magedson, Markot: Surface algorithms using bounds on derivatives, 1986.)
//!
//! # The bound of a trim
//!
//! A piece of a trim with control points `P_i` and the chord between its ends are apart by at most `max |P_i - x_i|`, `x_i` being any
//! points of the chord: both are the same convex combinations of them (and the ends agree, so that only the share of the inner points
//! counts). In space that is at most `|S_u| du + |S_v| dv`. What lies between piece and chord is swept by the segments between corresponding
//! points, so it is as near. Each trim is given one
//! half of the chord error, and the cells the other; the polyline in space is then within the chord error of the exact trim, also seen
//! from the face beside it.
//!
//! Both bounds leave out the rounding of evaluation, a few ulps of the largest coordinate.

mod apart;
mod bound;
mod cells;
mod curve;
mod fill;
mod grid;
mod mesh;
mod normal;
pub mod obj;
mod outline;
mod parity;
mod patch;
mod refine;
pub mod stl;
mod tessellate;

pub use curve::{Polyline, polyline};
pub use mesh::Mesh;
pub use tessellate::{InvalidChord, Limits, tessellate};
