//! [`Environment`]: a running world, with its state, the systems that change it, and a renderer.

use std::sync::Arc;

use driftworld_spec::{ActionModel, GameMode, Object, World};

use super::encounters::Encounters;
use super::interactions::Stimuli;
use super::neighbours::heap_warning;
use super::progress::ResumeState;
use super::pushed::is_pushed;
use super::rng::{Identities, Seed};
use super::sim_ref::SimRef;
use super::state::{AgentState, ObjectState, SimState};
use super::views::Views;
use super::walls;
use super::warning::Warning;
use crate::EnvError;
use crate::agents::OnRailsAgent;
use crate::assets::Catalogue;
use crate::prefetch::prefetch;
use crate::render::{Frame, Renderer, RendererKind};
use crate::scene::Scene;

/// Maximum number of walls whose geometry is prefetched, enough for an arena with a few walls.
const MAX_PREFETCHED_WALLS: usize = 8;

/// A running world with an agent.
///
/// Deterministic: the same world and the same actions give the same rewards, poses and pixels.
///
/// # Example
/// ```
/// use driftworld_env::{Action, Environment};
/// use driftworld_spec::World;
/// let mut environment = Environment::new(World::default());
/// let step = environment.step(Action::Continuous([10.0, 0.0, 0.0]))?;
/// assert_eq!(environment.agent().position, [0.0, 1.0], "10 m/s for 0.1 s along +y");
/// assert_eq!(step.reward, 0.0);
/// # Ok::<(), driftworld_env::EnvError>(())
/// ```
pub struct Environment {
    /// The initial world, plus objects that were spawned later.
    pub(super) world: Arc<World>,
    pub(super) seed: Seed,
    /// Identities of objects, which determine their random numbers.
    pub(super) identities: Identities,
    pub(super) state: SimState,
    pub(super) views: Views,
    /// The policy that steers in a world on rails.
    pub(super) rails: Option<OnRailsAgent>,
    pub(super) had_targets: bool,
    /// The objects' tags, for events.
    pub(super) tags: Vec<Option<Arc<str>>>,
    pub(super) encounters: Encounters,
    pub(super) stimuli: Stimuli,
    pub(super) renderer: Renderer,
    pub(super) frame: Frame,
}

impl Environment {
    /// A world at its start, with built-in assets. Every checked world can start.
    pub fn new(world: World) -> Self {
        Self::with_catalogue(world, Catalogue::default())
    }

