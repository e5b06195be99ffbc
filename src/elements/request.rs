//! [`ElementsRequest`]: which variants are tried, on how many worlds, and for which learner.

use std::path::PathBuf;
use std::sync::Arc;

use driftworld_env::MAX_EXPERIMENT_STEPS;
use driftworld_spec::{Modality, TaskSpec, Variant};

use crate::{Failure, tasks, within};

/// How many pairs of worlds are tried where nobody says.
pub const DEFAULT_ELEMENTS_WORLDS: u64 = 32;

/// The most pairs of worlds that can be tried.
pub const MAX_ELEMENTS_WORLDS: u64 = 1_000;

/// What is tried.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementsRequest {
    /// The task: a name or a path; with `#variant`, that variant alone is compared with the first.
    pub task: String,
    /// Two variants of the task that are compared with each other, in place of all with the first.
    pub between: Option<[String; 2]>,
    /// Which images the learner has; those that the task's worlds ask for if absent.
    pub modalities: Option<Vec<Modality>>,
    /// How many pairs of worlds, 1 to [`MAX_ELEMENTS_WORLDS`]; default [`DEFAULT_ELEMENTS_WORLDS`].
    pub worlds: u64,
    /// The seed that worlds are drawn under; default 0.
    pub seed: u64,
    /// Steps of an episode, 1 to [`MAX_EXPERIMENT_STEPS`]; default 100.
    pub steps: u32,
    /// Asset libraries whose classes the task uses, in front of the built-in assets, the last one first.
    pub libraries: Vec<PathBuf>,
}

impl ElementsRequest {
    /// All variants of a task beside the first.
    pub fn of(task: impl Into<String>) -> Self {
        Self {
            task: task.into(),
            between: None,
            modalities: None,
            worlds: DEFAULT_ELEMENTS_WORLDS,
            seed: 0,
            steps: 100,
            libraries: Vec::new(),
        }
    }

    /// One variant of a task beside another.
    pub fn between(task: impl Into<String>, a: impl Into<String>, b: impl Into<String>) -> Self {
        Self {
            between: Some([a.into(), b.into()]),
            ..Self::of(task)
        }
    }

    /// Refuses what is out of its range.
    pub(super) fn check(&self) -> Result<(), Failure> {
        within("worlds", self.worlds, 1..=MAX_ELEMENTS_WORLDS)?;
        within("steps", self.steps.into(), 1..=MAX_EXPERIMENT_STEPS.into())?;
        if self.between.is_some() && tasks::split(&self.task).1.is_some() {
            return Err(Failure::usage(format!(
                "task: found {:?} beside two variants, expected the task alone",
                self.task
            )));
        }
        Ok(())
    }

    /// The variants that are compared: the first with each of the others.
    pub(super) fn variants_of(&self, task: &Arc<TaskSpec>) -> Result<Vec<Variant>, Failure> {
        // A variant may be called as everywhere else: TASK#VARIANT.
        let own = |name: &str| tasks::split(name).1.unwrap_or(name).to_owned();
        if let Some(names) = &self.between {
            return names.iter().map(|name| Ok(task.variant(&own(name))?)).collect();
        }
        let all = task.all_variants();
        match tasks::split(&self.task).1 {
            None => Ok(all),
            Some(name) => Ok(all.into_iter().take(1).chain([task.variant(name)?]).collect()),
        }
    }
}
