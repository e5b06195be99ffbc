//! Spectral seriation: items along the one axis on which similar ones lie closest together. Axes for pictures are in `mds.rs`.

use rayon::prelude::*;

use super::items::{Items, by_rising};
use crate::SimilarityError;
use crate::matrix::eigen;

/// Sorts by the Fiedler vector: the second-lowest eigenvector of the Laplacian of the similarities `largest - distance`.
/// Time `O(n²)` for each of some dozens of steps.
///
/// Where some order exists from whose diagonal the distances only grow, this finds it (Atkins, Boman and Hendrickson 1998).
pub(super) fn order(items: &Items) -> Result<Vec<usize>, SimilarityError> {
    items.refuse_ends("spectral")?;
    let (n, largest) = (items.len(), items.largest_gap());
    if n < 3 || largest == 0.0 {
        return Ok((0..n).collect());
    }
    let similarity = |a: usize, b: usize| if a == b { 0.0 } else { 1.0 - items.gap(a, b) / largest };
    let degrees: Vec<f64> = (0..n)
        .into_par_iter()
        .map(|a| (0..n).map(|b| similarity(a, b)).sum())
        .collect();
    // The lowest of the Laplacian are the highest of this, which is never negative.
    let shift = 2.0 * degrees.iter().copied().fold(0.0, f64::max);
    let multiply = |x: &[f64], y: &mut [f64]| {
        y.par_iter_mut().enumerate().for_each(|(a, y)| {
            let pull: f64 = (0..n).map(|b| similarity(a, b) * x[b]).sum();
            *y = (shift - degrees[a]) * x[a] + pull;
        });
    };
    // The lowest of all is the same everywhere, and says nothing.
    let constant = vec![1.0 / (n as f64).sqrt(); n];
    let Some((_, mut axis)) = eigen::largest(n, &multiply, &[constant]) else {
        return Ok((0..n).collect());
    };
    let ranks = by_rising(&axis);
    if ranks[0] < ranks[n - 1] {
        return Ok(ranks);
    }
    // The vector may as well point the other way: let the order begin with the name that comes first.
    axis.iter_mut().for_each(|value| *value = -*value);
    Ok(by_rising(&axis))
}
