//! The evaluation results of each task in the log's own unit, and their comparison with the expert's level, which shows whether the
//! task was learned at all.

use std::collections::BTreeMap;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::lifetime::{Lifetime, Regime, SteRun, World, worlds};
use crate::preprocess::{anchors, given_range};
use crate::statistics::{mean, variance};
use crate::{Anchors, BlockType, Log, NormalizationMethod, Options, Unlabelled};

/// Share of the expert's level below which a task counts as never learned.
pub const LEARNED_SHARE: f64 = 0.2;

/// Number of standard errors by which an evaluation after learning must exceed the first one to count as a gain.
const MIN_STANDARD_ERRORS: f64 = 2.0;

/// One evaluation of one task.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct EvaluationCell {
    /// Number of the block, as logged.
    pub block: u64,
    /// Mean of the rows as logged.
    pub mean: f64,
    /// Standard error of the mean over worlds, or over rows if the log does not give their worlds; `None` for one world.
    pub standard_error: Option<f64>,
    /// Number of worlds, or of rows.
    pub num_worlds: usize,
    /// The mean as the position between the task's floor and ceiling; `None` if these are unknown.
    #[serde(default)]
    pub score: Option<f64>,
}

/// The evaluation results of a task.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Reached {
    /// Every evaluation, in order.
    pub evaluations: Vec<EvaluationCell>,
    /// Index in `evaluations` of the highest mean after the task was first learned; `None` if there is no such evaluation.
    pub best: Option<usize>,
    /// The expert's level, averaged over its runs: its last evaluation of the task, or else the last tenth of its learning;
    /// without an expert the task's ceiling. `None` if neither is known.
    pub expert: Option<f64>,
    /// The best evaluation as a share of the expert's level: both measured from the task's floor, or else the lower end of the
    /// given range, or else 0. `None` if one is missing, or the expert's level is not above that baseline.
    pub share: Option<f64>,
    /// Like `share`, for the first evaluation after each time the task was learned, in order: shows how well it could still be
    /// learned.
    /// Empty if there are no such shares.
    #[serde(default)]
    pub shares: Vec<f64>,
    /// Reward of an agent that knows nothing about the task, if known.
    #[serde(default)]
    pub floor: Option<f64>,
    /// Reward of an agent that knows the task, if known and above the floor.
    #[serde(default)]
    pub ceiling: Option<f64>,
    /// Rewards of the best known agents that cannot distinguish the task from others of the lifetime that look the same, if
    /// known: for the largest set of such tasks that are all in the lifetime.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unlabelled: Option<Unlabelled>,
    /// The scaling of the task's performances for the metrics.
    #[serde(default)]
    pub scaled_by: ScaledBy,
}

/// The scaling of a task's performances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScaledBy {
    /// The task's floor and ceiling.
    Anchors,
    /// A range that was given for the task.
    Range,
    /// The smallest and largest performance of the lifetime and its experts.
    #[default]
    Own,
    /// Nothing.
    Nothing,
}

impl Reached {
    /// The last evaluation.
    pub fn last(&self) -> Option<&EvaluationCell> {
        self.evaluations.last()
    }

    /// The evaluation with the highest mean after learning.
    pub fn best(&self) -> Option<&EvaluationCell> {
        self.evaluations.get(self.best?)
    }

    /// The position of a performance in the log's unit between floor and ceiling; `None` if these are unknown.
    pub fn score(&self, performance: f64) -> Option<f64> {
        let (floor, ceiling) = (self.floor?, self.ceiling?);
        Some((performance - floor) / (ceiling - floor))
    }

    /// Whether floor and ceiling are known.
    pub fn is_scaled(&self) -> bool {
        self.floor.is_some() && self.ceiling.is_some()
    }

    /// The share of the expert's level after the first learning of the task, minus that after the last; above 0 if the agent
    /// lost the ability to learn. `None` for a task that was learned and evaluated less than twice.
    pub fn plasticity_loss(&self) -> Option<f64> {
        match self.shares.as_slice() {
            [first, .., last] => Some(first - last),
            _ => None,
        }
    }

