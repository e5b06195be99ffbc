//! [`StateDistances`]: how far all states of two decision processes are from each other, and what that makes of the processes.
//! Where the numbers come from is known elsewhere.

use super::check_equal;
use crate::shares::shares;
use crate::{Assignment, SimilarityError, optimal_transport};

/// Distances between the states of two decision processes.
#[derive(Clone, Debug, PartialEq)]
pub struct StateDistances {
    of_a: usize,
    of_b: usize,
    values: Vec<f64>,
    error: f64,
}

/// Which states of two processes go together best, and how far they are apart then.
#[derive(Clone, Debug, PartialEq)]
pub struct BestMatch {
    /// For each state of the first process its partner in the second.
    pub partners: Vec<usize>,
    /// The mean distance of partners, in the unit of the rewards: the least that any pairing has.
    pub mean: f64,
    /// The largest distance of partners, in the unit of the rewards; where several pairings have the least mean, the least of
    /// theirs.
    pub largest: f64,
}

impl StateDistances {
    /// `values`: `(of_a, of_b)`, at least 0; both counts at least 1.
    pub(super) fn new(of_a: usize, of_b: usize, values: Vec<f64>, error: f64) -> Self {
        Self {
            of_a,
            of_b,
            values,
            error,
        }
    }

    /// From a state of the first process to one of the second, in the unit of the rewards. Panics where there is no such state.
    pub fn between(&self, of_a: usize, of_b: usize) -> f64 {
        assert!(of_b < self.of_b, "a state that the second process does not have");
        self.values[of_a * self.of_b + of_b]
    }

    /// How many states the first and the second process have.
    pub fn sizes(&self) -> (usize, usize) {
        (self.of_a, self.of_b)
    }

    /// All distances: `(states of the first, states of the second)`, row after row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// By how much a distance can be too small, in the unit of the rewards. Those of the processes below likewise.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// How far the state is that is farthest from all of the other process (Hausdorff distance), in the unit of the rewards.
    ///
    /// A pseudometric on processes; 0 where each state has one in the other process that cannot be told from it.
    ///
    /// Source: Song, Gao, Wang and An 2016, "Measuring the distance between finite Markov decision processes".
    pub fn hausdorff(&self) -> f64 {
        let mut to_a = vec![f64::INFINITY; self.of_b];
        let mut most = 0.0_f64;
        for row in self.values.chunks_exact(self.of_b) {
            most = most.max(row.iter().copied().fold(f64::INFINITY, f64::min));
            for (least, distance) in to_a.iter_mut().zip(row) {
                *least = least.min(*distance);
            }
        }
        to_a.into_iter().fold(most, f64::max)
    }

    /// The least mean way between two distributions over states (Kantorovich, Wasserstein-1), in the unit of the rewards.
    ///
    /// `of_a` and `of_b`: a weight of at least 0 for each state, in any proportion. With those of the initial states it says how far
    /// the processes are apart as they begin; with equal ones it is Song's distance, `wasserstein_mdp_distance` in SuReLI/llrl.
    /// A pseudometric on processes with weights.
    ///
    /// Source: Song, Gao, Wang and An 2016.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`], [`SimilarityError::BadMass`] and [`SimilarityError::BadNumber`] for weights that are
    /// none, [`SimilarityError::TooMany`] above [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) states that weigh anything.
    pub fn kantorovich(&self, of_a: &[f64], of_b: &[f64]) -> Result<f64, SimilarityError> {
        let of_a = shares("weights of the first process's states", of_a, self.of_a)?;
        let of_b = shares("weights of the second process's states", of_b, self.of_b)?;
        Ok(optimal_transport(&of_a, &of_b, &self.values)?.cost.max(0.0))
    }

