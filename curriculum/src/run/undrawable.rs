//! Worlds that cannot be drawn: how a run treats them, and trial draws before the run.

use std::collections::BTreeSet;

use driftworld_generator::{GeneratorError, Sampler};
use driftworld_spec::Variant;
use serde::Serialize;

use super::finishing::Finished;
use super::plan::Plan;
use super::planned::Planned;

/// Maximum number of experiences of a drift whose variants are checked.
const MAX_CHECKED_VARIANTS: u32 = 100_000;
/// Maximum number of failures that are listed.
const MAX_LISTED: usize = 100;

/// How an experience whose world cannot be drawn is treated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Undrawable {
    /// The run stops there.
    #[default]
    Refused,
    /// It is skipped: its row in the log has no numbers, but gives the reason.
    Skipped,
}

/// A world that cannot be drawn.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Failed {
    /// The experience, from 0 over the whole lifetime; `None` outside a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub experience: Option<u64>,
    /// The index of the world under its seed.
    pub index: u64,
    /// Progress of a drift, 0..=1; 0 without a drift.
    pub progress: f64,
    /// The code of the error, such as `generator/no-place`.
    pub code: &'static str,
    /// The error message.
    pub reason: String,
}

/// The result of trial draws of a variant, or of a regime of a scenario.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Trial {
    /// The block, from 0; `None` outside a scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub block: Option<usize>,
    /// The variant as `task#variant`; for a drift, with both ends.
    pub variant: String,
    /// The seed of its worlds.
    pub seed: u64,
    /// Number of worlds tried, including failures.
    pub worlds: u64,
    /// Failures because an object or the agent could not be placed.
    pub placement: u64,
    /// Failures because a requirement of the task did not hold.
    pub requirement: u64,
    /// Failures for other reasons.
    pub other: u64,
    /// The first failures, at most 100.
    pub failed: Vec<Failed>,
    /// The planner's results in the worlds that could be drawn, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expert: Option<Finished>,
}

impl Trial {
    fn new(block: Option<usize>, variant: String, seed: u64) -> Self {
        Self {
            block,
            variant,
            seed,
            ..Self::default()
        }
    }

    /// Number of worlds that could not be drawn.
    pub fn num_failed(&self) -> u64 {
        self.placement + self.requirement + self.other
    }

    fn count(&mut self, error: &GeneratorError, experience: Option<u64>, index: u64, progress: f64) {
        let kind = match error {
            GeneratorError::NoPlace { .. } | GeneratorError::NoStart { .. } | GeneratorError::NoStartCell { .. } => {
                &mut self.placement
            }
            GeneratorError::Requirement { .. } | GeneratorError::Between(_) => &mut self.requirement,
            _ => &mut self.other,
        };
        *kind += 1;
        if self.failed.len() < MAX_LISTED {
            self.failed.push(Failed {
                experience,
                index,
                progress,
                code: error.code(),
                reason: error.to_string(),
            });
        }
    }
}

/// Draws the first `worlds` worlds of a variant under a seed.
pub fn try_worlds(variant: &Variant, seed: u64, worlds: u64) -> Trial {
    let sampler = Sampler::new(variant, seed);
    let mut trial = Trial::new(None, variant.id(), seed);
    for index in 0..worlds {
        trial.worlds += 1;
        if let Err(error) = sampler.world(index) {
            trial.count(&error, None, index, 0.0);
        }
    }
    trial
}

/// Worlds already tried: scenarios evaluate the same worlds repeatedly.
#[derive(Debug, Default)]
pub struct Tried(BTreeSet<(String, u64, u64, u32)>);

impl Plan {
    /// Draws `worlds` worlds of each regime, evenly spaced from its first experience to its last, and checks that every
    /// experience of a drift, or 100,000 evenly spaced ones, has a variant at all. Regimes with the same worlds are tried once;
    /// those with world files have nothing to draw.
    ///
    /// A plan that refuses undrawable worlds cannot be created if the first world of a variant is undrawable: use one created
    /// with [`Undrawable::Skipped`].
    pub fn try_worlds(&self, worlds: u32, tried: &mut Tried) -> Vec<Trial> {
        let mut trials = Vec::new();
        for planned in self.regimes.iter().filter(|planned| planned.is_drawn()) {
            let drift = planned.drift_key();
            let key = (
                format!("{}{drift}", planned.id),
                planned.seed,
                planned.first_index,
                planned.count,
            );
            if worlds > 0 && tried.0.insert(key) {
                trials.push(planned.try_worlds(worlds));
            }
        }
        trials
    }
}

impl Planned {
    fn try_worlds(&self, worlds: u32) -> Trial {
        let mut trial = Trial::new(Some(self.block), self.id.clone(), self.seed);
        let sampler = self.sampler();
        let drawn: BTreeSet<u32> = evenly(self.count, worlds).collect();
        let checked: BTreeSet<u32> = match &sampler {
            Some(_) => BTreeSet::new(),
            None => evenly(self.count, MAX_CHECKED_VARIANTS).collect(),
        };
        for step in drawn.union(&checked) {
            let number = self.number(u64::from(*step));
            let result = if drawn.contains(step) {
                self.draw(number, sampler.as_ref()).map(drop)
            } else {
                self.variant_of(number).map(drop)
            };
            trial.worlds += u64::from(drawn.contains(step) || result.is_err());
            if let Err(error) = result {
                trial.count(&error, Some(number), self.index_of(number), self.progress(number));
            }
        }
        trial
    }
}

/// `wanted` numbers of `0..count`, evenly spaced from the first to the last.
fn evenly(count: u32, wanted: u32) -> impl Iterator<Item = u32> {
    let wanted = wanted.min(count);
    let last = u64::from(wanted.max(2) - 1);
    (0..u64::from(wanted)).map(move |step| (step * u64::from(count - 1) / last) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_even_and_include_the_first_and_last() {
        let check = |count, wanted, expected: &[u32]| {
            assert_eq!(
                evenly(count, wanted).collect::<Vec<_>>(),
                expected,
                "{wanted} of {count}"
            );
        };
        check(10, 1, &[0]);
        check(10, 2, &[0, 9]);
        check(10, 4, &[0, 3, 6, 9]);
        check(3, 5, &[0, 1, 2]);
        check(1, 5, &[0]);
        check(u32::MAX, 3, &[0, u32::MAX / 2, u32::MAX - 1]);
    }
}
