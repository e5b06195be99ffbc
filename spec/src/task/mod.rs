//! [`TaskSpec`]: typed parameters, a world template that refers to them, and named variants.

mod by;
mod check;
mod choices;
mod compare;
mod document;
mod element_weights;
mod ends;
mod expression;
mod extends;
mod family;
mod group;
mod layouts;
mod load;
mod parameter;
mod read;
mod readers;
mod scope;
mod sweep;
mod template;
mod variant;
mod variant_spec;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use indexmap::IndexMap;
use serde_json::Value as Json;

pub use by::By;
pub use choices::Choices;
pub use compare::{Compare, MeasureName};
pub(crate) use document::TaskDocument;
pub use element_weights::ElementWeights;
pub use expression::Requirement;
pub use group::{Facing, Group, KeepOut};
pub use parameter::{Domain, Parameter, Role};
pub use readers::Readers;
pub use scope::Resolved;
pub use sweep::{Spacing, Sweep};
pub use template::{Hole, Source, Template};
pub use variant::Variant;
pub use variant_spec::{DEFAULT_VARIANT, VariantSpec};

use crate::distribution::Number;
use crate::error::{Problem, SpecError};
use crate::value::Value;
use crate::world::{Object, WorldDraft};
use scope::{Scope, Unsettled};

/// A task: what its worlds have in common, and what varies between them.
///
/// Loading checks everything that can be checked before a world is sampled: types, domains, references, the distributions of
/// every variant, and every chain of `extends`.
///
/// # Example
/// ```
/// use driftworld_spec::TaskSpec;
/// let text = r#"{
///   "name": "light_and_dark",
///   "parameters": { "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 } },
///   "world": { "max_steps": 100, "environment_params": { "light_intensity": { "param": "light" } } },
///   "variants": { "day": {}, "dusk": { "light": 0.3 } }
/// }"#;
/// let task = TaskSpec::from_json("inline", text)?;
/// assert_eq!(task.variant("dusk")?.value("light").and_then(|light| light.as_number()), Some(0.3));
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
#[derive(Debug)]
pub struct TaskSpec {
    document: TaskDocument,
    variants: family::Variants,
    world: Template<WorldDraft>,
    fixtures: Vec<Template<Object>>,
    groups: Vec<PlacedGroup>,
    requirements: Vec<Requirement>,
    /// The conditions of `read_if`, by parameter.
    read_conditions: IndexMap<String, Requirement>,
    /// The readers of each parameter, computed on first use.
    readers: OnceLock<BTreeMap<String, Readers>>,
}

/// A group of a checked task: its declaration, with its count and object ready for sampling.
#[derive(Debug)]
pub struct PlacedGroup {
    /// The group as declared.
    pub spec: Group,
    /// The number of objects.
    pub count: Count,
    /// The template of its objects.
    pub object: Template<Object>,
    /// Index of the group around which it is placed.
    pub around: Option<usize>,
    /// Index of the group that it faces.
    pub facing_group: Option<usize>,
    /// Indices of the groups from which it keeps distance, with the distances in metres.
    pub keep_groups: Vec<(usize, Number)>,
}

/// The number of objects of a group.
#[derive(Clone, Debug, PartialEq)]
pub enum Count {
    /// A fixed number.
    Fixed(u32),
    /// Given by a parameter or a draw.
    Drawn(Source),
}

impl TaskSpec {
    /// The task's name.
    pub fn name(&self) -> &str {
        &self.document.name
    }

    /// The task's description.
    pub fn description(&self) -> &str {
        &self.document.description
    }

    /// The parameters in the order of the document.
    pub fn parameters(&self) -> &IndexMap<String, Parameter> {
        &self.document.parameters
    }

    /// Whether another task has the same document, apart from white space and the order of keys.
    pub fn is_same_as(&self, other: &Self) -> bool {
        std::ptr::eq(self, other) || self.document == other.document
    }

    /// The weight of each element of the decision process in comparisons of variants.
    pub fn element_weights(&self) -> ElementWeights {
        self.document.element_weights
    }

    /// The default comparison of variants: declared by the task, otherwise by parameters.
    pub fn compare_by(&self) -> By {
        self.document.compare_by.unwrap_or(By::Parameters)
    }

