//! [`run_rollout`]: the main loop of a lifetime, for anything that can run single experiences ([`Rollout`]).

use std::ops::{ControlFlow, Range};

use driftworld_env::Recording;
use driftworld_metrics::Timestamp;
use driftworld_spec::{BlockKind, World};

use super::budget::Budget;
use super::journal::FinishedExperience;
use super::worlds::Worlds;
use super::{Experience, Journal, Plan, Progress, Repeats, Summary};
use crate::CurriculumError;

/// Runs single experiences: an agent with an environment of its own.
pub trait Rollout {
    /// The rollout's error type.
    type Error: From<CurriculumError>;

    /// Called before the first experience of a block. `learning`: whether the agent may learn in it; `repeated`: the evaluations
    /// that are run again at its end, in ascending order.
    ///
    /// # Errors
    /// An error ends the run.
    fn begin_block(&mut self, learning: bool, repeated: &[u64]) -> Result<(), Self::Error> {
        let _ = (learning, repeated);
        Ok(())
    }

    /// Which evaluations of each block are run again at its end, to check that the agent is frozen; none by default.
    fn repeats(&self) -> Repeats {
        Repeats::default()
    }

    /// The trace of the last experience: a hash of each action and the state that it led to. A repeated evaluation must give the
    /// same trace. Empty by default: then only rewards are compared.
    fn trace(&self) -> Vec<u64> {
        Vec::new()
    }

    /// Runs an experience in its world, from the first step to the last. `None` ends the run without a row.
    ///
    /// # Errors
    /// An error ends the run.
    fn experience(&mut self, number: u64, world: World) -> Result<Option<Experience>, Self::Error>;

    /// The recording of the last experience, for a log that keeps recordings; `None` by default.
    ///
    /// # Errors
    /// An error ends the run.
    fn recording(&mut self, number: u64, experience: &Experience) -> Result<Option<Recording>, Self::Error> {
        let _ = (number, experience);
        Ok(None)
    }

    /// Called after the last experience of a learning block, when `done` experiences are in the log.
    ///
    /// # Errors
    /// An error ends the run.
    fn end_learning(&mut self, done: u64) -> Result<(), Self::Error> {
        let _ = done;
        Ok(())
    }

    /// Called after each experience is logged; may end the run. `reward` is `None` for a skipped one.
    ///
    /// # Errors
    /// An error ends the run.
    fn logged(&mut self, progress: &Progress, reward: Option<f64>) -> Result<ControlFlow<()>, Self::Error>;
}

/// Runs a scenario one experience after the other, from the first that is not in the log.
///
/// The agent has learned from the first `learned` experiences. Later learning experiences in the log are run again, in the same
/// worlds, without being logged again.
///
/// # Errors
/// Those of [`run`](super::run), and the rollout's own; all earlier experiences are in the log.
/// [`CurriculumError::NotFrozen`] if the agent behaves differently when an evaluation is repeated.
pub fn run_rollout<R: Rollout>(
    plan: &Plan,
    rollout: &mut R,
    journal: &mut Journal,
    learned: u64,
    now: &mut dyn FnMut() -> Timestamp,
) -> Result<Summary, R::Error> {
    let (done, total) = (journal.num_experiences(), plan.num_experiences());
    let (mut worlds, mut block) = (Worlds::new(plan), None);
    if relearn_range(plan, learned..done, (&mut worlds, &mut block), rollout)?.is_break() {
        return Ok(journal.summary().clone());
    }
    // The summary shows whether the rollout ended the run early.
    let _ = run_range(plan, done..total, (&mut worlds, &mut block), rollout, journal, now)?;
    Ok(journal.summary().clone())
}

