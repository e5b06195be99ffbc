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
        /// What the numbers of an action mean.
        pub action_model: ActionModel = ActionModel::ByVelocity => Field::original(Leaves(ModelOfActions)),
        /// Height of the camera above the ground in metres.
        #[schemars(range(min = 0.1, max = 10.0))]
        pub agent_height: f64 = 1.0 => Field::original(Leaves(CameraAndWeather)).unit("m"),
        /// Width (diameter) of the agent's collider in metres.
        #[schemars(range(min = 0.05, max = 10.0))]
        pub agent_width: f64 = 1.0 => Field::original(Measured(&[Width])).unit("m"),
        /// Largest speed in metres per second.
        #[schemars(range(min = 0.0, max = 100.0))]
        pub max_linear_speed: f64 = 10.0 => Field::original(Measured(&[LargestSpeed])).unit("m/s"),
        /// Largest turn rate in degrees per second.
        #[schemars(range(min = 0.0, max = 3600.0))]
        pub max_angular_speed: f64 = 90.0 => Field::original(Measured(&[LargestTurnRate])).unit("degrees/s"),
        /// Height of the observations in pixels, and their width unless `observation_width` says otherwise.
        #[schemars(range(min = 1, max = 4096))]
        pub observation_size: u32 = 84 => Field::original(Measured(&[CameraAndWeather])).unit("pixels"),
        /// Width of the observations in pixels; as high as wide if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1, max = 4096))]
        pub observation_width: Option<u32> = None => Field::ours(Measured(&[CameraAndWeather])).unit("pixels"),
        /// Points per pixel along each side that colours are the mean of: 1 is fast, 2 and more are smooth.
        #[serde(skip_serializing_if = "is_one")]
        #[schemars(range(min = 1, max = 4))]
        pub supersampling: u32 = 1 => Field::ours(Leaves(CameraAndWeather)),
        /// Start position in metres.
        #[schemars(inner(range(min = -300.0, max = 300.0)))]
        pub coordinates: [f64; 2] = [0.0, 0.0] => Field::original(Measured(&[Start])).unit("m"),
        /// Start heading in degrees: 0 looks along +y, growing clockwise.
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
        /// Which images an observation holds. Segmentation by reward category shows what is worth what, so it is none of them
        /// unless it is asked for.
        #[schemars(length(max = 5))]
        pub modalities: Vec<Modality> = vec![Modality::Rgb, Modality::Depth]
            => Field::ours(Leaves(CameraAndWeather)),
        /// What the state vector holds, in this order.
        #[serde(skip_serializing_if = "is_classic")]
        #[schemars(length(max = 20))]
        pub state_features: Vec<StateFeature> = StateFeature::CLASSIC.to_vec() => Field::ours(Leaves(CameraAndWeather)),
        /// Numbers that tell the agent what to do, after the features in the state vector: say 1 for the colour that is wanted,
        /// 0 for the others.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(length(max = 64), inner(range(min = -1e6, max = 1e6)))]
        pub instruction: Vec<f64> = Vec::new() => Field::ours(Leaves(CameraAndWeather)),
        /// How actions are given.
        pub actions: ActionSpace = ActionSpace::Continuous => Field::ours(Leaves(SpaceOfActions)),
        /// Whether the agent can interact: without, the third number of an action by velocity is ignored, and the default table of
        /// actions has no row for it.
        #[serde(skip_serializing_if = "is_true")]
        pub interact: bool = true => Field::ours(Leaves(SpaceOfActions)),
        /// How many things the agent can carry at once; 0 is none.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = 0, max = 100))]
        pub carry_limit: u32 = 0 => Field::ours(Leaves(SpaceOfActions)),
        /// Whether pictures from the agent's eyes show what it carries: small, at the lower edge of the colours, and in
        /// no other image.
        #[serde(skip_serializing_if = "is_default")]
        pub show_carried: bool = false => Field::ours(Leaves(CameraAndWeather)),
        /// The agent's energy, which falls and rises; without it there is none. What comes of it is said by an end condition and by the
        /// state feature `energy`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub energy: Option<Energy> = None => Field::ours(Leaves(EnergyOfAgent)),
    }
}

fields! {
    /// How the agent's energy changes. It is never less than 0 and never more than `most`. Objects give it by their `energy`.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "start": 100, "per_second": -1, "per_metre": -0.1, "most": 100 }]))]
    pub struct Energy {
        /// What the agent has at the start.
        #[schemars(range(min = 0.0, max = 1e9))]
        pub start: f64 = 100.0 => Field::ours(AsPart),
        /// What every second of the world's own time adds; less than 0 to use it up.
        #[schemars(range(min = -1e9, max = 1e9))]
        pub per_second: f64 = -1.0 => Field::ours(AsPart).unit("1/s"),
        /// What every metre adds that the agent goes.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub per_metre: f64 = 0.0 => Field::ours(AsPart).unit("1/m"),
        /// The most that it can have.
        #[schemars(range(min = 0.0, max = 1e9))]
        pub most: f64 = 100.0 => Field::ours(AsPart),
    }
}

fn is_classic(features: &[StateFeature]) -> bool {
    features == StateFeature::CLASSIC
}

impl AgentParams {
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

/// How a learner hands in actions.
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
    /// Three numbers in −1..1, cut off there: shares of the largest speed and turn rate, under `bywaypoint` of half the arena's
    /// sides; above 0 is to interact.
    Normalized,
    /// The number of a row of a table that comes with the agent: ahead, ahead and left, ahead and right, left,
    /// right, back, and interact if it can; not under `bywaypoint`, which knows no ahead.
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
