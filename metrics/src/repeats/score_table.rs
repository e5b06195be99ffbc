//! Scores of many runs in strata: one number per run and task, the input of the statistics over repeats.

use indexmap::{IndexMap, IndexSet};

use super::Resampling;
use crate::MetricsError;
use crate::options::is_bounded;

/// Maximum number of runs in a table.
pub const MAX_RUNS: usize = 10_000;

/// Maximum number of strata in a table.
pub const MAX_STRATA: usize = 10_000;

/// Maximum number of scores in a table, over all runs and strata.
pub const MAX_SCORES: usize = 1_000_000;

/// Maximum number of names listed in a caution; the others are counted.
const MAX_NAMES: usize = 5;

/// Scores of repeated runs. A *stratum* is a task or a pair of tasks; a *run* is one lifetime of the agent, and may lack the
/// score of a stratum.
///
/// Within the limits of [`MAX_RUNS`] runs, [`MAX_STRATA`] strata and [`MAX_SCORES`] scores in total, each stratum has at least
/// one score, and each score is below 1e100 in magnitude.
///
/// ```
/// use driftworld_metrics::{Aggregate, BootstrapOptions, ScoreTable, estimate};
///
/// # fn main() -> Result<(), driftworld_metrics::MetricsError> {
/// let table = ScoreTable::from_runs([
///     ("seed 1", vec![("find_red", 0.5), ("find_blue", 0.75)]),
///     ("seed 2", vec![("find_red", 1.0), ("find_blue", 0.25)]),
///     ("seed 3", vec![("find_red", 0.75)]),
/// ])?;
/// let [iqm, mean] = estimate(&table, [Aggregate::Iqm, Aggregate::Mean], &BootstrapOptions::default())?;
/// assert_eq!((iqm.value, mean.value), (2.0 / 3.0, 0.625), "of 0.5, 0.75 and 0.75; of 0.75 and 0.5");
/// let interval = iqm.interval.expect("there are several runs");
/// assert!(interval.low < iqm.value && iqm.value < interval.high, "whole runs are drawn: {interval:?}");
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ScoreTable {
    runs: IndexSet<String>,
    /// Per stratum, each score with the index of its run, sorted by score.
    strata: IndexMap<String, Vec<(f64, u32)>>,
}

impl ScoreTable {
    /// Builds a table from the scores of each run by stratum. Runs and strata keep the order in which they first appear.
    ///
    /// # Errors
    /// [`MetricsError::Scores`] if there is no run or no score, if a run or one of its strata is repeated, if a score is not
    /// finite or too large, and if a limit is exceeded.
    pub fn from_runs<R, S, N>(runs: impl IntoIterator<Item = (R, S)>) -> Result<Self, MetricsError>
    where
        R: Into<String>,
        S: IntoIterator<Item = (N, f64)>,
        N: Into<String>,
    {
        let mut table = Self {
            runs: IndexSet::new(),
            strata: IndexMap::new(),
        };
        let mut num_scores = 0;
        for (run, scores) in runs {
            let run = run.into();
            let (run_index, is_new) = table.runs.insert_full(run.clone());
            if !is_new {
                return Err(wrong(format!("run {run:?}"), "it twice", "every run once"));
            }
            check_limit(table.runs.len(), "runs", MAX_RUNS)?;
            for (stratum, score) in scores {
                num_scores += 1;
                check_limit(num_scores, "scores", MAX_SCORES)?;
                table.push(stratum.into(), score, &run, run_index as u32)?;
            }
        }
        if table.strata.is_empty() {
            return Err(wrong("the table".to_owned(), "no score in any run", "at least one"));
        }
        for scores in table.strata.values_mut() {
            scores.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        }
        Ok(table)
    }

    fn push(&mut self, stratum: String, score: f64, run: &str, run_index: u32) -> Result<(), MetricsError> {
        let location = || format!("{stratum:?} of run {run:?}");
        if !is_bounded(score) {
            return Err(wrong(
                location(),
                format!("{score:e}"),
                "a number below 1e100 in magnitude",
            ));
        }
        // Runs are added one after the other, so a score of this run can only be the last.
        let last_score = self.strata.get(&stratum).and_then(|scores| scores.last());
        if last_score.is_some_and(|(_, last)| *last == run_index) {
            return Err(wrong(location(), "two scores", "one"));
        }
        // Zeros of either sign become one number, so that their order does not depend on the order of runs.
        self.strata.entry(stratum).or_default().push((score + 0.0, run_index));
        check_limit(self.strata.len(), "strata", MAX_STRATA)
    }

    /// Number of runs.
    pub fn num_runs(&self) -> usize {
        self.runs.len()
    }

    /// Number of scores, over all runs and strata.
    pub fn num_scores(&self) -> usize {
        self.strata.values().map(Vec::len).sum()
    }

    /// The names of the strata, in order.
    pub fn strata(&self) -> impl Iterator<Item = &str> {
        self.strata.keys().map(String::as_str)
    }

    /// The scores of a stratum, sorted; `None` if there is no such stratum.
    pub fn scores(&self, stratum: &str) -> Option<impl Iterator<Item = f64>> {
        Some(self.strata.get(stratum)?.iter().map(|(score, _)| *score))
    }

    /// The scores of a stratum with the indices of their runs, sorted by score; empty if there is no such stratum.
    pub(super) fn scored_runs(&self, stratum: &str) -> &[(f64, u32)] {
        self.strata.get(stratum).map_or(&[], Vec::as_slice)
    }

