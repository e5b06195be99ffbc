//! [`Choice`]: a variant as a scenario names it, declared by its task or made of a declared one. Finding variants is not done here.

use driftworld_spec::{Regime, Value, Variant};
use indexmap::IndexMap;

/// A variant as a scenario names it.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The task: a built-in name, or the path of a task spec.
    pub task: String,
    /// The variant of the task that it is, or that it is made of.
    pub variant: String,
    /// Values laid over the variant's; empty for a declared variant.
    pub values: IndexMap<String, Value>,
    /// What it is called where it has values of its own.
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

    /// A variant that no task declares, by the values in which it differs from one that `task` does.
    pub fn made(task: impl Into<String>, from: &Variant, made: &Variant) -> Self {
        Self {
            values: changes(from, made),
            name: Some(made.name().to_owned()),
            ..Self::new(task, from.name())
        }
    }

    /// Its name among the variants of its task.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.variant)
    }

    /// The name by which tables know it: `find_objects#red`.
    pub fn id(&self) -> String {
        format!("{}#{}", self.task, self.name())
    }

    /// A stretch of experiences of it.
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