    /// A world at its start, with assets from a catalogue, which later worlds will use as well.
    ///
    /// Objects unknown to the catalogue are drawn as placeholders, with a warning.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "a catalogue is cheap to clone, and the environment keeps it"
    )]
    pub fn with_catalogue(world: World, catalogue: Catalogue) -> Self {
        let frame = Frame::new(0, 0);
        Self::build(Arc::new(world), &catalogue, Renderer::default(), frame)
    }

    /// A world at its start, with a renderer of this kind.
    ///
    /// # Errors
    /// [`EnvError::NoGpu`] if a GPU is requested and none works.
    pub fn with_renderer(world: World, kind: RendererKind) -> Result<Self, EnvError> {
        let mut environment = Self::new(world);
        environment.set_renderer(Renderer::new(kind)?);
        Ok(environment)
    }

    /// Prefetches the lists that the next step reads.
    pub(crate) fn prefetch_lists(&self) {
        prefetch(self.world.as_ref());
        prefetch(self.state.objects.as_slice());
        prefetch(self.views.scene.items.as_slice());
        prefetch(self.views.scene.panels.as_slice());
        self.views.bodies.prefetch();
    }

    /// Prefetches the data to which those lists point.
    pub(crate) fn prefetch_contents(&self) {
        self.world.objects.first().inspect(|object| prefetch(*object));
        for group in self.views.scene.panels.iter().take(MAX_PREFETCHED_WALLS) {
            prefetch(group.edges.as_slice());
            group.blocks.first().inspect(|block| prefetch(*block));
        }
    }

    /// The renderer of this environment.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Replaces the renderer.
    pub fn set_renderer(&mut self, renderer: Renderer) {
        self.renderer = renderer;
    }

    /// Resets to another world or to the same one.
    pub fn reset(&mut self, world: World) {
        let catalogue = self.views.scene.catalogue().clone();
        self.start_with(Arc::new(world), &catalogue);
    }

    pub(super) fn start_with(&mut self, world: Arc<World>, catalogue: &Catalogue) {
        let frame = std::mem::replace(&mut self.frame, Frame::new(0, 0));
        let (encounters, stimuli, scratch) = (
            std::mem::take(&mut self.encounters),
            std::mem::take(&mut self.stimuli),
            std::mem::take(&mut self.views.bodies.scratch),
        );
        *self = Self::build(world, catalogue, std::mem::take(&mut self.renderer), frame);
        // Lists that have grown are reused; each step clears them.
        (self.encounters, self.stimuli, self.views.bodies.scratch) = (encounters, stimuli, scratch);
    }

    fn build(mut world: Arc<World>, catalogue: &Catalogue, renderer: Renderer, frame: Frame) -> Self {
        // A world that was saved while running is first restored to its start, and then resumed.
        let resume = world.progress.is_some().then(|| ResumeState::extract_from(&mut world));
        let mut views = Views::new(&world, catalogue);
        let seed = Seed::of(&world, resume.as_ref().and_then(|resume| resume.progress.seed.clone()));
        let mut identities = Identities::default();
        let mut state = SimState::new(&world, &seed, &mut identities);
        views.zones.resume(&[], &mut state);
        let mut rails = (world.agent_params.action_model == ActionModel::OnRails).then(OnRailsAgent::default);
        for door in &state.doors {
            if state.objects[door.object].open {
                views.sync_object(door.object, &world.objects[door.object], &state.objects[door.object]);
            }
        }
        if let Some(resume) = resume.filter(ResumeState::has_begun) {
            resume.apply(&world, &mut state, &mut views);
            if let (Some(policy), Some(progress)) = (&mut rails, &resume.progress.rails) {
                *policy = OnRailsAgent::resumed(progress, &world);
            }
        }
        Self {
            had_targets: world.objects.iter().any(Object::is_target),
            tags: tags(&world),
            world,
            seed,
            identities,
            state,
            views,
            rails,
            encounters: Encounters::default(),
            stimuli: Stimuli::default(),
            renderer,
            frame,
        }
    }

    /// A read-only view of the running world.
    pub(crate) fn sim(&self) -> SimRef<'_> {
        SimRef {
            world: &self.world,
            state: &self.state,
            views: &self.views,
        }
    }

    /// The world at its start, with spawned objects appended.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The agent's current state.
    pub fn agent(&self) -> AgentState {
        self.state.agent
    }

    /// The objects' current states, in the world's order.
    pub fn objects(&self) -> &[ObjectState] {
        &self.state.objects
    }

    /// The current scene.
    pub fn scene(&self) -> &Scene {
        &self.views.scene
    }

    /// Steps since the start.
    pub fn num_steps(&self) -> u32 {
        self.state.steps
    }

    /// Seconds of simulated time since the start.
    pub fn seconds(&self) -> f64 {
        self.state.ticks as f64 * self.world.agent_params.time_step
    }

    /// The sum of rewards since the start.
    pub fn episode_return(&self) -> f64 {
        self.state.earned
    }

    /// The agent's remaining energy; `None` if the world has no energy.
    pub fn energy(&self) -> Option<f64> {
        self.world.agent_params.energy.map(|_| self.state.energy)
    }

    /// Whether the episode has ended, so that a reset must come before the next step.
    pub fn ended(&self) -> bool {
        self.state.ended
    }

    /// Warnings about settings that may not be as intended.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.world.game_mode == GameMode::CollectImages {
            warnings.push(Warning::ForPhotographs);
        }
        if self.state.ticks == 0
            && let Some(obstacle) = walls::agent_obstacle(self.sim(), self.world.agent_params.coordinates)
        {
            warnings.push(Warning::StartsInside { obstacle });
        }
        let objects = 0..self.world.objects.len();
        warnings.extend(objects.flat_map(|index| self.warnings_of(index)));
        warnings.extend(heap_warning(self.sim()));
        warnings
    }

    /// The warnings about one object, by its index in the world.
    pub(crate) fn warnings_of(&self, index: usize) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let (object, item) = (&self.world.objects[index], &self.views.scene.items[index]);
        if let Some(enclosure) = self.world.enclosure(object.coordinates) {
            warnings.push(Warning::StandsInWall {
                object: index,
                enclosure,
            });
        }
        let body = object.body_model.as_ref().map(|model| (&item.body, model));
        for (asset, model) in [(&item.asset, &object.model)].into_iter().chain(body) {
            if !asset.known {
                warnings.push(Warning::UnknownAsset {
                    object: index,
                    class: object.class.clone(),
                    model: model.0.clone(),
                });
            }
        }
        if object.stands_still() {
            warnings.push(Warning::StandsStill { object: index });
        }
        if object.pushable.is_some() && !is_pushed(object) {
            warnings.push(Warning::IsNotPushed { object: index });
        }
        warnings
    }
}

/// The tags of a world's objects; consecutive objects with the same tag share it.
fn tags(world: &World) -> Vec<Option<Arc<str>>> {
    let mut tags: Vec<Option<Arc<str>>> = Vec::with_capacity(world.objects.len());
    for object in &world.objects {
        let last = tags.last().and_then(Option::as_ref);
        let shared = last.filter(|last| object.tag.as_deref() == Some(&***last)).cloned();
        tags.push(shared.or_else(|| object.tag.as_deref().map(Arc::from)));
    }
    tags
}
