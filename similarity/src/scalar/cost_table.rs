//! [`CostTable`]: distances between named choices, given by the task's author.

use std::collections::BTreeMap;

use crate::{MetricProperties, SimilarityError};

/// Maximum number of choices in a table.
pub const MAX_CHOICES: usize = 1000;

/// A checked table of distances between choices: costs are finite and at least 0, 0 on the diagonal, and symmetric.
///
/// [`CostTable::properties`] says whether it is a metric: whether different choices are more than 0 apart and the triangle
/// inequality holds. In `0..=`[`CostTable::largest`], in the author's unit. Construction takes `O(n³)` for n choices, a look-up
/// two searches by name.
///
/// # Example
/// ```
/// use driftworld_similarity::{MetricProperties, scalar::CostTable};
/// let names = ["walk", "run", "fly"].map(str::to_owned).to_vec();
/// let table = CostTable::new(names, &[0.0, 1.0, 5.0, 1.0, 0.0, 4.0, 5.0, 4.0, 0.0])?;
/// assert_eq!(table.between("fly", "run")?, 4.0);
/// assert_eq!(table.properties(), MetricProperties::Metric);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CostTable {
    choices: BTreeMap<String, usize>,
    costs: Vec<f64>,
    properties: MetricProperties,
}

impl CostTable {
    /// Builds the table from the names of the choices and the costs, `(choices, choices)`, row after row in the order of the
    /// names.
    ///
    /// # Errors
    /// [`SimilarityError::TooMany`] above [`MAX_CHOICES`]; [`SimilarityError::Shape`] unless the costs fill the table;
    /// [`SimilarityError::TwiceNamed`] for a repeated name; [`SimilarityError::BadTable`] for a cost that is negative or not
    /// finite, not 0 on the diagonal, or not symmetric.
    pub fn new(names: Vec<String>, costs: &[f64]) -> Result<Self, SimilarityError> {
        let count = names.len();
        SimilarityError::check_count(count, MAX_CHOICES)?;
        SimilarityError::check_length("cost table", costs.len(), count * count)?;
        check(&names, costs)?;
        let properties = properties(count, costs);
        let mut choices = BTreeMap::new();
        for (index, name) in names.into_iter().enumerate() {
            if choices.contains_key(&name) {
                return Err(SimilarityError::TwiceNamed { name });
            }
            choices.insert(name, index);
        }
        Ok(Self {
            choices,
            costs: costs.to_vec(),
            properties,
        })
    }

    /// The cost between two choices.
    ///
    /// # Errors
    /// [`SimilarityError::UnknownChoice`] for a choice that is not in the table.
    pub fn between(&self, a: &str, b: &str) -> Result<f64, SimilarityError> {
        Ok(self.costs[self.index(a)? * self.choices.len() + self.index(b)?])
    }

    /// The largest cost, for normalising to `0..=1`. 0 for a table of one choice.
    pub fn largest(&self) -> f64 {
        self.costs.iter().copied().fold(0.0, f64::max)
    }

    /// The metric properties of the table.
    pub fn properties(&self) -> MetricProperties {
        self.properties
    }

    fn index(&self, name: &str) -> Result<usize, SimilarityError> {
        self.choices
            .get(name)
            .copied()
            .ok_or_else(|| SimilarityError::UnknownChoice {
                found: name.to_owned(),
                expected: self.choices.keys().cloned().collect::<Vec<_>>().join(", "),
            })
    }
}

fn check(names: &[String], costs: &[f64]) -> Result<(), SimilarityError> {
    let count = names.len();
    for (index, &found) in costs.iter().enumerate() {
        let (row, column) = (index / count, index % count);
        let back = costs[column * count + row];
        let expected = if !found.is_finite() || found < 0.0 {
            "a finite number of at least 0".to_owned()
        } else if row == column && found != 0.0 {
            "0, the cost of a choice to itself".to_owned()
        } else if back.is_finite() && found != back {
            format!("{back}, the cost in the other direction")
        } else {
            continue;
        };
        return Err(SimilarityError::BadTable {
            a: names[row].clone(),
            b: names[column].clone(),
            found,
            expected,
        });
    }
    Ok(())
}

