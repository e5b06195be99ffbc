//! The plain numbers of measures whose story is told in `wasserstein_1.rs`, `total_variation.rs` and `extent.rs`.

use driftworld_spec::Distribution;

/// The value of [`distribution::wasserstein_1`](super::wasserstein_1()).
pub fn wasserstein_1(a: &Distribution, b: &Distribution) -> Option<f64> {
    super::wasserstein_1(a, b).map(|found| found.value)
}

/// The value of [`distribution::total_variation`](super::total_variation()).
pub fn total_variation(a: &Distribution, b: &Distribution) -> Option<f64> {
    super::total_variation(a, b).map(|found| found.value)
}

pub(crate) use super::extent::extent as width;
