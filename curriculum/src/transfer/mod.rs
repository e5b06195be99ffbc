//! [`transfer_report`]: tests whether similar variants transfer more, using the metrics of lifetimes and a distance matrix.

mod names;
mod pooling;

use std::collections::BTreeSet;

use driftworld_metrics::{LifetimeMetrics, TransferMethod};
use driftworld_similarity::{Correlation, DistanceMatrix, MantelTest, PairValue, mantel};
use driftworld_text::first_of;
use serde::Serialize;

use crate::CurriculumError;
use names::Names;
pub use names::log_name_of_label;
use pooling::pool;

/// Options for comparing transfer with distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferOptions {
    /// The measure of transfer; the lifetimes must have been scored with it. `Both` counts as `Contrast`.
    pub measure: TransferMethod,
    /// Maximum number of relabellings in the test, 1 to [`MAX_RELABELLINGS`](driftworld_similarity::MAX_RELABELLINGS).
    pub relabellings: u64,
    /// Seed for drawing relabellings at random, if more are possible.
    pub seed: u64,
}

impl Default for TransferOptions {
    /// Contrast, 9,999 relabellings, seed 0.
    fn default() -> Self {
        Self {
            measure: TransferMethod::Contrast,
            relabellings: 9_999,
            seed: 0,
        }
    }
}

/// The result of comparing transfer with distance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TransferReport {
    /// Number of lifetimes pooled.
    pub lifetimes: usize,
    /// Number of different orders in which they learned the matrix's variants.
    pub learning_orders: usize,
    /// The measure of transfer.
    pub measure: TransferMethod,
    /// Variants of the matrix that no log has.
    pub not_in_logs: Vec<String>,
    /// Names in the logs that the matrix does not have.
    pub not_in_matrix: Vec<String>,
    /// Transfer to variants that had not been learned yet.
    pub forward: DirectionReport,
    /// Transfer to variants that had been learned before.
    pub backward: DirectionReport,
}

/// The result for forward or for backward transfer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DirectionReport {
    /// Every pair with a transfer, in the matrix's order: by the learned variant, then by the evaluated one.
    pub pairs: Vec<PairTransfer>,
    /// The test on ranks, which is recommended.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spearman: Option<MantelTest>,
    /// The test on values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pearson: Option<MantelTest>,
    /// Why there is no test.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub untested: Option<String>,
}

/// A variant that was learned, another that was evaluated before and after, and the transfer between them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PairTransfer {
    /// The variant that was learned.
    pub from: String,
    /// The variant that was evaluated.
    pub to: String,
    /// Their distance.
    pub distance: f64,
    /// Mean over lifetimes of the pair's first transfer in each.
    pub transfer: f64,
    /// Number of lifetimes in which it was measured.
    pub lifetimes: usize,
}

