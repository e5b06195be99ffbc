//! Distances between distributions: of numbers, words and points. How those of many parameters combine is in `combined/`.

pub(crate) mod planar;
pub(crate) mod wasserstein;
