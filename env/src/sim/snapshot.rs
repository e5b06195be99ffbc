//! Keeping a moment of a running world, and going back to it: in memory, or as a world that is written down. What the
//! written form says is in `progress.rs`.

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
/// Taking one copies what changes and shares what does not, so it is much cheaper than
/// [`Environment::state`], which writes everything down.
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
    /// This moment, to be gone back to with [`Environment::restore`].
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

    /// Goes back to a moment of this environment or of another one; what follows is the same to the last bit.
    pub fn restore(&mut self, moment: &Snapshot) {
        if !Arc::ptr_eq(&self.world, &moment.world) {
            self.start_with(Arc::clone(&moment.world), &moment.catalogue);
        }
        self.seed.clone_from(&moment.seed);
        self.state.clone_from(&moment.state);
        self.rails.clone_from(&moment.rails);
        self.views.sync_objects(&self.world, &self.state);
    }

    /// The world as it is now, as a document: objects where they stand with the rewards that are left, and in
    /// `progress` all else that a reset to it needs to go on as if nothing had been.
    ///
    /// Destroyed objects are among the objects, so that numbers stay; their progress says that they are not there.
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

    /// The agent of the world, where it is now: to the bit where it started if it is there.
    pub(crate) fn agent_now(&self) -> AgentParams {
        agent_now(self.sim())
    }

    /// An object of the world, where it is now and with what is left of its reward.
    pub(crate) fn object_now(&self, index: usize) -> Object {
        object_now(self.sim(), index)
    }
}
