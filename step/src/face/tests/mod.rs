//! Tests of faces.

mod area;
mod corpus;
mod files;
mod oddities;
