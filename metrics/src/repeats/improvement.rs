//! Two agents compared: how probably a run of one scores higher than a run of the other.
//!
//! Not here: differences of aggregates; two agents' intervals stand beside each other for that, see `estimate`.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::score_table::wrong;
use super::{BootstrapOptions, Estimate, Resampling, ScoreTable};
use crate::MetricsError;

/// How probably agent A beats agent B.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Improvement {
    /// Mean of the strata's probabilities: 0.5 where neither is better, 1 where every run of A beats every run of B.
    pub probability: Estimate,
    /// The strata that both agents have, in A's order.
    pub strata: Vec<StratumImprovement>,
    /// Strata that only A has; left out.
    pub only_a: Vec<String>,
    /// Strata that only B has; left out.
    pub only_b: Vec<String>,
}

/// How probably A beats B in one stratum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StratumImprovement {
    /// Name of the stratum.
    pub stratum: String,
    /// Probability that a run of A scores higher than a run of B; ties count half.
    pub probability: Estimate,
}

/// How probably a run of agent A scores higher than a run of agent B, per stratum and in the mean over strata, with percentile
/// bootstrap intervals for which the runs of the two agents are drawn independently.
///
/// Corresponds to `probability_of_improvement` of rliable 1.2: the Mann–Whitney statistic over the number of pairs. It says how
/// often A is better and not by how much. Higher scores must be better.
///
/// Intervals draw the scores within each stratum, whatever [`BootstrapOptions::resampling`] says: pairs of runs are formed
/// stratum by stratum. What [`ScoreTable::caution`] says of either table is true of them. Time `O(resamples · scores)`.
///
/// # Errors
/// [`MetricsError::Scores`] where the tables have no stratum in common; [`MetricsError::BadOption`] as
/// [`estimate`](super::estimate()).
///
/// # Example
/// ```
/// use driftworld_metrics::{BootstrapOptions, ScoreTable, probability_of_improvement};
///
/// # fn main() -> Result<(), driftworld_metrics::MetricsError> {
/// let a = ScoreTable::from_runs([("1", [("find_red", 3.0)]), ("2", [("find_red", 5.0)])])?;
/// let b = ScoreTable::from_runs([("1", [("find_red", 1.0)]), ("2", [("find_red", 3.0)])])?;
/// let improvement = probability_of_improvement(&a, &b, &BootstrapOptions::default())?;
/// assert_eq!(improvement.probability.value, 0.875, "of four pairs three are won and one is even");
/// # Ok(())
/// # }
/// ```
pub fn probability_of_improvement(
    a: &ScoreTable,
    b: &ScoreTable,
    options: &BootstrapOptions,
) -> Result<Improvement, MetricsError> {
    let shared: Vec<&str> = a.strata().filter(|name| b.scores(name).is_some()).collect();
    if shared.is_empty() {
        let listed = |table: &ScoreTable| table.strata().next().unwrap_or_default().to_owned();
        let found = format!(
            "no stratum that both have, {:?} in one and {:?} in the other",
            listed(a),
            listed(b)
        );
        return Err(wrong(
            "two tables to compare".to_owned(),
            found,
            "tasks of the same names",
        ));
    }
    options.check(a.num_scores() + b.num_scores())?;
    let mut contests: Vec<Contest> = shared.iter().map(|name| Contest::new(a, b, name)).collect();
    let values: Vec<f64> = contests.iter().map(Contest::probability).collect();
    let varies = a.varies(Resampling::Strata) || b.varies(Resampling::Strata);
    let intervals = varies.then(|| draw(&mut contests, options));
    let estimate = |k: usize, value| Estimate {
        value,
        interval: intervals.as_ref().map(|intervals| intervals[k]),
    };
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let strata = shared
        .iter()
        .zip(&values)
        .enumerate()
        .map(|(k, (name, value))| StratumImprovement {
            stratum: (*name).to_owned(),
            probability: Estimate {
                interval: estimate(k, *value).interval.filter(|_| contests[k].varies()),
                value: *value,
            },
        });
    let missing = |from: &ScoreTable, other: &ScoreTable| {
        let alone = from.strata().filter(|name| other.scores(name).is_none());
        alone.map(str::to_owned).collect()
    };
    Ok(Improvement {
        strata: strata.collect(),
        probability: estimate(shared.len(), mean),
        only_a: missing(a, b),
        only_b: missing(b, a),
    })
}

/// Intervals of the strata, and last that of their mean.
fn draw(contests: &mut [Contest], options: &BootstrapOptions) -> Vec<super::Interval> {
    let resamples = options.resamples as usize;
    let mut drawn = vec![Vec::with_capacity(resamples); contests.len() + 1];
    let mut chance = options.chance();
    for _ in 0..resamples {
        let mut sum = 0.0;
        for (contest, drawn) in contests.iter_mut().zip(&mut drawn) {
            contest.draw(&mut chance);
            let probability = contest.probability();
            sum += probability;
            drawn.push(probability);
        }
        let mean = sum / contests.len() as f64;
        drawn.last_mut().expect("one place for the mean").push(mean);
    }
    drawn.iter_mut().map(|values| options.interval(values)).collect()
}

