//! One variant of a task: every fixed and variant parameter has its value. Drawing the randomized ones is the generator's job.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::Arc;

use driftworld_text::IDENTIFIER_PATTERN;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::TaskSpec;
use super::family::{Sweep, Variants};
use super::parameter::{Parameter, Role};
use super::require::Requirement;
use super::template::Source;
use crate::describe::escape;
use crate::distribution::{Distribution, Number, ParamRef};
use crate::error::{MAX_PROBLEMS, Problem, SpecError, first_of, nearest};
use crate::value::Value;

/// The name of the variant in which every parameter has its default, unless the task declares one of this name.
pub const DEFAULT_VARIANT: &str = "default";

/// One variant of a task, ready to be sampled and compared. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Variant {
    task: Arc<TaskSpec>,
    name: String,
    values: Arc<IndexMap<String, Value>>,
}

/// What a source comes to in a variant.
#[derive(Clone, Debug, PartialEq)]
pub enum Resolved {
    /// The same value in every world.
    Value(Value),
    /// The value of this randomized parameter, or the number at a place of it.
    Randomized(ParamRef),
    /// A draw of its own.
    Draw(Distribution),
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

    /// A hash of everything that its worlds and its distances are made from: the task's document in the current version without
    /// descriptions and without the other variants, and the values of this one. Variants of one hash have the same worlds.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::TaskSpec;
    /// let hash = |light: &str, about: &str| {
    ///     let text = format!(
    ///         r#"{{ "name": "a", "description": "{about}",
    ///              "world": {{ "environment_params": {{ "light_intensity": {light} }} }} }}"#
    ///     );
    ///     Ok::<_, driftworld_spec::SpecError>(TaskSpec::from_json("a", &text)?.variant("default")?.hash())
    /// };
    /// assert_eq!(hash("2", "old")?, hash("2", "new")?);
    /// assert_ne!(hash("2", "old")?, hash("3", "old")?);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn hash(&self) -> String {
        let values = self.values.iter().map(|(name, value)| (name, value.to_json()));
        let values: Vec<(&String, serde_json::Value)> = values.collect();
        let whole = serde_json::json!({ "task": self.task.canonical(), "variant": self.name, "values": values });
        Sha256::digest(whole.to_string())
            .iter()
            .fold(String::with_capacity(64), |mut hash, byte| {
                write!(hash, "{byte:02x}").expect("writing to a String does not fail");
                hash
            })
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

    /// The distribution of a randomized parameter, or the one that a parameter of type distribution is, with all its numbers
    /// settled; `None` for any other parameter.
    pub fn distribution(&self, parameter: &str) -> Option<Distribution> {
        if let Some(Value::Distribution(distribution)) = self.values.get(parameter) {
            return Some(self.settle(distribution));
        }
        let declared = self.task.parameters().get(parameter)?.distribution.as_ref()?;
        match self.resolve(declared) {
            Resolved::Draw(distribution) => Some(distribution),
            _ => None,
        }
    }

    /// What a source comes to in this variant.
    pub fn resolve(&self, source: &Source) -> Resolved {
        match source {
            Source::Distribution(distribution) => Resolved::Draw(self.settle(distribution)),
            Source::Param(reference) => match self.values.get(&reference.param) {
                None => Resolved::Randomized(reference.clone()),
                Some(Value::Distribution(distribution)) => Resolved::Draw(self.settle(distribution)),
                Some(value) => Resolved::Value(
                    value
                        .at(reference.index)
                        .expect("loading the task checked the index of every reference"),
                ),
            },
        }
    }

    /// A distribution with every reference replaced by this variant's value.
    pub fn settle(&self, distribution: &Distribution<Number>) -> Distribution {
        settle(&self.values, distribution).expect("loading the task checked that every reference names a number")
    }

    /// The number that a literal or a reference stands for in this variant.
    pub fn number(&self, number: &Number) -> f64 {
        settle_number(&self.values, number).expect("loading the task checked that every reference names a number")
    }