    /// Whether every evaluation after learning is below [`LEARNED_SHARE`] of the expert's level; `None` if unknown.
    pub fn is_never_learned(&self) -> Option<bool> {
        self.share.map(|share| share < LEARNED_SHARE)
    }

    /// Whether the task is better after learning than in its first evaluation: if its expert's level is known, whether it was
    /// learned; otherwise whether the gain exceeds two standard errors. `None` if it was not evaluated after learning.
    pub fn has_gained(&self) -> Option<bool> {
        let (first, best) = (self.evaluations.first()?, self.best()?);
        if let Some(is_never_learned) = self.is_never_learned() {
            return Some(!is_never_learned);
        }
        let [before, after] = [first, best].map(|cell| cell.standard_error.unwrap_or(0.0));
        Some(best.mean - first.mean > MIN_STANDARD_ERRORS * (before * before + after * after).sqrt())
    }
}

/// The evaluation results of each task, in the lifetime's order; the list is empty for tasks without an evaluation.
pub(crate) fn reached(log: &Log, lifetime: &Lifetime, options: &Options) -> IndexMap<String, Reached> {
    let worlds = worlds(log, lifetime.regimes());
    let mut found = IndexMap::new();
    for task in lifetime.tasks() {
        let mut evaluations = Vec::new();
        let (mut after_learning, mut was_learning) = (Vec::new(), false);
        let mut best: Option<(usize, f64)> = None;
        let mut is_learned = false;
        for regime in lifetime
            .regimes_about(task)
            .filter(|regime| lifetime.is_assessed(regime))
        {
            if regime.block_type == BlockType::Train {
                (is_learned, was_learning) = (true, true);
                continue;
            }
            let cell = cell(regime, &worlds[regime.regime_num]);
            if is_learned && best.is_none_or(|(_, highest)| cell.mean > highest) {
                best = Some((evaluations.len(), cell.mean));
            }
            if std::mem::take(&mut was_learning) {
                after_learning.push(cell.mean);
            }
            evaluations.push(cell);
        }
        let levels: Vec<f64> = lifetime
            .experts_of(task)
            .iter()
            .filter_map(|run| level(run, task))
            .collect();
        let anchors = anchors(task, options);
        let ceiling = anchors.as_ref().map(|anchors| anchors.ceiling);
        let expert = mean(&levels).or(ceiling);
        // Ranges that lack a task are refused where they are used.
        let range = given_range(task, lifetime, options).ok().flatten();
        let floor = (anchors.as_ref()).map_or(range.map_or(0.0, |range| range.min), |anchors| anchors.floor);
        let share_of_expert = |level: f64| {
            let expert = expert.filter(|expert| *expert > floor)?;
            Some((level - floor) / (expert - floor)).filter(|share_of_expert| share_of_expert.is_finite())
        };
        let mut reached = Reached {
            best: best.map(|(index, _)| index),
            expert,
            share: best.and_then(|(_, highest)| share_of_expert(highest)),
            shares: after_learning.into_iter().filter_map(share_of_expert).collect(),
            floor: anchors.as_ref().map(|anchors| anchors.floor),
            ceiling,
            unlabelled: anchors.as_ref().and_then(|anchors| unlabelled(anchors, lifetime)),
            scaled_by: scaled_by(task, lifetime, options),
            evaluations: Vec::new(),
        };
        for cell in &mut evaluations {
            cell.score = reached.score(cell.mean);
        }
        reached.evaluations = evaluations;
        found.insert(task.clone(), reached);
    }
    found
}

/// The largest set of tasks that look alike and are all in the lifetime.
fn unlabelled(anchors: &Anchors, lifetime: &Lifetime) -> Option<Unlabelled> {
    let is_complete = |set: &&Unlabelled| set.among.iter().all(|task| lifetime.tasks().contains(task));
    let complete = anchors.unlabelled.iter().filter(is_complete);
    complete.max_by_key(|set| set.among.len()).cloned()
}