fn properties(count: usize, costs: &[f64]) -> MetricProperties {
    let cost = |a: usize, b: usize| costs[a * count + b];
    let is_metric = (0..count).all(|a| {
        (0..count).filter(|&b| b != a).all(|b| {
            // Sums of decimal fractions carry rounding errors.
            let straight = cost(a, b) * (1.0 - 1e-12);
            straight > 0.0 && (0..count).all(|via| straight <= cost(a, via) + cost(via, b))
        })
    });
    if is_metric {
        MetricProperties::Metric
    } else {
        MetricProperties::Distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table(costs: &[f64]) -> Result<CostTable, SimilarityError> {
        CostTable::new(["a", "b", "c"].map(str::to_owned).to_vec(), costs)
    }

    #[track_caller]
    fn check(costs: &[f64], code: &str) {
        assert_eq!(table(costs).unwrap_err().code(), code, "{costs:?}");
    }

    #[test]
    fn invalid_tables_are_refused() {
        check(&[0.0, 1.0, 1.0, 0.0], "similarity/shape");
        check(&[0.0, 1.0, 2.0, 1.5, 0.0, 1.0, 2.0, 1.0, 0.0], "similarity/bad-table");
        check(&[0.5, 1.0, 2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0], "similarity/bad-table");
        check(&[0.0, -1.0, 2.0, -1.0, 0.0, 1.0, 2.0, 1.0, 0.0], "similarity/bad-table");
        check(
            &[0.0, f64::NAN, 2.0, 1.0, 0.0, 1.0, 2.0, 1.0, 0.0],
            "similarity/bad-table",
        );
        let error = CostTable::new(vec!["a".into(), "a".into()], &[0.0; 4]).unwrap_err();
        assert_eq!(error.code(), "similarity/twice-named");
        let names = (0..=MAX_CHOICES).map(|k| k.to_string()).collect();
        assert_eq!(CostTable::new(names, &[]).unwrap_err().code(), "similarity/too-many");
    }

    #[test]
    fn unknown_choice_is_named() {
        let error = table(&[0.0; 9]).unwrap().between("a", "d").unwrap_err();
        assert_eq!(
            error.to_string(),
            "choice: found \"d\", expected one of a, b, c; add it to the cost table"
        );
    }

    #[test]
    fn violated_triangle_makes_it_a_distance() {
        let properties = |ac: f64| {
            table(&[0.0, 0.1, ac, 0.1, 0.0, 0.2, ac, 0.2, 0.0])
                .unwrap()
                .properties()
        };
        assert_eq!(properties(0.3), MetricProperties::Metric);
        assert_eq!(properties(0.31), MetricProperties::Distance);
        assert_eq!(
            properties(0.0),
            MetricProperties::Distance,
            "two choices that are 0 apart"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn table_declared_a_metric_is_one(costs in prop::array::uniform3(0.0..2.0)) {
            let [ab, ac, bc] = costs;
            let table = table(&[0.0, ab, ac, ab, 0.0, bc, ac, bc, 0.0]).unwrap();
            let triangles = ab <= ac + bc && ac <= ab + bc && bc <= ab + ac;
            let are_distinct = costs.iter().all(|&cost| cost > 0.0);
            prop_assert_eq!(table.properties().is_metric(), triangles && are_distinct);
            for (a, b, expected) in [("a", "b", ab), ("c", "a", ac), ("b", "c", bc), ("b", "b", 0.0)] {
                prop_assert_eq!(table.between(a, b).unwrap(), expected);
                prop_assert_eq!(table.between(b, a).unwrap(), expected);
            }
            prop_assert_eq!(table.largest(), ab.max(ac).max(bc));
        }
    }
}
