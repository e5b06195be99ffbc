//! The state vector: the numbers of the features that a world requests.

use driftworld_spec::{Object, StateFeature, Stimulus, World};

use super::environment::Environment;
use super::state::{ObjectState, SimState};
use super::termination::pays_now;
use super::views::Views;

impl Environment {
    /// The numbers of the requested features, in the world's order, followed by the instruction. The default features are
    /// position, heading and velocity.
    pub fn state_vector(&self) -> Vec<f32> {
        let mut state = vec![0.0; self.world.agent_params.state_len()];
        self.fill_state(&mut state);
        state
    }

    /// Writes the state vector into a buffer.
    ///
    /// # Errors
    /// [`EnvError::StateLength`](crate::EnvError::StateLength) unless the buffer has exactly the vector's length.
    pub fn write_state(&self, state: &mut [f32]) -> Result<(), crate::EnvError> {
        let expected = self.world.agent_params.state_len();
        if state.len() != expected {
            let found = state.len();
            return Err(crate::EnvError::StateLength { found, expected });
        }
        self.fill_state(state);
        Ok(())
    }

    fn fill_state(&self, state: &mut [f32]) {
        let mut rest = state;
        for feature in &self.world.agent_params.state_features {
            let numbers = values(&self.world, &self.state, &self.views, *feature);
            let (own, others) = rest.split_at_mut(feature.num_values());
            own.copy_from_slice(&numbers[..own.len()]);
            rest = others;
        }
        for (value, number) in rest.iter_mut().zip(&self.world.agent_params.instruction) {
            *value = *number as f32;
        }
    }
}

/// The numbers of one feature, padded with zeros.
fn values(world: &World, state: &SimState, views: &Views, feature: StateFeature) -> [f32; 3] {
    let agent = &state.agent;
    let [x, y] = agent.position;
    let [vx, vy] = agent.velocity;
    match feature {
        StateFeature::Position => [x, y, 0.0],
        StateFeature::Heading => [agent.heading_deg, 0.0, 0.0],
        StateFeature::Velocity => [vx, vy, 0.0],
        StateFeature::Direction => {
            let [east, north] = agent.forward();
            [east, north, 0.0]
        }
        StateFeature::OwnVelocity => {
            let [ahead, right] = own_axes(state, agent.velocity);
            [ahead, right, 0.0]
        }
        StateFeature::Goal => {
            offset_in_own_axes(state, state.nearest(world, |object, own| is_goal(world, object, own)))
        }
        StateFeature::NearestTarget => {
            let due = |object: &Object, own: &ObjectState| pays_now(object, own) && state.is_due(object.order);
            offset_in_own_axes(state, state.nearest(world, due))
        }
        StateFeature::Counts => {
            let objects = || world.objects.iter().zip(&state.objects);
            let left = objects().filter(|(object, own)| pays_now(object, own)).count();
            let collected = objects().filter(|(_, own)| own.collected).count();
            [left as f32, collected as f32, 0.0]
        }
        StateFeature::LastReward => [state.last_reward as f32, 0.0, 0.0],
        StateFeature::LastEvent => state.last_event.map_or([0.0; 3], |event| {
            let number = match event.stimulus {
                Stimulus::AgentCollide => 1.0,
                Stimulus::AgentInteract => 2.0,
                Stimulus::AgentInRange => 3.0,
            };
            [number, event.reward as f32, f32::from(u8::from(event.destroyed))]
        }),
        StateFeature::Carrying => {
            let class = |index: u32| views.scene.items[index as usize].class_id;
            let last = state.carried.last();
            let (class, number) = last.map_or((0, 0), |&index| (class(index), index + 1));
            [state.carried.len() as f32, f32::from(class), number as f32]
        }
        StateFeature::Energy => [state.energy as f32, 0.0, 0.0],
        StateFeature::Zone => {
            let zones = || views.zones.around(agent.position.map(f64::from));
            let rate: f64 = zones().map(|zone| zone.reward_per_second).sum();
            [zones().count() as f32, rate as f32, 0.0]
        }
        StateFeature::StepsLeft => {
            let limit = world.step_limit().unwrap_or(0);
            let left = f64::from(limit.saturating_sub(state.steps)) / f64::from(limit.max(1));
            [if limit == 0 { 1.0 } else { left as f32 }, 0.0, 0.0]
        }
    }
}

/// Whether the goal feature may point to an object: it has the shaping's tag or, if shaping has no tag, touching it is a
/// success.
fn is_goal(world: &World, object: &Object, own: &ObjectState) -> bool {
    let Some(tag) = &object.tag else { return false };
    let rules = &world.rules;
    let wanted = rules.shaping.as_ref().and_then(|shaping| shaping.toward.as_ref());
    let is_touched = || rules.success.iter().any(|condition| condition.is_touch_of(object));
    own.present && wanted.map_or_else(is_touched, |wanted| wanted == tag)
}

/// The vector to an object, ahead and to the right in metres, and 1; all 0 without an object.
fn offset_in_own_axes(state: &SimState, index: Option<usize>) -> [f32; 3] {
    index.map_or([0.0; 3], |index| {
        let [ahead, right] = own_axes(state, state.offset_to(index));
        [ahead, right, 1.0]
    })
}

/// Converts a world vector to the agent's axes: ahead and to the right.
fn own_axes(state: &SimState, [x, y]: [f32; 2]) -> [f32; 2] {
    let [east, north] = state.agent.forward();
    [x * east + y * north, x * north - y * east]
}
