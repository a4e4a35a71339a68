//! Tests of faces.

mod area;
mod corpus;
mod oddities;
