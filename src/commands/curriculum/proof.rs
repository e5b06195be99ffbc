//! That a scenario can be run, before it is written: its names in logs, its classes, a few of its worlds. Drawing them is the library's.

use crate::commands::assets::LibraryChoice;
use crate::commands::{Failure, trials};
use crate::curriculum::Tried;
use crate::scenarios;
use crate::spec::{Classes, Scenario};
use crate::tasks;

/// What is looked at of each scenario; what one has in common with another is looked at once.
pub(super) struct Proof {
    worlds: u32,
    classes: Classes,
    tried: Tried,
}

impl Proof {
    pub(super) fn new(worlds: u32, libraries: &LibraryChoice) -> Result<Self, Failure> {
        Ok(Self {
            worlds,
            classes: tasks::classes(&libraries.catalogue()?),
            tried: Tried::default(),
        })
    }

    /// Refuses a scenario that could not be run.
    pub(super) fn check(&mut self, scenario: &Scenario) -> Result<(), Failure> {
        let plan = scenarios::plan_to_try(scenario)?;
        for (name, task) in plan.tasks() {
            tasks::check_classes(name, task, &self.classes)?;
        }
        let found = plan.try_worlds(self.worlds, &mut self.tried);
        let Some(told) = trials::told(&found) else {
            return Ok(());
        };
        let failed: Vec<_> = found.into_iter().filter(|trial| trial.num_failed() > 0).collect();
        Err(Failure::input(format!(
            "{}: {told}, so the scenario is not written\n{}\nmend the task; or write it as it is with --worlds 0, and leave such \
             experiences out with driftworld run --skip-undrawable",
            scenario.name,
            trials::shown(&failed)
        )))
    }
}
