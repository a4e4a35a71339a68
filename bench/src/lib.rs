//! Benchmarks of perpend: questions that an application would ask, with the worst error seen beside every time.
