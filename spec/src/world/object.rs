//! [`Object`]: an object of a world, its appearance, motion and rewards.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};

use super::fields::{Place, fields, word};
use super::stimulus::{Stimulus, Trigger};
use super::{Door, Portable, Surface, Switch};
use crate::Color;
use crate::limits::MAX_SEED;
use crate::schema::wording::TEXT_PATTERN;
use crate::serde_defaults::{half, is_default, is_one, one, yes};
use crate::value::{ParameterType, Value};

fields! {
    /// An object: its appearance, position, motion and reward.
    ///
    /// Every field but `class` and `coordinates` has a default.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "class": "geometric", "model": "1", "coordinates": [0, 10], "color": "red", "reward": 100,
            "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"] },
    ]))]
    pub struct Object {
        /// Kind of asset: `geometric`, `tree`, `barrel`, …; commands reject unknown classes and models.
        #[schemars(length(min = 1, max = 100))]
        pub class: String = String::new() => Field::original(Measured(&[Unmatched, Rewards, UnmatchedLooks])),
        /// The asset of the class: its name, such as `sphere` or `fox`, or its number from "1".
        #[serde(default)]
        pub model: Model = Model::default() => Field::original(Leaves(ModelsOfObjects)),
        /// The model (of the same class) whose body this object uses, whatever it looks like: the shape that is collided with,
        /// and the height from which range is measured. Defaults to the object's own model.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub body_model: Option<Model> = None => Field::ours(Leaves(Bodies)),
        /// The text of a sign, in block letters on its front: capital letters, digits, spaces and `! ? < > + -`. Only the class
        /// `sign` shows it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(max = 8), regex(pattern = TEXT_PATTERN))]
        pub text: Option<String> = None => Field::ours(Leaves(ModelsOfObjects)),
        /// Position on the ground in metres.
        #[schemars(inner(range(min = -300.0, max = 300.0)))]
        pub coordinates: [f64; 2] = [0.0; 2] => Field::original(Measured(&[PlacesOfObjects])).unit("m"),
        /// The direction the object faces, in degrees clockwise from +y.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 360.0))]
        pub heading: f64 = 0.0 => Field::ours(Measured(&[HeadingsOfObjects])).heading(),
        /// Size relative to the asset's natural size.
        #[serde(default = "one")]
        #[schemars(range(min = 0.01, max = 100.0))]
        pub scale: f64 = 1.0 => Field::ours(Measured(&[SizesOfObjects])),
        /// Main colour; the asset's own colours if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub color: Option<Color> = None => Field::original(Measured(&[ColorsOfObjects])),
        /// Its surface pattern, shown only in worlds with natural looks; drawn at its own size in metres regardless of `scale`.
        #[serde(default, skip_serializing_if = "is_default")]
        pub surface: Surface = Surface::Plain => Field::ours(Leaves(ModelsOfObjects)),
        /// Whether it stops the agent.
        #[serde(default = "yes")]
        pub solid: bool = true => Field::ours(Leaves(Bodies)),
        /// Makes it a body that the agent can push along the ground; absent if it stays put. Only solid objects that do not
        /// move by themselves can be pushed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pushable: Option<Pushable> = None => Field::ours(Leaves(Bodies)),
        /// Reward each time the object is triggered.
        #[serde(default)]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub reward: f64 = 0.0 => Field::original(Measured(&[Rewards])),
        /// Probability that a trigger pays the reward (a bandit arm), 0..1.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        #[schemars(range(min = 0.0, max = 1.0))]
        pub reward_probability: f64 = 1.0 => Field::ours(Measured(&[RewardProbabilities])),
        /// Stimuli that pay `reward` every time they occur.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 3))]
        pub reward_stimulus: Vec<Stimulus> = Vec::new() => Field::original(Leaves(PaidFor)),
        /// Stimuli that pay `reward` once, after which the object's reward is 0.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 3))]
        pub reward_once_stimulus: Vec<Stimulus> = Vec::new() => Field::original(Leaves(PaidFor)),
        /// Stimuli that destroy the object.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 3))]
        pub destroy_stimulus: Vec<Stimulus> = Vec::new() => Field::original(Leaves(Bodies)),
        /// Distance from centre to centre in metres below which `AgentInRange` holds.
        #[serde(default, skip_serializing_if = "is_default")]
        #[schemars(range(min = 0.0, max = 1000.0))]
        pub range_stimulus_distance: f64 = 0.0 => Field::original(Leaves(PaidFor)).unit("m"),
        /// How the object moves by itself.
        #[serde(default)]
        pub motion_model: MotionModel = MotionModel::Stationary => Field::original(Leaves(Motion)),
        /// Speed of the object's own motion in metres per second.
        #[serde(default, skip_serializing_if = "is_default")]
        #[schemars(range(min = 0.0, max = 100.0))]
        pub speed: f64 = 0.0 => Field::ours(Leaves(Motion)).unit("m/s"),
        /// Maximum turn rate of the object's own motion in degrees per second; turns instantly if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 3600.0))]
        pub turn_rate: Option<f64> = None => Field::ours(Leaves(Motion)).unit("degrees/s"),
        /// How far a predator or prey sees the agent in metres, from centre to centre; everywhere if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 1000.0))]
        pub sight_range: Option<f64> = None => Field::ours(Leaves(Motion)).unit("m"),
        /// Points in metres that the object walks along, in order, then back to the first.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 1000), inner(inner(range(min = -1e4, max = 1e4))))]
        pub waypoints: Vec<[f64; 2]> = Vec::new() => Field::ours(Leaves(Motion)).unit("m"),
        /// Position in a scavenger sequence, from 1: it pays only once all objects with lower numbers have been collected.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1, max = 100_000))]
        pub order: Option<u32> = None => Field::ours(Leaves(PaidFor)),
        /// How the object comes back after it was destroyed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub respawn: Option<Respawn> = None => Field::ours(Leaves(Bodies)),
        /// Seed of the object's own random numbers, so that they do not depend on other objects or their order. Sampled objects
        /// get a seed derived from their group's name and their number in the group. If absent, the seed is derived from the
        /// object's starting position. Objects with the same seed are distinguished by their order.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = MAX_SEED))]
        pub seed: Option<u64> = None => Field::ours(Not("two worlds that differ only in their seeds are two runs of one world")),
        /// A free-form label by which rules and logs refer to it; the name of the group for sampled objects.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub tag: Option<String> = None => Field::ours(Not("it is only a name; its effect through the rules is what is compared")),
        /// A name that is unique in the world.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub unique_name: Option<String> = None => Field::original(Not("it is a name"))
                .fixed("it must be unique in the world; a tag can name several objects"),
        /// Makes it a door.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub door: Option<Door> = None => Field::ours(Leaves(Bodies)),
        /// Makes it a switch for doors.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub switch: Option<Switch> = None => Field::ours(Leaves(Bodies)),
        /// Makes it a thing that the agent can carry, such as a key.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub portable: Option<Portable> = None => Field::ours(Leaves(Bodies)),
        /// Energy the agent gains whenever the object pays its reward (even a reward of 0) or is destroyed; only once if the
        /// reward is paid only once.
        #[serde(default, skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub energy: f64 = 0.0 => Field::ours(Leaves(Bodies)),
        /// How often `AgentInRange` holds: when the agent comes into range, or at every time step in it. An agent that starts within
        /// range comes into it in the first time step.
        #[serde(default, skip_serializing_if = "is_default")]
        pub range_trigger: Trigger = Trigger::Edge => Field::ours(Leaves(PaidFor)),
        /// How often `AgentCollide` holds: when the bodies meet, or at every time step in which they touch. An agent that
        /// starts in contact with it counts as meeting it in the first time step.
        #[serde(default, skip_serializing_if = "is_default")]
        pub contact_trigger: Trigger = Trigger::Edge => Field::ours(Leaves(PaidFor)),
    }
}