    /// The world's template; its objects are in [`TaskSpec::fixtures`].
    pub fn world(&self) -> &Template<WorldDraft> {
        &self.world
    }

    /// The templates of the objects outside groups, each with its own position.
    pub fn fixtures(&self) -> &[Template<Object>] {
        &self.fixtures
    }

    /// The groups in the order of placement.
    pub fn groups(&self) -> &[PlacedGroup] {
        &self.groups
    }

    /// Whether the world template sets the agent's start.
    pub fn says_start(&self) -> bool {
        self.document.world.pointer("/agent_params/coordinates").is_some()
    }

    /// The conditions that every variant and every world must meet.
    pub fn requirements(&self) -> &[Requirement] {
        &self.requirements
    }

    /// The names of the declared variants in the order of the document, with families unfolded; only [`DEFAULT_VARIANT`] if
    /// there are none.
    pub fn variant_names(&self) -> Vec<&str> {
        let declared: Vec<&str> = self.variants.keys().map(String::as_str).collect();
        if declared.is_empty() {
            vec![DEFAULT_VARIANT]
        } else {
            declared
        }
    }

    /// The names of the variants in a family (declared by a grid or a sweep), in order; `None` if there is no such family.
    pub fn family(&self, name: &str) -> Option<Vec<&str>> {
        let spec = self.document.variants.get(name)?;
        let is_family = !spec.grid.is_empty() || !spec.sweep.is_empty();
        let members = self.variants.iter().filter(|(_, declared)| declared.origin == name);
        is_family.then(|| members.map(|(member, _)| member.as_str()).collect())
    }

    /// The names of the families in the order of the document.
    pub fn family_names(&self) -> Vec<&str> {
        let names = self.document.variants.keys().map(String::as_str);
        names.filter(|name| self.family(name).is_some()).collect()
    }

    /// The document as text; [`TaskSpec::from_json`] reads the same task from it.
    pub fn to_json(&self) -> String {
        let mut json = serde_json::to_value(&self.document).expect("a document that was read serialises");
        if let Some(map) = json.as_object_mut() {
            // A task without a world has no such key, because `null` would be rejected.
            map.retain(|key, value| key != "world" || !value.is_null());
        }
        let parameters = json.get_mut("parameters").and_then(Json::as_object_mut);
        for parameter in parameters.into_iter().flat_map(|map| map.values_mut()) {
            // A parameter that changes must list what it affects, even if that is nothing.
            if let Some(parameter) = parameter.as_object_mut().filter(|map| map["role"] != "fixed") {
                parameter.entry("affects").or_insert_with(|| Json::Array(Vec::new()));
            }
        }
        json.to_string()
    }

    /// The author's description of a variant.
    pub fn variant_description(&self, name: &str) -> Option<&str> {
        self.variants.get(name)?.description.as_deref()
    }

    /// The variant with this name. [`DEFAULT_VARIANT`], with every parameter at its default, always exists.
    ///
    /// # Errors
    /// [`SpecError::UnknownVariant`] with the known names; [`SpecError::Values`] if the defaults violate a requirement.
    pub fn variant(self: &Arc<Self>, name: &str) -> Result<Variant, SpecError> {
        if !self.variants.contains_key(name) && name != DEFAULT_VARIANT {
            let known: Vec<&str> = match self.family(name) {
                Some(members) => members,
                None => self.variant_names(),
            };
            return Err(SpecError::UnknownVariant {
                task: self.name().to_owned(),
                found: name.to_owned(),
                known: known.into_iter().map(str::to_owned).collect(),
            });
        }
        let values = extends::values_of(&self.document.parameters, &self.variants, name)
            .expect("loading the task checked every chain of extends");
        // Loading checked the declared variants, but not the defaults, which may never be needed.
        let problems = if self.variants.contains_key(name) {
            Vec::new()
        } else {
            self.problems_of(&values)
        };
        if problems.is_empty() {
            Ok(Variant::new(Arc::clone(self), name, values))
        } else {
            let variant = format!("{}#{name}", self.name());
            Err(SpecError::Values { variant, problems })
        }
    }

    /// All declared variants.
    pub fn all_variants(self: &Arc<Self>) -> Vec<Variant> {
        let names = self.variant_names();
        names.into_iter().filter_map(|name| self.variant(name).ok()).collect()
    }

