//! [`Parameter`]: the role, type and domain of a declared parameter.

use std::sync::LazyLock;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::json;

use super::choices::{self, Choices};
use super::compare::Compare;
use super::layouts;
use super::template::Source;
use crate::describe::escape;
use crate::distribution::{Distribution, Number};
use crate::element::Element;
use crate::error::{Problem, cut, first_of};
use crate::schema::document::DocumentSchema;
use crate::value::{ParameterType, Value};

/// What determines a parameter's value, and when.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Role {
    /// The task: one value in every variant.
    Fixed,
    /// The variant: one value in every world of the variant.
    Variant,
    /// Chance: drawn separately for every world.
    Randomized,
}

/// A parameter of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(transform = require_what_the_role_needs)]
#[schemars(extend("examples" = [
    { "role": "fixed", "type": "integer", "value": 5 },
    { "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "blue"], "default": "red" },
    { "role": "variant", "type": "number", "unit": "m", "affects": ["S"], "range": [2, 40], "default": 20 },
    { "role": "randomized", "type": "heading", "unit": "deg", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high": 360 } } },
]))]
pub struct Parameter {
    /// What determines its value.
    pub role: Role,
    /// Its type.
    #[serde(rename = "type")]
    pub kind: ParameterType,
    /// The elements of the decision process that it affects: state `S`, action `A`, transition `T`, reward `R`, observation
    /// `O`; `p` for the distribution of the initial state alone, `phi` for the emission alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 7))]
    pub affects: Vec<Element>,
    /// Its unit, such as `m` or `deg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// The parameter in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Fixed only: its value.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(schema_with = "any_value")]
    pub value: Option<Value>,
    /// Variant only: a list of the values it may have; for layouts, distributions and JSON also an object with named values,
    /// which are then referred to by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(schema_with = "choices::schema")]
    pub choices: Option<Choices>,
    /// Variant only: the smallest and largest number it may have.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Variant only: its value in variants that do not set it.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "present")]
    #[schemars(schema_with = "any_value")]
    pub default: Option<Value>,
    /// Variant only, for values that cannot be interpolated: the fraction (0..1) of a drift at which it switches; one half if
    /// absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub switch_at: Option<f64>,
    /// Randomized only: the distribution it is drawn from, or a parameter of type distribution.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Source>,
    /// Variant only: the condition under which anything reads it, over fixed and variant parameters, such as `"trigger ==
    /// 'AgentInRange'"`. In variants that do not meet it, the parameter counts as if it had its default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 500))]
    pub read_if: Option<String>,
    /// Variant and randomized only: the measure by which two variants are compared in this parameter, and its weight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compare: Option<Compare>,
}

/// The values that a variant parameter may have.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// One of these values.
    Choices(Vec<Value>),
    /// Any number in the range, both ends included.
    Range([f64; 2]),
}

/// Reads a value that may be `null`, which serde would otherwise treat as absent.
fn present<'de, D: Deserializer<'de>>(value: D) -> Result<Option<Value>, D::Error> {
    Value::deserialize(value).map(Some)
}

/// Any JSON; the parameter's type determines what is allowed.
fn any_value(_: &mut SchemaGenerator) -> Schema {
    Schema::from(true)
}

