//! What the world's rules pay beside the objects, and what ends an episode. What objects pay is in `answer.rs`.

use driftworld_spec::{EndCondition, Object, Stimulus};

use super::environment::Environment;
use super::episode::ObjectState;
use super::event::Step;

impl Environment {
    /// Metres to the nearest object of the tag that the world's shaping names.
    pub(super) fn shaping_distance(&self) -> Option<f64> {
        let tag = &self.world.rules.shaping.as_ref()?.toward;
        let [x, y] = self.episode.agent.position;
        let drawn = self
            .world
            .objects
            .iter()
            .zip(&self.scene.items)
            .filter(|(object, _)| object.tag.as_ref() == Some(tag));
        drawn
            .map(|(_, item)| {
                let (dx, dy) = (f64::from(item.position[0] - x), f64::from(item.position[1] - y));
                (dx * dx + dy * dy).sqrt()
            })
            .min_by(f64::total_cmp)
    }

    /// Whether the step ended the episode, and how.
    pub(super) fn judge(&self, step: &mut Step) {
        let rules = &self.world.rules;
        step.success = rules.success.iter().any(|condition| self.holds(condition, step));
        let failed = !step.success && rules.failure.iter().any(|condition| self.holds(condition, step));
        step.terminated = step.success || failed;
        step.truncated = !step.terminated && self.world.max_steps > 0 && self.episode.steps >= self.world.max_steps;
    }

    fn holds(&self, condition: &EndCondition, step: &Step) -> bool {
        match condition {
            EndCondition::AllCollected => {
                let left = |(object, state): (&Object, &ObjectState)| {
                    object.is_target() && state.present && state.reward > 0.0
                };
                self.had_targets && !self.world.objects.iter().zip(&self.episode.objects).any(left)
            }
            EndCondition::Touch(tag) => step
                .events
                .iter()
                .any(|event| event.stimulus != Stimulus::AgentInRange && event.tag.as_deref() == Some(tag.as_str())),
            EndCondition::ReturnAtLeast(bound) => self.episode.earned >= *bound,
            EndCondition::ReturnAtMost(bound) => self.episode.earned <= *bound,
        }
    }
}
