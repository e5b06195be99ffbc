//! [`Choice`]: a variant as named in a scenario, either declared by its task or derived from a declared one.

use driftworld_spec::{Regime, Value, Variant};
use indexmap::IndexMap;

/// A variant as named in a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The task: a built-in name, or the path of a task spec.
    pub task: String,
    /// The declared variant, or the one that this variant is derived from.
    pub variant: String,
    /// Values that override the variant's; empty for a declared variant.
    pub values: IndexMap<String, Value>,
    /// Its name, if it has values of its own.
    pub name: Option<String>,
}

impl Choice {
    /// A variant that its task declares.
    pub fn new(task: impl Into<String>, variant: impl Into<String>) -> Self {
        Self {
            task: task.into(),
            variant: variant.into(),
            values: IndexMap::new(),
            name: None,
        }
    }

    /// A generated variant, described by its differences from the declared variant `from`.
    pub fn made(task: impl Into<String>, from: &Variant, generated: &Variant) -> Self {
        Self {
            values: changes(from, generated),
            name: Some(generated.name().to_owned()),
            ..Self::new(task, from.name())
        }
    }

    /// Its name among the variants of its task.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.variant)
    }

    /// Its name in tables: `find_objects#red`.
    pub fn id(&self) -> String {
        format!("{}#{}", self.task, self.name())
    }

    /// A regime of `count` experiences of it.
    pub(super) fn regime(&self, count: u32, seed: u64, first_index: u64) -> Regime {
        Regime {
            values: self.values.clone(),
            name: self.name.clone(),
            seed,
            first_index,
            ..Regime::new(&self.task, &self.variant, count)
        }
    }
}

/// The values in which a variant differs from another of its task.
pub(super) fn changes(from: &Variant, to: &Variant) -> IndexMap<String, Value> {
    let values = to.values().iter();
    let changed = values.filter(|(name, value)| from.value(name) != Some(*value));
    changed.map(|(name, value)| (name.clone(), value.clone())).collect()
}
