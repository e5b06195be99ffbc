//! Checks before a scenario is written that it can be run: its names in logs, its classes, and a few of its worlds.

use driftworld_curriculum::{Tried, Undrawable};
use driftworld_env::Catalogue;
use driftworld_spec::{Classes, Scenario};

use crate::{Failure, argument, scenarios, tasks, trials};

/// Checks scenarios; parts that several of them share are checked once.
pub(super) struct Drawable {
    worlds: u32,
    classes: Classes,
    tried: Tried,
}

impl Drawable {
    pub(super) fn new(worlds: u32, catalogue: &Catalogue) -> Self {
        Self {
            worlds,
            classes: tasks::classes(catalogue),
            tried: Tried::default(),
        }
    }

    /// Refuses a scenario that could not be run.
    pub(super) fn check(&mut self, scenario: &Scenario) -> Result<(), Failure> {
        let plan = scenarios::plan(scenario, Undrawable::Skipped)?;
        for (name, task) in plan.tasks() {
            tasks::check_classes(name, task, &self.classes)?;
        }
        let found = plan.try_worlds(self.worlds, &mut self.tried);
        let Some(summary) = trials::summary(&found) else {
            return Ok(());
        };
        let failed: Vec<_> = found.into_iter().filter(|trial| trial.num_failed() > 0).collect();
        Err(Failure::input(format!(
            "{}: {summary}, so the scenario is not written\n{}\nfix the task; or write it unchecked with {} 0, and \
             skip such experiences with driftworld run {}",
            scenario.name,
            trials::shown(&failed),
            argument("worlds"),
            argument("skip_undrawable")
        )))
    }
}
