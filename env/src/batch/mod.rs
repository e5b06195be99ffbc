//! [`Batch`]: many environments that step together, with one contiguous buffer per output.

mod graphics;
mod images;
mod options;
mod outputs;
mod part;
mod slot;

use std::num::NonZeroUsize;
use std::sync::Arc;

pub use images::{ImageLayout, Images};
pub use options::{Autoreset, BatchOptions, Episode, GoOn, MAX_BATCH_BYTES, MAX_ENVS, WorldSource};
pub use outputs::Outputs;

use self::part::{Drawing, Part, Work};
use self::slot::{Slot, world_of};
use crate::EnvError;
use crate::assets::Catalogue;
use crate::recording::Recording;
use crate::render::{CpuRenderer, Renderer, RendererKind};
use crate::sim::{Action, EndedBy, Environment, Event};

/// Maximum number of threads of a batch per processor; more would only take turns.
const THREADS_PER_PROCESSOR: usize = 4;

/// `num_envs` environments that step together.
///
/// Each behaves exactly as a single [`Environment`] would, regardless of the number of threads. A step in which no episode
/// begins allocates nothing, except a small block for each additional thread. Steps also allocate when something is pushed
/// or respawns, when bodies overlap, and when an agent on rails chooses a destination.
///
/// # Example
/// ```
/// use std::sync::Arc;
/// use driftworld_env::{Action, Batch, BatchOptions};
/// use driftworld_spec::World;
/// let world = World::default().edit(|world| world.max_steps = 3)?;
/// let mut batch = Batch::new(4, Arc::new(move |_| Ok(world.clone())), BatchOptions::default())?;
/// batch.step(&[Action::Continuous([10.0, 0.0, 0.0]); 4])?;
/// assert_eq!(batch.outputs().images.rgb.len(), 4 * 84 * 84 * 3);
/// assert_eq!(batch.outputs().truncated, [false; 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Batch {
    slots: Vec<Slot>,
    outputs: Outputs,
    /// Last outputs of episodes that ended in the last step; only with [`Autoreset::SameStep`].
    finals: Option<Outputs>,
    autoreset: Autoreset,
    renderers: Vec<CpuRenderer>,
    /// Draws the images of all environments together, if a GPU is used; `renderers` are idle then.
    graphics: Option<Renderer>,
    pool: Option<rayon::ThreadPool>,
}

impl Batch {
    /// Creates environments at the start of their episode 0, with their first observations rendered.
    ///
    /// # Errors
    /// [`EnvError::BatchSize`] unless there are 1 to [`MAX_ENVS`] environments; [`EnvError::BatchMemory`] if outputs would take
    /// more memory than [`MAX_BATCH_BYTES`] or than is available; [`EnvError::BatchWorld`] if the source has no world;
    /// [`EnvError::BatchImages`] if worlds request images of different sizes, or modalities that the batch lacks;
    /// [`EnvError::BatchThreads`] if threads cannot be started; [`EnvError::NoGpu`] if a GPU is requested and none works; and
    /// the errors of [`Renderer::draw_batch`].
    pub fn new(num_envs: usize, source: WorldSource, options: BatchOptions) -> Result<Self, EnvError> {
        Self::with_catalogue_while(num_envs, source, options, &Catalogue::default(), &never_stop)
    }

