//! A resample of a table: how often each of its scores was drawn.
//!
//! Counting instead of copying keeps scores sorted without sorting again, and sums in a fixed order.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{Resampling, ScoreTable};

/// A table with a count per score; initially 1 each.
pub(super) struct Resample {
    /// Every score, sorted.
    pub(super) scores: Vec<f64>,
    /// How often each was drawn.
    pub(super) counts: Vec<u32>,
    /// Per stratum, sorted by score.
    strata: Vec<Vec<Slot>>,
    num_runs: usize,
}

/// A score of a stratum.
#[derive(Clone, Copy)]
struct Slot {
    /// Index in `scores`.
    index: u32,
    /// Index of the run.
    run: u32,
}

impl Resample {
    pub(super) fn new(table: &ScoreTable) -> Self {
        let mut all: Vec<(f64, usize, u32)> = Vec::with_capacity(table.num_scores());
        for (stratum, sorted) in table.sorted().enumerate() {
            all.extend(sorted.iter().map(|(score, run)| (*score, stratum, *run)));
        }
        // The sort is stable: equal scores keep the order of strata, and within one the order of runs.
        all.sort_by(|(a, ..), (b, ..)| a.total_cmp(b));
        let mut strata: Vec<Vec<Slot>> = table.sorted().map(|sorted| Vec::with_capacity(sorted.len())).collect();
        for (index, (_, stratum, run)) in (0..).zip(&all) {
            strata[*stratum].push(Slot { index, run: *run });
        }
        Self {
            counts: vec![1; all.len()],
            scores: all.into_iter().map(|(score, ..)| score).collect(),
            strata,
            num_runs: table.num_runs(),
        }
    }

    /// Leaves out one run and counts every other run once; false if no score is left.
    pub(super) fn leave_out(&mut self, run: usize) -> bool {
        for slot in self.strata.iter().flatten() {
            self.counts[slot.index as usize] = u32::from(slot.run as usize != run);
        }
        self.counts.iter().any(|count| *count > 0)
    }

    /// Draws a new resample.
    pub(super) fn draw(&mut self, resampling: Resampling, rng: &mut ChaCha8Rng) {
        match resampling {
            Resampling::Strata => self.draw_strata(rng),
            Resampling::Runs => self.draw_runs(rng),
        }
    }

    /// Draws from each stratum as many scores as it has, with replacement.
    fn draw_strata(&mut self, rng: &mut ChaCha8Rng) {
        self.counts.fill(0);
        for slots in &self.strata {
            let num_slots = slots.len() as u32;
            for _ in slots {
                let slot = slots[rng.random_range(0..num_slots) as usize];
                self.counts[slot.index as usize] += 1;
            }
        }
    }

    /// Draws as many whole runs as there are, with replacement. If runs lack scores, the resample may be empty: it is then
    /// drawn again, which terminates because some run has a score.
    fn draw_runs(&mut self, rng: &mut ChaCha8Rng) {
        let mut runs = vec![0; self.num_runs];
        loop {
            draw_whole_runs(&mut runs, rng);
            for slot in self.strata.iter().flatten() {
                self.counts[slot.index as usize] = runs[slot.run as usize];
            }
            if self.counts.iter().any(|count| *count > 0) {
                return;
            }
        }
    }

    /// Number of scores drawn.
    pub(super) fn num_drawn(&self) -> u64 {
        self.counts.iter().map(|count| u64::from(*count)).sum()
    }

    /// The mean of each stratum with at least one drawn score.
    pub(super) fn stratum_means(&self) -> impl Iterator<Item = f64> {
        self.strata.iter().filter_map(|slots| {
            let (mut sum, mut num_drawn) = (0.0, 0);
            for slot in slots {
                let count = self.counts[slot.index as usize];
                sum += self.scores[slot.index as usize] * f64::from(count);
                num_drawn += count;
            }
            (num_drawn > 0).then(|| sum / f64::from(num_drawn))
        })
    }
}

/// Draws as many runs as there are, with replacement, and counts each.
pub(super) fn draw_whole_runs(counts: &mut [u32], rng: &mut ChaCha8Rng) {
    counts.fill(0);
    for _ in 0..counts.len() {
        counts[rng.random_range(0..counts.len() as u32) as usize] += 1;
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::rand_core::SeedableRng;

    use super::*;

    fn table() -> ScoreTable {
        let runs = [
            ("1", vec![("a", 5.0), ("b", 1.0)]),
            ("2", vec![("a", 2.0), ("b", 2.0)]),
            ("3", vec![("a", 9.0)]),
        ];
        ScoreTable::from_runs(runs).unwrap()
    }

    #[test]
    fn initial_resample_is_the_table() {
        let resample = Resample::new(&table());
        assert_eq!(resample.scores, [1.0, 2.0, 2.0, 5.0, 9.0]);
        assert_eq!(resample.num_drawn(), 5);
        assert_eq!(resample.stratum_means().collect::<Vec<_>>(), [16.0 / 3.0, 1.5]);
    }

    #[test]
    fn each_stratum_keeps_its_size() {
        let (mut resample, mut rng) = (Resample::new(&table()), ChaCha8Rng::seed_from_u64(0));
        let mut drawn = [0; 5];
        for _ in 0..3_000 {
            resample.draw(Resampling::Strata, &mut rng);
            let of_a = resample.counts[1] + resample.counts[3] + resample.counts[4];
            assert_eq!((of_a, resample.num_drawn()), (3, 5));
            drawn
                .iter_mut()
                .zip(&resample.counts)
                .for_each(|(sum, count)| *sum += count);
        }
        // Each score is drawn once per resample on average; five standard deviations are 230.
        assert!(drawn.iter().all(|sum| sum.abs_diff(3_000) < 230), "{drawn:?}");
    }

    #[test]
    fn whole_runs_are_drawn_together() {
        let (mut resample, mut rng) = (Resample::new(&table()), ChaCha8Rng::seed_from_u64(0));
        for _ in 0..100 {
            resample.draw(Resampling::Runs, &mut rng);
            // Positions by score: 1 (run 1, b), 2 (run 2, a), 2 (run 2, b), 5 (run 1, a), 9 (run 3, a).
            let counts = &resample.counts;
            assert_eq!((counts[0], counts[1]), (counts[3], counts[2]));
            assert_eq!(counts[0] + counts[1] + counts[4], 3);
        }
    }
}
