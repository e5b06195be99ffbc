//! [`Object`]: an object of a world, and what touching it does.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};

use super::fields::{Place, fields, word};
use super::{Door, MAX_SEED, Portable, Surface, Switch};
use crate::Color;
use crate::serde_defaults::{half, is_default, is_one, one, yes};
use crate::value::{ParameterType, Value};

/// Pattern of the text on a sign.
pub(crate) const TEXT_PATTERN: &str = "^[A-Z0-9!?<>+ -]*$";

fields! {
    /// An object: its look, its place, what it is worth.
    ///
    /// Every field but `class` and `coordinates` has a default.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "class": "geometric", "model": "1", "coordinates": [0, 10], "color": "red", "reward": 100,
            "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"] },
    ]))]
    pub struct Object {
        /// Kind of asset: `geometric`, `tree`, `barrel`, …; commands refuse classes and models that are not known.
        #[schemars(length(min = 1, max = 100))]
        pub class: String = String::new() => Field::original(Measured(&[Unmatched, Rewards, UnmatchedLooks])),
        /// Which asset of the class: its name, such as `sphere` or `fox`, or its number from "1".
        #[serde(default)]
        pub model: Model = Model::default() => Field::original(Leaves(ModelsOfObjects)),
        /// The model of the class whose body it has, whatever it looks like: the shape that is bumped into, and the height from which
        /// its range is measured. That of its own model if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub body_model: Option<Model> = None => Field::ours(Leaves(Bodies)),
        /// What a sign says, in block letters on its front: capital letters, digits, spaces and `! ? < > + -`. Only the class `sign`
        /// shows it.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(max = 8), regex(pattern = TEXT_PATTERN))]
        pub text: Option<String> = None => Field::ours(Leaves(ModelsOfObjects)),
        /// Position on the ground in metres.
        #[schemars(inner(range(min = -300.0, max = 300.0)))]
        pub coordinates: [f64; 2] = [0.0; 2] => Field::original(Measured(&[PlacesOfObjects])).unit("m"),
        /// Where the object faces, in degrees: 0 is +y, growing clockwise.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 360.0))]
        pub heading: f64 = 0.0 => Field::ours(Measured(&[HeadingsOfObjects])).heading(),
        /// Factor on the asset's natural size.
        #[serde(default = "one")]
        #[schemars(range(min = 0.01, max = 100.0))]
        pub scale: f64 = 1.0 => Field::ours(Measured(&[SizesOfObjects])),
        /// Main colour; the asset's own colours if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub color: Option<Color> = None => Field::original(Measured(&[ColorsOfObjects])),
        /// What covers it, where the world's looks are natural: a pattern at its own size in metres, whatever the object's `scale`.
        #[serde(default, skip_serializing_if = "is_default")]
        pub surface: Surface = Surface::Plain => Field::ours(Leaves(ModelsOfObjects)),
        /// Whether the agent is stopped by it.
        #[serde(default = "yes")]
        pub solid: bool = true => Field::ours(Leaves(Bodies)),
        /// Makes it a body that the agent pushes along the ground; absent for one that stands fast. Only solid objects that do not
        /// move by themselves are pushed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pushable: Option<Pushable> = None => Field::ours(Leaves(Bodies)),
        /// What one triggering is worth.
        #[serde(default)]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub reward: f64 = 0.0 => Field::original(Measured(&[Rewards])),
        /// Probability that triggering pays at all (a bandit arm), 0..1.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        #[schemars(range(min = 0.0, max = 1.0))]
        pub reward_probability: f64 = 1.0 => Field::ours(Measured(&[RewardProbabilities])),
        /// Stimuli of which each triggering pays `reward`.
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
        /// Largest turn of the object's own motion in degrees per second; at once if absent.
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
        /// Place in a scavenger sequence, from 1: it pays only when all lower places have been collected.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1, max = 100_000))]
        pub order: Option<u32> = None => Field::ours(Leaves(PaidFor)),
        /// How the object comes back after it was destroyed.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub respawn: Option<Respawn> = None => Field::ours(Leaves(Bodies)),
        /// The seed of its own random numbers, whatever else is in the world and in which order. Sampled objects
        /// have one of their group's name and their number in it; without it the place where it starts decides. Objects
        /// that share one are distinguished by their order.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = MAX_SEED))]
        pub seed: Option<u64> = None => Field::ours(Not("two worlds that differ in their seeds alone are two runs of one world")),
        /// A free word that rules and logs refer to; the name of the group for sampled objects.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub tag: Option<String> = None => Field::ours(Not("it is a name: what rules make of it is compared")),
        /// A name that no other object of the world has.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub unique_name: Option<String> = None => Field::original(Not("it is a name"))
                .fixed("no two objects of a world may have the same; objects are named together by their tag"),
        /// Makes it a door.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub door: Option<Door> = None => Field::ours(Leaves(Bodies)),
        /// Makes it a switch of doors.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub switch: Option<Switch> = None => Field::ours(Leaves(Bodies)),
        /// Makes it a thing that the agent can carry, such as a key.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub portable: Option<Portable> = None => Field::ours(Leaves(Bodies)),
        /// Energy that the agent gains when a triggering pays its reward, be that 0, or destroys it; once for what pays once.
        #[serde(default, skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub energy: f64 = 0.0 => Field::ours(Leaves(Bodies)),
        /// How often `AgentInRange` holds: when the agent comes into range, or at every time step in it. An agent that starts within
        /// range comes into it in the first time step.
        #[serde(default, skip_serializing_if = "is_default")]
        pub range_trigger: Trigger = Trigger::Edge => Field::ours(Leaves(PaidFor)),
        /// How often `AgentCollide` holds: when the bodies meet, or at every time step in which they touch. An agent that starts in
        /// touch meets it in the first time step.
        #[serde(default, skip_serializing_if = "is_default")]
        pub contact_trigger: Trigger = Trigger::Edge => Field::ours(Leaves(PaidFor)),
    }
}