    /// Like [`Batch::new`], with assets from a catalogue for all environments and episodes; stops when `go_on` returns false.
    ///
    /// # Errors
    /// The errors of [`Batch::new`], and [`EnvError::Stopped`] if `go_on` returned false.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "a source belongs to its batch; callers keep a clone if they need one"
    )]
    pub fn with_catalogue_while(
        num_envs: usize,
        source: WorldSource,
        options: BatchOptions,
        catalogue: &Catalogue,
        go_on: GoOn<'_>,
    ) -> Result<Self, EnvError> {
        if !(1..=MAX_ENVS).contains(&num_envs) {
            return Err(EnvError::BatchSize {
                found: num_envs,
                most: MAX_ENVS,
            });
        }
        let graphics = Some(Renderer::new(options.renderer)?).filter(|renderer| renderer.kind() == RendererKind::Gpu);
        let limit = options.max_episode_steps;
        let world = world_of(&source, 0, 0)?;
        let mut layout = ImageLayout::of(&world);
        layout.modalities = options.modalities.unwrap_or(layout.modalities);
        let (layout, state_len) = (Arc::new(layout), world.agent_params.state_len());
        let first = Slot::new(0, world, &source, &layout, catalogue, limit)?;
        // Checks memory before allocating anything large.
        let copies = 1 + u64::from(options.autoreset == Autoreset::SameStep);
        check_memory(copies * Outputs::bytes(&layout, options.depth, state_len, num_envs))?;
        let threads = threads(options.num_threads, num_envs);
        // The calling thread works too, unless a GPU draws the images.
        let pool = match threads - usize::from(graphics.is_none()) {
            0 => None,
            others => {
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(others)
                    .thread_name(|index| format!("driftworld-{index}"))
                    .build();
                Some(pool.map_err(|error| EnvError::BatchThreads {
                    wanted: threads,
                    reason: error.to_string(),
                })?)
            }
        };
        let mut slots = Vec::with_capacity(num_envs);
        slots.push(first);
        for env in 1..num_envs {
            if !go_on() {
                return Err(EnvError::Stopped);
            }
            let world = world_of(&source, env, 0)?;
            slots.push(Slot::new(env, world, &source, &layout, catalogue, limit)?);
        }
        let outputs = Outputs::new(&layout, options.depth, state_len, num_envs)?;
        let finals = match options.autoreset {
            Autoreset::SameStep => Some(Outputs::new(&layout, options.depth, state_len, num_envs)?),
            Autoreset::NextStep | Autoreset::Disabled => None,
        };
        let mut batch = Self {
            finals,
            slots,
            outputs,
            autoreset: options.autoreset,
            renderers: vec![CpuRenderer::new(); threads],
            graphics,
            pool,
        };
        batch.work(Work::Reset { chosen: &[], go_on })?;
        Ok(batch)
    }

    /// Number of environments.
    pub fn num_envs(&self) -> usize {
        self.slots.len()
    }

    /// Outputs of the last step or reset.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// With [`Autoreset::SameStep`], the last observation, reward and flags of each episode that ended in the last step. The
    /// outputs mark these environments as terminated or truncated; entries of the others are stale.
    pub fn final_outputs(&self) -> Option<&Outputs> {
        self.finals.as_ref()
    }

    /// One of the environments.
    pub fn environment(&self, env: usize) -> Option<&Environment> {
        self.slots.get(env).map(|slot| &slot.environment)
    }

    /// Events in an environment during the last step.
    pub fn events(&self, env: usize) -> Option<&[Event]> {
        self.slots.get(env).map(|slot| slot.step.events.as_slice())
    }

    /// Why the last step of an environment ended its episode, if it did.
    pub fn ended_by(&self, env: usize) -> Option<EndedBy> {
        self.slots.get(env)?.step.ended_by
    }

    /// Starts or stops recording in one environment, if it exists, or in every one. Steps allocate memory while recording.
    pub fn set_recording(&mut self, env: Option<usize>, records: bool) {
        let is_chosen = |place: usize| env.is_none_or(|env| env == place);
        let slots = self.slots.iter_mut().enumerate();
        for (_, slot) in slots.filter(|(place, _)| is_chosen(*place)) {
            slot.set_recording(records);
        }
    }

    /// The recording of an environment's current episode. Before that episode's first step, for example after an automatic
    /// reset, it is the recording of the previous episode, if any. `None` unless [`Batch::set_recording`] requested it.
    pub fn recording(&self, env: usize) -> Option<Recording> {
        self.slots.get(env)?.recording()
    }

    /// An environment's current episode.
    pub fn episode(&self, env: usize) -> Option<Episode> {
        self.slots.get(env).map(Slot::episode)
    }

    /// Steps of an environment's current episode, as counted for [`BatchOptions::max_episode_steps`].
    pub fn episode_steps(&self, env: usize) -> Option<u32> {
        self.slots.get(env).map(|slot| slot.steps)
    }

    /// Sets the number of steps already taken, for an episode that began elsewhere.
    ///
    /// # Errors
    /// [`EnvError::NoSuchEnv`] if there is no such environment.
    pub fn set_episode_steps(&mut self, env: usize, steps: u32) -> Result<(), EnvError> {
        let num_envs = self.slots.len();
        let slot = self.slots.get_mut(env);
        slot.ok_or(EnvError::NoSuchEnv { found: env, num_envs })?
            .set_steps(steps);
        Ok(())
    }

    /// Begins the next episode in every environment, whether its current one has ended or not.
    ///
    /// # Errors
    /// [`EnvError::BatchWorld`] or [`EnvError::BatchImages`] for the first environment that gets no suitable world; all others
    /// have begun.
    pub fn reset(&mut self) -> Result<(), EnvError> {
        self.begin_next(|_| true);
        let go_on = &never_stop;
        self.work(Work::Reset { chosen: &[], go_on })
    }

    /// Begins the next episode in the environments for which `chosen` is true, until `go_on` returns false; the others' outputs
    /// stay.
    ///
    /// # Errors
    /// [`EnvError::BatchLength`] unless `chosen` has one entry per environment; the errors of [`Batch::reset`];
    /// [`EnvError::Stopped`] if `go_on` returned false before all chosen environments had begun. The rest begin with the next
    /// reset or, with automatic resets, with the next step.
    pub fn reset_where_while(&mut self, chosen: &[bool], go_on: GoOn<'_>) -> Result<(), EnvError> {
        self.check_length(chosen.len())?;
        self.begin_next(|env| chosen[env]);
        self.work(Work::Reset { chosen, go_on })
    }

    fn begin_next(&mut self, chosen: impl Fn(usize) -> bool) {
        for (env, slot) in self.slots.iter_mut().enumerate() {
            if chosen(env) {
                slot.is_over = true;
            }
        }
    }

    /// Steps every environment with one action each, in order. The results are in [`Batch::outputs`].
    ///
    /// # Errors
    /// [`EnvError::BatchLength`] and [`EnvError::BatchAction`] if the actions are invalid; nothing has changed then.
    /// [`EnvError::BatchWorld`] and [`EnvError::BatchImages`] if the next episode of an environment cannot begin; the others
    /// have stepped, and the next step requests that world again.
    pub fn step(&mut self, actions: &[Action]) -> Result<(), EnvError> {
        self.check_length(actions.len())?;
        for (env, (slot, action)) in self.slots.iter().zip(actions).enumerate() {
            let checked = slot.check(*action, self.autoreset);
            checked.map_err(|error| EnvError::BatchAction {
                env,
                error: Box::new(error),
            })?;
        }
        let autoreset = self.autoreset;
        self.work(Work::Step { actions, autoreset })
    }

    fn check_length(&self, found: usize) -> Result<(), EnvError> {
        let num_envs = self.slots.len();
        if found == num_envs {
            Ok(())
        } else {
            Err(EnvError::BatchLength { found, num_envs })
        }
    }

    /// The kind of renderer that draws the images.
    pub fn renderer(&self) -> RendererKind {
        self.graphics.as_ref().map_or(RendererKind::Cpu, Renderer::kind)
    }

    fn work(&mut self, work: Work<'_>) -> Result<(), EnvError> {
        if self.graphics.is_none() {
            return self.run_parts(work, Drawing::Now);
        }
        let mut outcome = self.run_parts(work, Drawing::Later);
        if let Some(finals) = &mut self.finals
            && matches!(work, Work::Step { .. })
        {
            let last = draw_together(
                &mut self.graphics,
                self.pool.as_ref(),
                &self.slots,
                finals,
                |_, slot| slot.awaits_last_image(),
            );
            outcome = outcome
                .and(last)
                .and(self.run_parts(Work::BeginAfterLastImage, Drawing::Later));
        }
        let chosen = match work {
            Work::Reset { chosen, .. } => chosen,
            Work::Step { .. } | Work::BeginAfterLastImage => &[],
        };
        let (pool, outputs) = (self.pool.as_ref(), &mut self.outputs);
        let result = draw_together(&mut self.graphics, pool, &self.slots, outputs, |env, _| {
            chosen.get(env) != Some(&false)
        });
        outcome.and(result)
    }

    fn run_parts(&mut self, work: Work<'_>, drawing: Drawing) -> Result<(), EnvError> {
        let part = Part {
            slots: &mut self.slots,
            outputs: self.outputs.view(),
            finals: self.finals.as_mut().map(Outputs::view),
            drawing,
        };
        part.run(&mut self.renderers, self.pool.as_ref(), work)
    }
}