    /// A variant like this one under another name, with some parameters at other values.
    ///
    /// Each value has its parameter's type and lies in its range; where the domain is a list of choices, it may lie between
    /// them, as the colours of a drift do.
    ///
    /// # Errors
    /// [`SpecError::Values`] with every parameter that cannot have its value, a distribution that cannot be drawn from, or a
    /// requirement that does not hold.
    pub fn with(&self, name: &str, changes: impl IntoIterator<Item = (String, Value)>) -> Result<Self, SpecError> {
        let mut values = (*self.values).clone();
        let mut problems = Vec::new();
        for (parameter, value) in changes {
            match accepted(self.task.parameters(), &parameter, &value) {
                Ok(typed) => {
                    values.insert(parameter, typed);
                }
                Err(problem) => problems.push(problem),
            }
        }
        if problems.is_empty() {
            problems = self.task.problems_of(&values);
        }
        if problems.is_empty() {
            Ok(Self::new(Arc::clone(&self.task), name, values))
        } else {
            let variant = format!("{}#{name}", self.task.name());
            Err(SpecError::Values { variant, problems })
        }
    }
}

fn accepted(parameters: &IndexMap<String, Parameter>, name: &str, value: &Value) -> Result<Value, Problem> {
    let known: Vec<&String> = parameters
        .iter()
        .filter(|(_, p)| p.role == Role::Variant)
        .map(|(name, _)| name)
        .collect();
    let parameter = parameters
        .get(name)
        .filter(|parameter| parameter.role == Role::Variant)
        .ok_or_else(|| {
            let expected = format!("a variant parameter, one of {}", first_of(&known));
            Problem::new(
                "spec/unknown-parameter",
                format!("/{name}"),
                format!("{name:?}"),
                expected,
            )
            .suggest(name, &known)
        })?;
    parameter
        .accept_between(value)
        .map_err(|expected| Problem::new("spec/value", format!("/{name}"), value.to_string(), expected))
}

/// A variant, or a family of them, as a document declares it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(transform = values_of_parameters)]
#[schemars(extend("examples" = [
    { "extends": "day", "description": "Red cubes at dusk.", "light": 0.6 },
    { "grid": { "target_color": ["red", "green"], "light": [0.6, 2.3] } },
    { "sweep": { "light": { "from": 0.2, "to": 4, "steps": 5 } } },
]))]
pub struct VariantSpec {
    /// The variant whose values it starts from; the defaults if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 200))]
    pub extends: Option<String>,
    /// What it is, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Makes it a family: for each parameter the values that it takes; one variant for every combination, named after the
    /// family and its values, as `look-red-0.5`.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(length(min = 1, max = 20), inner(length(min = 1, max = 1000)))]
    pub grid: IndexMap<String, Vec<Value>>,
    /// Makes it a family: for each parameter evenly spaced values; combined with those of the grid and of each other.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(length(min = 1, max = 20))]
    pub sweep: IndexMap<String, Sweep>,
    /// Values of variant parameters.
    #[serde(flatten)]
    pub values: IndexMap<String, Value>,
}

/// The keys that a variant has beside its parameters' names.
pub(crate) const RESERVED: [&str; 4] = ["extends", "description", "grid", "sweep"];

fn values_of_parameters(schema: &mut schemars::Schema) {
    schema.insert(
        "propertyNames".to_owned(),
        serde_json::json!({ "pattern": IDENTIFIER_PATTERN, "maxLength": 100 }),
    );
    for key in ["grid", "sweep"] {
        if let Some(map) = schema
            .pointer_mut(&format!("/properties/{key}"))
            .and_then(serde_json::Value::as_object_mut)
        {
            map.insert("minProperties".to_owned(), serde_json::json!(1));
            map.insert("maxProperties".to_owned(), serde_json::json!(20));
            if key == "grid" {
                map["additionalProperties"]["minItems"] = serde_json::json!(1);
                map["additionalProperties"]["maxItems"] = serde_json::json!(1000);
            }
        }
    }
}

/// A reference that does not name a number of this variant.
#[derive(Debug)]
pub(crate) struct UnresolvedParams;

pub(crate) fn settle_number(values: &IndexMap<String, Value>, number: &Number) -> Result<f64, UnresolvedParams> {
    match number {
        Number::Literal(number) => Ok(*number),
        Number::Param(reference) => {
            let value = values.get(&reference.param).ok_or(UnresolvedParams)?;
            value
                .at(reference.index)
                .and_then(|value| value.as_number())
                .ok_or(UnresolvedParams)
        }
    }
}

pub(crate) fn settle(
    values: &IndexMap<String, Value>,
    distribution: &Distribution<Number>,
) -> Result<Distribution, UnresolvedParams> {
    distribution.try_map(&mut |number| settle_number(values, number))
}