/// Schema rules of the form `if` this role or type, `then` these keys, so that editors with JSON Schema report errors while
/// the author types.
fn require_what_the_role_needs(schema: &mut schemars::Schema) {
    let role = |role: &str, needs: serde_json::Value, not: &[&str]| {
        let mut then = needs;
        then["properties"] = not.iter().map(|key| ((*key).to_owned(), json!(false))).collect();
        json!({ "if": { "properties": { "role": { "const": role } }, "required": ["role"] }, "then": then })
    };
    let kind = |kinds: &[&str], value: serde_json::Value, range: bool| {
        let mut then = json!({ "properties": { "value": value, "default": value, "choices": { "items": value } } });
        if ["layout", "distribution", "json"].contains(&kinds[0]) {
            then["properties"]["default"] = json!({ "anyOf": [value, { "type": "string" }] });
            then["properties"]["choices"]["additionalProperties"] = value;
        }
        if !range {
            then["properties"]["range"] = json!(false);
        }
        json!({ "if": { "properties": { "type": { "enum": kinds } }, "required": ["type"] }, "then": then })
    };
    let number = json!({ "type": "number" });
    let rules = [
        role(
            "fixed",
            json!({ "required": ["value"] }),
            &[
                "choices",
                "range",
                "default",
                "switch_at",
                "read_if",
                "distribution",
                "compare",
            ],
        ),
        role(
            "variant",
            json!({
                "required": ["affects", "default"],
                "anyOf": [{ "required": ["choices"] }, { "required": ["range"] }]
            }),
            &["value", "distribution"],
        ),
        role(
            "randomized",
            json!({ "required": ["affects", "distribution"] }),
            &["value", "choices", "range", "default", "switch_at", "read_if"],
        ),
        kind(&["number", "heading"], number.clone(), true),
        kind(&["integer"], json!({ "type": "integer" }), true),
        kind(&["boolean"], json!({ "type": "boolean" }), false),
        kind(&["string"], json!({ "type": "string" }), false),
        kind(&["color"], json!({ "$ref": "#/$defs/Color" }), false),
        kind(
            &["point"],
            json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 }),
            false,
        ),
        kind(
            &["vector"],
            json!({ "type": "array", "items": number, "minItems": 1, "maxItems": 100 }),
            true,
        ),
        kind(&["distribution"], json!({ "$ref": "#/$defs/Distribution" }), false),
        kind(&["layout"], json!({ "$ref": "#/$defs/Layout" }), false),
        kind(&["json"], json!(true), false),
    ];
    schema.insert("allOf".to_owned(), json!(rules));
}

/// The only part in which two values of the same structure differ; `None` if they differ as a whole, or in more than one part.
fn only_difference(found: &serde_json::Value, choice: &serde_json::Value, pointer: &str) -> Option<Problem> {
    use serde_json::Value as Json;
    let inner: Vec<(String, Option<&Json>, Option<&Json>)> = match (found, choice) {
        (Json::Object(found), Json::Object(choice)) => {
            let missing = choice.keys().filter(|key| !found.contains_key(*key));
            let keys = found.keys().chain(missing);
            keys.map(|key| (escape(key), found.get(key), choice.get(key))).collect()
        }
        (Json::Array(found), Json::Array(choice)) if found.len() == choice.len() => {
            let pairs = found.iter().zip(choice).enumerate();
            pairs
                .map(|(index, (found, choice))| (index.to_string(), Some(found), Some(choice)))
                .collect()
        }
        _ => return None,
    };
    let mut different = inner.into_iter().filter(|(_, found, choice)| found != choice);
    let (key, found, choice) = different.next().filter(|_| different.next().is_none())?;
    let pointer = format!("{pointer}/{key}");
    let or = |value: Option<&Json>, absent: &str| value.map_or_else(|| absent.to_owned(), Json::to_string);
    let whole = || {
        Problem::new(
            "spec/value",
            pointer.as_str(),
            or(found, "nothing"),
            or(choice, "no such key"),
        )
    };
    let deeper = found
        .zip(choice)
        .and_then(|(found, choice)| only_difference(found, choice, &pointer));
    Some(deeper.unwrap_or_else(whole))
}

impl Parameter {
    /// Whether it affects this element or the finer one within it, and nothing else.
    pub fn affects_only(&self, element: Element) -> bool {
        !self.affects.is_empty() && self.affects.iter().all(|affected| element.covers(*affected))
    }

    /// The possible values of a variant parameter.
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

    /// A value, or the choice that it names, converted to the parameter's type.
    pub fn typed(&self, value: &Value) -> Option<Value> {
        let named = self.choices.as_ref().and_then(|choices| choices.named(value));
        named.unwrap_or(value).cast(self.kind)
    }

    /// The name of a choice, if choices have names.
    pub fn name_of(&self, value: &Value) -> Option<&str> {
        let choices = self.choices.as_ref().filter(|choices| !choices.names().is_empty())?;
        let index = choices
            .iter()
            .position(|choice| choice.cast(self.kind).as_ref() == Some(value))?;
        choices.names().get(index).map(String::as_str)
    }

    /// A value for messages: by name, if choices have names.
    pub(super) fn shown(&self, value: &Value) -> String {
        self.name_of(value).map_or_else(|| value.to_string(), str::to_owned)
    }