impl Object {
    /// An object of this class at this position in metres, with everything else at its default.
    pub fn new(class: impl Into<String>, coordinates: [f64; 2]) -> Self {
        Self {
            class: class.into(),
            coordinates,
            ..Self::default()
        }
    }

    /// Whether the agent can gain from this object: it has a positive reward and a stimulus that pays it.
    pub fn is_target(&self) -> bool {
        self.reward > 0.0 && !(self.reward_stimulus.is_empty() && self.reward_once_stimulus.is_empty())
    }

    /// Whether it has a function: a door, a switch or a portable object.
    pub fn is_used(&self) -> bool {
        self.door.is_some() || self.switch.is_some() || self.portable.is_some()
    }

    /// Whether its behaviour is random: it wanders, pays with a probability, or respawns.
    pub fn takes_chances(&self) -> bool {
        self.motion_model == MotionModel::RandomWaypoint || self.reward_probability < 1.0 || self.respawn.is_some()
    }
}

/// A model within a class. Documents write `"3"` or `3`; it is stored as a string.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Model(pub String);

impl Default for Model {
    fn default() -> Self {
        Self("1".to_owned())
    }
}

impl Model {
    /// The model's number, if it is a number.
    pub fn number(&self) -> Option<u32> {
        self.0.trim().parse().ok()
    }
}

