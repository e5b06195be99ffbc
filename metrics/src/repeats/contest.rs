//! Compares the runs of two agents pairwise in each stratum, and resamples the comparison.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::jackknife::{FEW_RUNS, t_interval};
use super::resample::draw_whole_runs;
use super::{BootstrapOptions, Interval, Resampling, ScoreTable};

/// Two agents, A and B, in every shared stratum.
pub(super) struct Contests {
    strata: Vec<Contest>,
    /// How often each run of an agent was drawn, if whole runs are resampled.
    drawn: [Vec<u32>; 2],
}

impl Contests {
    /// Compares two tables in these strata.
    pub(super) fn new(a: &ScoreTable, b: &ScoreTable, strata: &[&str]) -> Self {
        Self {
            strata: strata.iter().map(|name| Contest::new(a, b, name)).collect(),
            drawn: [a, b].map(|table| vec![1; table.num_runs()]),
        }
    }

    /// The probability that A wins in each stratum, followed by the mean over strata with pairs. Before resampling, every
    /// stratum has pairs.
    pub(super) fn probabilities(&self) -> Vec<Option<f64>> {
        let mut values = Vec::new();
        self.write_probabilities(&mut values);
        values
    }

    /// Like [`Self::probabilities`], but overwrites a list.
    fn write_probabilities(&self, values: &mut Vec<Option<f64>>) {
        values.clear();
        values.extend(self.strata.iter().map(Contest::probability));
        let known = values.iter().flatten();
        let (num, sum) = (known.clone().count(), known.sum::<f64>());
        values.push((num > 0).then(|| sum / num as f64));
    }

    /// Intervals of the strata, followed by the interval of their mean. `None` for a stratum that resampling cannot vary, or that
    /// had no pair in any resample.
    pub(super) fn intervals(&mut self, options: &BootstrapOptions) -> Vec<Option<Interval>> {
        let resamples = options.resamples as usize;
        let mut drawn = vec![Vec::with_capacity(resamples); self.strata.len() + 1];
        let (mut values, mut rng) = (Vec::new(), options.rng());
        // At most six resamples in ten have no pair in any stratum: each agent draws a given run with a chance of at least 1 - 1/e.
        while drawn[self.strata.len()].len() < resamples {
            self.draw(options.resampling, &mut rng);
            self.write_probabilities(&mut values);
            for (drawn, probability) in drawn.iter_mut().zip(&values) {
                drawn.extend(*probability);
            }
        }
        let varies = self.strata.iter().map(Contest::varies).chain([true]);
        drawn
            .iter_mut()
            .zip(varies)
            .map(|(values, varies)| (varies && !values.is_empty()).then(|| options.interval(values)))
            .collect()
    }

    /// Student's t intervals of the strata, followed by the interval of their mean, all clipped to 0..=1; `None` unless an agent has
    /// few runs. A stratum in which an agent has only one run has no interval.
    pub(super) fn t_intervals(&mut self, confidence: f64) -> Option<Vec<Option<Interval>>> {
        if self.drawn.iter().all(|runs| runs.len() >= FEW_RUNS) {
            return None;
        }
        self.use_each_run_once();
        let values = self.probabilities();
        let mut left_out = vec![[vec![], vec![]]; values.len()];
        for agent in [0, 1] {
            for run in 0..self.drawn[agent].len() {
                self.use_each_run_once();
                self.drawn[agent][run] = 0;
                self.use_drawn_runs();
                for (index, value) in self.probabilities().into_iter().enumerate() {
                    // A run without a score in a stratum does not count there.
                    let scored = (self.strata.get(index)).is_none_or(|contest| contest.0[agent].has_score(run));
                    left_out[index][agent].extend(value.filter(|_| scored));
                }
            }
        }
        self.use_each_run_once();
        let interval = |(value, left_out): (Option<f64>, &[Vec<f64>; 2])| {
            let found = t_interval(value?, left_out, confidence)?;
            let (low, high) = (found.low.max(0.0), found.high.min(1.0));
            Some(Interval { low, high })
        };
        Some(values.into_iter().zip(&left_out).map(interval).collect())
    }

    fn use_each_run_once(&mut self) {
        self.drawn.iter_mut().for_each(|runs| runs.fill(1));
        self.use_drawn_runs();
    }

    fn use_drawn_runs(&mut self) {
        for Contest(sides) in &mut self.strata {
            for (side, drawn) in sides.iter_mut().zip(&self.drawn) {
                side.use_runs(drawn);
            }
        }
    }

    fn draw(&mut self, resampling: Resampling, rng: &mut ChaCha8Rng) {
        match resampling {
            Resampling::Strata => {
                for side in self.strata.iter_mut().flat_map(|Contest(sides)| sides) {
                    side.draw(rng);
                }
            }
            Resampling::Runs => {
                for runs in &mut self.drawn {
                    draw_whole_runs(runs, rng);
                }
                self.use_drawn_runs();
            }
        }
    }
}

/// The runs of A and of B in one stratum, by rank.
struct Contest([Side; 2]);

