//! Checks before a scenario is written that it can be run: its names in logs, its classes, and a few of its worlds.

use driftworld_curriculum::{Tried, Undrawable};
use driftworld_spec::{Classes, Scenario};

use crate::{Failure, argument, scenarios, tasks, trials};

/// Refuses a scenario that could not be run. Parts that it shares with scenarios already `tried` are not checked again.
pub(super) fn check_drawable(
    scenario: &Scenario,
    worlds: u32,
    classes: &Classes,
    tried: &mut Tried,
) -> Result<(), Failure> {
    let plan = scenarios::plan(scenario, Undrawable::Skipped)?;
    for (name, task) in plan.tasks() {
        tasks::check_classes(name, task, classes)?;
    }
    let found = plan.try_worlds(worlds, tried);
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
