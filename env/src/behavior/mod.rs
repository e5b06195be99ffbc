//! What experts earn in worlds that are not theirs. Drawing the worlds, and what the numbers mean for tasks, is for others.

mod belief;
mod finding_out;
#[cfg(test)]
mod tests;

use driftworld_spec::World;

use crate::EnvError;
use crate::assets::Catalogue;

/// The most steps of an episode of an expert.
pub const MAX_EXPERT_STEPS: u32 = 100_000;

/// What became of one episode.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpertRun {
    /// The sum of rewards, in points.
    pub earned: f64,
    /// Whether it ended as a success.
    pub success: bool,
    /// How many steps it took.
    pub steps: u32,
}

/// How experts live: those of the world they are in, and others.
#[derive(Clone, Debug)]
pub struct Expertise {
    /// Steps after which an episode ends that no rule ends before, up to [`MAX_EXPERT_STEPS`]; 500 by default.
    pub steps: u32,
    /// Where assets come from.
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
    /// The expert of a world in its own world: [`OnRailsAgent`](crate::OnRailsAgent).
    ///
    /// # Errors
    /// Those of [`Environment::step`](crate::Environment::step).
    pub fn at_home(&self, world: &World) -> Result<ExpertRun, EnvError> {
        self.finding_out(&[], world)
    }

    /// The expert of the world `home` in the world `abroad`: it sees what is there and believes that it pays as at home.
    ///
    /// Before each step the expert is shown the true state of `abroad`: its map, where the agent and the objects are and which are
    /// there. It plans there by the rules of `home`, and takes each object for the one of the same class at home that looks most
    /// like it: of the nearest colour, then of the same model, then nearest to the same place, then next in number. That object's
    /// reward, its probability, stimuli, order and respawn are what it believes of this one; of a class that home does not have it
    /// believes nothing. Then the action that it chooses is carried out in `abroad`, within that agent's limits, by the nearest row
    /// of its table if it has one. What it believes to be used up once set off, it leaves when it has set that off.
    ///
    /// In a world that is `home` it does the same as [`at_home`](Self::at_home), to the bit.
    ///
    /// # Errors
    /// Those of [`Environment::step`](crate::Environment::step); [`EnvError::BadWorld`] where the rules of one world cannot hold in the other.
    ///
    /// # Example
    /// ```
    /// use driftworld_env::Expertise;
    /// use driftworld_spec::{Object, Stimulus, WorldDraft};
    /// let mut cube = Object::new("geometric", [0.0, 8.0]);
    /// cube.reward = 10.0;
    /// cube.reward_once_stimulus = vec![Stimulus::AgentCollide];
    /// let home = WorldDraft { objects: vec![cube], ..WorldDraft::default() }.check().expect("it is sound");
    /// let trap = home.clone().edit(|world| world.objects[0].reward = -10.0).expect("it is sound");
    /// let expertise = Expertise { steps: 50, ..Expertise::default() };
    /// assert_eq!(expertise.abroad(&home, &trap)?.earned, -10.0);
    /// assert_eq!(expertise.at_home(&trap)?.earned, 0.0);
    /// # Ok::<(), driftworld_env::EnvError>(())
    /// ```
    pub fn abroad(&self, home: &World, abroad: &World) -> Result<ExpertRun, EnvError> {
        self.finding_out(&[home], abroad)
    }
}
