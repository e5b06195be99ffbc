//! [`Snapshot`]: saves a moment of a running world in memory and restores it, or saves it as a world document.

use std::fmt;
use std::sync::Arc;

use driftworld_spec::{AgentParams, Object, World};

use super::environment::Environment;
use super::progress::{agent_now, object_now, to_world};
use super::rng::Seed;
use super::state::SimState;
use crate::agents::OnRailsAgent;
use crate::assets::Catalogue;

/// A moment of a running world, in memory.
///
/// Taking one copies what changes and shares the rest, so it is much cheaper than [`Environment::state`], which saves
/// everything as a document.
#[derive(Clone)]
pub struct Snapshot {
    world: Arc<World>,
    catalogue: Catalogue,
    seed: Seed,
    state: SimState,
    rails: Option<OnRailsAgent>,
}

impl fmt::Debug for Snapshot {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Snapshot")
            .field("steps", &self.state.steps)
            .field("agent", &self.state.agent)
            .field("objects", &self.state.objects.len())
            .finish_non_exhaustive()
    }
}

impl Environment {
    /// Saves this moment, for [`Environment::restore`].
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Action, Environment};
    /// use driftworld_spec::{AgentParams, Object, World};
    /// let mut environment = Environment::new(World::default());
    /// let start = environment.snapshot();
    /// environment.step(Action::Continuous([10.0, 90.0, 0.0]))?;
    /// environment.restore(&start);
    /// assert_eq!((environment.num_steps(), environment.agent().position), (0, [0.0, 0.0]));
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            world: Arc::clone(&self.world),
            catalogue: self.views.scene.catalogue().clone(),
            seed: self.seed.clone(),
            state: self.state.clone(),
            rails: self.rails.clone(),
        }
    }

    /// Restores a moment of this environment or of another one; everything afterwards is the same, bit for bit.
    pub fn restore(&mut self, moment: &Snapshot) {
        if !Arc::ptr_eq(&self.world, &moment.world) {
            self.start_with(Arc::clone(&moment.world), &moment.catalogue);
        }
        self.seed.clone_from(&moment.seed);
        self.state.clone_from(&moment.state);
        self.rails.clone_from(&moment.rails);
        self.views.sync_objects(&self.world, &self.state);
    }

    /// The current state of the world as a document: objects at their places with their remaining rewards, and in `progress`
    /// everything else that a reset to it needs to resume.
    ///
    /// Includes destroyed objects, so that indices stay the same; their progress marks them as absent.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Action, Environment};
    /// use driftworld_spec::World;
    /// let mut environment = Environment::new(World::default());
    /// environment.step(Action::Continuous([10.0, 90.0, 0.0]))?;
    /// let written = environment.state().to_json();
    /// let read = World::from_json("state", &written).expect("a state is a sound world");
    /// assert_eq!(Environment::new(read).agent(), environment.agent());
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn state(&self) -> World {
        to_world(self.sim(), &self.seed, self.rails.as_ref().map(OnRailsAgent::progress))
    }

    /// The world's agent at its current position and heading; if these are its start, exactly as in the world, bit for bit.
    pub(crate) fn agent_now(&self) -> AgentParams {
        agent_now(self.sim())
    }

    /// A world's object at its current position, with its remaining reward.
    pub(crate) fn object_now(&self, index: usize) -> Object {
        object_now(self.sim(), index)
    }
}
