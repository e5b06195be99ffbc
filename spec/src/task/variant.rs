//! One variant of a task: every fixed and variant parameter has its value. Drawing the randomized ones is the generator's job.

use std::collections::BTreeSet;
use std::sync::Arc;

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::distribution::{Distribution, Number};
use super::parameter::{Parameter, Role};
use super::value::Value;
use super::{TaskSpec, VariantDocument};
use crate::document::escape;
use crate::error::{Problem, nearest};

/// The name of the variant in which every parameter has its default, unless the task declares one of this name.
pub const DEFAULT_VARIANT: &str = "default";

/// One variant of a task, ready to be sampled and compared. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Variant {
    task: Arc<TaskSpec>,
    name: String,
    values: Arc<IndexMap<String, Value>>,
}

impl Variant {
    pub(crate) fn new(task: Arc<TaskSpec>, name: &str, values: IndexMap<String, Value>) -> Self {
        Self {
            task,
            name: name.to_owned(),
            values: Arc::new(values),
        }
    }

    /// The name by which every command knows it: `find_objects#red`.
    pub fn id(&self) -> String {
        format!("{}#{}", self.task.name(), self.name)
    }

    /// The task that it is a variant of.
    pub fn task(&self) -> &Arc<TaskSpec> {
        &self.task
    }

    /// Its name within the task.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The values of all fixed and variant parameters, typed, in the order in which the task declares them.
    pub fn values(&self) -> &IndexMap<String, Value> {
        &self.values
    }

    /// The value of a fixed or variant parameter; `None` for a randomized or unknown one.
    pub fn value(&self, parameter: &str) -> Option<&Value> {
        self.values.get(parameter)
    }

    /// The distribution of a randomized parameter with all its numbers settled; `None` for any other parameter.
    pub fn distribution(&self, parameter: &str) -> Option<Distribution> {
        let declared = self.task.parameters().get(parameter)?.distribution.as_ref()?;
        Some(self.settle(declared))
    }

    /// A distribution with every reference replaced by this variant's value.
    pub fn settle(&self, distribution: &Distribution<Number>) -> Distribution {
        settle(&self.values, distribution).expect("loading the task checked that every reference names a number")
    }

    /// The number that a literal or a reference stands for in this variant.
    pub fn number(&self, number: &Number) -> f64 {
        settle_number(&self.values, number).expect("loading the task checked that every reference names a number")
    }
}

/// A variant as a document declares it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VariantSpec {
    /// The variant whose values it starts from; the defaults if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extends: Option<String>,
    /// What it is, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Values of variant parameters.
    #[serde(flatten)]
    pub values: IndexMap<String, Value>,
}

/// A reference that does not name a number of this variant.
#[derive(Debug)]
pub(crate) struct Unsettled;

pub(crate) fn settle_number(values: &IndexMap<String, Value>, number: &Number) -> Result<f64, Unsettled> {
    match number {
        Number::Literal(number) => Ok(*number),
        Number::Param(reference) => values.get(&reference.param).and_then(Value::as_number).ok_or(Unsettled),
    }
}

pub(crate) fn settle(
    values: &IndexMap<String, Value>,
    distribution: &Distribution<Number>,
) -> Result<Distribution, Unsettled> {
    distribution.try_map(&mut |number| settle_number(values, number))
}

