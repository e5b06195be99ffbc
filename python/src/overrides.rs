//! [`WorldOverrides`]: an environment's options that override values of its worlds.

use driftworld_spec::{
    ActionModel, ActionSpace, AgentParams, Modality, Resolved, SpecError, StateFeature, Value, Variant, World,
    WorldDraft,
};
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};

/// Options that override values of worlds; `None` keeps a value.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct WorldOverrides {
    modalities: Option<Vec<Modality>>,
    /// Whether observations have no state vector, so that its contents do not matter.
    stateless: bool,
    /// Height and width in pixels.
    size: Option<[u32; 2]>,
    actions: Option<ActionSpace>,
    /// Whether numeric actions in a world's units are replaced by −1..1.
    normalizes: bool,
    interact: Option<bool>,
    frame_skip: Option<u32>,
    max_steps: Option<u32>,
    supersampling: Option<u32>,
}

impl WorldOverrides {
    /// Applies the options to a world.
    pub(crate) fn apply(&self, world: &mut WorldDraft) {
        let agent = &mut world.agent_params;
        if let Some(modalities) = &self.modalities {
            agent.modalities.clone_from(modalities);
        }
        if self.stateless {
            agent.state_features = StateFeature::CLASSIC.to_vec();
            agent.instruction.clear();
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

    /// Whether there are no options.
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Checks a world with these options, and returns the layout of an environment for it.
    ///
    /// # Errors
    /// [`SpecError`] with every value out of range.
    pub(crate) fn checked_layout(&self, world: World, reach: &Reach) -> Result<Json, SpecError> {
        let mut draft = world.into_draft();
        self.apply(&mut draft);
        let text = serde_json::to_string(&draft).expect("a world has string keys only, which always serialise");
        Ok(layout(&World::from_json("options", &text)?, reach))
    }
}

/// The largest values that bound actions, if a variant draws them for each world.
#[derive(Default)]
pub(crate) struct Reach {
    speed: Option<f64>,
    turn: Option<f64>,
    /// The longest side of an arena, for actions that are waypoints.
    side: Option<f64>,
}

impl Reach {
    pub(crate) fn of(variant: &Variant) -> Self {
        let mut reach = Self::default();
        for hole in &variant.task().world().holes {
            let drawn = match variant.resolve(&hole.source) {
                Resolved::Value(_) => continue,
                Resolved::Draw(distribution) => Some(distribution),
                Resolved::Randomized(reference) => variant.distribution(&reference.param),
            };
            let place = match hole.pointer.as_str() {
                "/agent_params/max_linear_speed" => &mut reach.speed,
                "/agent_params/max_angular_speed" => &mut reach.turn,
                pointer if ARENA.iter().any(|key| pointer.starts_with(key)) => {
                    reach.side = Some(LONGEST_SIDE);
                    continue;
                }
                _ => continue,
            };
            // Unbounded distributions are limited by the key's range: worlds outside are refused.
            let numbers = drawn.and_then(|drawn| drawn.support());
            let numbers = numbers.and_then(|values| values.iter().map(Value::as_number).collect::<Option<Vec<f64>>>());
            let greatest = match numbers {
                // Noise of 0 has a constant value.
                Some(numbers) if numbers.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq()) => continue,
                Some(numbers) => numbers.into_iter().fold(hole.range[0], f64::max),
                None => hole.range[1],
            };
            *place = Some(greatest.min(hole.range[1]));
        }
        reach
    }
}

/// Keys of a world that determine the size of its arena.
const ARENA: [&str; 3] = [
    "/environment_params/map_size",
    "/environment_params/layout",
    "/environment_params/predefined_map",
];
/// The longest side of an arena in metres.
const LONGEST_SIDE: f64 = 300.0;

fn lay<T: Copy>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

/// The data from which an environment's spaces are built.
fn layout(world: &World, reach: &Reach) -> Json {
    let agent = &world.agent_params;
    let [width, height] = agent.picture_size();
    json!({
        "height": height,
        "width": width,
        "modalities": agent.modalities,
        "state_features": agent.state_features,
        "instruction_len": agent.instruction.len(),
        "state_len": agent.state_len(),
        "max_steps": world.step_limit().unwrap_or(0),
        "seconds_per_step": agent.time_step * f64::from(agent.frame_skip.max(1)),
        "action_model": agent.action_model,
        "action": action(agent, world.environment_params.arena_size(), reach),
    })
}

/// The number of rows of the action table, or the bounds of the numbers that actions use.
fn action(agent: &AgentParams, [x, y]: [f64; 2], reach: &Reach) -> Json {
    if let Some(rows) = agent.num_actions() {
        return json!({ "n": rows });
    }
    let speed = reach.speed.unwrap_or(agent.max_linear_speed);
    let turn = reach.turn.unwrap_or(agent.max_angular_speed);
    let [x, y] = reach.side.map_or([x, y], |side| [side; 2]);
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
    let places = agent.action_model == ActionModel::ByWaypoint;
    let mut drawn = reach.turn.is_some()
        || if places {
            reach.side.is_some()
        } else {
            reach.speed.is_some()
        };
    if agent.actions == ActionSpace::Normalized {
        low_high.fill([-1.0, 1.0]);
        drawn = false;
    }
    json!({ "bounds": low_high, "drawn": drawn })
}