/// The first requirement that speaks of settled parameters only and does not hold, with the values it fails for.
pub(crate) fn broken<'a>(
    requirements: &'a [Requirement],
    values: &IndexMap<String, Value>,
) -> Option<(&'a Requirement, String)> {
    let value_of = |name: &str| values.get(name).cloned();
    let broken = requirements
        .iter()
        .find(|requirement| requirement.holds(value_of) == Some(false))?;
    Some((broken, broken.describe(value_of)))
}

/// The most variants that extend each other in a row.
pub(crate) const MAX_EXTENDED: usize = 100;

/// The values of a variant: its own over those that it extends over the defaults.
///
/// `Err` where the chain of `extends` breaks or bites its own tail; wrong values are [`problems`]' to find.
pub(crate) fn values_of(
    parameters: &IndexMap<String, Parameter>,
    variants: &Variants,
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
        if chain.len() > MAX_EXTENDED {
            return Err(Problem::new(
                "spec/length",
                format!("/variants/{}/extends", escape(&variants[chain[0]].origin)),
                format!("a chain of more than {MAX_EXTENDED} variants that extend each other"),
                format!("at most {MAX_EXTENDED}"),
            )
            .advise("extend a variant further up"));
        }
        next = match &variant.extends {
            None => None,
            Some(parent) if parent == DEFAULT_VARIANT && !variants.contains_key(parent) => None,
            Some(parent) => Some((
                parent,
                variants
                    .get(parent)
                    .ok_or_else(|| unknown_parent(&variant.origin, parent, variants))?,
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

fn cycle(start: &str, again: &str, variants: &Variants) -> Problem {
    let mut path = vec![again];
    let mut name = variants[again].extends.as_deref();
    while let Some(next) = name.filter(|next| *next != again) {
        path.push(next);
        name = variants[next].extends.as_deref();
    }
    path.push(again);
    Problem::new(
        "spec/extends-cycle",
        format!("/variants/{}/extends", escape(&variants[start].origin)),
        format!("a cycle: {}", path.join(" extends ")),
        "a chain of extends that ends",
    )
}

fn unknown_parent(origin: &str, parent: &str, variants: &Variants) -> Problem {
    let known: Vec<&str> = variants.keys().map(String::as_str).chain([DEFAULT_VARIANT]).collect();
    let shown = first_of(&known);
    Problem::new(
        "spec/unknown-variant",
        format!("/variants/{}/extends", escape(origin)),
        format!("{parent:?}"),
        format!("one of {shown}"),
    )
    .suggest(parent, known)
}

/// Everything wrong with what the variants say, but for values of parameters of which nothing is known.
pub(crate) fn problems(
    parameters: &IndexMap<String, Parameter>,
    document: &IndexMap<String, VariantSpec>,
    variants: &Variants,
    is_unsound: impl Fn(&str) -> bool,
) -> Vec<Problem> {
    let mut problems: Vec<Problem> = variants
        .keys()
        .filter_map(|name| values_of(parameters, variants, name).err())
        .take(MAX_PROBLEMS + 1)
        .collect();
    problems.dedup();
    let check = |pointer: &str, parameter: &str, value: &Value| {
        let known = !is_unsound(parameter);
        known
            .then(|| problem_of(parameters, pointer, parameter, value))
            .flatten()
    };
    for (name, variant) in document {
        for (parameter, value) in &variant.values {
            if problems.len() > MAX_PROBLEMS {
                return problems;
            }
            problems.extend(check(
                &format!("/variants/{}/{}", escape(name), escape(parameter)),
                parameter,
                value,
            ));
        }
        problems.extend(super::family::problems(parameters, name, variant, check));
    }
    problems
}

fn problem_of(parameters: &IndexMap<String, Parameter>, pointer: &str, name: &str, value: &Value) -> Option<Problem> {
    let Some(parameter) = parameters.get(name) else {
        let known: Vec<&String> = parameters
            .iter()
            .filter(|(_, p)| p.role == Role::Variant)
            .map(|(name, _)| name)
            .collect();
        let expected = format!("a variant parameter, one of {}", first_of(&known));
        let found = format!("the unknown parameter {name:?}");
        let near = nearest(name, &known).or_else(|| nearest(name, RESERVED));
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
