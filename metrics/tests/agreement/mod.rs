//! Compares values with those of the reference.

use serde_json::{Number, Value};

/// The reference adds in another order; its values for lifetimes have ten decimals.
const TOLERANCE: f64 = 1e-9;

/// Compares numbers within the tolerance, lists entry by entry; returns the number of numbers.
pub(crate) fn compare(place: &str, found: &Value, expected: &Value) -> usize {
    match (found, expected) {
        (Value::Number(found), Value::Number(expected)) => {
            let number = |number: &Number| number.as_f64().expect("every number of a file is an f64");
            let (found, expected) = (number(found), number(expected));
            // Differences of numbers around 100 lose precision by cancellation.
            let near = (found - expected).abs() <= TOLERANCE * expected.abs().max(1.0);
            assert!(near, "{place}: found {found}, the reference has {expected}");
            1
        }
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{place}: {found:?}, {expected:?}");
            let pairs = found.iter().zip(expected).enumerate();
            pairs
                .map(|(index, (found, expected))| compare(&format!("{place}/{index}"), found, expected))
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
                    compare(&format!("{place}/{name}"), found, expected)
                })
                .sum()
        }
        (found, expected) => {
            assert_eq!(found, expected, "{place}");
            0
        }
    }
}
