//! The agent's body, abilities and senses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::StateFeature;
use super::camera::{DEFAULT_FIELD_OF_VIEW, Modality};
use super::fields::{Field, FieldPlace, Place, fields, word};
use crate::serde_defaults::{is_default, is_one, is_true};
use crate::value::{ParameterType, Value};

fields! {
    /// The agent: where it starts, how it moves, what it observes.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "action_model": "byvelocity", "coordinates": [0, 0], "heading": 90, "observation_size": 84 },
    ]))]
    pub struct AgentParams {
        /// The meaning of the numbers of an action.
        pub action_model: ActionModel = ActionModel::ByVelocity => Field::original(Leaves(ModelOfActions)),
        /// Height of the camera above the ground in metres.
        #[schemars(range(min = 0.1, max = 10.0))]
        pub agent_height: f64 = 1.0 => Field::original(Leaves(CameraAndWeather)).unit("m"),
        /// Width (diameter) of the agent's collider in metres.
        #[schemars(range(min = 0.05, max = 10.0))]
        pub agent_width: f64 = 1.0 => Field::original(Measured(&[Width])).unit("m"),
        /// Maximum speed in metres per second.
        #[schemars(range(min = 0.0, max = 100.0))]
        pub max_linear_speed: f64 = 10.0 => Field::original(Measured(&[LargestSpeed])).unit("m/s"),
        /// Maximum turn rate in degrees per second.
        #[schemars(range(min = 0.0, max = 3600.0))]
        pub max_angular_speed: f64 = 90.0 => Field::original(Measured(&[LargestTurnRate])).unit("degrees/s"),
        /// Height of the observations in pixels, and also their width unless `observation_width` is set.
        #[schemars(range(min = 1, max = 4096))]
        pub observation_size: u32 = 84 => Field::original(Measured(&[CameraAndWeather])).unit("pixels"),
        /// Width of the observations in pixels; the same as their height if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1, max = 4096))]
        pub observation_width: Option<u32> = None => Field::ours(Measured(&[CameraAndWeather])).unit("pixels"),
        /// Sample points per pixel along each side, averaged to its colour: 1 is fast, 2 and more are smooth.
        #[serde(skip_serializing_if = "is_one")]
        #[schemars(range(min = 1, max = 4))]
        pub supersampling: u32 = 1 => Field::ours(Leaves(CameraAndWeather)),
        /// Start position in metres.
        #[schemars(inner(range(min = -300.0, max = 300.0)))]
        pub coordinates: [f64; 2] = [0.0, 0.0] => Field::original(Measured(&[Start])).unit("m"),
        /// Start heading in degrees clockwise from +y.
        #[schemars(range(min = 0.0, max = 360.0))]
        pub heading: f64 = 0.0 => Field::original(Measured(&[Heading])).heading(),
        /// Simulated seconds per time step.
        #[schemars(range(min = 0.001, max = 10.0))]
        pub time_step: f64 = 0.1 => Field::ours(Measured(&[TimeStep, StepReward, Limit])).unit("s"),
        /// Time steps for which each action is held: a step of the environment lasts this many.
        #[serde(skip_serializing_if = "is_one")]
        #[schemars(range(min = 1, max = 1000))]
        pub frame_skip: u32 = 1 => Field::ours(Measured(&[TimeStep, StepReward, Limit])),
        /// Vertical field of view in degrees.
        #[schemars(range(min = 1.0, max = 170.0))]
        pub field_of_view: f64 = DEFAULT_FIELD_OF_VIEW => Field::ours(Leaves(CameraAndWeather)).unit("degrees"),
        /// The images in an observation. Segmentation by reward category reveals the value of each object, so it is not
        /// included unless requested.
        #[schemars(length(max = 5))]
        pub modalities: Vec<Modality> = vec![Modality::Rgb, Modality::Depth]
            => Field::ours(Leaves(CameraAndWeather)),
        /// The contents of the state vector, in this order.
        #[serde(skip_serializing_if = "is_classic")]
        #[schemars(length(max = 20))]
        pub state_features: Vec<StateFeature> = StateFeature::CLASSIC.to_vec() => Field::ours(Leaves(CameraAndWeather)),
        /// Numbers that tell the agent what to do, appended to the features in the state vector: for example, 1 for the wanted
        /// colour, 0 for the others.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(length(max = 64), inner(range(min = -1e6, max = 1e6)))]
        pub instruction: Vec<f64> = Vec::new() => Field::ours(Leaves(CameraAndWeather)),
        /// The form in which actions are given.
        pub actions: ActionSpace = ActionSpace::Continuous => Field::ours(Leaves(SpaceOfActions)),
        /// Whether the agent can interact. If not, the third number of an action by velocity is ignored, and the default table
        /// of actions has no row for interacting.
        #[serde(skip_serializing_if = "is_true")]
        pub interact: bool = true => Field::ours(Leaves(SpaceOfActions)),
        /// Number of things that the agent can carry at once; 0 means none.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = 0, max = 100))]
        pub carry_limit: u32 = 0 => Field::ours(Leaves(SpaceOfActions)),
        /// Whether colour images from the agent's view show what it carries, small and at the lower edge; other kinds of image
        /// never do.
        #[serde(skip_serializing_if = "is_default")]
        pub show_carried: bool = false => Field::ours(Leaves(CameraAndWeather)),
        /// The agent's energy, which falls and rises; if absent, the agent has no energy. It takes effect through end
        /// conditions and the state feature `energy`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub energy: Option<Energy> = None => Field::ours(Leaves(EnergyOfAgent)),
    }
}

