//! [`OnRailsAgent`] knows the map and visits whatever pays: a practical ceiling for learners. It also steers worlds on rails.

use driftworld_spec::{RailsProgress, World};

use super::Agent;
use super::planner::Planner;
use crate::sim::{Action, Environment, SimRef};

/// Visits all objects that pay, along paths around obstacles and through doors, then goes to the object or zone that counts as
/// success. Visits the nearest first, where an uncertain reward counts as farther away.
///
/// Reads the world's state, not its images.
#[derive(Clone, Debug, Default)]
pub struct OnRailsAgent {
    /// What a snapshot stores: the target, its place, the steps on it, the targets given up.
    progress: RailsProgress,
    /// Boxed because agents are moved often and this is large.
    planner: Box<Planner>,
}

impl OnRailsAgent {
    /// An agent at the start of its tour.
    pub fn new() -> Self {
        Self::default()
    }

    /// Its plan, for a snapshot.
    pub(crate) fn progress(&self) -> RailsProgress {
        self.progress.clone()
    }

    /// Resumes from a snapshot; ignores objects that the world does not have.
    pub(crate) fn resumed(progress: &RailsProgress, world: &World) -> Self {
        let known = |index: &u32| (*index as usize) < world.objects.len();
        let mut progress = progress.clone();
        progress.target = progress.target.filter(known);
        progress.given_up.retain(known);
        Self {
            progress,
            planner: Box::default(),
        }
    }

    /// Whether nothing worth visiting is left.
    pub(crate) fn is_done(sim: SimRef) -> bool {
        Planner::is_done(sim)
    }

    /// Its next step as speed, turn rate and interaction, independent of the world's action space.
    pub(crate) fn steer(&mut self, sim: SimRef) -> [f64; 3] {
        let step = self.planner.steer(sim, &mut self.progress);
        self.planner.shield().slowed(sim, step)
    }
}

impl Agent for OnRailsAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        let sim = environment.sim();
        let step = self.steer(sim);
        self.planner.shield().in_space(step, sim)
    }

    // Keeps the planner's floor, which is checked before it is used.
    fn begin(&mut self, _seed: u64) {
        self.progress = RailsProgress::default();
        self.planner.begin();
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}
