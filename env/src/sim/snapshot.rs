//! Keeping a moment of a running world in memory, and going back to it. The form that can be written down is in `progress.rs`.

use std::fmt;
use std::sync::Arc;

use driftworld_spec::World;

use super::environment::Environment;
use super::state::SimState;
use super::streams::Seed;
use crate::EnvError;
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
    episode: SimState,
    /// Where each object stands and faces.
    places: Vec<([f32; 2], f32)>,
}

impl fmt::Debug for Snapshot {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("Snapshot")
            .field("steps", &self.episode.steps)
            .field("agent", &self.episode.agent)
            .field("objects", &self.episode.objects.len())
            .finish_non_exhaustive()
    }
}

impl Environment {
    /// This moment, to be gone back to with [`Environment::restore`].
    ///
    /// # Example
    /// ```
    /// use driftworld_env::{Action, Environment};
    /// use driftworld_spec::World;
    /// let mut environment = Environment::new(World::default())?;
    /// let start = environment.snapshot();
    /// environment.step(Action::Continuous([10.0, 90.0, 0.0]))?;
    /// environment.restore(&start)?;
    /// assert_eq!((environment.num_steps(), environment.agent().position), (0, [0.0, 0.0]));
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn snapshot(&self) -> Snapshot {
        let place = |item: &crate::Item| (item.position, item.heading_deg);
        Snapshot {
            world: Arc::clone(&self.world),
            catalogue: self.scene.catalogue().clone(),
            seed: self.seed.clone(),
            episode: self.episode.clone(),
            places: self.scene.items.iter().map(place).collect(),
        }
    }

    /// Goes back to a moment of this environment or of another one; what follows is the same to the last bit.
    ///
    /// # Errors
    /// None today: every moment can be gone back to.
    pub fn restore(&mut self, moment: &Snapshot) -> Result<(), EnvError> {
        if !Arc::ptr_eq(&self.world, &moment.world) {
            self.start_with(Arc::clone(&moment.world), &moment.catalogue);
        }
        self.seed.clone_from(&moment.seed);
        self.episode.clone_from(&moment.episode);
        for (index, &(position, heading_deg)) in moment.places.iter().enumerate() {
            let state = &self.episode.objects[index];
            let item = &mut self.scene.items[index];
            item.position = position;
            item.heading_deg = heading_deg;
            item.reward = state.reward as f32;
            item.visible = state.present;
            self.ground.remove(index as u32);
            if state.present {
                self.ground
                    .add_object(index as u32, item, self.world.objects[index].solid);
            }
        }
        Ok(())
    }
}