/// The runs of both agents in one stratum, by rank.
struct Contest {
    a: Side,
    b: Side,
}

/// One agent's runs.
struct Side {
    /// The rank of each run's score among the different scores of both agents.
    ranks: Vec<u32>,
    /// How many runs stand at each rank.
    counts: Vec<u32>,
}

impl Contest {
    fn new(a: &ScoreTable, b: &ScoreTable, stratum: &str) -> Self {
        let scores = |table: &ScoreTable| -> Vec<f64> { table.scores(stratum).into_iter().flatten().collect() };
        let (of_a, of_b) = (scores(a), scores(b));
        let mut different: Vec<f64> = of_a.iter().chain(&of_b).copied().collect();
        different.sort_by(f64::total_cmp);
        different.dedup();
        Self {
            a: Side::new(&of_a, &different),
            b: Side::new(&of_b, &different),
        }
    }

    fn varies(&self) -> bool {
        self.a.ranks.len() > 1 || self.b.ranks.len() > 1
    }

    fn draw(&mut self, chance: &mut ChaCha8Rng) {
        self.a.draw(chance);
        self.b.draw(chance);
    }

    /// Share of pairs that A wins, ties counted half.
    fn probability(&self) -> f64 {
        let (mut halves, mut below) = (0, 0);
        for (of_a, of_b) in self.a.counts.iter().zip(&self.b.counts) {
            halves += u64::from(*of_a) * (2 * below + u64::from(*of_b));
            below += u64::from(*of_b);
        }
        let pairs = self.a.ranks.len() * self.b.ranks.len();
        halves as f64 / (2 * pairs) as f64
    }
}

impl Side {
    fn new(scores: &[f64], different: &[f64]) -> Self {
        let rank = |score: &f64| different.partition_point(|other| other < score) as u32;
        let mut side = Self {
            ranks: scores.iter().map(rank).collect(),
            counts: vec![0; different.len()],
        };
        side.ranks.iter().for_each(|rank| side.counts[*rank as usize] += 1);
        side
    }

    fn draw(&mut self, chance: &mut ChaCha8Rng) {
        self.counts.fill(0);
        let num_runs = self.ranks.len() as u32;
        for _ in 0..num_runs {
            let rank = self.ranks[chance.random_range(0..num_runs) as usize];
            self.counts[rank as usize] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(strata: &[(&str, &[f64])]) -> ScoreTable {
        let num_runs = strata.iter().map(|(_, scores)| scores.len()).max().unwrap();
        let run = |k: usize| {
            strata
                .iter()
                .filter_map(move |(name, scores)| Some((*name, *scores.get(k)?)))
        };
        ScoreTable::from_runs((0..num_runs).map(|k| (k.to_string(), run(k)))).unwrap()
    }

    #[test]
    fn pairs_are_won_lost_or_even() {
        let check = |a: &[f64], b: &[f64], expected: f64| {
            let (a, b) = (table(&[("t", a)]), table(&[("t", b)]));
            let found = probability_of_improvement(&a, &b, &BootstrapOptions::default()).unwrap();
            assert_eq!(found.probability.value, expected);
            assert_eq!(found.strata[0].probability, found.probability);
        };
        check(&[2.0, 3.0], &[0.0, 1.0], 1.0);
        check(&[0.0], &[1.0, 2.0, 3.0], 0.0);
        check(&[1.0, 1.0], &[1.0, 1.0], 0.5);
        check(&[1.0, 4.0, 2.0], &[3.0, 2.0], (0.0 + 2.0 + 0.5) / 6.0);
        check(&[-0.0], &[0.0], 0.5);
    }

    #[test]
    fn only_shared_strata_count() {
        let a = table(&[("x", &[1.0, 2.0]), ("y", &[1.0, 2.0]), ("z", &[5.0])]);
        let b = table(&[("w", &[0.0]), ("z", &[1.0]), ("y", &[3.0, 3.0])]);
        let found = probability_of_improvement(&a, &b, &BootstrapOptions::default()).unwrap();
        assert_eq!(found.probability.value, 0.5);
        let names: Vec<&str> = found.strata.iter().map(|stratum| stratum.stratum.as_str()).collect();
        assert_eq!(names, ["y", "z"]);
        assert_eq!(
            (found.only_a, found.only_b),
            (vec!["x".to_owned()], vec!["w".to_owned()])
        );
        assert!(found.strata[0].probability.interval.is_some());
        assert!(found.strata[1].probability.interval.is_none(), "one run on either side");
    }

    #[test]
    fn strangers_cannot_be_compared() {
        let (a, b) = (table(&[("x", &[1.0])]), table(&[("y", &[1.0])]));
        let error = probability_of_improvement(&a, &b, &BootstrapOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "scores, two tables to compare: found no stratum that both have, \"x\" in one and \"y\" in the other, expected tasks of \
             the same names"
        );
    }

    #[test]
    fn one_run_each_has_no_interval() {
        let (a, b) = (table(&[("x", &[1.0])]), table(&[("x", &[1.0])]));
        let found = probability_of_improvement(&a, &b, &BootstrapOptions::default()).unwrap();
        assert_eq!((found.probability.value, found.probability.interval), (0.5, None));
    }
}
