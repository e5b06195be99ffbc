//! Distance between two Dirichlet distributions.

use driftworld_spec::Distribution;

use super::measured::Measured;
use super::wasserstein_1::wasserstein_1;

/// How much of the whole moves between the shares that two Dirichlet distributions draw: half the sum, over the shares, of
/// Wasserstein-1 between their marginals, which are beta distributions.
///
/// A metric in `0..=1`: 0 only if all shapes are equal. No unit. By quadrature. `None` unless both draw the same number of
/// shares.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::shares_wasserstein_1;
/// use driftworld_spec::Distribution::Dirichlet;
/// let shares = |shape: f64| Dirichlet { alpha: vec![shape; 2] };
/// // Nearly always all to one, against nearly always half to each.
/// let found = shares_wasserstein_1(&shares(0.01), &shares(1e4)).unwrap().value;
/// assert!((found - 0.5).abs() < 0.02);
/// ```
pub fn shares_wasserstein_1(a: &Distribution, b: &Distribution) -> Option<Measured> {
    let (Distribution::Dirichlet { alpha: of_a }, Distribution::Dirichlet { alpha: of_b }) = (a, b) else {
        return None;
    };
    if of_a.len() != of_b.len() {
        return None;
    }
    if of_a == of_b {
        return Some(Measured::closed(0.0));
    }
    let share = |alpha: &[f64], index: usize| Distribution::Beta {
        alpha: alpha[index],
        beta: alpha.iter().sum::<f64>() - alpha[index],
        low: None,
        high: None,
    };
    let (mut sum, mut error) = (0.0, 0.0);
    for index in 0..of_a.len() {
        let found = wasserstein_1(&share(of_a, index), &share(of_b, index))?;
        sum += found.value;
        error += found.tolerance();
    }
    Some(Measured::quadrature(sum / 2.0, error / 2.0))
}
