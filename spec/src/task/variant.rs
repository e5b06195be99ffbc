//! [`Variant`]: one variant of a task, in which every fixed and variant parameter has a value.

use std::sync::Arc;

use indexmap::IndexMap;
use sha2::{Digest, Sha256};

use super::TaskSpec;
use super::expression::Requirement;
use super::parameter::{Parameter, Role};
use super::scope::{self, Resolved, Scope, Unsettled};
use super::template::Source;
use super::variant_spec::variant_parameters;
use crate::describe::hexadecimal;
use crate::distribution::{Distribution, Number};
use crate::error::{Problem, SpecError};
use crate::value::Value;

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

    /// Its name on the command line: `find_objects#red`.
    pub fn id(&self) -> String {
        format!("{}#{}", self.task.name(), self.name)
    }

    /// A hash of everything that determines its worlds and distances: the task's document in the current version,
    /// without descriptions and variants, and this variant's name and values. The same hash means the same worlds.
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
        hexadecimal(&Sha256::digest(whole.to_string()))
    }

    /// The task of this variant.
    pub fn task(&self) -> &Arc<TaskSpec> {
        &self.task
    }

    /// Its name within the task.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The values of all fixed and variant parameters, typed, in the task's order of declaration.
    pub fn values(&self) -> &IndexMap<String, Value> {
        &self.values
    }

    /// The value of a fixed or variant parameter; `None` for a randomized or unknown parameter.
    pub fn value(&self, parameter: &str) -> Option<&Value> {
        self.values.get(parameter)
    }

    /// The distribution of a randomized parameter, or the value of a parameter of type distribution, with all numbers resolved;
    /// `None` for any other parameter.
    pub fn distribution(&self, parameter: &str) -> Option<Distribution> {
        if let Some(Value::Distribution(distribution)) = self.values.get(parameter) {
            return Some(self.settle(distribution));
        }
        let declared = self.task.parameters().get(parameter)?.distribution.as_ref()?;
        match self.resolve(declared) {
            Resolved::Draw(distribution) => Some(distribution),
            Resolved::Value(value) => Some(Distribution::Constant { value }),
            Resolved::Randomized(_) => None,
        }
    }

    /// Resolves a source. If its look-ups read randomized parameters, the result is a draw that mixes all cases.
    pub fn resolve(&self, source: &Source) -> Resolved {
        self.resolve_with(source, &[]).unwrap_or_else(|| {
            let outcomes = self.scope().outcomes(source);
            Resolved::Draw(scope::merged(
                outcomes.expect("loading the task checked the cases of every look-up"),
            ))
        })
    }

    /// Resolves a source in a world with these values of randomized parameters; `None` if its look-ups read other randomized
    /// parameters.
    pub fn resolve_with(&self, source: &Source, drawn: &[(&str, Value)]) -> Option<Resolved> {
        let scope = Scope { drawn, ..self.scope() };
        match scope.resolve(source) {
            Ok(resolved) => Some(resolved),
            Err(Unsettled::Drawn(_)) => None,
            Err(other) => unreachable!("loading the task checked every reference and look-up: {other:?}"),
        }
    }

    fn scope(&self) -> Scope<'_> {
        Scope::new(self.task.parameters(), &self.values)
    }

    /// A distribution with every reference replaced by this variant's value.
    pub fn settle(&self, distribution: &Distribution<Number>) -> Distribution {
        let settled = self.scope().settle(distribution);
        settled.expect("loading the task checked that every reference names a number")
    }

    /// The value of a literal, a reference or a look-up in this variant.
    pub fn number(&self, number: &Number) -> f64 {
        let settled = self.scope().number(number);
        settled.expect("loading the task checked that every reference names a number")
    }

    /// A variant like this one with a different name and some changed values.
    ///
    /// Each value must have its parameter's type and be in its range; if the domain is a list of choices, it may be between them,
    /// like the colours of a drift.
    ///
    /// # Errors
    /// [`SpecError::Values`] with every parameter that cannot have its value, an invalid distribution, or a violated
    /// requirement.
    pub fn with(&self, name: &str, changes: impl IntoIterator<Item = (String, Value)>) -> Result<Self, SpecError> {
        self.changed(name, changes, TaskSpec::problems_of)
    }

    /// Like [`Variant::with`], but without checking the task's requirements, so that distances to forbidden variants can be
    /// measured. Do not sample worlds from it.
    ///
    /// # Errors
    /// [`SpecError::Values`] with every parameter that cannot have its value, or an invalid distribution.
    pub fn beyond_requirements(
        &self,
        name: &str,
        changes: impl IntoIterator<Item = (String, Value)>,
    ) -> Result<Self, SpecError> {
        self.changed(name, changes, TaskSpec::faults_of)
    }

    fn changed(
        &self,
        name: &str,
        changes: impl IntoIterator<Item = (String, Value)>,
        check: impl Fn(&TaskSpec, &IndexMap<String, Value>) -> Vec<Problem>,
    ) -> Result<Self, SpecError> {
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
            problems = check(&self.task, &values);
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
    let parameter = parameters
        .get(name)
        .filter(|parameter| parameter.role == Role::Variant)
        .ok_or_else(|| {
            let (known, expected) = variant_parameters(parameters);
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

/// The first violated requirement on the given parameters, with the values that violate it.
pub(crate) fn violated_requirement<'a>(
    requirements: &'a [Requirement],
    values: &IndexMap<String, Value>,
) -> Option<(&'a Requirement, String)> {
    let value_of = |name: &str| values.get(name).cloned();
    let violated = requirements
        .iter()
        .find(|requirement| requirement.holds(value_of) == Some(false))?;
    Some((violated, violated.describe(value_of)))
}
