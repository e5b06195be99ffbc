//! [`WorldRequest`] identifies a world for a page or a link; [`TaskCache`] parses or samples the world.

use std::collections::BTreeMap;
use std::sync::Arc;

use driftworld::distances::Side;
use driftworld::spec::{DEFAULT_VARIANT, Style, TaskSpec, Value, Variant, World};
use driftworld::{generator, tasks};
use serde::{Deserialize, Serialize};

use crate::fault::Fault;

/// A world drawn from a task, or a world given as JSON.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WorldRequest {
    /// The name of a built-in task, or the text of a task spec.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) task: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) variant: Option<String>,
    /// Values that override those of the variant.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(crate) values: BTreeMap<String, Value>,
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) seed: u64,
    #[serde(default, skip_serializing_if = "is_zero")]
    pub(crate) index: u64,
    /// The JSON of a world, instead of a task.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) world: Option<String>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde requires this signature")]
fn is_zero(number: &u64) -> bool {
    *number == 0
}

/// The name given to a variant with overridden values.
const CHANGED: &str = "changed";

/// Caches the task that was read last, because a page requests many worlds of the same task.
#[derive(Debug, Default)]
pub(crate) struct TaskCache(Option<(String, Arc<TaskSpec>)>);

impl TaskCache {
    /// The task with this name or text.
    pub(crate) fn task(&mut self, name_or_text: &str) -> Result<Arc<TaskSpec>, Fault> {
        if let Some((known, task)) = &self.0
            && known == name_or_text
        {
            return Ok(Arc::clone(task));
        }
        let task = if is_text(name_or_text) {
            let classes = tasks::classes(&driftworld::env::Catalogue::default());
            TaskSpec::from_json_with("task", name_or_text, Some(&classes))?
        } else {
            tasks::task(name_or_text)?
        };
        self.0 = Some((name_or_text.to_owned(), Arc::clone(&task)));
        Ok(task)
    }

    /// The variant of a request, with the values that the request sets.
    pub(crate) fn variant(&mut self, request: &WorldRequest) -> Result<Variant, Fault> {
        let name_or_text = request.task.as_deref().ok_or_else(|| {
            Fault::request("request: found no task, expected the name or the text of one, or a world")
        })?;
        let variant = self
            .task(name_or_text)?
            .variant(request.variant.as_deref().unwrap_or(DEFAULT_VARIANT))?;
        if request.values.is_empty() {
            return Ok(variant);
        }
        let values = request.values.iter().map(|(name, value)| (name.clone(), value.clone()));
        Ok(variant.with(CHANGED, values)?)
    }

    /// The world of a request.
    pub(crate) fn world(&mut self, request: &WorldRequest) -> Result<World, Fault> {
        match &request.world {
            Some(_) if request.task.is_some() => Err(Fault::request("request: found a task and a world, expected one")),
            Some(text) => {
                let classes = tasks::classes(&driftworld::env::Catalogue::default());
                Ok(World::from_json_with("world", text, Some(&classes))?)
            }
            None => Ok(generator::sample(&self.variant(request)?, request.seed, request.index)?),
        }
    }

    /// One side of a comparison: the variant of a request, or its world.
    pub(crate) fn side(&mut self, request: &WorldRequest, as_worlds: bool) -> Result<Side, Fault> {
        if as_worlds || request.world.is_some() {
            return Ok(Side::World(Box::new(self.world(request)?)));
        }
        Ok(Side::Variant(self.variant(request)?))
    }
}

/// Whether a task is given by its text rather than by its name.
pub(crate) fn is_text(name_or_text: &str) -> bool {
    name_or_text.trim_start().starts_with(['{', '/', '\u{feff}'])
}

/// The world in the given style, or its own.
pub(crate) fn in_style(world: World, style: Option<Style>) -> Result<World, Fault> {
    let Some(style) = style else { return Ok(world) };
    Ok(world.edit(|world| world.environment_params.looks.style = style)?)
}