    /// A warning for readers: there is no interval, or it misses the variation of some strata because only one run scored them.
    pub fn caution(&self, resampling: Resampling) -> Option<String> {
        if !self.varies(resampling) {
            let what = match resampling {
                Resampling::Strata => "each task was scored in only one run",
                Resampling::Runs => "there is only one run",
            };
            return Some(format!("no interval: {what}; repeat the lifetime with other seeds"));
        }
        let single: Vec<&str> = self.strata().filter(|name| self.strata[*name].len() == 1).collect();
        if resampling == Resampling::Runs || single.is_empty() {
            return None;
        }
        let named = driftworld_text::first_of(&single, MAX_NAMES);
        Some(format!(
            "the interval is too narrow: only one run scored {named}, so its variance is unknown"
        ))
    }

    /// Whether resampling can give a different table at all.
    pub(super) fn varies(&self, resampling: Resampling) -> bool {
        match resampling {
            Resampling::Strata => self.strata.values().any(|scores| scores.len() > 1),
            Resampling::Runs => self.runs.len() > 1,
        }
    }

    /// Per stratum, each score with the index of its run, sorted by score.
    pub(super) fn sorted(&self) -> impl Iterator<Item = &[(f64, u32)]> {
        self.strata.values().map(Vec::as_slice)
    }
}

fn check_limit(found: usize, what: &str, limit: usize) -> Result<(), MetricsError> {
    if found > limit {
        let (found, expected) = (format!("more than {limit} {what}"), format!("at most {limit}"));
        return Err(wrong("the table".to_owned(), found, expected));
    }
    Ok(())
}

pub(super) fn wrong(place: String, found: impl Into<String>, expected: impl Into<String>) -> MetricsError {
    MetricsError::Scores {
        place,
        found: found.into(),
        expected: expected.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Runs<'a> = &'a [(&'a str, &'a [(&'a str, f64)])];

    fn table(runs: Runs) -> Result<ScoreTable, MetricsError> {
        ScoreTable::from_runs(runs.iter().map(|(run, scores)| (*run, scores.iter().copied())))
    }

    #[test]
    fn scores_are_sorted_within_their_stratum() {
        let runs: Runs = &[
            ("1", &[("b", 3.0), ("a", 1.0)]),
            ("2", &[("a", -1.0)]),
            ("3", &[("b", 2.0)]),
        ];
        let table = table(runs).unwrap();
        assert_eq!((table.num_runs(), table.num_scores()), (3, 4));
        assert_eq!(table.strata().collect::<Vec<_>>(), ["b", "a"]);
        assert_eq!(table.scores("b").unwrap().collect::<Vec<_>>(), [2.0, 3.0]);
        assert!(table.scores("c").is_none());
    }

    #[test]
    fn invalid_tables_are_refused() {
        let check = |runs: Runs, expected: &str| assert_eq!(table(runs).unwrap_err().to_string(), expected);
        check(
            &[],
            "scores, the table: found no score in any run, expected at least one",
        );
        check(
            &[("1", &[])],
            "scores, the table: found no score in any run, expected at least one",
        );
        check(
            &[("1", &[("a", 1.0)]), ("1", &[])],
            "scores, run \"1\": found it twice, expected every run once",
        );
        check(
            &[("1", &[("a", 1.0), ("a", 2.0)])],
            "scores, \"a\" of run \"1\": found two scores, expected one",
        );
        for (number, found) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (-1e100, "-1e100")] {
            let expected =
                format!("scores, \"a\" of run \"1\": found {found}, expected a number below 1e100 in magnitude");
            check(&[("1", &[("a", number)])], &expected);
        }
    }

    #[test]
    fn tables_beyond_the_limits_are_refused() {
        let check = |found: MetricsError, expected: &str| assert_eq!(found.to_string(), expected);
        let runs = (0..=MAX_RUNS).map(|run| (run.to_string(), [("a", 1.0)]));
        check(
            ScoreTable::from_runs(runs).unwrap_err(),
            "scores, the table: found more than 10000 runs, expected at most 10000",
        );
        let strata = (0..=MAX_STRATA).map(|stratum| (stratum.to_string(), 1.0));
        check(
            ScoreTable::from_runs([("1", strata)]).unwrap_err(),
            "scores, the table: found more than 10000 strata, expected at most 10000",
        );
    }

    #[test]
    fn too_few_runs_cause_a_caution() {
        let check = |runs: Runs, resampling: Resampling, expected: Option<&str>| {
            assert_eq!(table(runs).unwrap().caution(resampling).as_deref(), expected);
        };
        let one: Runs = &[("1", &[("a", 1.0), ("b", 2.0)])];
        let each = "no interval: each task was scored in only one run; repeat the lifetime with other seeds";
        check(one, Resampling::Strata, Some(each));
        let only = "no interval: there is only one run; repeat the lifetime with other seeds";
        check(one, Resampling::Runs, Some(only));
        let ragged: Runs = &[("1", &[("a", 1.0), ("b", 2.0)]), ("2", &[("a", 2.0)])];
        let narrow = "the interval is too narrow: only one run scored b, so its variance is unknown";
        check(ragged, Resampling::Strata, Some(narrow));
        check(ragged, Resampling::Runs, None);
        let full: Runs = &[("1", &[("a", 1.0)]), ("2", &[("a", 2.0)])];
        check(full, Resampling::Strata, None);
    }
}
