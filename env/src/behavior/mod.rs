//! Measures how much experts earn in their own worlds and in others.

mod belief;
mod finding_out;
#[cfg(test)]
mod tests;

use driftworld_spec::World;

use crate::EnvError;
use crate::assets::Catalogue;

/// Maximum number of steps of an expert's episode.
pub const MAX_EXPERT_STEPS: u32 = 100_000;

/// Result of one episode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpertRun {
    /// The sum of rewards, in points.
    pub earned: f64,
    /// Whether it ended as a success.
    pub success: bool,
    /// Number of steps.
    pub steps: u32,
}

/// Settings for running experts in their own worlds and in others.
#[derive(Clone, Debug)]
pub struct Expertise {
    /// Step limit of an episode, up to [`MAX_EXPERT_STEPS`]; 500 by default.
    pub steps: u32,
    /// The catalogue of assets.
    pub catalogue: Catalogue,
}

impl Default for Expertise {
    fn default() -> Self {
        Self {
            steps: 500,
            catalogue: Catalogue::default(),
        }
    }
}

impl Expertise {
    /// Runs the expert of a world in its own world: [`OnRailsAgent`](crate::OnRailsAgent).
    ///
    /// # Errors
    /// The errors of [`Environment::step`](crate::Environment::step).
    pub fn at_home(&self, world: &World) -> Result<ExpertRun, EnvError> {
        self.finding_out(&[], world)
    }

    /// Runs the expert of the world `home` in the world `abroad`, where it sees the true objects but expects the rewards of
    /// `home`.
    ///
    /// Before each step the expert sees the true state of `abroad`: its map, the agent, and the present objects with their
    /// positions. It plans by the rules of `home`. It mistakes each object for the most similar one of the same class at home:
    /// by nearest colour, then model, then nearest position, then index. It believes that the object has the reward,
    /// probability, stimuli, order and respawn of that counterpart, and that objects of classes that home lacks have no effect.
    /// The chosen action is carried out in `abroad`, within that agent's limits, as the nearest row of the action table if
    /// there is one. The expert leaves an object alone once it has triggered a stimulus that it believes to use the object up.
    ///
    /// If the world is `home` itself, the result is that of [`at_home`](Self::at_home), bit for bit.
    ///
    /// # Errors
    /// The errors of [`Environment::step`](crate::Environment::step); [`EnvError::BadWorld`] if the rules of one world are invalid
    /// in the other.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::Expertise;
    /// use driftworld_spec::{Object, Stimulus, WorldDraft};
    /// let mut cube = Object::new("geometric", [0.0, 8.0]);
    /// cube.reward = 10.0;
    /// cube.reward_once_stimulus = vec![Stimulus::AgentCollide];
    /// let home = WorldDraft::with_objects(vec![cube]).check().expect("the world is valid");
    /// let trap = home.clone().edit(|world| world.objects[0].reward = -10.0).expect("the world is valid");
    /// let expertise = Expertise { steps: 50, ..Expertise::default() };
    /// assert_eq!(expertise.abroad(&home, &trap)?.earned, -10.0);
    /// assert_eq!(expertise.at_home(&trap)?.earned, 0.0);
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn abroad(&self, home: &World, abroad: &World) -> Result<ExpertRun, EnvError> {
        self.finding_out(&[home], abroad)
    }
}
