//! What the tests of the whole share: an oracle that has no code in common with the solver, generators of entities and points that
//! are hard on purpose, and readers of the test sets.

#![allow(dead_code, unreachable_pub, reason = "every test is a crate of its own and uses its part")]

pub mod adversaries;
pub mod corpus;
pub mod disguise;
pub mod double_double;
pub mod exact;
pub mod face_judgement;
pub mod face_oracle;
pub mod judgement;
pub mod kinds;
pub mod known;
pub mod oracle;
pub mod outline;
pub mod points;
pub mod random;
pub mod real_faces;
pub mod shape;
pub mod strategies;
