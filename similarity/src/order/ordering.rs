//! [`Ordering`]: items in an order, with its steps and statistics.

use serde::Serialize;

use crate::{DistanceMatrix, ranks};

/// Items in an order, with the distance of each step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ordering {
    /// The items, by their index in the matrix.
    pub indices: Vec<usize>,
    /// The distance from each item to the next: one fewer than items.
    pub steps: Vec<f64>,
    /// The sum of the steps.
    pub length: f64,
    /// How steadily the order leads away from its first item: Spearman's rank correlation, in -1..=1, between an item's position
    /// and its distance from the first, over all items but the first. `None` for fewer than three items, or if all distances
    /// are equal.
    pub anchor_correlation: Option<f64>,
}

impl Ordering {
    /// Measures the items in this order. Every index must be valid in the matrix.
    pub fn given(matrix: &DistanceMatrix, indices: Vec<usize>) -> Self {
        let steps: Vec<f64> = indices.windows(2).map(|pair| matrix.get(pair[0], pair[1])).collect();
        Self {
            // Not `sum`: its empty sum is −0.
            length: steps.iter().fold(0.0, |sum, step| sum + step),
            anchor_correlation: anchor_correlation(matrix, &indices),
            indices,
            steps,
        }
    }

    /// The largest step; 0 if there is none.
    pub fn largest_step(&self) -> f64 {
        self.steps.iter().copied().fold(0.0, f64::max)
    }

    /// The mean step; 0 if there is none.
    pub fn mean_step(&self) -> f64 {
        if self.steps.is_empty() {
            0.0
        } else {
            self.length / self.steps.len() as f64
        }
    }
}

fn anchor_correlation(matrix: &DistanceMatrix, indices: &[usize]) -> Option<f64> {
    let (first, others) = indices.split_first()?;
    let distances: Vec<f64> = others.iter().map(|item| matrix.get(*first, *item)).collect();
    let positions: Vec<f64> = (0..others.len()).map(|position| position as f64).collect();
    pearson(&positions, &ranks(&distances))
}

/// Correlation of two lists of equal length; `None` if a list is constant.
fn pearson(a: &[f64], b: &[f64]) -> Option<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        aa += x * x;
        bb += y * y;
        ab += x * y;
    }
    (aa > 0.0 && bb > 0.0).then(|| (ab / (aa * bb).sqrt()).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimilarityError;

    fn on_a_line(at: &[f64]) -> DistanceMatrix {
        let labels = (0..at.len()).map(|k| format!("{k:03}")).collect();
        DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs())).unwrap()
    }

    fn check_correlation(at: &[f64], expected: Option<f64>) {
        let found = Ordering::given(&on_a_line(at), (0..at.len()).collect()).anchor_correlation;
        match (found, expected) {
            (Some(found), Some(expected)) => assert!((found - expected).abs() < 1e-12, "{at:?}: {found}"),
            _ => assert_eq!(found, expected, "{at:?}"),
        }
    }

    #[test]
    fn steps_length_and_mean_describe_the_path() {
        let path = Ordering::given(&on_a_line(&[0.0, 4.0, 1.0]), vec![0, 1, 2]);
        assert_eq!((path.steps.as_slice(), path.length), ([4.0, 3.0].as_slice(), 7.0));
        assert_eq!((path.largest_step(), path.mean_step()), (4.0, 3.5));
        let alone = Ordering::given(&on_a_line(&[0.0]), vec![0]);
        assert_eq!((alone.largest_step(), alone.mean_step(), alone.length), (0.0, 0.0, 0.0));
    }

    #[test]
    fn anchor_correlation_is_spearmans() {
        check_correlation(&[0.0, 1.0, 2.0, 3.0], Some(1.0));
        check_correlation(&[0.0, 3.0, 2.0, 1.0], Some(-1.0));
        // scipy.stats.spearmanr([1, 2, 3, 4, 5], [2, 7, 2, 5, 9]) = 0.6155870112510925.
        check_correlation(&[0.0, 2.0, 7.0, 2.0, 5.0, 9.0], Some(0.615_587_011_251_092_5));
        check_correlation(&[0.0, 1.0], None);
        check_correlation(&[0.0, 1.0, -1.0, 1.0], None);
    }
}
