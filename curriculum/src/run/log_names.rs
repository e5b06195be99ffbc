//! The names of variants in a log, and a check that no two variants have the same name there.

use std::collections::BTreeMap;
use std::sync::Arc;

use driftworld_metrics::logged_word;
use driftworld_spec::{Regime, Scenario, TaskSpec};

use crate::CurriculumError;

/// The name of a variant in a log: the letters and digits of the task's name, an underscore, and the letters and digits of the
/// variant's name.
///
/// The format requires `task_variant` with letters and digits only: `find_objects` and `red` become `findobjects_red`. A name
/// without letters and digits becomes `x`.
pub fn log_name(task: &str, variant: &str) -> String {
    format!("{}_{}", logged_word(task), logged_word(variant))
}

/// The names in a log, with the scenario's names for them.
#[derive(Default)]
pub(super) struct LogNames(BTreeMap<String, String>);

impl LogNames {
    /// Claims a log name for a regime's variant; an error if another variant has it already.
    pub(super) fn claim(&mut self, regime: &Regime, name: &str) -> Result<(), CurriculumError> {
        let scenario_name = scenario_name(regime);
        match self.0.insert(name.to_owned(), scenario_name.clone()) {
            Some(other) if other != scenario_name => Err(CurriculumError::SameLogName {
                a: other,
                b: scenario_name,
                name: name.to_owned(),
            }),
            _ => Ok(()),
        }
    }
}

/// The first two variants of a scenario with the same log name, as an error. `task` looks up the tasks that the scenario names;
/// if it returns `None`, the name in the scenario is taken to be the task's own.
///
/// # Example
/// ```
/// use driftworld_curriculum::same_log_name;
/// use driftworld_spec::Scenario;
/// let regime = |variant: &str| format!(r#"{{ "task": "t", "variant": "{variant}", "count": 1 }}"#);
/// let text = format!(
///     r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{}, {}] }}] }}"#,
///     regime("two-a"), regime("twoa")
/// );
/// let scenario = Scenario::from_json("s", &text)?;
/// let error = same_log_name(&scenario, |_| None).expect("both are t_twoa");
/// assert!(error.to_string().contains("t_twoa"));
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
pub fn same_log_name(
    scenario: &Scenario,
    mut task: impl FnMut(&str) -> Option<Arc<TaskSpec>>,
) -> Option<CurriculumError> {
    let mut names = LogNames::default();
    let mut tasks: BTreeMap<&str, String> = BTreeMap::new();
    let mut named = |name| -> String {
        let own = tasks.entry(name);
        let own = own.or_insert_with(|| task(name).map_or_else(|| name.to_owned(), |task| task.name().to_owned()));
        own.clone()
    };
    for regime in scenario.blocks.iter().flat_map(|block| &block.regimes) {
        // A world from a file is logged under the scenario's name for its task.
        let own = match &regime.world {
            Some(_) => regime.task.clone(),
            None => named(regime.task.as_str()),
        };
        let variant = match &regime.drift {
            Some(drift) if regime.end_task() != regime.task => {
                let end = named(regime.end_task());
                format!("{}to{end}{}", regime.variant_name(), drift.variant_name())
            }
            Some(drift) => format!("{}to{}", regime.variant_name(), drift.variant_name()),
            None => regime.variant_name().to_owned(),
        };
        if let Err(error) = names.claim(regime, &log_name(&own, &variant)) {
            return Some(error);
        }
    }
    None
}

/// The scenario's name for a regime's variant.
fn scenario_name(regime: &Regime) -> String {
    let to = match &regime.drift {
        None => String::new(),
        Some(drift) if regime.end_task() == regime.task => format!("..{}", drift.variant_name()),
        Some(drift) => format!("..{}#{}", regime.end_task(), drift.variant_name()),
    };
    format!("{}#{}{to}", regime.task, regime.variant_name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log_names_are_letters_and_digits() {
        let check = |task: &str, variant: &str, expected: &str| assert_eq!(log_name(task, variant), expected);
        check("find_objects", "red", "findobjects_red");
        check("Task1", "map_findobjects_0", "task1_mapfindobjects0");
        check("tasks/my-own.json", "élan 2", "tasksmyownjson_lan2");
        check("任务", "#", "x_x");
    }
}
