//! [`Slot`]: one environment of a batch, which fetches its worlds and handles the ends of its episodes.

use std::num::NonZeroU32;
use std::sync::Arc;

use driftworld_spec::{Modality, World};

use super::images::{ImageLayout, blank_unrequested};
use super::options::{Autoreset, Episode, WorldSource};
use super::outputs::OutputsMut;
use crate::EnvError;
use crate::assets::Catalogue;
use crate::recording::{Recorder, Recording};
use crate::render::CpuRenderer;
use crate::sim::{Action, EndedBy, Environment, Step};

pub(super) struct Slot {
    env: usize,
    pub(super) environment: Environment,
    pub(super) step: Step,
    source: WorldSource,
    pub(super) layout: Arc<ImageLayout>,
    /// Index of the current episode.
    current: u64,
    /// Index of the next episode.
    next: u64,
    /// Whether the next episode must begin before anything else.
    pub(super) is_over: bool,
    /// Steps of the current episode, and its limit.
    pub(super) steps: u32,
    limit: Option<NonZeroU32>,
    /// Records the episode, if requested; `previous` is the recording of the previous episode.
    recorder: Option<Box<Recorder>>,
    previous: Option<Box<Recording>>,
}

impl Slot {
    /// An environment at the start of its episode 0, in `world`.
    pub(super) fn new(
        env: usize,
        world: World,
        source: &WorldSource,
        layout: &Arc<ImageLayout>,
        catalogue: &Catalogue,
        limit: Option<NonZeroU32>,
    ) -> Result<Self, EnvError> {
        layout.check(env, &world)?;
        Ok(Self {
            env,
            environment: Environment::with_catalogue(world, catalogue.clone()),
            layout: Arc::clone(layout),
            step: Step::default(),
            source: Arc::clone(source),
            current: 0,
            next: 1,
            is_over: false,
            steps: 0,
            limit,
            recorder: None,
            previous: None,
        })
    }

    /// Starts or stops recording.
    pub(super) fn set_recording(&mut self, records: bool) {
        self.recorder = records.then(|| Box::new(Recorder::from_now(&self.environment)));
        self.previous = None;
    }

    /// The recording of the current episode; before its first step, the recording of the previous one, if any.
    pub(super) fn recording(&self) -> Option<Recording> {
        let recorder = self.recorder.as_ref()?;
        if recorder.num_steps() == 0 && self.previous.is_some() {
            return self.previous.as_deref().cloned();
        }
        // Without recorded steps, the end belongs to an earlier episode.
        let ended_by = self.step.ended_by.filter(|_| recorder.num_steps() > 0);
        Some(recorder.recording(&self.environment, ended_by))
    }

    pub(super) fn episode(&self) -> Episode {
        Episode {
            env: self.env,
            index: self.current,
        }
    }

    /// Sets the number of steps taken, which may reach the limit.
    pub(super) fn set_steps(&mut self, steps: u32) {
        self.steps = steps;
        self.is_over |= self.limit.is_some_and(|limit| steps >= limit.get());
    }

    /// Checks that the action is valid now.
    pub(super) fn check(&self, action: Action, autoreset: Autoreset) -> Result<(), EnvError> {
        if !self.is_over {
            return self.environment.check(action);
        }
        match autoreset {
            Autoreset::Disabled => Err(EnvError::Ended),
            Autoreset::NextStep | Autoreset::SameStep => Ok(()),
        }
    }

    /// Begins the next episode after a same-step reset, once the last image has been drawn.
    pub(super) fn begin_after_last_image(
        &mut self,
        index: usize,
        outputs: &mut OutputsMut<'_>,
    ) -> Result<(), EnvError> {
        if self.awaits_last_image() {
            self.begin()?;
            self.environment.write_state(outputs.state(index))?;
        }
        Ok(())
    }

    /// Whether the last step ended the episode and the next episode has not begun.
    pub(super) fn awaits_last_image(&self) -> bool {
        self.is_over && self.step.ended()
    }