    /// The document in canonical form, without parts that change neither worlds nor distances: descriptions and variants.
    pub(crate) fn canonical(&self) -> Json {
        let mut json = serde_json::to_value(&self.document).expect("a document that was read serialises");
        if let Some(map) = json.as_object_mut() {
            map.shift_remove("description");
            map.shift_remove("variants");
        }
        json
    }

    /// Reasons why a variant with these values cannot be sampled: invalid distributions and violated requirements.
    pub(crate) fn problems_of(&self, values: &IndexMap<String, Value>) -> Vec<Problem> {
        if let Some((requirement, shown)) = variant::violated_requirement(&self.requirements, values) {
            let expected = format!("the condition in \"require\": {requirement}");
            let mut problems = self.faults_of(values);
            problems.push(Problem::new("spec/requirement", "/require", shown, expected));
            return problems;
        }
        self.faults_of(values)
    }

    /// Reasons, other than requirements, why a variant with these values cannot be sampled: invalid distributions and margins
    /// out of range.
    pub(crate) fn faults_of(&self, values: &IndexMap<String, Value>) -> Vec<Problem> {
        let mut problems = Vec::new();
        let scope = Scope::new(&self.document.parameters, values);
        let mut check = |pointer: &dyn Fn() -> String, source: &Source| {
            // A randomized parameter, or one that is not a distribution, is checked elsewhere.
            if let Source::Param(reference) = source
                && !matches!(values.get(&reference.param), Some(Value::Distribution(_)))
            {
                return;
            }
            match scope.outcomes(source) {
                Ok(outcomes) => {
                    let fault = outcomes.iter().find_map(|(distribution, _)| distribution.fault());
                    problems.extend(
                        fault.map(|(found, expected)| Problem::new("spec/distribution", pointer(), found, expected)),
                    );
                }
                Err(Unsettled::NoCase(found, expected)) => {
                    problems.push(Problem::new("spec/case", pointer(), found, expected));
                }
                Err(_) => {}
            }
        };
        for (name, parameter) in &self.document.parameters {
            parameter
                .distribution
                .iter()
                .for_each(|source| check(&|| format!("/parameters/{name}/distribution"), source));
        }
        for hole in &self.world.holes {
            check(&|| format!("/world{}", hole.pointer), &hole.source);
        }
        for (index, fixture) in self.fixtures.iter().enumerate() {
            fixture
                .holes
                .iter()
                .for_each(|hole| check(&|| format!("/world/objects/{index}{}", hole.pointer), &hole.source));
        }
        for (index, group) in self.groups.iter().enumerate() {
            check(&|| format!("/groups/{index}/placement"), &group.spec.placement);
            if let Count::Drawn(source) = &group.count {
                check(&|| format!("/groups/{index}/count"), source);
            }
            for hole in &group.object.holes {
                check(&|| format!("/groups/{index}/object{}", hole.pointer), &hole.source);
            }
        }
        for (index, group) in self.groups.iter().enumerate() {
            let anything = f64::MIN..=f64::MAX;
            let mut numbers = vec![
                ("separation", &group.spec.separation, 0.0..=300.0),
                ("keep_out/walls", &group.spec.keep_out.walls, 0.0..=300.0),
                ("keep_out/agent", &group.spec.keep_out.agent, 0.0..=300.0),
            ];
            let keep_groups = group.keep_groups.iter();
            numbers.extend(keep_groups.map(|(_, number)| ("keep_out/groups", number, anything.clone())));
            if let Some(Facing::Point(point)) = &group.spec.facing {
                numbers.extend(point.iter().map(|number| ("facing", number, anything.clone())));
            }
            for (key, number, range) in numbers {
                let pointer = || format!("/groups/{index}/{key}");
                match scope.number(number) {
                    Ok(metres) if !range.contains(&metres) => {
                        problems.push(Problem::new(
                            "spec/range",
                            pointer(),
                            format!("{metres} m"),
                            "0 to 300 m",
                        ));
                    }
                    Err(Unsettled::NoCase(found, expected)) => {
                        problems.push(Problem::new("spec/case", pointer(), found, expected));
                    }
                    _ => {}
                }
            }
        }
        problems
    }
}
