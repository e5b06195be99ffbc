//! Distributions of discrete values of any type: words, colours, booleans, points.

use std::cmp::Ordering;

use driftworld_spec::{Distribution, Value};

/// Maximum number of values to enumerate.
const MAX_VALUES: f64 = 100_000.0;

/// Probability of entry `k` of `count`, by weight if there are weights.
pub(super) fn share(k: usize, count: usize, weights: Option<&[f64]>) -> f64 {
    weights.map_or(1.0 / count as f64, |weights| weights[k] / weights.iter().sum::<f64>())
}

/// Every possible value with its probability, each once, in a fixed order; `None` for distributions with a density.
///
/// For points taken in turn: the points of one round.
pub(super) fn probabilities(distribution: &Distribution) -> Option<Vec<(Value, f64)>> {
    let mut found = Vec::new();
    add(&mut found, 1.0, distribution)?;
    found.sort_by(|a, b| compare(&a.0, &b.0));
    found.dedup_by(|next, kept| {
        let same = compare(&next.0, &kept.0).is_eq();
        if same {
            kept.1 += next.1;
        }
        same
    });
    found.retain(|(_, mass)| *mass > 0.0);
    Some(found)
}

fn add(found: &mut Vec<(Value, f64)>, scale: f64, distribution: &Distribution) -> Option<()> {
    let nested = |value: &Value| matches!(value, Value::Distribution(_));
    match distribution {
        Distribution::Constant { value } if nested(value) => return None,
        Distribution::Choice { values, .. } if values.iter().any(nested) => return None,
        Distribution::Constant { value } => found.push((value.clone(), scale)),
        Distribution::Choice { values, weights } => {
            let total: f64 = weights
                .as_ref()
                .map_or(values.len() as f64, |weights| weights.iter().sum());
            let weight = |k: usize| weights.as_ref().map_or(1.0, |weights| weights[k]);
            let each = values.iter().enumerate();
            found.extend(each.map(|(k, value)| (value.clone(), scale * weight(k) / total)));
        }
        Distribution::Bernoulli { p } => {
            found.extend([
                (Value::Boolean(false), scale * (1.0 - p)),
                (Value::Boolean(true), scale * p),
            ]);
        }
        Distribution::Points { values, .. } => {
            let each = scale / values.len() as f64;
            found.extend(values.iter().map(|point| (Value::Point(*point), each)));
        }
        Distribution::Grid {
            low,
            high,
            columns,
            rows,
            jitter,
            ..
        } if jitter.unwrap_or(0.0) == 0.0 && columns * rows <= MAX_VALUES => {
            let each = scale / (columns * rows);
            let centres = grid_centres(*low, *high, [*columns, *rows]);
            found.extend(centres.map(|point| (Value::Point(point), each)));
        }
        Distribution::Mixture { parts, weights } => {
            for (k, part) in parts.iter().enumerate() {
                add(found, scale * share(k, parts.len(), weights.as_deref()), part)?;
            }
        }
        _ => return None,
    }
    Some(())
}

/// The centres of the cells of a grid, row by row from the south-west.
pub(super) fn grid_centres(low: [f64; 2], high: [f64; 2], cells: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let along =
        move |axis: usize, cell: u32| low[axis] + (high[axis] - low[axis]) * (f64::from(cell) + 0.5) / cells[axis];
    let [columns, rows] = cells.map(|count| count as u32);
    (0..rows).flat_map(move |row| (0..columns).map(move |column| [along(0, column), along(1, row)]))
}

/// Pairs the probabilities of equal values, with 0 for values that are in one list only; both lists are sorted.
pub(super) fn aligned(a: &[(Value, f64)], b: &[(Value, f64)]) -> Vec<[f64; 2]> {
    let (mut i, mut j) = (0, 0);
    let mut pairs = Vec::with_capacity(a.len().max(b.len()));
    while i < a.len() || j < b.len() {
        let order = match (a.get(i), b.get(j)) {
            (Some(a), Some(b)) => compare(&a.0, &b.0),
            (Some(_), None) => Ordering::Less,
            _ => Ordering::Greater,
        };
        let p = if order.is_le() { a[i].1 } else { 0.0 };
        let q = if order.is_ge() { b[j].1 } else { 0.0 };
        i += usize::from(order.is_le());
        j += usize::from(order.is_ge());
        pairs.push([p, q]);
    }
    pairs
}

/// A total order of values: by type, then by content. Integers and real numbers are one type.
fn compare(a: &Value, b: &Value) -> Ordering {
    let numbers = |a: &[f64], b: &[f64]| {
        let each = a.iter().zip(b).map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)));
        each.fold(a.len().cmp(&b.len()), Ordering::then)
    };
    let rank = |value: &Value| match value {
        Value::Boolean(_) => 0,
        Value::Integer(_) | Value::Number(_) => 1,
        Value::Text(_) => 2,
        Value::Point(_) => 3,
        Value::Color(_) => 4,
        Value::Vector(_) | Value::Distribution(_) => 5,
        Value::Layout(_) | Value::Json(_) => 6,
    };
    match (a, b) {
        (Value::Boolean(a), Value::Boolean(b)) => a.cmp(b),
        (Value::Text(a), Value::Text(b)) => a.cmp(b),
        (Value::Json(a), Value::Json(b)) => a.to_string().cmp(&b.to_string()),
        _ => match (a.as_number(), b.as_number()) {
            (Some(a), Some(b)) => (a + 0.0).total_cmp(&(b + 0.0)),
            _ => rank(a).cmp(&rank(b)).then_with(|| {
                let (a, b) = (a.as_vector().unwrap_or_default(), b.as_vector().unwrap_or_default());
                numbers(a, b)
            }),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn probabilities_of_equal_words_are_paired_in_any_order() {
        let words = |words: &[&str], weights: &[f64]| Distribution::Choice {
            values: words.iter().map(|word| Value::Text((*word).into())).collect(),
            weights: Some(weights.to_vec()),
        };
        let a = probabilities(&words(&["b", "a"], &[1.0, 3.0])).unwrap();
        let b = probabilities(&words(&["c", "b", "b"], &[2.0, 1.0, 1.0])).unwrap();
        assert_eq!(aligned(&a, &b), [[0.75, 0.0], [0.25, 0.5], [0.0, 0.5]]);
    }

    #[test]
    fn bernoulli_is_a_choice_of_booleans() {
        let choice = Distribution::Choice {
            values: vec![Value::Boolean(true), Value::Boolean(false)],
            weights: Some(vec![1.0, 3.0]),
        };
        assert_eq!(
            probabilities(&choice),
            probabilities(&Distribution::Bernoulli { p: 0.25 })
        );
    }
}