fn never_stop() -> bool {
    true
}

/// Number of threads: as many as requested, but no more than can be kept busy.
fn threads(requested: usize, num_envs: usize) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let wanted = if requested == 0 { processors } else { requested };
    wanted.min(num_envs).min(THREADS_PER_PROCESSOR * processors)
}

fn check_memory(bytes: u64) -> Result<(), EnvError> {
    if bytes <= MAX_BATCH_BYTES {
        return Ok(());
    }
    Err(EnvError::BatchMemory {
        found: bytes,
        most: MAX_BATCH_BYTES,
    })
}

/// Draws the chosen environments' images together, on the batch's own threads.
fn draw_together(
    graphics: &mut Option<Renderer>,
    pool: Option<&rayon::ThreadPool>,
    slots: &[Slot],
    outputs: &mut Outputs,
    is_chosen: impl Fn(usize, &Slot) -> bool + Send + Sync,
) -> Result<(), EnvError> {
    let Some(renderer) = graphics else { return Ok(()) };
    let images = outputs.images.view();
    match pool {
        Some(pool) => pool.install(|| graphics::draw(renderer, slots, images, &is_chosen)),
        None => graphics::draw(renderer, slots, images, &is_chosen),
    }?;
    let mut images = outputs.images.view();
    for (env, slot) in slots.iter().enumerate() {
        if is_chosen(env, slot) {
            images.convert_depth(env);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thread_count_is_limited_by_environments_and_processors() {
        let processors = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
        assert_eq!(threads(0, 65_536), processors);
        assert_eq!(threads(2, 65_536), 2);
        assert_eq!(threads(100_000, 3), 3);
        assert_eq!(threads(2_000, 65_536), THREADS_PER_PROCESSOR * processors);
    }
}
