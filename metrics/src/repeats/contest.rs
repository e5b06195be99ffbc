//! The runs of two agents set against each other, stratum by stratum: the pairs that each wins, and how that varies with the draw.
//!
//! Not here: what a caller gets to see of it, see `improvement`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::jackknife::{FEW_RUNS, LeftOut, t_interval};
use super::resample::draw_whole_runs;
use super::{BootstrapOptions, Interval, Resampling, ScoreTable};

/// Two agents in every stratum that both have.
pub(super) struct Contests {
    strata: Vec<Contest>,
    /// How often each run of an agent was drawn, for draws of whole runs.
    runs_of_a: Vec<u32>,
    runs_of_b: Vec<u32>,
}

impl Contests {
    /// As the tables are; of the strata that are named.
    pub(super) fn new(a: &ScoreTable, b: &ScoreTable, strata: &[&str]) -> Self {
        Self {
            strata: strata.iter().map(|name| Contest::new(a, b, name)).collect(),
            runs_of_a: vec![1; a.num_runs()],
            runs_of_b: vec![1; b.num_runs()],
        }
    }

    /// How probably A wins in each stratum. Before anything is drawn every stratum has pairs.
    pub(super) fn probabilities(&self) -> Vec<f64> {
        self.strata.iter().filter_map(Contest::probability).collect()
    }

    /// Intervals of the strata, and last that of their mean. A stratum has none where drawing again gives nothing new, or where no
    /// draw had a pair of it.
    pub(super) fn intervals(&mut self, options: &BootstrapOptions) -> Vec<Option<Interval>> {
        let resamples = options.resamples as usize;
        let mut drawn = vec![Vec::with_capacity(resamples); self.strata.len() + 1];
        let mut rng = options.rng();
        while drawn[self.strata.len()].len() < resamples {
            self.draw(options.resampling, &mut rng);
            let (mut sum, mut num_strata) = (0.0, 0);
            for (contest, drawn) in self.strata.iter().zip(&mut drawn) {
                if let Some(probability) = contest.probability() {
                    sum += probability;
                    num_strata += 1;
                    drawn.push(probability);
                }
            }
            // At worst six draws in ten leave no stratum: each agent draws a given run with a chance of 1 - 1/e or more.
            if num_strata > 0 {
                drawn[self.strata.len()].push(sum / f64::from(num_strata));
            }
        }
        let varies = self.strata.iter().map(Contest::varies).chain([true]);
        drawn
            .iter_mut()
            .zip(varies)
            .map(|(values, varies)| (varies && !values.is_empty()).then(|| options.interval(values)))
            .collect()
    }

    /// Student's intervals of the strata, and last that of their mean, where an agent has few runs; within 0..=1. A stratum has none
    /// where an agent has one run in it.
    pub(super) fn t_intervals(&mut self, confidence: f64) -> Option<Vec<Option<Interval>>> {
        if self.runs_of_a.len().min(self.runs_of_b.len()) >= FEW_RUNS {
            return None;
        }
        self.take_each_once();
        let values = self.with_mean();
        let mut left_out: Vec<[LeftOut; 2]> = values.iter().map(|_| [LeftOut(vec![]), LeftOut(vec![])]).collect();
        for agent in 0..2 {
            for run in 0..[&self.runs_of_a, &self.runs_of_b][agent].len() {
                self.take_each_once();
                if agent == 0 {
                    self.runs_of_a[run] = 0;
                } else {
                    self.runs_of_b[run] = 0;
                }
                self.take_runs();
                for (place, value) in self.with_mean().into_iter().enumerate() {
                    // A run that has no score in a stratum says nothing of it.
                    let scored = self.strata.get(place).is_none_or(|contest| contest.has(agent, run));
                    left_out[place][agent].0.extend(value.filter(|_| scored));
                }
            }
        }
        self.take_each_once();
        let interval = |(value, left_out): (Option<f64>, &[LeftOut; 2])| {
            let found = t_interval(value?, left_out, confidence)?;
            let (low, high) = (found.low.max(0.0), found.high.min(1.0));
            Some(Interval { low, high })
        };
        Some(values.into_iter().zip(&left_out).map(interval).collect())
    }

    /// How probably A wins in each stratum, and in the mean of those with pairs.
    fn with_mean(&self) -> Vec<Option<f64>> {
        let mut values: Vec<Option<f64>> = self.strata.iter().map(Contest::probability).collect();
        let known: Vec<f64> = values.iter().flatten().copied().collect();
        values.push((!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64));
        values
    }

    fn take_each_once(&mut self) {
        self.runs_of_a.fill(1);
        self.runs_of_b.fill(1);
        self.take_runs();
    }

    fn take_runs(&mut self) {
        for contest in &mut self.strata {
            contest.a.take(&self.runs_of_a);
            contest.b.take(&self.runs_of_b);
        }
    }

