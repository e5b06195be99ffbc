//! Distances between distributions: of numbers, words and points. How those of many parameters combine is in `combined/`.

pub mod planar;
pub mod wasserstein;
