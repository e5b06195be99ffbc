//! [`Environment`]: a world that runs. Steps are in `step.rs`, bodies in `collision_world.rs`, pictures in `observation.rs`, who acts
//! in `agents`.

use std::sync::Arc;

use driftworld_spec::{GameMode, Object, Stimulus, World};

use super::collision_world::CollisionWorld;
use super::event::Warning;
use super::progress::ResumeState;
use super::pushing::is_pushed;
use super::state::{AgentState, ObjectState, SimState};
use super::streams::{Identities, Seed};
use crate::EnvError;
use crate::assets::Catalogue;
use crate::render::{Frame, Renderer, RendererKind};
use crate::scene::Scene;

/// A world that runs: reset, step, look.
///
/// Everything is deterministic: the same world and the same actions give the same rewards, poses and pixels.
///
/// # Example
/// ```
/// use driftworld_env::{Action, Environment};
/// use driftworld_spec::World;
/// let mut environment = Environment::new(World::default())?;
/// let step = environment.step(Action::Continuous([10.0, 0.0, 0.0]))?;
/// assert_eq!(environment.agent().position, [0.0, 1.0], "10 m/s for 0.1 s along +y");
/// assert_eq!(step.reward, 0.0);
/// # Ok::<(), driftworld_env::EnvError>(())
/// ```
pub struct Environment {
    /// The world at its start, and with it what was spawned later.
    pub(super) world: Arc<World>,
    pub(super) seed: Seed,
    /// Which random numbers belong to which object.
    pub(super) identities: Identities,
    pub(super) scene: Scene,
    pub(super) ground: CollisionWorld,
    pub(super) episode: SimState,
    pub(super) had_targets: bool,
    /// The objects' tags, for events.
    pub(super) tags: Vec<Option<Arc<str>>>,
    pub(super) scratch: Scratch,
    pub(super) renderer: Renderer,
    pub(super) frame: Frame,
}

/// Lists that each time step uses again.
#[derive(Default)]
pub(super) struct Scratch {
    /// Objects that the agent met on its way, and that met it on theirs.
    pub(super) met: Vec<u32>,
    /// Contacts that last although a moving object ran ahead, in rising order.
    pub(super) kept: Vec<u32>,
    /// Objects that moved in this time step, by index, and where they came from.
    pub(super) moved: Vec<(usize, [f32; 2])>,
    /// Objects that came back in this time step.
    pub(super) arrived: Vec<usize>,
    pub(super) reached: Vec<u32>,
    pub(super) triggered: Vec<(u32, Stimulus)>,
    /// How much the time steps so far looked at.
    #[cfg(test)]
    pub(super) looked: u64,
}

impl Environment {
    /// A world of built-in assets at its start.
    ///
    /// # Errors
    /// None today: a checked world can always start.
    pub fn new(world: World) -> Result<Self, EnvError> {
        Self::with_catalogue(world, Catalogue::default())
    }

