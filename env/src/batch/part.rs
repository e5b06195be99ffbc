//! Shares the work of a step or a reset among threads: each takes a part of the environments.

use super::options::{Autoreset, GoOn};
use super::outputs::OutputsMut;
use super::slot::Slot;
use crate::EnvError;
use crate::render::CpuRenderer;
use crate::sim::Action;

/// A part of a batch for one step or reset.
pub(super) struct Part<'a> {
    pub(super) slots: &'a mut [Slot],
    pub(super) outputs: OutputsMut<'a>,
    pub(super) finals: Option<OutputsMut<'a>>,
    pub(super) renderers: &'a mut [CpuRenderer],
    pub(super) drawing: Drawing,
}

/// When images are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Drawing {
    /// Right after each environment's step.
    Now,
    /// After all environments have stepped.
    Later,
}

/// The work for all parts.
#[derive(Clone, Copy)]
pub(super) enum Work<'a> {
    Step {
        actions: &'a [Action],
        autoreset: Autoreset,
    },
    Reset {
        chosen: &'a [bool],
        go_on: GoOn<'a>,
    },
    /// Begins the next episodes of environments whose last image had to be drawn first.
    BeginLate,
}

impl Part<'_> {
    /// Does the work on environments from `first` on, halving until each part has one renderer.
    pub(super) fn run(self, first: usize, work: Work<'_>) -> Result<(), EnvError> {
        if self.renderers.len() <= 1 {
            return self.run_here(first, work);
        }
        let share = self.renderers.len() / 2;
        let middle = self.slots.len() * share / self.renderers.len();
        let (low, high) = self.split(middle, share);
        let (low, high) = rayon::join(|| low.run(first, work), || high.run(first + middle, work));
        low.and(high)
    }

    /// Splits off the first environments with the first renderers.
    fn split(mut self, num_envs: usize, num_renderers: usize) -> (Self, Self) {
        let (outputs, more_outputs) = self.outputs.split(num_envs);
        let (finals, more_finals) = self.finals.map(|finals| finals.split(num_envs)).unzip();
        let rest = Self {
            slots: self.slots.split_off_mut(num_envs..).unwrap_or_default(),
            outputs: more_outputs,
            finals: more_finals,
            renderers: self.renderers.split_off_mut(num_renderers..).unwrap_or_default(),
            drawing: self.drawing,
        };
        (
            Self {
                outputs,
                finals,
                ..self
            },
            rest,
        )
    }

    fn run_here(mut self, first: usize, work: Work<'_>) -> Result<(), EnvError> {
        let mut outcome = Ok(());
        let Some(renderer) = self.renderers.first_mut() else {
            return outcome;
        };
        for (index, slot) in self.slots.iter_mut().enumerate() {
            let env = first + index;
            let renderer = (self.drawing == Drawing::Now).then_some(&mut *renderer);
            let done = match work {
                Work::Reset { chosen, .. } if chosen.get(env) == Some(&false) => Ok(()),
                Work::Reset { go_on, .. } if !go_on() => Err(EnvError::Stopped),
                Work::Reset { .. } => slot.reset(index, &mut self.outputs, renderer),
                Work::Step { actions, autoreset } => slot.step(
                    actions[env],
                    autoreset,
                    index,
                    &mut self.outputs,
                    self.finals.as_mut(),
                    renderer,
                ),
                Work::BeginLate => slot.begin_late(index, &mut self.outputs),
            };
            outcome = outcome.and(done);
        }
        outcome
    }
}
