//! [`ElementsRequest`]: the variants to test, the number of worlds, and the learner.

use std::path::PathBuf;
use std::sync::Arc;

use clap::Args;
use driftworld_env::MAX_EXPERIMENT_STEPS;
use driftworld_spec::{Modality, TaskSpec, Variant};
use serde::Deserialize;

use crate::modality;
use crate::numbers::{self, documented};
use crate::{Failure, tasks, within};

/// Default number of pairs of worlds.
pub const DEFAULT_ELEMENTS_WORLDS: u64 = 32;

/// Maximum number of pairs of worlds.
pub const MAX_ELEMENTS_WORLDS: u64 = 1_000;

/// The settings of the test: the arguments of `driftworld elements` and of Python's `elements`. There are 1 to
/// [`MAX_ELEMENTS_WORLDS`] pairs of worlds, and 1 to [`MAX_EXPERIMENT_STEPS`] steps. If `a` and `b` are given, they are
/// compared with each other; otherwise all variants, or the one that `task` names, are compared with the first.
#[derive(Args, Clone, Debug, PartialEq, Deserialize)]
#[group(skip)]
#[serde(default, deny_unknown_fields)]
pub struct ElementsRequest {
    /// A task: PATH, PATH#variant, or a built-in such as `find_objects`.
    pub task: String,
    /// A variant of the task.
    #[arg(requires = "b")]
    pub a: Option<String>,
    /// The variant that is compared with it.
    pub b: Option<String>,
    /// Images that the learner gets [default: those of the task's worlds].
    #[arg(long, value_parser = documented::<Modality>(&modality::NAMES), value_delimiter = ',', value_name = "KIND,…")]
    pub modalities: Option<Vec<Modality>>,
    /// Number of pairs of worlds to test.
    #[arg(long, default_value_t = DEFAULT_ELEMENTS_WORLDS, value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..=MAX_ELEMENTS_WORLDS))]
    pub worlds: u64,
    /// Seed of the worlds.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = numbers::seed)]
    pub seed: u64,
    /// Maximum number of steps per episode.
    #[arg(long, default_value_t = 100, value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_EXPERIMENT_STEPS)))]
    pub steps: u32,
    /// An asset library to search before the built-in assets. Repeatable.
    ///
    /// The last one given is searched first.
    #[arg(long = "assets", value_name = "LIBRARY")]
    #[serde(rename = "assets")]
    pub libraries: Vec<PathBuf>,
}

impl Default for ElementsRequest {
    fn default() -> Self {
        Self {
            task: String::new(),
            a: None,
            b: None,
            modalities: None,
            worlds: DEFAULT_ELEMENTS_WORLDS,
            seed: 0,
            steps: 100,
            libraries: Vec::new(),
        }
    }
}

impl ElementsRequest {
    /// All variants of a task, compared with the first.
    pub fn of(task: impl Into<String>) -> Self {
        Self {
            task: task.into(),
            ..Self::default()
        }
    }

    /// One variant of a task, compared with another.
    pub fn between(task: impl Into<String>, a: impl Into<String>, b: impl Into<String>) -> Self {
        Self {
            a: Some(a.into()),
            b: Some(b.into()),
            ..Self::of(task)
        }
    }

    /// Refuses values out of range.
    pub(super) fn check(&self) -> Result<(), Failure> {
        within("worlds", self.worlds, 1..=MAX_ELEMENTS_WORLDS)?;
        within("steps", self.steps.into(), 1..=MAX_EXPERIMENT_STEPS.into())?;
        if self.a.is_some() != self.b.is_some() {
            return Err(Failure::usage("found one variant, expected none or two"));
        }
        if self.a.is_some() && tasks::split(&self.task).1.is_some() {
            return Err(Failure::usage(format!(
                "task: found {:?} beside two variants, expected the task alone",
                self.task
            )));
        }
        Ok(())
    }

    /// The variants to compare: the first with each of the others.
    pub(super) fn variants_of(&self, task: &Arc<TaskSpec>) -> Result<Vec<Variant>, Failure> {
        // A variant may be given as TASK#VARIANT.
        let own = |name: &str| tasks::split(name).1.unwrap_or(name).to_owned();
        if let (Some(a), Some(b)) = (&self.a, &self.b) {
            return [a, b].map(|name| Ok(task.variant(&own(name))?)).into_iter().collect();
        }
        let all = task.all_variants();
        match tasks::split(&self.task).1 {
            None => Ok(all),
            Some(name) => Ok(all.into_iter().take(1).chain([task.variant(name)?]).collect()),
        }
    }
}
