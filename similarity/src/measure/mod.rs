//! The measures, one file each. How they combine into distances of variants and worlds is one floor up in this crate.

pub(crate) mod color;
pub(crate) mod occupancy;
pub(crate) mod planar;
pub(crate) mod wasserstein;
