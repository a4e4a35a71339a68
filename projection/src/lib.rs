//! Certified nearest points.