    /// Begins the next episode if it is due, and writes the observation.
    pub(super) fn reset(
        &mut self,
        index: usize,
        outputs: &mut OutputsMut<'_>,
        renderer: Option<&mut CpuRenderer>,
    ) -> Result<(), EnvError> {
        if self.is_over {
            self.begin()?;
        }
        self.step.clear();
        outputs.record(index, &self.step);
        self.observe(index, outputs, renderer)
    }

    pub(super) fn step(
        &mut self,
        action: Action,
        autoreset: Autoreset,
        index: usize,
        outputs: &mut OutputsMut<'_>,
        finals: Option<&mut OutputsMut<'_>>,
        mut renderer: Option<&mut CpuRenderer>,
    ) -> Result<(), EnvError> {
        if self.is_over {
            // Either autoreset is next-step, or an episode could not begin when it was due.
            return self.reset(index, outputs, renderer);
        }
        self.environment.step_into(action, &mut self.step)?;
        if let Some(recorder) = &mut self.recorder {
            recorder.step(action);
        }
        self.steps = self.steps.saturating_add(1);
        if self.limit.is_some_and(|limit| self.steps >= limit.get()) {
            self.step.truncated = true;
            self.step.ended_by.get_or_insert(EndedBy::Steps);
        }
        outputs.record(index, &self.step);
        self.is_over = self.step.ended();
        if let (true, Autoreset::SameStep, Some(finals)) = (self.is_over, autoreset, finals) {
            finals.record(index, &self.step);
            self.observe(index, finals, renderer.as_deref_mut())?;
            if renderer.is_none() {
                // The last image is still to be drawn: see `begin_after_last_image`.
                return Ok(());
            }
            self.begin()?;
        }
        self.observe(index, outputs, renderer)
    }

    /// Fetches the next world and begins an episode in it. On error the slot stays unchanged.
    fn begin(&mut self) -> Result<(), EnvError> {
        let world = world_of(&self.source, self.env, self.next)?;
        self.layout.check(self.env, &world)?;
        if let Some(recorder) = &mut self.recorder {
            if recorder.num_steps() > 0 {
                self.previous = Some(Box::new(recorder.recording(&self.environment, self.step.ended_by)));
            }
            recorder.begin(world.clone());
        }
        self.environment.reset(world);
        self.current = self.next;
        self.next = self.next.saturating_add(1);
        // A world that was saved after the end of its episode has no steps left.
        self.is_over = self.environment.ended();
        self.steps = 0;
        Ok(())
    }

    /// The modalities that its world requests, if fewer than the layout's.
    pub(super) fn reduced_modalities(&self) -> Option<&[Modality]> {
        let requested = &self.environment.world().agent_params.modalities;
        let requests_fewer = self.layout.modalities.iter().any(|there| !requested.contains(there));
        requests_fewer.then_some(requested)
    }

    /// Writes the state vector, and the images if there is a renderer. Otherwise the images are drawn later, for all
    /// environments together.
    fn observe(
        &self,
        index: usize,
        outputs: &mut OutputsMut<'_>,
        renderer: Option<&mut CpuRenderer>,
    ) -> Result<(), EnvError> {
        self.environment.write_state(outputs.state(index))?;
        let Some(renderer) = renderer else { return Ok(()) };
        let camera = self.environment.camera();
        let mut target = outputs.images.target(index);
        if let Some(requested) = self.reduced_modalities() {
            blank_unrequested(&mut target, requested);
        }
        if !target.is_empty() {
            let scene = self.environment.scene();
            renderer.draw(scene, &camera, &mut target)?;
            renderer.draw_carried(scene, self.environment.shown_carried(), &mut target);
        }
        outputs.images.convert_depth(index);
        Ok(())
    }
}

/// The world of an episode of an environment.
pub(super) fn world_of(source: &WorldSource, env: usize, episode: u64) -> Result<World, EnvError> {
    let world = source(Episode { env, index: episode });
    world.map_err(|reason| EnvError::BatchWorld { env, episode, reason })
}
