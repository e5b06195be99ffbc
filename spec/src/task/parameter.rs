//! One declared parameter: its role, type and domain. The values that variants give it are in `variant.rs`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::distribution::{Distribution, Number};
use super::value::{ParameterType, Value};
use crate::document::escape;
use crate::error::Problem;

/// An element of the decision process that a parameter touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
pub enum Element {
    /// The states: what is where.
    S,
    /// The actions that the agent has.
    A,
    /// The transitions: how the world answers an action.
    T,
    /// The rewards.
    R,
    /// The observations: what the agent sees of a state.
    O,
}

impl Element {
    /// All elements, in the order in which tables show them.
    pub const ALL: [Self; 5] = [Self::S, Self::A, Self::T, Self::R, Self::O];

    /// The element in a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::S => "state",
            Self::A => "action",
            Self::T => "transition",
            Self::R => "reward",
            Self::O => "observation",
        }
    }

    /// The letter by which documents name the element.
    pub fn letter(self) -> &'static str {
        match self {
            Self::S => "S",
            Self::A => "A",
            Self::T => "T",
            Self::R => "R",
            Self::O => "O",
        }
    }
}

/// Who settles a parameter's value, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Role {
    /// The task: one value in every variant.
    Fixed,
    /// The variant: one value in every world of it.
    Variant,
    /// Chance: drawn anew for every world.
    Randomized,
}

/// A parameter of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = require_what_the_role_needs)]
pub struct Parameter {
    /// Who settles its value.
    pub role: Role,
    /// Its type.
    #[serde(rename = "type")]
    pub kind: ParameterType,
    /// Which elements of the decision process it touches: state `S`, action `A`, transition `T`, reward `R`, observation `O`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 5))]
    pub affects: Vec<Element>,
    /// Its unit, such as `m` or `deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// What it is, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Fixed only: its value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Value>,
    /// Variant only: the values it may have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 10_000))]
    pub choices: Option<Vec<Value>>,
    /// Variant only: the least and greatest number it may have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Variant only: its value in variants that do not set it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub default: Option<Value>,
    /// Randomized only: how it is drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Distribution<Number>>,
}

/// The values that a variant parameter may have.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// One of these.
    Choices(Vec<Value>),
    /// Any number from the first to the second, both included.
    Range([f64; 2]),
}

fn require_what_the_role_needs(schema: &mut schemars::Schema) {
    let rule = |role: &str, needs: serde_json::Value, not: &[&str]| {
        let mut then = needs;
        then["properties"] = not.iter().map(|key| ((*key).to_owned(), json!(false))).collect();
        json!({ "if": { "properties": { "role": { "const": role } }, "required": ["role"] }, "then": then })
    };
    let rules = [
        rule(
            "fixed",
            json!({ "required": ["value"] }),
            &["choices", "range", "default", "distribution"],
        ),
        rule(
            "variant",
            json!({
                "required": ["affects", "default"],
                "anyOf": [{ "required": ["choices"] }, { "required": ["range"] }]
            }),
            &["value", "distribution"],
        ),
        rule(
            "randomized",
            json!({ "required": ["affects", "distribution"] }),
            &["value", "choices", "range", "default"],
        ),
    ];
    schema.insert("allOf".to_owned(), json!(rules));
}

impl Parameter {
    /// The values it may have, if it is a variant parameter.
    pub fn domain(&self) -> Option<Domain> {
        let choices = || {
            Some(Domain::Choices(
                self.choices
                    .as_ref()?
                    .iter()
                    .filter_map(|v| v.cast(self.kind))
                    .collect(),
            ))
        };
        self.range.map(Domain::Range).or_else(choices)
    }

    /// The value with the parameter's type if it lies in the domain; else what was expected.
    pub(crate) fn accept(&self, value: &Value) -> Result<Value, String> {
        let typed = value
            .cast(self.kind)
            .ok_or_else(|| format!("a value of type {}", self.kind.name()))?;
        match self.domain() {
            Some(Domain::Range([low, high])) => {
                let inside = typed.as_number().is_some_and(|number| (low..=high).contains(&number));
                if inside {
                    Ok(typed)
                } else {
                    Err(format!("a number in {low}..{high}"))
                }
            }
            Some(Domain::Choices(choices)) if !choices.contains(&typed) => {
                let names: Vec<String> = choices.iter().map(ToString::to_string).collect();
                Err(format!("one of {}", names.join(", ")))
            }
            _ => Ok(typed),
        }
    }

    /// What the schema cannot say about one parameter alone.
    pub(crate) fn problems(&self, name: &str) -> Vec<Problem> {
        let pointer = format!("/parameters/{}", escape(name));
        let at = |key: &str| format!("{pointer}/{key}");
        let mut problems = Vec::new();
        let kind = self.kind.name();
        if let Some(value) = self.value.as_ref().filter(|value| value.cast(self.kind).is_none()) {
            problems.push(Problem::new(
                "spec/type",
                at("value"),
                value.to_string(),
                format!("a value of type {kind}"),
            ));
        }
        for (index, choice) in self
            .choices
            .iter()
            .flatten()
            .enumerate()
            .filter(|(_, choice)| choice.cast(self.kind).is_none())
        {
            let pointer = at(&format!("choices/{index}"));
            problems.push(Problem::new(
                "spec/type",
                pointer,
                choice.to_string(),
                format!("a value of type {kind}"),
            ));
        }
        if let Some([low, high]) = self.range {
            if self.choices.is_some() {
                problems.push(Problem::new(
                    "spec/value",
                    at("range"),
                    "a range beside choices",
                    "one of the two",
                ));
            } else if !matches!(self.kind, ParameterType::Number | ParameterType::Integer) {
                let advice = "list the values under \"choices\" instead";
                problems.push(
                    Problem::new("spec/type", at("range"), format!("a range for a {kind}"), "choices").advise(advice),
                );
            } else if low >= high {
                let found = format!("low {low} and high {high}");
                problems.push(Problem::new(
                    "spec/range",
                    at("range"),
                    found,
                    "the low end below the high end",
                ));
            }
        }
        if let (Some(default), true) = (&self.default, problems.is_empty())
            && let Err(expected) = self.accept(default)
        {
            problems.push(Problem::new("spec/value", at("default"), default.to_string(), expected));
        }
        if let Some(distribution) = &self.distribution {
            if matches!(distribution, Distribution::Points { .. }) {
                let advice = "write a choice of points to draw one of them";
                problems.push(
                    Problem::new(
                        "spec/type",
                        at("distribution"),
                        "points, which are taken in turn",
                        "a distribution",
                    )
                    .advise(advice),
                );
            } else if !distribution.yields(self.kind) {
                let found = format!("the distribution {}", distribution.name());
                problems.push(Problem::new(
                    "spec/type",
                    at("distribution"),
                    found,
                    format!("one that draws a {kind}"),
                ));
            }
        }
        problems
    }
}