/// Correlates the transfer measured in lifetimes with distances.
///
/// For each pair of variants the first transfer of each lifetime counts, as in the lifetime's own mean, averaged over
/// lifetimes; forward and backward separately. Names in logs, `task_variant`, are matched with the matrix's `task#variant` by
/// [`log_name`](crate::log_name)'s rule. Correlations are tested by relabelling the variants, see [`mantel`].
///
/// Limits: if all lifetimes learn in the same order, distance is confounded with position in that order, which `learning_orders`
/// shows; a variant that is already at its best has nothing left to gain.
///
/// # Errors
/// [`CurriculumError::NoEvaluations`] if no lifetime evaluates, [`CurriculumError::NoCommonNames`] if logs and matrix have too
/// few common variants, [`CurriculumError::TooFewTransfers`] if neither direction has 3 pairs, [`CurriculumError::SameLogName`]
/// if two labels have the same log name, [`CurriculumError::Relabelling`] for an invalid number of relabellings.
pub fn transfer_report(
    lifetimes: &[LifetimeMetrics],
    distances: &DistanceMatrix,
    options: &TransferOptions,
) -> Result<TransferReport, CurriculumError> {
    if lifetimes.iter().all(|lifetime| lifetime.num_ex == 0) {
        return Err(CurriculumError::NoEvaluations(lifetimes.len()));
    }
    let names = Names::of(distances.labels())?;
    let logged: BTreeSet<&str> = lifetimes
        .iter()
        .flat_map(|lifetime| lifetime.task_metrics.keys().map(String::as_str))
        .collect();
    let known: BTreeSet<usize> = logged.iter().filter_map(|name| names.index(name)).collect();
    if known.len() < 2 {
        return Err(CurriculumError::NoCommonNames {
            found: known.len(),
            logs: shown(&Vec::from_iter(logged)),
            matrix: shown(&distances.labels().iter().map(String::as_str).collect::<Vec<_>>()),
        });
    }
    let direction = |direction| {
        let pairs = pool(lifetimes, &names, direction, options.measure);
        test_direction(pairs, distances, options)
    };
    let (forward, backward) = (direction("forward")?, direction("backward")?);
    let max_pairs = forward.pairs.len().max(backward.pairs.len());
    if max_pairs < driftworld_similarity::MIN_CORRELATED {
        return Err(CurriculumError::TooFewTransfers {
            forward: forward.pairs.len(),
            backward: backward.pairs.len(),
        });
    }
    let labels = distances.labels().iter().enumerate();
    Ok(TransferReport {
        lifetimes: lifetimes.len(),
        learning_orders: learning_orders(lifetimes, &names),
        measure: options.measure,
        not_in_logs: labels
            .filter(|(index, _)| !known.contains(index))
            .map(|(_, label)| label.clone())
            .collect(),
        not_in_matrix: logged
            .into_iter()
            .filter(|name| names.index(name).is_none())
            .map(str::to_owned)
            .collect(),
        forward,
        backward,
    })
}

fn test_direction(
    values: Vec<(PairValue, usize)>,
    distances: &DistanceMatrix,
    options: &TransferOptions,
) -> Result<DirectionReport, CurriculumError> {
    let label = |index: usize| distances.labels()[index].clone();
    let pairs = values.iter().map(|(pair, lifetimes)| PairTransfer {
        from: label(pair.from),
        to: label(pair.to),
        distance: distances.get(pair.from, pair.to),
        transfer: pair.value,
        lifetimes: *lifetimes,
    });
    let pairs: Vec<PairTransfer> = pairs.collect();
    let values: Vec<PairValue> = values.into_iter().map(|(pair, _)| pair).collect();
    let test = |method| mantel(distances, &values, method, options.relabellings, options.seed);
    let (spearman, pearson, untested) = match (test(Correlation::Spearman), test(Correlation::Pearson)) {
        (Ok(spearman), Ok(pearson)) => (Some(spearman), Some(pearson), None),
        // The number of relabellings is invalid for any measurement.
        (Err(source), _) if source.code() == "similarity/mantel-count" => {
            return Err(CurriculumError::Relabelling(source));
        }
        (Err(reason), _) | (_, Err(reason)) => (None, None, Some(reason.to_string())),
    };
    Ok(DirectionReport {
        pairs,
        spearman,
        pearson,
        untested,
    })
}

/// Number of different orders in which a matrix's variants were first learned.
fn learning_orders(lifetimes: &[LifetimeMetrics], names: &Names) -> usize {
    let order = |lifetime: &LifetimeMetrics| -> Vec<usize> {
        let learned = lifetime
            .task_metrics
            .iter()
            .filter(|(_, task)| task.number("num_lx").is_some_and(|num| num > 0.0));
        learned.filter_map(|(name, _)| names.index(name)).collect()
    };
    lifetimes.iter().map(order).collect::<BTreeSet<_>>().len()
}