/// Runs the learning experiences of a range again, without logging them. `block` is the last block that the rollout began.
pub(super) fn relearn_range<R: Rollout>(
    plan: &Plan,
    numbers: Range<u64>,
    (worlds, block): (&mut Worlds<'_>, &mut Option<usize>),
    rollout: &mut R,
) -> Result<ControlFlow<()>, R::Error> {
    let mut budget = Budget::default();
    let mut next = numbers.start;
    while next < numbers.end {
        let number = next;
        let planned = &plan.regimes[plan.regime_of(number)];
        next = number + 1;
        if planned.kind == BlockKind::Learning
            && let Ok((world, _)) = worlds.draw(number)?
        {
            if block.replace(planned.block) != Some(planned.block) {
                rollout.begin_block(true, &[])?;
            }
            let Some(experience) = rollout.experience(number, world)? else {
                return Ok(ControlFlow::Break(()));
            };
            budget.count(plan, number, u64::from(experience.steps));
        }
        next = budget.next(plan, next);
    }
    Ok(ControlFlow::Continue(()))
}

/// Runs a range of experiences, and logs each as soon as it has ended. `block` is the last block that the rollout began.
pub(super) fn run_range<R: Rollout>(
    plan: &Plan,
    numbers: Range<u64>,
    (worlds, block): (&mut Worlds<'_>, &mut Option<usize>),
    rollout: &mut R,
    journal: &mut Journal,
    now: &mut dyn FnMut() -> Timestamp,
) -> Result<ControlFlow<()>, R::Error> {
    let total = plan.num_experiences();
    // Repeated evaluations of the current block, with their rewards and traces.
    let mut repeated: Vec<u64> = Vec::new();
    let mut evaluated: Vec<(u64, f64, Vec<u64>)> = Vec::new();
    let mut next = numbers.start;
    while next < numbers.end {
        let number = next;
        let planned = &plan.regimes[plan.regime_of(number)];
        let (progress, reward) = match worlds.draw(number)? {
            Err(reason) => (journal.leave_out(plan, number, &reason, now())?, None),
            Ok((world, between)) => {
                if block.replace(planned.block) != Some(planned.block) {
                    repeated = plan.repeated(number, rollout.repeats());
                    rollout.begin_block(planned.kind == BlockKind::Learning, &repeated)?;
                }
                let Some(experience) = rollout.experience(number, world)? else {
                    return Ok(ControlFlow::Break(()));
                };
                let recording = if journal.records() {
                    rollout.recording(number, &experience)?
                } else {
                    None
                };
                let finished = FinishedExperience {
                    experience,
                    between,
                    recording,
                };
                let progress = journal.append(plan, number, finished, now())?;
                if repeated.contains(&number) {
                    evaluated.push((number, experience.reward, rollout.trace()));
                }
                (progress, Some(experience.reward))
            }
        };
        next = journal.num_experiences();
        let is_last = next == total || plan.regimes[plan.regime_of(next)].block != planned.block;
        if planned.kind == BlockKind::Learning && is_last {
            rollout.end_learning(next)?;
        }
        if rollout.logged(&progress, reward)?.is_break() {
            return Ok(ControlFlow::Break(()));
        }
        if is_last {
            for (number, reward, trace) in evaluated.drain(..) {
                let Ok((world, _)) = worlds.draw(number)? else {
                    continue;
                };
                let Some(repeat) = rollout.experience(number, world)? else {
                    return Ok(ControlFlow::Break(()));
                };
                let (first, repeat) = ((reward, &trace[..]), (repeat.reward, &rollout.trace()[..]));
                expect_frozen(plan, number, first, repeat, journal)?;
            }
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// Fails if a repeated evaluation gave a different reward or trace, after removing its block from the log.
pub(super) fn expect_frozen(
    plan: &Plan,
    number: u64,
    first: (f64, &[u64]),
    repeat: (f64, &[u64]),
    journal: &mut Journal,
) -> Result<(), CurriculumError> {
    let found = if first.1 != repeat.1 {
        let pairs = first.1.iter().zip(repeat.1);
        let same = pairs.take_while(|(one, other)| one == other).count();
        format!("a different action in step {}", same + 1)
    } else if first.0.to_bits() != repeat.0.to_bits() {
        format!("reward {} instead of {}, at the end", repeat.0, first.0)
    } else {
        return Ok(());
    };
    journal.withdraw_block()?;
    let planned = &plan.regimes[plan.regime_of(number)];
    Err(CurriculumError::NotFrozen {
        block: planned.block,
        variant: planned.id.clone(),
        experience: number,
        found,
    })
}
