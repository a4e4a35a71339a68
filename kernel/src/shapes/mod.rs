//! Analytic shapes and their exact NURBS forms.
//!
//! Each shape is plain data: build it by its fields or with `new`, which checks them; `to_nurbs` checks again and gives the NURBS.
//! Angles are in radians. Surfaces run along the profile (height, latitude, tube) in u and around the axis, from `xdir` towards
//! `ydir`, in v; every domain is `[0, 1]`. So the normal `S_u × S_v` of a cylinder, cone, sphere or torus points inward, that of a plane
//! along its axis. A full turn closes in the same bits. An arc has one rational quadratic span for each
//! 90 degrees or part of them (The NURBS Book, §7.5), so its parameter is not the angle but agrees with it at the joints.

mod arc;
mod check;
mod circle;
mod cone;
mod cylinder;
mod ellipse;
mod frame;
mod line;
mod plane;
mod sphere;
mod torus;
mod turn;

pub(crate) use arc::Arc;
pub(crate) use check::sweep as check_sweep;
pub use circle::Circle;
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use ellipse::Ellipse;
pub use frame::Frame;
pub(crate) use frame::unit_vector;
pub use line::Line;
pub use plane::Plane;
pub use sphere::Sphere;
pub use torus::Torus;
