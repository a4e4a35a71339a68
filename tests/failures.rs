//! The failures that users of other kernels report, each as a test with its story in a line, and what the answers' documentation
//! promises about places, signs and options.
//!
//! A story names where the failure was seen; the data are our own unless the test says that it keeps the report's numbers. Every
//! answer passes [`case::Case`] first, which holds it to all that every answer promises.

mod common;

#[path = "failures/beside_poles.rs"]
mod beside_poles;
#[path = "failures/boundaries.rs"]
mod boundaries;
#[path = "failures/case.rs"]
mod case;
#[path = "failures/degenerate.rs"]
mod degenerate;
#[path = "failures/exclusion.rs"]
mod exclusion;
#[path = "failures/honesty.rs"]
mod honesty;
#[path = "failures/many_minima.rs"]
mod many_minima;
#[path = "failures/motions.rs"]
mod motions;
#[path = "failures/near.rs"]
mod near;
#[path = "failures/options.rs"]
mod options;
#[path = "failures/places.rs"]
mod places;
#[path = "failures/polylines.rs"]
mod polylines;
#[path = "failures/seams.rs"]
mod seams;
#[path = "failures/shapes.rs"]
mod shapes;
#[path = "failures/signs.rs"]
mod signs;
#[path = "failures/ties.rs"]
mod ties;
