//! A knowledge-guided geometry kernel.
