//! [`Rules`]: rewards of an episode in addition to those of objects, and the conditions that end it early.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Object;
use super::fields::{Field, FieldPlace, Place, fields};
use crate::serde_defaults::{is_default, is_one, is_two, one, two};
use crate::value::{ParameterType, Value};

fields! {
    /// Rewards and endings that belong to the world as a whole.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "step_reward": -0.1, "shaping": { "toward": "goal", "scale": 1 }, "success": ["all_collected"], "failure": [{ "return_at_most": -50 }] },
    ]))]
    pub struct Rules {
        /// Paid at every step; a small negative number rewards haste.
        #[schemars(range(min = -1e9, max = 1e9))]
        pub step_reward: f64 = 0.0 => Field::ours(Measured(&[StepReward])),
        /// Paid per simulated second, proportionally in each time step. Unlike `step_reward`, it does not depend on the length
        /// of a step.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub reward_per_second: f64 = 0.0 => Field::ours(Measured(&[StepReward])),
        /// Paid instead of an object's reward if the object is triggered before its turn in a sequence; a negative number makes
        /// it a penalty.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(range(min = -1e9, max = 1e9))]
        pub order_penalty: f64 = 0.0 => Field::ours(Leaves(ShapingAndEndings)),
        /// A shaping reward for coming closer.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub shaping: Option<Shaping> = None => Field::ours(Leaves(ShapingAndEndings)),
        /// Any of these ends the episode as a success.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 100))]
        pub success: Vec<EndCondition> = Vec::new() => Field::ours(Leaves(ShapingAndEndings)),
        /// Any of these ends the episode as a failure.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 100))]
        pub failure: Vec<EndCondition> = Vec::new() => Field::ours(Leaves(ShapingAndEndings)),
    }
}

fields! {
    /// Potential-based shaping: each step pays `discount × potential after − potential before`.
    ///
    /// The potential is `−scale ×` the distance in metres to the nearest attracting object; it is 0 if there is none, and at
    /// the end of an episode that terminates. The optimal policy of a learner with this discount therefore stays optimal (Ng,
    /// Harada and Russell 1999): with discount 1, the total of shaping is the same in every episode that terminates, `scale ×`
    /// the initial distance. When the nearest object is removed, the potential falls to that of the next one, and the step that
    /// collects it pays that much less. Conditions on the return ignore shaping.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "toward": "goal", "scale": 1 },
        { "scale": 0.1, "discount": 0.99 },
    ]))]
    pub struct Shaping {
        /// Tag of the attracting objects; if absent, all objects that would pay a positive reward now, taking their turn in a
        /// sequence into account.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub toward: Option<String> => Field::ours(AsPart),
        /// Reward per metre.
        #[schemars(range(min = -1e6, max = 1e6))]
        pub scale: f64 => Field::ours(AsPart).unit("1/m"),
        /// The learner's discount, 0..1.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        #[schemars(range(min = 0.0, max = 1.0))]
        pub discount: f64 => Field::ours(AsPart),
    }
}

/// A condition that ends an episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(extend("examples" = [
    "all_collected",
    { "touch": "goal" },
    { "return_at_least": 500 },
    { "opened": "gate" },
    { "delivered": { "tag": "ball", "to": "box" } },
]))]
pub enum EndCondition {
    /// No object is left that pays a positive reward.
    AllCollected,
    /// The agent touches, or interacts with, an object with this tag.
    Touch(#[schemars(length(min = 1, max = 100))] String),
    /// The return of the episode, without shaping, reaches this number.
    ReturnAtLeast(f64),
    /// The return of the episode, without shaping, falls to this number.
    ReturnAtMost(f64),
    /// A door with this tag is open.
    Opened(#[schemars(length(min = 1, max = 100))] String),
    /// The agent carries a thing with this tag.
    Carried(#[schemars(length(min = 1, max = 100))] String),
    /// Every thing with one tag lies near an object with another tag.
    Delivered(Delivery),
    /// The agent's energy is used up; never in worlds without energy.
    OutOfEnergy,
}

fields! {
    /// Things to be delivered, and their destination.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "tag": "ball", "to": "box", "within": 2 }]))]
    pub struct Delivery {
        /// Tag of the things. At least one must remain, and all that remain must lie there; carried ones remain, but not there.
        #[schemars(length(min = 1, max = 100))]
        pub tag: String => Field::ours(AsPart),
        /// Tag of the destination objects.
        #[schemars(length(min = 1, max = 100))]
        pub to: String => Field::ours(AsPart),
        /// Maximum distance in metres, between centres.
        #[serde(default = "two", skip_serializing_if = "is_two")]
        #[schemars(range(min = 0.0, max = 1000.0))]
        pub within: f64 => Field::ours(AsPart).unit("m"),
    }
}

impl EndCondition {
    /// Whether it is the condition of touching this object.
    pub fn is_touch_of(&self, object: &Object) -> bool {
        matches!(self, Self::Touch(tag) if object.tag.as_ref() == Some(tag))
    }
}

/// As a whole, or through its variant's value.
impl Place for EndCondition {
    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        // It has one part.
        steps.push(0);
        match words {
            ["touch" | "opened" | "carried"] => Some(ParameterType::String),
            ["delivered", rest @ ..] => Delivery::find_inside(rest, steps),
            ["return_at_least" | "return_at_most"] => Some(ParameterType::Number),
            _ => None,
        }
    }

    fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        match self {
            Self::AllCollected | Self::OutOfEnergy => None,
            Self::Touch(tag) | Self::Opened(tag) | Self::Carried(tag) => tag.set(&[], value),
            Self::Delivered(delivery) => delivery.set_inside(steps.get(1..)?, value),
            Self::ReturnAtLeast(reward) | Self::ReturnAtMost(reward) => reward.set(&[], value),
        }
    }

    fn list_inside(pointer: &str, field: &Field, found: &mut Vec<FieldPlace>) {
        String::list(format!("{pointer}/touch"), field, true, found);
        f64::list(format!("{pointer}/return_at_least"), field, true, found);
        f64::list(format!("{pointer}/return_at_most"), field, true, found);
        String::list(format!("{pointer}/opened"), field, true, found);
        String::list(format!("{pointer}/carried"), field, true, found);
        Delivery::list_inside(&format!("{pointer}/delivered"), field, found);
    }
}