/// The values of a variant: its own over those that it extends over the defaults.
///
/// `Err` where the chain of `extends` breaks or bites its own tail; wrong values are [`problems`]' to find.
pub(crate) fn values_of(
    parameters: &IndexMap<String, Parameter>,
    variants: &VariantDocument,
    name: &str,
) -> Result<IndexMap<String, Value>, Problem> {
    let mut chain = Vec::new();
    let mut seen = BTreeSet::new();
    let mut next = variants.get(name).map(|variant| (name, variant));
    while let Some((name, variant)) = next {
        if !seen.insert(name) {
            return Err(cycle(chain[0], name, variants));
        }
        chain.push(name);
        next = match &variant.extends {
            None => None,
            Some(parent) if parent == DEFAULT_VARIANT && !variants.contains_key(parent) => None,
            Some(parent) => Some((
                parent,
                variants
                    .get(parent)
                    .ok_or_else(|| unknown_parent(name, parent, variants))?,
            )),
        };
    }
    let mut values = IndexMap::new();
    for (parameter, declared) in parameters
        .iter()
        .filter(|(_, declared)| declared.role != Role::Randomized)
    {
        let own = chain.iter().find_map(|name| variants[*name].values.get(parameter));
        let value = own.or(declared.default.as_ref()).or(declared.value.as_ref());
        if let Some(typed) = value.and_then(|value| value.cast(declared.kind)) {
            values.insert(parameter.clone(), typed);
        }
    }
    Ok(values)
}

fn cycle(start: &str, again: &str, variants: &VariantDocument) -> Problem {
    let mut path = vec![again];
    let mut name = variants[again].extends.as_deref();
    while let Some(next) = name.filter(|next| *next != again) {
        path.push(next);
        name = variants[next].extends.as_deref();
    }
    path.push(again);
    Problem::new(
        "spec/extends-cycle",
        format!("/variants/{}/extends", escape(start)),
        format!("a cycle: {}", path.join(" extends ")),
        "a chain of extends that ends",
    )
}

fn unknown_parent(name: &str, parent: &str, variants: &VariantDocument) -> Problem {
    let known: Vec<&str> = variants.keys().map(String::as_str).chain([DEFAULT_VARIANT]).collect();
    Problem::new(
        "spec/unknown-variant",
        format!("/variants/{}/extends", escape(name)),
        format!("{parent:?}"),
        format!("one of {}", known.join(", ")),
    )
    .suggest(parent, known)
}

/// Everything wrong with what the variants say.
pub(crate) fn problems(parameters: &IndexMap<String, Parameter>, variants: &VariantDocument) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (name, variant) in variants {
        problems.extend(values_of(parameters, variants, name).err());
        for (parameter, value) in &variant.values {
            problems.extend(problem_of(parameters, name, parameter, value));
        }
    }
    problems
}

fn problem_of(parameters: &IndexMap<String, Parameter>, variant: &str, name: &str, value: &Value) -> Option<Problem> {
    let pointer = format!("/variants/{}/{}", escape(variant), escape(name));
    let Some(parameter) = parameters.get(name) else {
        let known: Vec<&String> = parameters
            .iter()
            .filter(|(_, p)| p.role == Role::Variant)
            .map(|(name, _)| name)
            .collect();
        let names: Vec<&str> = known.iter().map(|name| name.as_str()).collect();
        let expected = format!("a variant parameter, one of {}", names.join(", "));
        let found = format!("the unknown parameter {name:?}");
        let near = nearest(name, &known).or_else(|| nearest(name, ["extends", "description"]));
        let problem = Problem::new("spec/unknown-key", pointer, found, expected);
        return Some(match near {
            Some(near) => problem.advise(format!("did you mean {near:?}?")),
            None => problem,
        });
    };
    if parameter.role != Role::Variant {
        let role = if parameter.role == Role::Fixed {
            "fixed"
        } else {
            "randomized"
        };
        let found = format!("a value for the {role} parameter {name:?}");
        let problem = Problem::new("spec/role", pointer, found, "values for variant parameters only");
        return Some(problem.advise(format!("give {name:?} the role variant, or leave it out here")));
    }
    let expected = parameter.accept(value).err()?;
    let word = if let Value::Text(word) = value {
        word.as_str()
    } else {
        ""
    };
    let choices: Vec<String> = parameter.choices.iter().flatten().map(ToString::to_string).collect();
    Some(Problem::new("spec/value", pointer, value.to_string(), expected).suggest(word, choices))
}
