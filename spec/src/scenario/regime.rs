//! [`Regime`]: a sequence of experiences of one variant, as declared in a scenario.

use std::sync::Arc;

use driftworld_text::NAME_PATTERN;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::drift::RegimeDrift;
use crate::error::SpecError;
use crate::task::{TaskSpec, Variant};
use crate::value::Value;

/// A sequence of experiences (episodes) of one variant, or of a drift from it to another.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "task": "find_objects", "variant": "red", "count": 100, "seed": 7, "first_index": 0 },
    { "task": "find_objects", "variant": "red", "values": { "light": 1.2 }, "name": "red-dim", "count": 100 },
    { "task": "Task1", "variant": "yard", "world": "maps/yard.json", "max_steps": 200, "count": 10 },
    { "task": "find_objects", "variant": "red", "count": 100, "drift": { "to": "dusk", "schedule": "cosine" } },
]))]
pub struct Regime {
    /// The task: a built-in name, or the path of a task spec.
    #[schemars(length(min = 1, max = 4096))]
    pub task: String,
    /// The variant of the task.
    #[schemars(length(min = 1, max = 100))]
    pub variant: String,
    /// Values that override the variant's, by parameter: they make a new variant that the task does not declare.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(schema_with = "super::drift::values_schema")]
    pub values: IndexMap<String, Value>,
    /// The name of the variant with these values in tables and logs; only with `values`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 100), regex(pattern = NAME_PATTERN))]
    pub name: Option<String>,
    /// Number of experiences.
    #[schemars(range(min = 1, max = 10_000_000))]
    pub count: u32,
    /// A budget of decisions for a learning block: once its experiences have used it up, no further experience begins. `count`
    /// is then the maximum number of experiences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 1_000_000_000))]
    pub steps: Option<u32>,
    /// The seed of its worlds.
    #[serde(default)]
    pub seed: u64,
    /// The index of its first world; the others follow.
    #[serde(default)]
    pub first_index: u64,
    /// A world file, ours or L2Explorer's, used in every experience instead of sampled worlds; relative to the scenario's
    /// folder. Task and variant are then only names.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 4096))]
    pub world: Option<String>,
    /// Steps after which an experience is cut off, overriding the world's value; 0 = never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 1_000_000_000))]
    pub max_steps: Option<u32>,
    /// A drift from the variant to another over the course of the experiences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift: Option<RegimeDrift>,
}

impl Regime {
    /// The first `count` worlds of a variant under seed 0.
    pub fn new(task: impl Into<String>, variant: impl Into<String>, count: u32) -> Self {
        Self {
            task: task.into(),
            variant: variant.into(),
            count,
            ..Self::default()
        }
    }

    /// Name of its variant in tables and logs: the regime's name if it has one, otherwise the variant's.
    pub fn variant_name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.variant)
    }

    /// The variant from which its worlds are drawn, with its values applied; for a drift, the start variant.
    ///
    /// # Errors
    /// [`SpecError::UnknownVariant`] if the task has no such variant; [`SpecError::Values`] if the variant cannot have the
    /// values.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Regime, TaskSpec, Value};
    /// let task = TaskSpec::from_json("t", r#"{ "name": "t", "parameters": {
    ///     "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 } } }"#)?;
    /// let mut regime = Regime::new("t", "default", 10);
    /// regime.values.insert("light".into(), Value::Number(0.5));
    /// regime.name = Some("dim".into());
    /// let variant = regime.resolve(&task)?;
    /// assert_eq!((variant.id().as_str(), variant.value("light")), ("t#dim", Some(&Value::Number(0.5))));
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn resolve(&self, task: &Arc<TaskSpec>) -> Result<Variant, SpecError> {
        with_overrides(task, &self.variant, &self.values, self.variant_name())
    }

    /// The task of the drift's end variant, as the scenario names it; the regime's own task without a drift.
    pub fn end_task(&self) -> &str {
        let of_drift = self.drift.as_ref().and_then(|drift| drift.task.as_deref());
        of_drift.unwrap_or(&self.task)
    }

    /// The variant of [`end_task`](Self::end_task) that its drift leads to; `None` without a drift.
    ///
    /// # Errors
    /// As [`Regime::resolve`].
    pub fn resolve_end(&self, task: &Arc<TaskSpec>) -> Result<Option<Variant>, SpecError> {
        self.drift
            .as_ref()
            .map(|drift| with_overrides(task, &drift.to, &drift.values, drift.variant_name()))
            .transpose()
    }
}

fn with_overrides(
    task: &Arc<TaskSpec>,
    variant: &str,
    values: &IndexMap<String, Value>,
    name: &str,
) -> Result<Variant, SpecError> {
    let declared = task.variant(variant)?;
    if values.is_empty() {
        return Ok(declared);
    }
    declared.with(name, values.iter().map(|(name, value)| (name.clone(), value.clone())))
}