    /// The value with the parameter's type if it is in the domain; otherwise a description of what was expected.
    pub(crate) fn accept(&self, value: &Value) -> Result<Value, String> {
        let typed = self.accept_typed(value)?;
        match self.domain() {
            Some(Domain::Choices(choices)) if !choices.contains(&typed) => {
                let shown: Vec<String> = choices.iter().take(20).map(|choice| cut(&self.shown(choice))).collect();
                let more = match choices.len() - shown.len() {
                    0 => String::new(),
                    more => format!(" and {more} more"),
                };
                Err(format!("one of {}{more}", shown.join(", ")))
            }
            _ => Ok(typed),
        }
    }

    /// The problems of a value at a pointer, as specific as its type and the choices allow.
    pub(crate) fn value_problems(&self, pointer: &str, value: &Value) -> Vec<Problem> {
        let Err(expected) = self.accept(value) else {
            return Vec::new();
        };
        let names = self.choices.as_ref().map_or(&[][..], Choices::names);
        if let (Value::Text(word), false) = (value, names.is_empty()) {
            let expected = format!("one of {}", first_of(names));
            return vec![Problem::new("spec/value", pointer, format!("{word:?}"), expected).suggest(word, names)];
        }
        let json = value.to_json();
        let within = |problem: Problem| problem.within(pointer);
        let of_type = self.type_problems(&json);
        if !of_type.is_empty() {
            return of_type.into_iter().map(within).collect();
        }
        let choices = self.choices.iter().flat_map(Choices::entries);
        let only_differs = choices.into_iter().find_map(|(key, choice)| {
            let difference = only_difference(&json, &choice.to_json(), "")?;
            Some(within(difference).advise(format!("choice {key} differs only here")))
        });
        if let Some(only_differs) = only_differs {
            return vec![only_differs];
        }
        let word = value.as_text().unwrap_or_default();
        let choices: Vec<String> = self.choices.iter().flatten().map(ToString::to_string).collect();
        vec![Problem::new("spec/value", pointer, value.to_string(), expected).suggest(word, choices)]
    }