    /// A world at its start, its assets from a catalogue; the worlds that follow it take theirs from there too.
    ///
    /// # Errors
    /// As [`Environment::new`]: what the catalogue does not know is drawn as a placeholder, with a warning.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "a catalogue is cheap to clone, and the environment keeps it"
    )]
    pub fn with_catalogue(world: World, catalogue: Catalogue) -> Result<Self, EnvError> {
        let frame = Frame::new(0, 0);
        Ok(Self::build(Arc::new(world), &catalogue, Renderer::default(), frame))
    }

    /// A world at its start, drawn by a renderer of this kind.
    ///
    /// # Errors
    /// As [`Environment::new`]; [`EnvError::NoGpu`] if a graphics card is asked for and none works.
    pub fn with_renderer(world: World, kind: RendererKind) -> Result<Self, EnvError> {
        let mut environment = Self::new(world)?;
        environment.set_renderer(Renderer::new(kind)?);
        Ok(environment)
    }

    /// What draws this world's pictures.
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// Lets another renderer draw from now on.
    pub fn set_renderer(&mut self, renderer: Renderer) {
        self.renderer = renderer;
    }

    /// Leaves this world for another, or for the same from its start; buffers for pictures are kept.
    ///
    /// # Errors
    /// As [`Environment::new`]; on error this world goes on.
    pub fn reset(&mut self, world: World) -> Result<(), EnvError> {
        self.start(Arc::new(world));
        Ok(())
    }

    pub(super) fn start(&mut self, world: Arc<World>) {
        let catalogue = self.scene.catalogue().clone();
        self.start_with(world, &catalogue);
    }

    pub(super) fn start_with(&mut self, world: Arc<World>, catalogue: &Catalogue) {
        let frame = std::mem::replace(&mut self.frame, Frame::new(0, 0));
        let (scratch, ways) = (
            std::mem::take(&mut self.scratch),
            std::mem::take(&mut self.ground.scratch),
        );
        *self = Self::build(world, catalogue, std::mem::take(&mut self.renderer), frame);
        // Lists that have grown are used again; each step clears them.
        (self.scratch, self.ground.scratch) = (scratch, ways);
    }

    fn build(mut world: Arc<World>, catalogue: &Catalogue, renderer: Renderer, frame: Frame) -> Self {
        // A world that was written down while it ran is taken back to its start, and then told how far it had come.
        let came = world.progress.is_some().then(|| ResumeState::out_of(&mut world));
        let scene = Scene::from_world_with(&world, catalogue);
        let ground = CollisionWorld::new(&world, &scene);
        let seed = Seed::of(&world, came.as_ref().and_then(ResumeState::seed));
        let mut identities = Identities::default();
        let mut environment = Self {
            episode: SimState::new(&world, &seed, &mut identities),
            had_targets: world.objects.iter().any(Object::is_target),
            tags: tags(&world),
            scratch: Scratch::default(),
            world,
            seed,
            identities,
            scene,
            ground,
            renderer,
            frame,
        };
        // At a start nothing is touched or near yet: where the agent starts counts as news in the first step.
        if let Some(came) = came.filter(ResumeState::has_begun) {
            environment.resume(&came);
        }
        environment
    }

    /// Notes what is touched and near now, as no news.
    pub(super) fn init_contacts(&mut self) {
        let here = self.episode.agent.position;
        self.episode.contacts.clear();
        self.ground.note_touching(here, &mut self.episode.contacts);
        self.episode.contacts.sort_unstable();
        for index in 0..self.episode.objects.len() {
            self.episode.objects[index].in_range = self.is_in_range(index);
        }
    }

    /// The world as it was at its start, and behind its objects those that were spawned since.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Where the agent is.
    pub fn agent(&self) -> AgentState {
        self.episode.agent
    }

    /// The objects as they are now, in the world's order.
    pub fn objects(&self) -> &[ObjectState] {
        &self.episode.objects
    }

    /// What there is to see now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Steps since the start.
    pub fn num_steps(&self) -> u32 {
        self.episode.steps
    }

    /// Seconds of the world's own time since the start.
    pub fn seconds(&self) -> f64 {
        self.episode.ticks as f64 * self.world.agent_params.time_step
    }

    /// The sum of rewards since the start.
    pub fn episode_return(&self) -> f64 {
        self.episode.earned
    }

    /// Whether the episode is over, so that a reset must come before the next step.
    pub fn ended(&self) -> bool {
        self.episode.ended
    }

    /// What this world asks for that is not as its author may think.
    pub fn warnings(&self) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.world.game_mode == GameMode::CollectImages {
            warnings.push(Warning::ForPhotographs);
        }
        if self.episode.ticks == 0
            && let Some(obstacle) = self.obstacle(self.world.agent_params.coordinates)
        {
            warnings.push(Warning::StartsInside { obstacle });
        }
        let objects = 0..self.world.objects.len();
        warnings.extend(objects.flat_map(|index| self.warnings_of(index)));
        warnings.extend(self.heap());
        warnings
    }

    /// The warnings about one object, by its index in the world.
    pub(crate) fn warnings_of(&self, index: usize) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let (object, item) = (&self.world.objects[index], &self.scene.items[index]);
        if let Some(enclosure) = self.world.environment_params.enclosure(object.coordinates) {
            warnings.push(Warning::StandsInWall {
                object: index,
                enclosure,
            });
        }
        if !item.asset.known {
            let (class, model) = (object.class.clone(), object.model.0.clone());
            warnings.push(Warning::UnknownAsset {
                object: index,
                class,
                model,
            });
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

/// The tags of a world's objects; neighbours of one group share theirs.
fn tags(world: &World) -> Vec<Option<Arc<str>>> {
    let mut tags: Vec<Option<Arc<str>>> = Vec::with_capacity(world.objects.len());
    for object in &world.objects {
        let last = tags.last().and_then(Option::as_ref);
        let shared = last.filter(|last| object.tag.as_deref() == Some(&***last)).cloned();
        tags.push(shared.or_else(|| object.tag.as_deref().map(Arc::from)));
    }
    tags
}
