//! Shapes with a closed form are answered to the last digits: on and beside every set where a foot is not alone or not regular, at
//! every scale and place, however they are cut, parametrised and described; and it is the closed form that answers.
//!
//! Distances are held to `common/exact`, which enumerates all stationary points, edges and corners to 30 digits and shares nothing
//! with the solvers.

#![allow(clippy::print_stderr, reason = "the worst error and the share of the closed form are wanted by readers")]

mod common;

#[path = "analytic/almost.rs"]
mod almost;
#[path = "analytic/case.rs"]
mod case;
#[path = "analytic/forms.rs"]
mod forms;
#[path = "analytic/options.rs"]
mod options;
#[path = "analytic/probes.rs"]
mod probes;
#[path = "analytic/profiles.rs"]
mod profiles;
#[path = "analytic/shapes.rs"]
mod shapes;
#[path = "analytic/whole.rs"]
mod whole;
