//! Compares all methods on one matrix.

use crate::similarity::{DistanceMatrix, Method, Ordering};
use serde_json::{Value, json};

use crate::table::table;

/// Each method with its order, or its error.
pub(super) struct Comparison {
    outcomes: Vec<(Method, Result<Ordering, String>)>,
}

impl Comparison {
    /// Target steps are compared only if a length is given.
    pub(super) fn new(has_target_step: bool, order: impl Fn(Method) -> Result<Ordering, String>) -> Self {
        let is_compared = |method: &Method| *method != Method::TargetStep || has_target_step;
        let methods = Method::ALL.iter().copied().filter(is_compared);
        Self {
            outcomes: methods.map(|method| (method, order(method))).collect(),
        }
    }

    /// A line for each method, followed by the reasons for missing numbers.
    pub(super) fn table(&self) -> String {
        let mut errors = String::new();
        let mut rows = Vec::new();
        for (method, outcome) in &self.outcomes {
            match outcome {
                Ok(found) => rows.push([
                    method.name().to_owned(),
                    format!("{:.4}", found.length),
                    format!("{:.4}", found.largest_step()),
                    format!("{:.4}", found.mean_step()),
                    found
                        .anchor_correlation
                        .map_or_else(|| "-".to_owned(), |rho| format!("{rho:.2}")),
                ]),
                Err(error) => {
                    rows.push([method.name(), "-", "-", "-", "-"].map(str::to_owned));
                    errors = format!("{errors}\n{error}");
                }
            }
        }
        let headings = [
            "method",
            "length",
            "largest step",
            "mean step",
            "correlation with the first",
        ];
        let table = table(headings, rows, &[1, 2, 3, 4]);
        if errors.is_empty() {
            table
        } else {
            format!("{table}\n{errors}")
        }
    }

    pub(super) fn json(&self, matrix: &DistanceMatrix, seed: u64) -> Value {
        let one = |(method, outcome): &(Method, Result<Ordering, String>)| match outcome {
            Ok(found) => super::json_of(matrix, *method, found, seed),
            Err(error) => json!({"method": method, "error": error}),
        };
        self.outcomes.iter().map(one).collect()
    }
}
