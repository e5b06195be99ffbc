//! Compares values with those of the reference.

use driftworld_metrics::LifetimeMetrics;
use serde_json::{Number, Value};

/// The reference sums in a different order; its values for lifetimes have ten decimals.
const TOLERANCE: f64 = 1e-9;

/// Compares numbers within the tolerance, and lists and objects entry by entry; returns how many numbers were compared.
pub(crate) fn compare(place: &str, found: &Value, expected: &Value) -> usize {
    // Differences of numbers around 100 lose precision by cancellation.
    compare_above(1.0, place, found, expected)
}

/// Like [`compare`], with a tolerance relative to each number or to `min_scale`, whichever is larger.
pub(crate) fn compare_above(min_scale: f64, place: &str, found: &Value, expected: &Value) -> usize {
    let compare = |place: String, found: &Value, expected: &Value| compare_above(min_scale, &place, found, expected);
    match (found, expected) {
        (Value::Number(found), Value::Number(expected)) => {
            let number = |number: &Number| number.as_f64().expect("every number of a file is an f64");
            let (found, expected) = (number(found), number(expected));
            let is_near = (found - expected).abs() <= TOLERANCE * expected.abs().max(min_scale);
            assert!(is_near, "{place}: found {found}, the reference has {expected}");
            1
        }
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{place}: {found:?}, {expected:?}");
            let pairs = found.iter().zip(expected).enumerate();
            pairs
                .map(|(index, (found, expected))| compare(format!("{place}/{index}"), found, expected))
                .sum()
        }
        (Value::Object(found), Value::Object(expected)) => {
            let names = found
                .keys()
                .filter(|name| !expected.contains_key(*name))
                .collect::<Vec<_>>();
            assert!(names.is_empty(), "{place}: the reference has no {names:?}");
            let entries = expected.iter();
            entries
                .map(|(name, expected)| {
                    let found = found.get(name).unwrap_or(&Value::Null);
                    compare(format!("{place}/{name}"), found, expected)
                })
                .sum()
        }
        (found, expected) => {
            assert_eq!(found, expected, "{place}");
            0
        }
    }
}

/// Compares a lifetime's table of regimes; returns how many numbers were compared.
pub(crate) fn compare_regimes(place: &str, found: &LifetimeMetrics, expected: &Value) -> usize {
    let expected = expected.as_array().expect("the table is a list");
    assert_eq!(found.regimes.len(), expected.len(), "{place}: regimes");
    let rows = found.regimes.iter().zip(expected).map(|(regime, expected)| {
        let value = |name: &str| serde_json::to_value(regime.values.get(name)).expect("values serialise");
        let row = Value::Array(vec![
            regime.regime_num.into(),
            regime.block_num.into(),
            regime.task_name.clone().into(),
            value("saturation"),
            value("exp_to_sat"),
            value("term_perf"),
            value("exp_to_term_perf"),
            value("avg_perf"),
        ]);
        compare(&format!("{place}, regime {}", regime.regime_num), &row, expected)
    });
    rows.sum()
}
