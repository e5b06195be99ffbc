//! Compares two agents: the probability that a run of one scores higher than a run of the other.

use serde::{Deserialize, Serialize};

use super::contest::Contests;
use super::permutation::permutation_test;
use super::score_table::wrong;
use super::{BootstrapOptions, Estimate, ScoreTable};
use crate::MetricsError;

/// The probability that agent A beats agent B.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Improvement {
    /// Mean of the strata's probabilities: 0.5 if neither is better, 1 if every run of A beats every run of B.
    pub probability: Estimate,
    /// P-value of a permutation test: the share of ways to divide all runs between the two agents, as whole runs, in
    /// which the mean probability is at least as far from 0.5. Calling agents different at 0.05 or less is wrong for at
    /// most 5 % of pairs of equal agents, whatever the correlation within runs. `None` if each agent has only one run.
    #[serde(default)]
    pub p_value: Option<f64>,
    /// The smallest possible p-value with this number of runs: 0.1 for three runs of each agent.
    #[serde(default)]
    pub least_p_value: Option<f64>,
    /// The shared strata, in A's order.
    pub strata: Vec<StratumImprovement>,
    /// Strata that only A has; ignored.
    pub only_a: Vec<String>,
    /// Strata that only B has; ignored.
    pub only_b: Vec<String>,
}

/// The probability that A beats B in one stratum.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StratumImprovement {
    /// Name of the stratum.
    pub stratum: String,
    /// Probability that a run of A scores higher than a run of B; ties count half.
    pub probability: Estimate,
}

/// The probability that a run of agent A scores higher than a run of agent B, per stratum and averaged over strata, with
/// percentile bootstrap intervals that resample the two agents independently.
///
/// Corresponds to `probability_of_improvement` of rliable 1.2: the Mann–Whitney statistic over the number of pairs. It measures
/// how often A is better and not by how much. Higher scores must be better.
///
/// Runs are paired within each stratum. [`BootstrapOptions::resampling`] chooses what is resampled: the scores within each
/// stratum, or the whole runs of each agent, the same in every stratum. If runs lack scores, resampled whole runs may have no
/// score in some stratum: such a stratum is left out of the mean of that resample, and its own interval uses the other
/// resamples; a resample without any stratum is drawn again. [`ScoreTable::caution`] of either table applies to the intervals.
/// Time `O(resamples · scores)`.
///
/// # Errors
/// [`MetricsError::Scores`] if the tables have no stratum in common; [`MetricsError::BadOption`] as in
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
/// assert_eq!(improvement.probability.value, 0.875, "of four pairs, three are won and one is tied");
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
            "no stratum in common, {:?} in one and {:?} in the other",
            listed(a),
            listed(b)
        );
        return Err(wrong(
            "two tables to compare".to_owned(),
            found,
            "tasks with the same names",
        ));
    }
    options.check(a.num_scores() + b.num_scores())?;
    let mut contests = Contests::new(a, b, &shared);
    let values = contests.probabilities();
    let varies = a.varies(options.resampling) || b.varies(options.resampling);
    let intervals = varies.then(|| contests.intervals(options));
    let by_t = contests.t_intervals(options.confidence);
    let estimate = |k: usize| Estimate {
        value: values[k].expect("every stratum has pairs before resampling"),
        interval: intervals.as_ref().and_then(|intervals| intervals[k]),
        t_interval: by_t.as_ref().and_then(|intervals| intervals[k]),
    };
    let permutation_test = permutation_test(a, b, &shared, options);
    let strata = shared.iter().enumerate().map(|(k, name)| StratumImprovement {
        stratum: (*name).to_owned(),
        probability: estimate(k),
    });
    let missing = |from: &ScoreTable, other: &ScoreTable| {
        let alone = from.strata().filter(|name| other.scores(name).is_none());
        alone.map(str::to_owned).collect()
    };
    Ok(Improvement {
        strata: strata.collect(),
        probability: estimate(shared.len()),
        p_value: permutation_test.map(|shared| shared.p_value),
        least_p_value: permutation_test.map(|shared| shared.least),
        only_a: missing(a, b),
        only_b: missing(b, a),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Resampling;

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
    fn pairs_are_won_lost_or_tied() {
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
        assert!(found.strata[1].probability.interval.is_none(), "one run per agent");
    }

    #[test]
    fn agents_without_shared_strata_are_refused() {
        let (a, b) = (table(&[("x", &[1.0])]), table(&[("y", &[1.0])]));
        let error = probability_of_improvement(&a, &b, &BootstrapOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "scores, two tables to compare: found no stratum in common, \"x\" in one and \"y\" in the other, expected tasks with \
             the same names"
        );
    }

    #[test]
    fn single_runs_have_no_interval() {
        let (a, b) = (table(&[("x", &[1.0])]), table(&[("x", &[1.0])]));
        let found = probability_of_improvement(&a, &b, &BootstrapOptions::default()).unwrap();
        assert_eq!((found.probability.value, found.probability.interval), (0.5, None));
    }

    /// A seed gives the same numbers on every machine. If these change, earlier results cannot be reproduced.
    #[test]
    fn intervals_are_reproducible() {
        let a = table(&[
            ("x", &[1.0, 4.0, 2.0, 7.0, 3.0]),
            ("y", &[5.0, 2.0, 6.0]),
            ("z", &[2.0, 8.0]),
        ]);
        let b = table(&[
            ("x", &[3.0, 2.0, 1.0, 5.0]),
            ("y", &[3.0, 4.0, 1.0, 4.0]),
            ("z", &[6.0, 3.0, 5.0]),
        ]);
        let check = |resampling, expected: [(f64, f64); 4]| {
            let options = BootstrapOptions {
                resampling,
                resamples: 500,
                seed: 1,
                ..BootstrapOptions::default()
            };
            let found = probability_of_improvement(&a, &b, &options).unwrap();
            let strata = found.strata.iter().map(|stratum| &stratum.probability);
            let intervals = strata
                .chain([&found.probability])
                .map(|estimate| estimate.interval.unwrap());
            let ends: Vec<(f64, f64)> = intervals.map(|interval| (interval.low, interval.high)).collect();
            assert_eq!(ends, expected, "{resampling}");
        };
        check(
            Resampling::Strata,
            [
                (0.2, 0.938_124_999_999_999_4),
                (0.25, 1.0),
                (0.0, 1.0),
                (0.295_625_000_000_000_1, 0.891_666_666_666_666_6),
            ],
        );
        check(
            Resampling::Runs,
            [
                (0.186_875_000_000_000_26, 0.938_124_999_999_999_4),
                (0.25, 1.0),
                (0.0, 1.0),
                (0.416_666_666_666_666_7, 0.911_840_277_777_777_8),
            ],
        );
    }
}