    /// The problems of JSON read as a value of this type, if the type has parts; pointers are within the value.
    fn type_problems(&self, json: &serde_json::Value) -> Vec<Problem> {
        static DISTRIBUTION: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<Distribution<Number>>("distribution", "Distribution"));
        let list = |length: usize| {
            let number = json!({ "type": "number" });
            DocumentSchema::new(json!({ "type": "array", "items": number, "minItems": length, "maxItems": length }))
        };
        match self.kind {
            ParameterType::Distribution => DISTRIBUTION.problems(json).problems,
            ParameterType::Layout => layouts::problems(json),
            ParameterType::Point => list(2).problems(json).problems,
            ParameterType::Vector => self
                .vector_length()
                .map_or_else(Vec::new, |length| list(length).problems(json).problems),
            _ => Vec::new(),
        }
    }

    /// Like [`Parameter::accept`], but also accepts a value between the choices, if the type can be interpolated.
    pub(crate) fn accept_between(&self, value: &Value) -> Result<Value, String> {
        match self.kind {
            ParameterType::Json => self.accept(value),
            _ => self.accept_typed(value),
        }
    }

    fn accept_typed(&self, value: &Value) -> Result<Value, String> {
        let typed = self
            .typed(value)
            .ok_or_else(|| format!("a value of type {}", self.kind.name()))?;
        if let Value::Layout(layout) = &typed {
            layout.check().map_err(|error| format!("a valid layout; {error}"))?;
        }
        if let Some(expected) = self.vector_length().filter(|_| !self.has_same_length(&typed)) {
            return Err(format!("a list of {expected} numbers"));
        }
        let Some([low, high]) = self.range else {
            return Ok(typed);
        };
        let inside = match (&typed, self.kind) {
            // The range of a heading is an arc, clockwise from low to high, and may cross north.
            (_, ParameterType::Heading) => typed
                .as_number()
                .is_some_and(|degrees| (degrees - low).rem_euclid(360.0) <= high - low),
            (Value::Vector(numbers), _) => numbers.iter().all(|number| (low..=high).contains(number)),
            _ => typed.as_number().is_some_and(|number| (low..=high).contains(&number)),
        };
        let what = if self.kind == ParameterType::Vector {
            "numbers"
        } else {
            "a number"
        };
        if inside {
            Ok(typed)
        } else {
            Err(format!("{what} in {low}..{high}"))
        }
    }

    /// The length of a vector, taken from its value, default or first choice.
    pub fn vector_length(&self) -> Option<usize> {
        self.declared().next()?.as_vector().map(<[f64]>::len)
    }

    /// Whether a value has the length of this parameter's vectors; true for other types.
    fn has_same_length(&self, value: &Value) -> bool {
        self.kind != ParameterType::Vector || value.as_vector().map(<[f64]>::len) == self.vector_length()
    }

    /// Its value, its default and its choices, as declared.
    fn declared(&self) -> impl Iterator<Item = &Value> {
        let alone = self.value.iter().chain(&self.default);
        alone.chain(self.choices.iter().flatten())
    }

    /// Its choices, its value and its default, each with its keys in the document.
    pub(super) fn entries(&self) -> impl Iterator<Item = (String, &Value)> {
        let choices = self.choices.iter().flat_map(Choices::entries);
        let alone = [("value", &self.value), ("default", &self.default)].into_iter();
        let alone = alone.filter_map(|(key, value)| Some((key.to_owned(), value.as_ref()?)));
        choices
            .map(|(key, choice)| (format!("choices/{key}"), choice))
            .chain(alone)
    }

    /// The distributions among its value, default and choices.
    pub(super) fn distributions(&self) -> impl Iterator<Item = &Distribution<Number>> {
        self.declared().filter_map(|value| match value {
            Value::Distribution(distribution) => Some(&**distribution),
            _ => None,
        })
    }

    /// The problems of a single parameter that the schema cannot report.
    pub(crate) fn problems(&self, name: &str) -> Vec<Problem> {
        let pointer = format!("/parameters/{}", escape(name));
        let at = |key: &str| format!("{pointer}/{key}");
        let mut problems = Vec::new();
        let kind = self.kind.name();
        let has_names = self.choices.as_ref().is_some_and(|choices| !choices.names().is_empty());
        if has_names
            && !matches!(
                self.kind,
                ParameterType::Layout | ParameterType::Distribution | ParameterType::Json
            )
        {
            let found = format!("names for choices of type {kind}");
            problems.push(Problem::new("spec/type", at("choices"), found, "a list of values"));
        }
        for (key, value) in self.entries().filter(|(key, _)| key != "default") {
            let typed = value.cast(self.kind);
            if typed.is_none() || !self.has_same_length(value) {
                let expected = format!("a value of type {kind}");
                problems.push(Problem::new("spec/type", at(&key), value.to_string(), expected));
            }
            if let (ParameterType::Layout, Some(Value::Layout(layout))) = (self.kind, typed) {
                let found = layouts::beyond_schema(&layout).into_iter();
                problems.extend(found.map(|problem| problem.within(&at(&key))));
            }
        }
        problems.extend(self.range_problem(&at("range")));
        if let Some(compare) = &self.compare {
            problems.extend(compare.problems(&at("compare"), self));
        }
        if let (Some(default), true) = (&self.default, problems.is_empty()) {
            problems.extend(self.value_problems(&at("default"), default));
        }
        if self.role == Role::Randomized && self.kind == ParameterType::Distribution {
            let advice = "draw from it where it is used: { \"param\": … } in place of a distribution";
            let found = "a randomized parameter of type distribution";
            problems.push(Problem::new("spec/role", &pointer, found, "the role fixed or variant").advise(advice));
        }
        problems
    }

    fn range_problem(&self, pointer: &str) -> Option<Problem> {
        let [low, high] = self.range?;
        let kind = self.kind.name();
        if self.choices.is_some() {
            let found = "a range and choices";
            return Some(Problem::new("spec/value", pointer, found, "one of the two"));
        }
        if !self.kind.is_numeric() {
            let advice = "list the values under \"choices\" instead";
            let problem = Problem::new("spec/type", pointer, format!("a range for a {kind}"), "choices");
            return Some(problem.advise(advice));
        }
        let has_fraction = low.fract() != 0.0 || high.fract() != 0.0;
        let expected = match self.kind {
            ParameterType::Heading if low >= high => {
                "the low end below the high end; an arc across north is [300, 420]"
            }
            _ if low >= high => "the low end below the high end",
            ParameterType::Integer if has_fraction => "whole numbers at both ends",
            ParameterType::Heading if high - low > 360.0 => "an arc of at most 360 degrees",
            _ => return None,
        };
        let found = format!("low {low} and high {high}");
        Some(Problem::new("spec/range", pointer, found, expected))
    }
}
