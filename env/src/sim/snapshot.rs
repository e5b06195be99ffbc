//! Saves the state of a running world, in memory as a [`Snapshot`] or as a world document, and restores snapshots.

use std::fmt;
use std::sync::Arc;

use driftworld_spec::{AgentParams, Object, World};

use super::environment::Environment;
use super::progress::{agent_now, object_now, to_world};
use super::rng::Seed;
use super::state::SimState;
use crate::agents::OnRailsAgent;
use crate::assets::Catalogue;

/// The state of a running world at one moment, in memory.
///
/// Taking a snapshot copies what changes and shares the rest, so it is much cheaper than [`Environment::state`], which saves
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
    /// Saves the current state for [`Environment::restore`].
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Action, Environment};
    /// use driftworld_spec::World;
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

    /// Restores a snapshot of this environment or of another one; everything after it is the same, bit for bit.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        if !Arc::ptr_eq(&self.world, &snapshot.world) {
            self.start_with(Arc::clone(&snapshot.world), &snapshot.catalogue);
        }
        self.seed.clone_from(&snapshot.seed);
        self.state.clone_from(&snapshot.state);
        self.rails.clone_from(&snapshot.rails);
        self.views.sync_objects(&self.world, &self.state);
    }

    /// The current state of the world as a document: objects at their current positions with their remaining rewards, and in
    /// `progress` everything else that a reset needs to resume.
    ///
    /// Includes destroyed objects, so that indices stay the same; their progress marks them as absent.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Action, Environment};
    /// use driftworld_spec::World;
    /// let mut environment = Environment::new(World::default());
    /// environment.step(Action::Continuous([10.0, 90.0, 0.0]))?;
    /// let json = environment.state().to_json();
    /// let read = World::from_json("state", &json).expect("a state is a valid world");
    /// assert_eq!(Environment::new(read).agent(), environment.agent());
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn state(&self) -> World {
        to_world(self.sim(), &self.seed, self.rails.as_ref().map(OnRailsAgent::progress))
    }

    /// The world's agent at its current position and heading; bit for bit as in the world if these are its start.
    pub(crate) fn agent_now(&self) -> AgentParams {
        agent_now(self.sim())
    }

    /// A world's object at its current position, with its remaining reward.
    pub(crate) fn object_now(&self, index: usize) -> Object {
        object_now(self.sim(), index)
    }
}