    /// Pairs all states of two processes of one size so that the mean distance is least; among such pairings, so that the largest is.
    ///
    /// The mean is [`StateDistances::kantorovich`] with equal weights. Sums of distances that differ by less than 1e-12 of their
    /// size, or than the errors of the distances make up, count as equal. An assignment problem for each step of a search for the
    /// largest, some 20 in all.
    ///
    /// Source: `best_match_mdp_distance` in SuReLI/llrl is the largest distance in a pairing of least mean. Several such
    /// pairings are common; it takes any, and what it returns hangs on the order of the states.
    ///
    /// # Errors
    /// [`SimilarityError::SizesDiffer`] for different numbers of states, [`SimilarityError::TooMany`] above
    /// [`MAX_ASSIGNED`](crate::MAX_ASSIGNED) states.
    pub fn best_match(&self) -> Result<BestMatch, SimilarityError> {
        check_equal("states", self.of_a, self.of_b)?;
        let mut assignment = Assignment::new();
        let least = assignment.solve(&self.values, self.of_a, self.of_b)?;
        let cheap = least * (1.0 + 1e-12) + self.of_a as f64 * self.error;
        let mut best = self.matched(&assignment, least);
        let mut limits: Vec<f64> = self
            .values
            .iter()
            .copied()
            .filter(|limit| *limit < best.largest)
            .collect();
        limits.sort_by(f64::total_cmp);
        limits.dedup();
        // The pairing before is allowed by limits not below its largest distance, so that the search closes in.
        let forbidden = 2.0 * (cheap + self.values.iter().copied().fold(1.0, f64::max));
        while let Some(&limit) = limits.get(limits.len() / 2) {
            let allowed = |distance: &f64| if *distance <= limit { *distance } else { forbidden };
            let costs: Vec<f64> = self.values.iter().map(allowed).collect();
            let total = assignment.solve(&costs, self.of_a, self.of_b)?;
            if total <= cheap {
                best = self.matched(&assignment, least);
                limits.retain(|limit| *limit < best.largest);
            } else {
                limits.retain(|other| *other > limit);
            }
        }
        Ok(best)
    }

    /// The pairs of an assignment, where the least sum is known.
    fn matched(&self, assignment: &Assignment, least: f64) -> BestMatch {
        let partners: Vec<usize> = assignment.partners().iter().copied().flatten().collect();
        let distances = partners
            .iter()
            .enumerate()
            .map(|(state, partner)| self.between(state, *partner));
        BestMatch {
            largest: distances.fold(0.0, f64::max),
            mean: least / self.of_a as f64,
            partners,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> StateDistances {
        StateDistances::new(2, 3, vec![1.0, 4.0, 2.0, 3.0, 0.5, 7.0], 0.0)
    }

    #[test]
    fn processes_are_as_far_apart_as_their_states_say() {
        let d = table();
        assert_eq!(d.sizes(), (2, 3));
        assert_eq!(d.between(1, 0), 3.0);
        // Of the first process 1 and 0.5, of the second 1, 0.5 and 2.
        assert_eq!(d.hausdorff(), 2.0);
        assert_eq!(d.kantorovich(&[1.0, 0.0], &[1.0, 0.0, 1.0]).unwrap(), 1.5);
        assert_eq!(d.kantorovich(&[1.0, 1.0], &[2.0, 2.0, 0.0]).unwrap(), 0.75);
    }

    #[test]
    fn the_best_match_has_the_least_mean() {
        let d = StateDistances::new(2, 2, vec![0.0, 1.0, 1.0, 9.0], 0.0);
        let found = d.best_match().unwrap();
        assert_eq!((found.partners, found.mean, found.largest), (vec![1, 0], 1.0, 1.0));
        // 1 + 3 and 2 + 2 are as much, but only the second has no 3.
        let d = StateDistances::new(2, 2, vec![1.0, 2.0, 2.0, 3.0], 0.0);
        assert_eq!(d.best_match().unwrap().partners, [1, 0]);
        let d = StateDistances::new(2, 2, vec![2.0, 1.0, 3.0, 2.0], 0.0);
        assert_eq!(d.best_match().unwrap().partners, [0, 1]);
        assert_eq!(table().best_match().unwrap_err().code(), "similarity/sizes-differ");
    }

    #[test]
    fn weights_that_are_none_are_refused() {
        let code = |a: &[f64], b: &[f64]| table().kantorovich(a, b).unwrap_err().code();
        assert_eq!(code(&[1.0], &[1.0; 3]), "similarity/shape");
        assert_eq!(code(&[1.0; 2], &[0.0; 3]), "similarity/bad-number");
    }
}
