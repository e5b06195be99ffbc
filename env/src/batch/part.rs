//! Divides the work of a step or a reset among threads; each thread takes parts of the environments.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use super::options::{Autoreset, GoOn};
use super::outputs::OutputsMut;
use super::slot::Slot;
use crate::EnvError;
use crate::prefetch::prefetch;
use crate::render::CpuRenderer;
use crate::sim::Action;

/// Number of parts per thread into which the remaining environments are divided. It exceeds 1 because environments whose
/// agents are near many objects take longer.
const PARTS_PER_THREAD: usize = 4;

/// Maximum number of checks whether the other threads have finished, before sleeping; together they take about 100 µs.
const MAX_SPINS: u32 = 3_000;

/// Maximum number of environments that stay in a processor's cache; in larger parts, they are prefetched.
const MAX_CACHED_ENVS: usize = 32;

/// Maximum number of bytes of an image to prefetch. Beyond that, the processor itself detects that they are written in order.
const MAX_PREFETCHED_BYTES: usize = 1 << 14;

/// A part of a batch for one step or reset.
pub(super) struct Part<'a> {
    pub(super) slots: &'a mut [Slot],
    pub(super) outputs: OutputsMut<'a>,
    pub(super) finals: Option<OutputsMut<'a>>,
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
    BeginAfterLastImage,
}

impl Part<'_> {
    /// Does the work on this thread and on those of a pool, with one renderer per thread. Each free thread takes a few
    /// environments.
    pub(super) fn run(
        self,
        renderers: &mut [CpuRenderer],
        pool: Option<&rayon::ThreadPool>,
        work: Work<'_>,
    ) -> Result<(), EnvError> {
        let num_threads = renderers.len();
        let Some((own, others)) = renderers.split_first_mut() else {
            return Ok(());
        };
        let Some(pool) = pool.filter(|_| num_threads > 1) else {
            return self.run_here(0, own, work);
        };
        let rest = Mutex::new((0, Some(self)));
        let earliest: Mutex<Option<(usize, EnvError)>> = Mutex::new(None);
        let busy = AtomicUsize::new(others.len());
        let run_until_done = |renderer: &mut CpuRenderer| {
            while let Some((first, part)) = take(&rest, num_threads) {
                if let Err(error) = part.run_here(first, renderer, work) {
                    let mut earliest = earliest.lock().unwrap_or_else(PoisonError::into_inner);
                    if earliest.as_ref().is_none_or(|(env, _)| first < *env) {
                        *earliest = Some((first, error));
                    }
                }
            }
        };
        pool.in_place_scope(|scope| {
            for renderer in others {
                scope.spawn(|_| {
                    run_until_done(renderer);
                    busy.fetch_sub(1, Ordering::Release);
                });
            }
            run_until_done(own);
            // The others are about to finish, which takes less time than going to sleep.
            for _ in 0..MAX_SPINS {
                if busy.load(Ordering::Acquire) == 0 {
                    break;
                }
                std::hint::spin_loop();
            }
        });
        let earliest = earliest.into_inner().unwrap_or_else(PoisonError::into_inner);
        earliest.map_or(Ok(()), |(_, error)| Err(error))
    }

    /// Splits off the first environments.
    fn split(self, num_envs: usize) -> (Self, Self) {
        let (slots, more_slots) = self.slots.split_at_mut(num_envs);
        let (outputs, more_outputs) = self.outputs.split(num_envs);
        let (finals, more_finals) = self.finals.map(|finals| finals.split(num_envs)).unzip();
        let drawing = self.drawing;
        let part = |slots, outputs, finals| Self {
            slots,
            outputs,
            finals,
            drawing,
        };
        (
            part(slots, outputs, finals),
            part(more_slots, more_outputs, more_finals),
        )
    }

    /// Prefetches the environments after this one, and the colour image of the next.
    fn prefetch_after(&mut self, index: usize) {
        let after = |distance: usize| self.slots.get(index + distance);
        if let Some(slot) = after(4) {
            prefetch(slot);
        }
        if let Some(slot) = after(3) {
            slot.environment.prefetch_lists();
        }
        if let Some(slot) = after(1) {
            slot.environment.prefetch_contents();
            let colors = self.outputs.images.target(index + 1).rgb;
            colors.inspect(|colors| prefetch(&colors[..colors.len().min(MAX_PREFETCHED_BYTES)]));
        }
    }

    fn run_here(mut self, first: usize, renderer: &mut CpuRenderer, work: Work<'_>) -> Result<(), EnvError> {
        let mut outcome = Ok(());
        let is_prefetched = matches!(work, Work::Step { .. }) && self.slots.len() > MAX_CACHED_ENVS;
        for index in 0..self.slots.len() {
            if is_prefetched {
                self.prefetch_after(index);
            }
            let slot = &mut self.slots[index];
            let env = first + index;
            let renderer = (self.drawing == Drawing::Now).then_some(&mut *renderer);
            let result = match work {
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
                Work::BeginAfterLastImage => slot.begin_after_last_image(index, &mut self.outputs),
            };
            outcome = outcome.and(result);
        }
        outcome
    }
}

/// Takes the next environments that no thread has taken yet, and the index of the first. Takes fewer each time, so that all
/// threads finish at about the same time. `None` if none are left.
fn take<'a>(rest: &Mutex<(usize, Option<Part<'a>>)>, num_threads: usize) -> Option<(usize, Part<'a>)> {
    let mut rest = rest.lock().unwrap_or_else(PoisonError::into_inner);
    let (first, part) = (rest.0, rest.1.take()?);
    let count = part.slots.len().div_ceil(PARTS_PER_THREAD * num_threads);
    if count == part.slots.len() {
        return Some((first, part));
    }
    let (now, later) = part.split(count);
    *rest = (first + count, Some(later));
    Some((first, now))
}
