//! [`Row`]: where one action may lead, and the cheapest way to turn that into where another may. What a step costs is handed in.

use crate::{SimilarityError, optimal_transport};

/// Successors of a state and an action, by rising number, with probabilities of sum 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<'a> {
    successors: &'a [u32],
    probabilities: &'a [f64],
}

impl<'a> Row<'a> {
    /// Of as many successors as probabilities, at least 1.
    pub(super) fn new(successors: &'a [u32], probabilities: &'a [f64]) -> Self {
        Self {
            successors,
            probabilities,
        }
    }

    pub(super) fn iter(self) -> impl Iterator<Item = (usize, f64)> + 'a {
        let probabilities = self.probabilities.iter().copied();
        self.successors
            .iter()
            .map(|successor| *successor as usize)
            .zip(probabilities)
    }

    /// The one successor, if there is but one.
    pub(super) fn certain(self) -> Option<usize> {
        match self.successors {
            [only] => Some(*only as usize),
            _ => None,
        }
    }

    /// The first successor, which is the only one where there is but one.
    pub(super) fn only(self) -> u32 {
        self.successors[0]
    }

    /// How many successors there are.
    pub(super) fn len(self) -> usize {
        self.successors.len()
    }

    /// Wasserstein-1 between where two actions lead, in the unit of `cost`, which is asked from a successor of the first to one of
    /// the second; at least 0.
    ///
    /// Exact within rounding: a look-up or a weighted sum where one of them is certain, at an end of an interval for two
    /// successors each, else by [`optimal_transport`].
    pub(super) fn wasserstein_1(
        self,
        other: Row<'_>,
        cost: impl Fn(usize, usize) -> f64,
    ) -> Result<f64, SimilarityError> {
        match (self.certain(), other.certain()) {
            (Some(from), Some(to)) => Ok(cost(from, to)),
            (Some(from), None) => Ok(other.iter().map(|(to, probability)| probability * cost(from, to)).sum()),
            (None, Some(to)) => Ok(self
                .iter()
                .map(|(from, probability)| probability * cost(from, to))
                .sum()),
            (None, None) if self.len() == 2 && other.len() == 2 => Ok(two_by_two(self, other, cost)),
            (None, None) => {
                let costs = self
                    .successors
                    .iter()
                    .flat_map(|from| other.successors.iter().map(|to| (*from, *to)));
                let costs: Vec<f64> = costs.map(|(from, to)| cost(from as usize, to as usize)).collect();
                Ok(optimal_transport(self.probabilities, other.probabilities, &costs)?
                    .cost
                    .max(0.0))
            }
        }
    }
}

/// What moves from the first to the first decides all; the cost is linear in it.
fn two_by_two(a: Row<'_>, b: Row<'_>, cost: impl Fn(usize, usize) -> f64) -> f64 {
    let (p, q) = (a.probabilities[0], b.probabilities[0]);
    let places = |row: Row<'_>| [row.successors[0] as usize, row.successors[1] as usize];
    let ([from, from_other], [to, to_other]) = (places(a), places(b));
    let straight = cost(from, to) + cost(from_other, to_other);
    let crossed = cost(from, to_other) + cost(from_other, to);
    let moved = if straight <= crossed {
        p.min(q)
    } else {
        (p - b.probabilities[1]).max(0.0)
    };
    moved * cost(from, to)
        + (p - moved) * cost(from, to_other)
        + (q - moved) * cost(from_other, to)
        + (a.probabilities[1] - (q - moved)).max(0.0) * cost(from_other, to_other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn short_cuts_cost_what_the_general_way_costs(
            p in 0.001..0.999,
            q in 0.001..0.999,
            costs in prop::array::uniform4(0_u8..5),
        ) {
            let costs = costs.map(f64::from);
            let (of_a, of_b) = ([p, 1.0 - p], [q, 1.0 - q]);
            let (a, b) = (Row::new(&[0, 1], &of_a), Row::new(&[0, 1], &of_b));
            let found = a.wasserstein_1(b, |from, to| costs[2 * from + to]).unwrap();
            let expected = optimal_transport(&of_a, &of_b, &costs).unwrap().cost;
            prop_assert!((found - expected).abs() < 1e-14, "{found}, {expected}");
            let one = Row::new(&[1], &[1.0]);
            let found = one.wasserstein_1(b, |from, to| costs[2 * from + to]).unwrap();
            prop_assert!((found - (q * costs[2] + (1.0 - q) * costs[3])).abs() < 1e-14);
            let back = b.wasserstein_1(one, |from, to| costs[2 * to + from]).unwrap();
            prop_assert_eq!(found, back);
        }
    }
}