impl Object {
    /// An object of this class at this place in metres, with everything else at its default.
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

    /// Whether its behaviour is random: it wanders, pays with a probability, or returns at a random place.
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
            "description": "Which asset of the class: \"1\", 1, or a name such as \"sphere\".",
            "anyOf": [
                { "type": "string", "minLength": 1, "maxLength": 100 },
                { "type": "integer", "minimum": 0, "maximum": 1_000_000 }
            ]
        })
    }
}

/// What sets an object off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[expect(clippy::enum_variant_names, reason = "the words of L2Explorer's documents")]
pub enum Stimulus {
    /// The agent's body meets the object's; again when it comes back from at least a quarter of a metre away.
    AgentCollide,
    /// The agent interacts while the object is in the 1 m cube right in front of it.
    AgentInteract,
    /// The centres come closer than `range_stimulus_distance`, even for a part of a step; again when they come back from a quarter of
    /// a metre beyond.
    AgentInRange,
}

/// How often a stimulus sets an object off while it lasts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Trigger {
    /// Once, when it begins.
    #[default]
    Edge,
    /// At every time step.
    Level,
}

/// How an object moves by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MotionModel {
    /// It does not.
    #[default]
    Stationary,
    /// Towards the agent.
    Predator,
    /// Away from the agent.
    Prey,
    /// To random points, one after the other.
    RandomWaypoint,
    /// Along its `waypoints`.
    Patrol,
}

fields! {
    /// How an object comes back: with the heading and reward that it began with, at rest. Where no free place is found for it
    /// in a time step, it is looked for again in the next. What it paid or counted for before its return stays so.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "delay": 5, "radius": 10 }]))]
    pub struct Respawn {
        /// Seconds between its destruction and its return.
        #[schemars(range(min = 0.0, max = 1e6))]
        pub delay: f64 => Field::ours(AsPart).unit("s"),
        /// Radius in metres around its first place within which it returns; 0 is the same place.
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

word!(Stimulus);
word!(MotionModel);
word!(Trigger);

impl Place for Model {
    const KIND: ParameterType = ParameterType::String;

    fn from_value(value: &Value) -> Option<Self> {
        String::from_value(value).map(Self)
    }
}
