//! [`WorldOverrides`]: what an environment's options lay over each of its worlds. Where the worlds come from is in `supply.rs`.

use driftworld_spec::{ActionModel, ActionSpace, AgentParams, Modality, SpecError, StateFeature, World, WorldDraft};
use serde::Deserialize;
use serde_json::{Value, json};

/// Options that stand in place of what worlds say; what is `None` stays as it is.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct WorldOverrides {
    modalities: Option<Vec<Modality>>,
    /// Whether observations have no state vector: what that would hold does not matter then.
    stateless: bool,
    /// Height and width in pixels.
    size: Option<[u32; 2]>,
    actions: Option<ActionSpace>,
    /// Whether actions that are numbers, in a world's units, are −1..1 in place of them.
    normalizes: bool,
    interact: Option<bool>,
    frame_skip: Option<u32>,
    max_steps: Option<u32>,
    supersampling: Option<u32>,
}

impl WorldOverrides {
    /// Lays the options over a world.
    pub(crate) fn apply(&self, world: &mut WorldDraft) {
        let agent = &mut world.agent_params;
        if let Some(modalities) = &self.modalities {
            agent.modalities.clone_from(modalities);
        }
        if self.stateless {
            agent.state_features = StateFeature::CLASSIC.to_vec();
        }
        if let Some([height, width]) = self.size {
            agent.observation_size = height;
            agent.observation_width = (width != height).then_some(width);
        }
        if let Some(actions) = &self.actions {
            agent.actions.clone_from(actions);
        }
        if self.normalizes && agent.actions == ActionSpace::Continuous {
            agent.actions = ActionSpace::Normalized;
        }
        lay(&mut agent.interact, self.interact);
        lay(&mut agent.frame_skip, self.frame_skip);
        lay(&mut agent.supersampling, self.supersampling);
        if let Some(max_steps) = self.max_steps {
            world.limit_steps(max_steps);
        }
    }

    /// The names of the options that stand in place of what every world says.
    pub(crate) fn given(&self) -> Vec<&'static str> {
        let given = [
            ("modalities", self.modalities.is_some()),
            ("size", self.size.is_some()),
            ("actions", self.actions.is_some()),
            ("interact", self.interact.is_some()),
            ("frame_skip", self.frame_skip.is_some()),
            ("supersampling", self.supersampling.is_some()),
            ("max_steps", self.max_steps.is_some()),
        ];
        given
            .into_iter()
            .filter(|(_, is_given)| *is_given)
            .map(|(name, _)| name)
            .collect()
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Whether a world is sound with these options, and what an environment of it looks like from outside.
    ///
    /// # Errors
    /// [`SpecError`] with every value out of its range.
    pub(crate) fn checked_layout(&self, world: World) -> Result<Value, SpecError> {
        let mut draft = world.into_draft();
        self.apply(&mut draft);
        let text = serde_json::to_string(&draft).expect("a world has string keys only, which always serialise");
        Ok(layout(&World::from_json("options", &text)?))
    }
}

fn lay<T: Copy>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

/// What the spaces of an environment are made from.
fn layout(world: &World) -> Value {
    let agent = &world.agent_params;
    let [width, height] = agent.picture_size();
    json!({
        "height": height,
        "width": width,
        "modalities": agent.modalities,
        "state_features": agent.state_features,
        "state_len": agent.state_len(),
        "max_steps": world.step_limit().unwrap_or(0),
        "seconds_per_step": agent.time_step * f64::from(agent.frame_skip.max(1)),
        "action_model": agent.action_model,
        "action": action(agent, world.environment_params.arena_size()),
    })
}

/// The number of rows, or the bounds of the numbers that are looked at.
fn action(agent: &AgentParams, [x, y]: [f64; 2]) -> Value {
    if let Some(rows) = agent.num_actions() {
        return json!({ "n": rows });
    }
    let (speed, turn) = (agent.max_linear_speed, agent.max_angular_speed);
    let mut low_high = match agent.action_model {
        ActionModel::ByWaypoint => vec![[-x / 2.0, x / 2.0], [-y / 2.0, y / 2.0], [-turn, turn]],
        ActionModel::ByVelocity | ActionModel::OnRails | ActionModel::None => {
            let mut numbers = vec![[-speed, speed], [-turn, turn]];
            if agent.interact {
                numbers.push([0.0, 1.0]);
            }
            numbers
        }
    };
    if agent.actions == ActionSpace::Normalized {
        low_high.fill([-1.0, 1.0]);
    }
    json!({ "bounds": low_high })
}
