//! What an agent can do, and what comes of it as motion. What the motion runs into is in `body.rs`.

use driftworld_spec::{ActionModel, ActionSpace, AgentParams};

use crate::EnvError;

/// What an agent does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Three numbers in the units of the world's action model.
    Continuous([f64; 3]),
    /// A row of the world's action table.
    Discrete(usize),
}

/// An action that can be carried out: limits are kept, numbers are finite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Intent {
    /// Degrees to turn clockwise, before moving.
    pub(crate) turn_deg: f32,
    /// Metres to move along the new heading.
    pub(crate) ahead: f32,
    /// A point to walk towards instead, and how many metres of the way.
    pub(crate) towards: Option<([f32; 2], f32)>,
    /// Whether to interact with what is ahead.
    pub(crate) interact: bool,
}

impl Action {
    /// The three numbers of the action.
    ///
    /// # Errors
    /// [`EnvError`] for a row that is not there and for numbers that are not finite.
    pub(crate) fn numbers(self, space: &ActionSpace) -> Result<[f64; 3], EnvError> {
        let numbers = match (self, space) {
            (Self::Continuous(numbers), _) => numbers,
            (Self::Discrete(found), ActionSpace::Continuous) => return Err(EnvError::NotDiscrete { found }),
            (Self::Discrete(found), ActionSpace::Discrete(table)) => {
                *table.get(found).ok_or(EnvError::NoSuchAction {
                    found,
                    last: table.len().saturating_sub(1),
                })?
            }
        };
        if numbers.iter().all(|number| number.is_finite()) {
            Ok(numbers)
        } else {
            Err(EnvError::NotFinite { found: numbers })
        }
    }
}

impl Intent {
    /// What the three numbers mean under an action model, within the agent's limits.
    pub(crate) fn new(model: ActionModel, [a, b, c]: [f64; 3], agent: &AgentParams) -> Self {
        let seconds = agent.time_step;
        let turn = |rate: f64| (rate.clamp(-agent.max_angular_speed, agent.max_angular_speed) * seconds) as f32;
        match model {
            ActionModel::ByVelocity | ActionModel::OnRails => Self {
                turn_deg: turn(b),
                ahead: (a.clamp(-agent.max_linear_speed, agent.max_linear_speed) * seconds) as f32,
                towards: None,
                interact: c > 0.5,
            },
            ActionModel::ByWaypoint => Self {
                turn_deg: turn(c),
                towards: Some(([a as f32, b as f32], (agent.max_linear_speed * seconds) as f32)),
                ..Self::default()
            },
            ActionModel::None => Self::default(),
        }
    }
}