/// One agent's runs.
struct Side {
    /// Each run with a score: its rank among the distinct scores of both agents, and its index in the table.
    runs: Vec<(u32, u32)>,
    /// Number of runs at each rank.
    counts: Vec<u32>,
    /// The sum of the counts.
    num_drawn: u64,
}

impl Contest {
    fn new(a: &ScoreTable, b: &ScoreTable, stratum: &str) -> Self {
        let (of_a, of_b) = (a.scored_runs(stratum), b.scored_runs(stratum));
        let mut distinct: Vec<f64> = of_a.iter().chain(of_b).map(|(score, _)| *score).collect();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        Self([of_a, of_b].map(|runs| Side::new(runs, &distinct)))
    }

    fn varies(&self) -> bool {
        self.0.iter().any(|side| side.runs.len() > 1)
    }

    /// Share of pairs that A wins, ties counted half; `None` without pairs.
    fn probability(&self) -> Option<f64> {
        let [a, b] = &self.0;
        let (mut halves, mut below) = (0, 0);
        for (of_a, of_b) in a.counts.iter().zip(&b.counts) {
            halves += u64::from(*of_a) * (2 * below + u64::from(*of_b));
            below += u64::from(*of_b);
        }
        let pairs = a.num_drawn * b.num_drawn;
        (pairs > 0).then(|| halves as f64 / (2 * pairs) as f64)
    }
}

impl Side {
    fn new(scored_runs: &[(f64, u32)], distinct: &[f64]) -> Self {
        let rank = |score: f64| distinct.partition_point(|other| *other < score) as u32;
        let mut side = Self {
            runs: scored_runs.iter().map(|(score, run)| (rank(*score), *run)).collect(),
            counts: vec![0; distinct.len()],
            num_drawn: scored_runs.len() as u64,
        };
        side.runs.iter().for_each(|(rank, _)| side.counts[*rank as usize] += 1);
        side
    }

    /// Whether a run has a score.
    fn has_score(&self, run: usize) -> bool {
        self.runs.iter().any(|(_, scored)| *scored as usize == run)
    }

    /// Draws as many runs as there are, with replacement.
    fn draw(&mut self, rng: &mut ChaCha8Rng) {
        self.counts.fill(0);
        let num_runs = self.runs.len() as u32;
        for _ in 0..num_runs {
            let (rank, _) = self.runs[rng.random_range(0..num_runs) as usize];
            self.counts[rank as usize] += 1;
        }
    }

    /// Uses the runs drawn for all strata, if they have a score in this one.
    fn use_runs(&mut self, drawn: &[u32]) {
        self.counts.fill(0);
        self.num_drawn = 0;
        for (rank, run) in &self.runs {
            let count = drawn[*run as usize];
            self.counts[*rank as usize] += count;
            self.num_drawn += u64::from(count);
        }
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::rand_core::SeedableRng;

    use super::*;

    #[test]
    fn whole_runs_are_drawn_for_all_strata_together() {
        // Run 1 of A always wins in both strata, run 2 always loses.
        let a = ScoreTable::from_runs([("1", [("x", 9.0), ("y", 9.0)]), ("2", [("x", 0.0), ("y", 0.0)])]).unwrap();
        let b = ScoreTable::from_runs([("1", [("x", 5.0), ("y", 6.0)]), ("2", [("x", 6.0), ("y", 5.0)])]).unwrap();
        let (mut contests, mut rng) = (Contests::new(&a, &b, &["x", "y"]), ChaCha8Rng::seed_from_u64(0));
        let mut seen = [0_u32; 3];
        for _ in 0..400 {
            contests.draw(Resampling::Runs, &mut rng);
            let [Some(x), Some(y), _] = contests.probabilities()[..] else {
                panic!("two strata")
            };
            assert_eq!(x, y);
            seen[(2.0 * x) as usize] += 1;
        }
        // A quarter, a half, a quarter; 50 is five standard deviations.
        assert!(seen[0].abs_diff(100) < 50 && seen[1].abs_diff(200) < 50, "{seen:?}");
    }

    #[test]
    fn stratum_without_drawn_scores_has_no_pairs() {
        let a = ScoreTable::from_runs([("1", vec![("x", 2.0)]), ("2", vec![("y", 2.0)])]).unwrap();
        let b = ScoreTable::from_runs([("1", [("x", 1.0), ("y", 3.0)])]).unwrap();
        let mut contests = Contests::new(&a, &b, &["x", "y"]);
        for contest in &mut contests.strata {
            contest.0[0].use_runs(&[2, 0]);
        }
        let found: Vec<Option<f64>> = contests.strata.iter().map(Contest::probability).collect();
        assert_eq!(found, [Some(1.0), None]);
        // The mean of a resample is taken over the strata with pairs: 1 (run 1 only), 0 (run 2 only) or 0.5 (both).
        let options = BootstrapOptions {
            resampling: Resampling::Runs,
            ..BootstrapOptions::default()
        };
        let ends = |interval: Interval| (interval.low, interval.high);
        let intervals: Vec<_> = contests
            .intervals(&options)
            .into_iter()
            .map(|found| found.map(ends))
            .collect();
        assert_eq!(
            intervals,
            [None, None, Some((0.0, 1.0))],
            "x and y do not vary, their mean does"
        );
    }
}