    fn draw(&mut self, resampling: Resampling, rng: &mut ChaCha8Rng) {
        match resampling {
            Resampling::Strata => {
                for contest in &mut self.strata {
                    contest.a.draw(rng);
                    contest.b.draw(rng);
                }
            }
            Resampling::Runs => {
                draw_whole_runs(&mut self.runs_of_a, rng);
                draw_whole_runs(&mut self.runs_of_b, rng);
                self.take_runs();
            }
        }
    }
}

/// The runs of both agents in one stratum, by rank.
struct Contest {
    a: Side,
    b: Side,
}

/// One agent's runs.
struct Side {
    /// Each run that has a score: its rank among the different scores of both agents, and its position in the table.
    runs: Vec<(u32, u32)>,
    /// How many runs stand at each rank.
    counts: Vec<u32>,
    /// How many that are in all.
    num_drawn: u64,
}

impl Contest {
    fn new(a: &ScoreTable, b: &ScoreTable, stratum: &str) -> Self {
        let (of_a, of_b) = (a.scored_runs(stratum), b.scored_runs(stratum));
        let mut different: Vec<f64> = of_a.iter().chain(of_b).map(|(score, _)| *score).collect();
        different.sort_by(f64::total_cmp);
        different.dedup();
        Self {
            a: Side::new(of_a, &different),
            b: Side::new(of_b, &different),
        }
    }

    /// Whether a run of the first or second agent has a score.
    fn has(&self, agent: usize, run: usize) -> bool {
        let side = if agent == 0 { &self.a } else { &self.b };
        side.runs.iter().any(|(_, scored)| *scored as usize == run)
    }

    fn varies(&self) -> bool {
        self.a.runs.len() > 1 || self.b.runs.len() > 1
    }

    /// Share of pairs that A wins, ties counted half; `None` where there is no pair.
    fn probability(&self) -> Option<f64> {
        let (mut halves, mut below) = (0, 0);
        for (of_a, of_b) in self.a.counts.iter().zip(&self.b.counts) {
            halves += u64::from(*of_a) * (2 * below + u64::from(*of_b));
            below += u64::from(*of_b);
        }
        let pairs = self.a.num_drawn * self.b.num_drawn;
        (pairs > 0).then(|| halves as f64 / (2 * pairs) as f64)
    }
}

impl Side {
    fn new(scored_runs: &[(f64, u32)], different: &[f64]) -> Self {
        let rank = |score: f64| different.partition_point(|other| *other < score) as u32;
        let mut side = Self {
            runs: scored_runs.iter().map(|(score, run)| (rank(*score), *run)).collect(),
            counts: vec![0; different.len()],
            num_drawn: scored_runs.len() as u64,
        };
        side.runs.iter().for_each(|(rank, _)| side.counts[*rank as usize] += 1);
        side
    }

    /// As many runs as there are, with replacement.
    fn draw(&mut self, rng: &mut ChaCha8Rng) {
        self.counts.fill(0);
        let num_runs = self.runs.len() as u32;
        for _ in 0..num_runs {
            let (rank, _) = self.runs[rng.random_range(0..num_runs) as usize];
            self.counts[rank as usize] += 1;
        }
    }

    /// The runs that were drawn for all strata, as far as they have a score in this one.
    fn take(&mut self, drawn: &[u32]) {
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
    fn whole_runs_are_drawn_for_all_strata_at_once() {
        // Of A, run 1 always wins in both strata and run 2 always loses.
        let a = ScoreTable::from_runs([("1", [("x", 9.0), ("y", 9.0)]), ("2", [("x", 0.0), ("y", 0.0)])]).unwrap();
        let b = ScoreTable::from_runs([("1", [("x", 5.0), ("y", 6.0)]), ("2", [("x", 6.0), ("y", 5.0)])]).unwrap();
        let (mut contests, mut rng) = (Contests::new(&a, &b, &["x", "y"]), ChaCha8Rng::seed_from_u64(0));
        let mut seen = [0_u32; 3];
        for _ in 0..400 {
            contests.draw(Resampling::Runs, &mut rng);
            let [x, y] = contests.probabilities()[..] else {
                panic!("two strata")
            };
            assert_eq!(x, y);
            seen[(2.0 * x) as usize] += 1;
        }
        // A quarter, a half, a quarter; 50 is five standard deviations.
        assert!(seen[0].abs_diff(100) < 50 && seen[1].abs_diff(200) < 50, "{seen:?}");
    }

    #[test]
    fn a_stratum_that_no_drawn_run_scored_has_no_pairs() {
        let a = ScoreTable::from_runs([("1", vec![("x", 2.0)]), ("2", vec![("y", 2.0)])]).unwrap();
        let b = ScoreTable::from_runs([("1", [("x", 1.0), ("y", 3.0)])]).unwrap();
        let mut contests = Contests::new(&a, &b, &["x", "y"]);
        for contest in &mut contests.strata {
            contest.a.take(&[2, 0]);
        }
        let found: Vec<Option<f64>> = contests.strata.iter().map(Contest::probability).collect();
        assert_eq!(found, [Some(1.0), None]);
        // The mean of a draw is that of the strata it has: 1 (run 1 only), 0 (run 2 only) or 0.5 (both).
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
