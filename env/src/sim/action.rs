//! [`Action`]: an agent's action in one step, and its conversion to a motion of the body.

use driftworld_spec::{ActionModel, ActionSpace, AgentParams, World};
use serde::{Deserialize, Serialize};

use crate::EnvError;

/// An agent's action for one step. It is held for all time steps of the step; an interaction happens only in the first one.
///
/// In JSON, a list of three numbers or the number of a row.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Action {
    /// Three numbers: in the units of the world's action model, or in −1..1 if its actions are normalised.
    Continuous([f64; 3]),
    /// A row of the world's action table, from 0.
    Discrete(usize),
}

/// A valid command for the body: finite, and within the agent's limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Intent {
    /// Degrees to turn clockwise, before moving.
    pub(crate) turn_deg: f32,
    /// Metres to move along the new heading.
    pub(crate) ahead: f32,
    /// A point to walk towards instead, and the distance to walk in metres.
    pub(crate) towards: Option<([f32; 2], f32)>,
    /// Whether to interact with objects ahead.
    pub(crate) interact: bool,
}

impl Action {
    /// The row, if it is one.
    pub fn row(self) -> Option<usize> {
        match self {
            Self::Discrete(row) => Some(row),
            Self::Continuous(_) => None,
        }
    }

    /// Its three numbers as they are; for a row, its number and two NaNs, which no action contains.
    pub fn raw_numbers(self) -> [f64; 3] {
        match self {
            Self::Discrete(row) => [row as f64, f64::NAN, f64::NAN],
            Self::Continuous(numbers) => numbers,
        }
    }

    /// The three numbers of the action, in the units of the world's action model.
    ///
    /// # Errors
    /// [`EnvError::NotDiscrete`] or [`EnvError::NoSuchAction`] for a row that does not exist, [`EnvError::NotFinite`] for
    /// numbers that are not finite.
    pub(crate) fn numbers(self, world: &World) -> Result<[f64; 3], EnvError> {
        let agent = &world.agent_params;
        match self {
            Self::Continuous(found) if !found.iter().all(|number| number.is_finite()) => {
                Err(EnvError::NotFinite { found })
            }
            Self::Continuous(fractions) if agent.actions == ActionSpace::Normalized => Ok(in_units(fractions, world)),
            Self::Continuous(numbers) => Ok(numbers),
            Self::Discrete(found) => {
                let rows = agent.num_actions().ok_or(EnvError::NotDiscrete { found })?;
                let row = agent.action_row(found).ok_or(EnvError::NoSuchAction {
                    found,
                    last: rows.saturating_sub(1),
                })?;
                // A table that was built in code may contain any numbers.
                if row.iter().all(|number| number.is_finite()) {
                    Ok(row)
                } else {
                    Err(EnvError::NotFinite { found: row })
                }
            }
        }
    }
}

/// Converts numbers in −1..1 to the units of the action model.
pub(crate) fn in_units(fractions: [f64; 3], world: &World) -> [f64; 3] {
    let agent = &world.agent_params;
    let [a, b, c] = fractions.map(|share| share.clamp(-1.0, 1.0));
    match agent.action_model {
        ActionModel::ByWaypoint => {
            let [x, y] = world.environment_params.arena_size();
            [a * x / 2.0, b * y / 2.0, c * agent.max_angular_speed]
        }
        ActionModel::ByVelocity | ActionModel::OnRails | ActionModel::None => {
            let interact = if c > 0.0 { 1.0 } else { 0.0 };
            [a * agent.max_linear_speed, b * agent.max_angular_speed, interact]
        }
    }
}

impl Intent {
    /// Interprets the three numbers under an action model, within the agent's limits.
    pub(crate) fn new(model: ActionModel, [a, b, c]: [f64; 3], agent: &AgentParams) -> Self {
        let seconds = agent.time_step;
        let turn = |rate: f64| (rate.clamp(-agent.max_angular_speed, agent.max_angular_speed) * seconds) as f32;
        match model {
            ActionModel::ByVelocity | ActionModel::OnRails => Self {
                turn_deg: turn(b),
                ahead: (a.clamp(-agent.max_linear_speed, agent.max_linear_speed) * seconds) as f32,
                towards: None,
                interact: agent.interact && c > 0.5,
            },
            ActionModel::ByWaypoint => Self {
                turn_deg: turn(c),
                towards: Some((
                    [a, b].map(|metres| metres.clamp(-1e6, 1e6) as f32),
                    (agent.max_linear_speed * seconds) as f32,
                )),
                ..Self::default()
            },
            ActionModel::None => Self::default(),
        }
    }
}
