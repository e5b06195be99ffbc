//! Functions of objects: doors, switches and portable objects. `docs/worlds.md` describes their behaviour.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::{fields, word};
use super::stimulus::Stimulus;
use crate::serde_defaults::is_default;

/// Default stimulus of objects with a handle: an interaction.
fn by_interaction() -> Vec<Stimulus> {
    vec![Stimulus::AgentInteract]
}

fn is_by_interaction(stimuli: &[Stimulus]) -> bool {
    stimuli == [Stimulus::AgentInteract]
}

fields! {
    /// Makes an object a door: a body that does not block anything while it is open.
    ///
    /// It never closes on something that stands in it: it closes in the first time step in which the doorway is free, unless it
    /// has been opened again in the meantime. The last command counts.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "key": "red_key" },
        { "opens_on": ["AgentCollide"], "closes_after": 5 },
        { "opens_on": [], "period": 8 },
    ]))]
    pub struct Door {
        /// Stimuli that open it; empty for a door that only a switch or its clock opens.
        #[serde(skip_serializing_if = "is_by_interaction")]
        #[schemars(length(max = 3))]
        pub opens_on: Vec<Stimulus> = by_interaction() => Field::ours(AsPart),
        /// Stimuli that close it when it is open.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 3))]
        pub closes_on: Vec<Stimulus> = Vec::new() => Field::ours(AsPart),
        /// Tag of the things that unlock it: `opens_on` opens it only if the agent carries one. Once unlocked, it stays
        /// unlocked. Not locked if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 100))]
        pub key: Option<String> = None => Field::ours(AsPart),
        /// Whether it is open at the start.
        #[serde(skip_serializing_if = "is_default")]
        pub open: bool = false => Field::ours(AsPart),
        /// Seconds after its opening until it closes by itself; never if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 1e6))]
        pub closes_after: Option<f64> = None => Field::ours(AsPart).unit("s"),
        /// Period of its clock in seconds: half of it in the initial state, half of it in the other. No clock if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.001, max = 1e6))]
        pub period: Option<f64> = None => Field::ours(AsPart).unit("s"),
    }
}

fields! {
    /// Makes an object a switch for doors, including locked ones.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "target": "gate" },
        { "on": ["AgentCollide"], "target": "gate", "action": "open" },
    ]))]
    pub struct Switch {
        /// Stimuli that trigger it.
        #[serde(default = "by_interaction", skip_serializing_if = "is_by_interaction")]
        #[schemars(length(max = 3))]
        pub on: Vec<Stimulus> => Field::ours(AsPart),
        /// Tag of the doors that it moves; it moves all of them.
        #[schemars(length(min = 1, max = 100))]
        pub target: String => Field::ours(AsPart),
        /// Its effect on each of them.
        #[serde(default, skip_serializing_if = "is_default")]
        pub action: SwitchAction => Field::ours(AsPart),
    }
}

fields! {
    /// Makes an object a thing that the agent can carry, and a key for the doors that name its tag as their `key`.
    ///
    /// A carried thing has no body and is not a target until it is put down.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [{}, { "on": ["AgentCollide"], "consumed": true }]))]
    pub struct Portable {
        /// Stimuli that pick it up, if the agent carries fewer things than its `carry_limit`.
        #[serde(skip_serializing_if = "is_by_interaction")]
        #[schemars(length(max = 3))]
        pub on: Vec<Stimulus> = by_interaction() => Field::ours(AsPart),
        /// Whether it disappears once it has unlocked a door.
        #[serde(skip_serializing_if = "is_default")]
        pub consumed: bool = false => Field::ours(AsPart),
    }
}

/// The effect of a switch on a door.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum SwitchAction {
    /// Opens it if it is closed, closes it if it is open.
    #[default]
    Toggle,
    /// Opens it.
    Open,
    /// Closes it.
    Close,
}

word!(SwitchAction);

impl Switch {
    /// A switch that an interaction triggers, and that toggles the doors with this tag.
    pub fn of(target: impl Into<String>) -> Self {
        Self {
            on: by_interaction(),
            target: target.into(),
            action: SwitchAction::Toggle,
        }
    }
}