/// Mean and standard error of an evaluation: each world counts once, by the mean of its rows.
fn cell(regime: &Regime, worlds: &[Option<World>]) -> EvaluationCell {
    let means = means_of_worlds(&regime.raw, worlds);
    EvaluationCell {
        block: regime.block_num,
        mean: mean(&regime.raw).unwrap_or(0.0),
        standard_error: standard_error(&means),
        num_worlds: means.len(),
        score: None,
    }
}

/// The mean of the rows of each world; rows without a known world count individually.
fn means_of_worlds(values: &[f64], worlds: &[Option<World>]) -> Vec<f64> {
    let mut of_world: BTreeMap<World, Vec<f64>> = BTreeMap::new();
    let mut means = Vec::new();
    for (value, world) in values.iter().zip(worlds) {
        match world {
            Some(world) => of_world.entry(*world).or_default().push(*value),
            None => means.push(*value),
        }
    }
    means.extend(of_world.values().filter_map(|values| mean(values)));
    means
}

/// The standard error over worlds of a regime's mean performance, after preprocessing; `None` for one world.
pub(crate) fn performance_error(regime: &Regime, worlds: &[Option<World>]) -> Option<f64> {
    standard_error(&means_of_worlds(&regime.performance, worlds))
}

/// The scaling of a task's performances.
fn scaled_by(task: &str, lifetime: &Lifetime, options: &Options) -> ScaledBy {
    match given_range(task, lifetime, options) {
        _ if options.normalization_method == NormalizationMethod::Off => ScaledBy::Nothing,
        Ok(Some(_)) if options.data_range.is_some() => ScaledBy::Range,
        Ok(Some(_)) => ScaledBy::Anchors,
        _ => ScaledBy::Own,
    }
}

/// Standard error of the mean of independent values; `None` for fewer than two.
fn standard_error(values: &[f64]) -> Option<f64> {
    Some((variance(values)? / values.len() as f64).sqrt())
}

/// The level of one run of an expert, as logged.
fn level(run: &SteRun, task: &str) -> Option<f64> {
    let of = |block_type: BlockType| {
        let regimes = run.regimes.iter().filter(move |regime| regime.block_type == block_type);
        regimes.filter(|regime| regime.task_name == task)
    };
    if let Some(evaluation) = of(BlockType::Test).next_back() {
        return mean(&evaluation.raw);
    }
    let learning: Vec<f64> = of(BlockType::Train)
        .flat_map(|regime| regime.raw.iter().copied())
        .collect();
    mean(&learning[learning.len() * 9 / 10..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn task_has_gained_beyond_two_standard_errors_or_by_its_experts_level() {
        let task = |gain: f64, share: Option<f64>| Reached {
            evaluations: [10.0, 10.0 + gain]
                .map(|mean| EvaluationCell {
                    block: 0,
                    mean,
                    standard_error: Some(1.0),
                    num_worlds: 4,
                    score: None,
                })
                .to_vec(),
            best: Some(1),
            share,
            ..Reached::default()
        };
        // Two standard errors of the difference are 2 √2 = 2.83.
        for (gain, share, expected) in [
            (2.8, None, false),
            (2.9, None, true),
            (-5.0, None, false),
            (0.5, Some(0.21), true),
            (5.0, Some(0.19), false),
        ] {
            assert_eq!(task(gain, share).has_gained(), Some(expected), "{gain} {share:?}");
        }
        let never_evaluated_after_learning = Reached {
            best: None,
            ..task(5.0, None)
        };
        assert_eq!(never_evaluated_after_learning.has_gained(), None);
    }

    #[test]
    fn standard_error_is_that_of_a_mean() {
        assert_eq!(standard_error(&[1.0]), None);
        assert_eq!(standard_error(&[]), None);
        // Squares that add up to 8, divided by n - 1 = 3 for the variance and by n = 4 for the mean.
        let found = standard_error(&[1.0, 5.0, 3.0, 3.0]).expect("four values");
        assert!((found - (8.0_f64 / 3.0 / 4.0).sqrt()).abs() < 1e-12, "{found}");
    }
}