fields! {
    /// How the agent's energy changes. It stays between 0 and `most`. Objects add to it by their `energy`.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "start": 100, "per_second": -1, "per_metre": -0.1, "most": 100 }]))]
    pub struct Energy {
        /// Energy at the start.
        #[schemars(range(min = 0.0, max = 1e9))]
        pub start: f64 = 100.0 => Field::ours(AsPart),
        /// Energy gained per simulated second; below 0, energy is used up.
        #[schemars(range(min = -1e9, max = 1e9))]
        pub per_second: f64 = -1.0 => Field::ours(AsPart).unit("1/s"),
        /// Energy gained per metre that the agent moves.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub per_metre: f64 = 0.0 => Field::ours(AsPart).unit("1/m"),
        /// Maximum energy.
        #[schemars(range(min = 0.0, max = 1e9))]
        pub most: f64 = 100.0 => Field::ours(AsPart),
    }
}

fn is_classic(features: &[StateFeature]) -> bool {
    features == StateFeature::CLASSIC
}

impl AgentParams {
    /// Width and height of the observations in pixels.
    pub fn picture_size(&self) -> [u32; 2] {
        [
            self.observation_width.unwrap_or(self.observation_size),
            self.observation_size,
        ]
    }

    /// Number of rows in the table of actions; `None` for continuous actions.
    pub fn num_actions(&self) -> Option<usize> {
        match &self.actions {
            ActionSpace::Continuous | ActionSpace::Normalized => None,
            ActionSpace::Discrete(table) => Some(table.len()),
            ActionSpace::DefaultDiscrete => Some(6 + usize::from(self.interact)),
        }
    }

    /// A row of the table of actions: three numbers in the units of the action model; `None` if there is no such row.
    ///
    /// The default table is: forwards; forwards and left; forwards and right; left; right; backwards; and, if the agent can
    /// interact, interact. It moves and turns at the agent's maximum speeds, and backwards at half speed.
    pub fn action_row(&self, number: usize) -> Option<[f64; 3]> {
        let (speed, turn) = (self.max_linear_speed, self.max_angular_speed);
        match &self.actions {
            ActionSpace::Continuous | ActionSpace::Normalized => None,
            ActionSpace::Discrete(table) => table.get(number).copied(),
            ActionSpace::DefaultDiscrete => match number {
                0 => Some([speed, 0.0, 0.0]),
                1 => Some([speed, -turn, 0.0]),
                2 => Some([speed, turn, 0.0]),
                3 => Some([0.0, -turn, 0.0]),
                4 => Some([0.0, turn, 0.0]),
                5 => Some([-speed / 2.0, 0.0, 0.0]),
                6 if self.interact => Some([0.0, 0.0, 1.0]),
                _ => None,
            },
        }
    }

    /// Length of the state vector.
    pub fn state_len(&self) -> usize {
        let features = self.state_features.iter().map(|feature| feature.num_values());
        features.sum::<usize>() + self.instruction.len()
    }
}

/// The meaning of the three numbers of an action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ActionModel {
    /// Speed in m/s, turn rate in °/s (positive turns right), interact if above 0.5.
    ByVelocity,
    /// A point (x, y) in metres to walk to, and a camera turn rate in °/s.
    ByWaypoint,
    /// Input is ignored: the agent visits all objects with positive reward by itself, nearest first.
    OnRails,
    /// Input is ignored: the agent stands still.
    None,
}

/// The form in which a learner gives actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(extend("examples" = [
    "continuous",
    "default_discrete",
    { "discrete": [[5, 0, 0], [0, -90, 0], [0, 90, 0]] },
]))]
pub enum ActionSpace {
    /// Three numbers, in the units of the action model.
    Continuous,
    /// Three numbers, clipped to −1..1: shares of the maximum speed and turn rate, or of half the arena's sides under
    /// `bywaypoint`; a third number above 0 interacts.
    Normalized,
    /// The number of a row of a built-in table: forwards, forwards and left, forwards and right, left, right, backwards, and
    /// interact if the agent can; not under `bywaypoint`, which has no direction ahead.
    DefaultDiscrete,
    /// The number of a row of this table; each row holds three numbers in the units of the action model.
    Discrete(#[schemars(length(min = 1, max = 1000))] Vec<[f64; 3]>),
}

impl Place for ActionSpace {
    const KIND: ParameterType = ParameterType::String;

    fn from_value(value: &Value) -> Option<Self> {
        serde_json::from_value(value.to_json()).ok()
    }

    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        let ["discrete", row, number] = words else { return None };
        steps.push(row.parse().ok()?);
        steps.push(number.parse().ok()?);
        Some(ParameterType::Number)
    }

    fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        let (Self::Discrete(table), [row, number]) = (self, steps) else {
            return None;
        };
        table.get_mut(*row)?.get_mut(*number)?.set(&[], value)
    }

    fn list_inside(pointer: &str, field: &Field, found: &mut Vec<FieldPlace>) {
        f64::list(format!("{pointer}/discrete/*/*"), field, false, found);
    }
}

word!(ActionModel);
word!(Modality);