/// A few names for a message.
fn shown(names: &[&str]) -> String {
    const MAX_SHOWN: usize = 4;
    if names.is_empty() {
        "none".to_owned()
    } else {
        first_of(names, MAX_SHOWN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// A lifetime that learned the tasks in this order, with these forward transfers.
    fn lifetime(order: &[&str], forward: &[(&str, &str, f64)], evaluations: usize) -> LifetimeMetrics {
        let mut tasks = serde_json::Map::new();
        for name in order {
            let mut to = serde_json::Map::new();
            for (_, other, value) in forward.iter().filter(|(from, _, _)| from == name) {
                to.insert((*other).to_owned(), json!([value, 99.0]));
            }
            let task = json!({ "num_lx": 5, "num_ex": evaluations, "forward_transfer_contrast": to });
            tasks.insert((*name).to_owned(), task);
        }
        serde_json::from_value(json!({
            "run_id": "run", "complexity": "", "difficulty": "", "scenario_type": "", "metrics_column": "reward",
            "min": 1.0, "max": 101.0, "num_lx": 10, "num_ex": evaluations, "runtime": 0.0,
            "normalization_data_range": null, "task_metrics": tasks,
        }))
        .expect("the fields of a lifetime are complete")
    }

    fn matrix(labels: &[&str]) -> DistanceMatrix {
        let labels = labels.iter().map(|label| (*label).to_owned()).collect();
        DistanceMatrix::measure(labels, |a, b| {
            Ok::<_, driftworld_similarity::SimilarityError>((b - a) as f64)
        })
        .expect("the distances are valid")
    }

    fn message(lifetimes: &[LifetimeMetrics], labels: &[&str]) -> String {
        let found = transfer_report(lifetimes, &matrix(labels), &TransferOptions::default());
        found.expect_err("there is nothing to correlate").to_string()
    }

    #[test]
    fn lifetimes_are_pooled_pair_by_pair() {
        let one = lifetime(&["t_a", "t_b", "t_c"], &[("t_a", "t_b", 0.4), ("t_a", "t_c", 0.1)], 9);
        let two = lifetime(&["t_b", "t_a", "t_x"], &[("t_b", "t_c", 0.2), ("t_a", "t_b", 0.2)], 9);
        let found = transfer_report(
            &[one.clone(), two, one],
            &matrix(&["t#a", "t#b", "t#c", "t#d"]),
            &TransferOptions::default(),
        )
        .expect("three pairs are enough");
        let pairs: Vec<_> = found
            .forward
            .pairs
            .iter()
            .map(|pair| (pair.from.as_str(), pair.to.as_str(), pair.distance, pair.lifetimes))
            .collect();
        assert_eq!(
            pairs,
            [("t#a", "t#b", 1.0, 3), ("t#a", "t#c", 2.0, 2), ("t#b", "t#c", 1.0, 1)]
        );
        assert!((found.forward.pairs[0].transfer - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!((found.lifetimes, found.learning_orders), (3, 2));
        assert_eq!(found.not_in_logs, ["t#d"]);
        assert_eq!(found.not_in_matrix, ["t_x"]);
        let test = found.forward.spearman.expect("three pairs with different numbers");
        assert_eq!((test.pairs, test.items, test.exact), (3, 3, true));
        assert!(found.backward.untested.is_some_and(|why| why.contains("found 0 pairs")));
    }

    #[test]
    fn impossible_correlations_are_refused_with_a_reason() {
        let none = lifetime(&["t_a"], &[], 0);
        assert!(message(&[none], &["t#a", "t#b"]).contains("no evaluation"));
        let strangers = lifetime(&["t_x", "t_y"], &[], 3);
        let error = message(&[strangers], &["t#a", "t#b"]);
        assert!(error.contains("t_x, t_y") && error.contains("t#a, t#b"), "{error}");
        let few = lifetime(&["t_a", "t_b"], &[("t_a", "t_b", 0.5)], 3);
        assert!(message(&[few], &["t#a", "t#b"]).contains("1 forward and 0 backward"));
        let one = lifetime(&["t_a", "t_b", "t_c"], &[("t_a", "t_b", 0.4)], 9);
        let options = TransferOptions {
            relabellings: 0,
            ..TransferOptions::default()
        };
        let error = transfer_report(&[one], &matrix(&["t#a", "t#b"]), &options).expect_err("0 relabellings");
        assert_eq!(error.code(), "curriculum/relabelling");
    }
}