impl<'de> Deserialize<'de> for Model {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a model: text such as \"1\", or a whole number")]
        enum Either {
            Number(u32),
            Text(String),
        }
        Ok(match Either::deserialize(deserializer)? {
            Either::Number(number) => Self(number.to_string()),
            Either::Text(text) => Self(text),
        })
    }
}

impl JsonSchema for Model {
    fn schema_name() -> Cow<'static, str> {
        "Model".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "The asset of the class: \"1\", 1, or a name such as \"sphere\".",
            "anyOf": [
                { "type": "string", "minLength": 1, "maxLength": 100 },
                { "type": "integer", "minimum": 0, "maximum": 1_000_000 }
            ]
        })
    }
}

/// How an object moves by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MotionModel {
    /// It does not move.
    #[default]
    Stationary,
    /// Towards the agent.
    Predator,
    /// Away from the agent.
    Prey,
    /// To random points, one after another.
    RandomWaypoint,
    /// Along its `waypoints`.
    Patrol,
}

fields! {
    /// How an object comes back: with its initial heading and reward, at rest. If no free position is found in a time step, the
    /// search continues in the next one. Rewards already paid, and credit already given, are not undone by its return.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "delay": 5, "radius": 10 }]))]
    pub struct Respawn {
        /// Seconds between its destruction and its return.
        #[schemars(range(min = 0.0, max = 1e6))]
        pub delay: f64 => Field::ours(AsPart).unit("s"),
        /// Radius in metres around its initial position within which it returns; 0 means the same position.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 300.0))]
        pub radius: f64 => Field::ours(AsPart).unit("m"),
    }
}

fields! {
    /// A body that slides and turns on the ground when it is pushed. It never topples.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "mass": 20, "friction": 0.5 }]))]
    pub struct Pushable {
        /// Mass in kilograms; the agent weighs 80.
        #[schemars(range(min = 0.01, max = 1e6))]
        pub mass: f64 => Field::ours(AsPart).unit("kg"),
        /// Friction with the ground and with other bodies: 0 is ice, 0.5 wood on stone.
        #[serde(default = "half")]
        #[schemars(range(min = 0.0, max = 10.0))]
        pub friction: f64 => Field::ours(AsPart),
    }
}

word!(MotionModel);

impl Place for Model {
    const KIND: ParameterType = ParameterType::String;

    fn from_value(value: &Value) -> Option<Self> {
        String::from_value(value).map(Self)
    }
}
