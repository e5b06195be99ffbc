//! What the world's rules make of where things stand: the potential of its shaping, and what ends an episode. What objects pay
//! is in `interactions.rs`.

use driftworld_spec::{EndCondition, Object, Stimulus};

use super::environment::Environment;
use super::event::Step;
use super::state::ObjectState;

impl Environment {
    /// The potential that the world's shaping gives to this moment; 0 without shaping and where nothing draws the agent.
    pub(super) fn potential(&self) -> f64 {
        let Some(shaping) = &self.world.rules.shaping else {
            return 0.0;
        };
        let nearest = match &shaping.toward {
            Some(tag) => self.nearest(|object, state| state.present && object.tag.as_ref() == Some(tag)),
            None => self.nearest(|object, state| pays_now(object, state) && self.is_due(object.order)),
        };
        nearest.map_or(0.0, |index| {
            let [x, y] = self.way_to(index).map(f64::from);
            -shaping.scale * (x * x + y * y).sqrt()
        })
    }

    /// The index of the nearest object, centre to centre on the ground, for which a condition holds.
    pub(super) fn nearest(&self, holds: impl Fn(&Object, &ObjectState) -> bool) -> Option<usize> {
        let objects = self.world.objects.iter().zip(&self.episode.objects).enumerate();
        let distance = |index: usize| {
            let [x, y] = self.way_to(index);
            x * x + y * y
        };
        objects
            .filter(|(_, (object, state))| holds(object, state))
            .map(|(index, _)| (index, distance(index)))
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(index, _)| index)
    }

    /// Whether the agent was in contact with an object at the end of the last step.
    pub(crate) fn touches(&self, index: usize) -> bool {
        self.episode.contacts.binary_search(&(index as u32)).is_ok()
    }

    /// The way from the agent to an object along x and y, in metres.
    pub(super) fn way_to(&self, index: usize) -> [f32; 2] {
        let (to, from) = (self.scene.items[index].position, self.episode.agent.position);
        [to[0] - from[0], to[1] - from[1]]
    }

    /// Whether the step so far ended the episode by itself, and how.
    pub(super) fn check_termination(&self, step: &mut Step) {
        let rules = &self.world.rules;
        let holds = |conditions: &[EndCondition]| conditions.iter().any(|condition| self.holds(condition, step));
        let success = holds(&rules.success);
        let failed = !success && holds(&rules.failure);
        (step.success, step.terminated) = (success, success || failed);
    }

    fn holds(&self, condition: &EndCondition, step: &Step) -> bool {
        let earned = self.episode.unshaped + step.reward;
        match condition {
            EndCondition::AllCollected => {
                self.had_targets
                    && !self
                        .world
                        .objects
                        .iter()
                        .zip(&self.episode.objects)
                        .any(|(object, state)| pays_now(object, state))
            }
            EndCondition::Touch(tag) => step
                .events
                .iter()
                .any(|event| event.stimulus != Stimulus::AgentInRange && event.tag.as_deref() == Some(tag.as_str())),
            EndCondition::ReturnAtLeast(bound) => earned >= *bound,
            EndCondition::ReturnAtMost(bound) => earned <= *bound,
        }
    }
}

/// Whether an object is a target that is there and still pays.
pub(super) fn pays_now(object: &Object, state: &ObjectState) -> bool {
    object.is_target() && state.present && state.reward > 0.0
}
