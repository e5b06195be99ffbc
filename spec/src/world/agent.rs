//! The agent's body, what it can do and what it sees. How it moves is computed in `env`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The agent: where it starts, how it moves, what it observes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct AgentParams {
    /// What the numbers of an action mean.
    pub action_model: ActionModel,
    /// Height of the camera above the ground in metres.
    #[schemars(range(min = 0.1, max = 10.0))]
    pub agent_height: f64,
    /// Width (diameter) of the agent's collider in metres.
    #[schemars(range(min = 0.05, max = 10.0))]
    pub agent_width: f64,
    /// Largest speed in metres per second.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub max_linear_speed: f64,
    /// Largest turn rate in degrees per second.
    #[schemars(range(min = 0.0, max = 3600.0))]
    pub max_angular_speed: f64,
    /// Height of the observations in pixels, and their width unless `observation_width` says otherwise.
    #[schemars(range(min = 1, max = 4096))]
    pub observation_size: u32,
    /// Width of the observations in pixels; as high as wide if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 4096))]
    pub observation_width: Option<u32>,
    /// Points per pixel along each side that colours are the mean of: 1 is fast, 2 and more are smooth.
    #[serde(skip_serializing_if = "is_one")]
    #[schemars(range(min = 1, max = 4))]
    pub supersampling: u32,
    /// Start position in metres.
    #[schemars(inner(range(min = -300.0, max = 300.0)))]
    pub coordinates: [f64; 2],
    /// Start heading in degrees: 0 looks along +y, growing clockwise.
    #[schemars(range(min = 0.0, max = 360.0))]
    pub heading: f64,
    /// Simulated seconds per step.
    #[schemars(range(min = 0.001, max = 10.0))]
    pub time_step: f64,
    /// Vertical field of view in degrees.
    #[schemars(range(min = 1.0, max = 170.0))]
    pub field_of_view: f64,
    /// Which images an observation holds.
    #[schemars(length(max = 5))]
    pub modalities: Vec<Modality>,
    /// How actions are given.
    pub actions: ActionSpace,
}

impl Default for AgentParams {
    fn default() -> Self {
        Self {
            action_model: ActionModel::ByVelocity,
            agent_height: 1.0,
            agent_width: 1.0,
            max_linear_speed: 10.0,
            max_angular_speed: 90.0,
            observation_size: 84,
            observation_width: None,
            supersampling: 1,
            coordinates: [0.0, 0.0],
            heading: 0.0,
            time_step: 0.1,
            field_of_view: 60.0,
            modalities: vec![Modality::Rgb, Modality::Depth, Modality::Segmentation],
            actions: ActionSpace::Continuous,
        }
    }
}

impl AgentParams {
    /// Width and height of the observations in pixels.
    pub fn picture_size(&self) -> [u32; 2] {
        [
            self.observation_width.unwrap_or(self.observation_size),
            self.observation_size,
        ]
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands the field by reference")]
fn is_one(value: &u32) -> bool {
    *value == 1
}

/// What the three numbers of an action mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ActionModel {
    /// Speed in m/s, turn rate in °/s (positive turns right), interact if above 0.5.
    ByVelocity,
    /// A point (x, y) in metres to walk to, and a camera turn rate in °/s.
    ByWaypoint,
    /// Input is ignored: the agent tours all objects of positive reward by itself, nearest first.
    OnRails,
    /// Input is ignored: the agent stands still.
    None,
}

/// One kind of image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Modality {
    /// Colour, `(size, size, 3)` bytes.
    Rgb,
    /// Distance along the view axis in metres, `(size, size)` floats.
    Depth,
    /// Reward category per pixel, `(size, size)` bytes.
    Segmentation,
    /// Object class per pixel, `(size, size)` numbers from 1 in order of first appearance in the world; 0 where there is no object.
    Class,
    /// Object per pixel, `(size, size)` numbers: its index in the world plus 1; 0 where there is no object.
    Instance,
}

/// How a learner hands in actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ActionSpace {
    /// Three numbers, in the units of the action model.
    Continuous,
    /// The number of a row of this table; each row holds three numbers in the units of the action model.
    Discrete(#[schemars(length(min = 1, max = 1000))] Vec<[f64; 3]>),
}
