//! Warns about scales that do not fit a log: no scale applies, a name is slightly different, or a set of tasks that look alike was
//! measured with other tasks.

use driftworld_metrics::{Log, Options, Scales};
use driftworld_spec::did_you_mean;
use driftworld_text::first_of;

use super::experts::{scored_name, tasks};

/// Maximum number of names listed.
const MAX_NAMES: usize = 5;

/// Warnings about the scales of this log.
pub(super) fn unfit_scales(log: &Log, options: &Options) -> Vec<String> {
    let Some(scales) = &options.scales else {
        return Vec::new();
    };
    let mut tasks = tasks(log, options);
    tasks.dedup();
    let scored: Vec<String> = scales.keys().map(|name| scored_name(name, options)).collect();
    let missing: Vec<&String> = tasks.iter().filter(|task| !scored.contains(task)).collect();
    // Names of other tasks of the log are no misspellings.
    let others = || scored.iter().filter(|name| !tasks.contains(name)).map(String::as_str);
    let near = |task: &str| did_you_mean(task, others());
    let has_similar_name = |task: &&&String| !near(task).is_empty();
    let mut found = Vec::new();
    if missing.len() == tasks.len() {
        let hint = tasks.first().map_or_else(String::new, |task| near(task));
        found.push(format!(
            "scales: found no floor and ceiling for any task of this log, expected {}{hint}; every task is scaled by \
             its own range",
            first_of(&tasks, MAX_NAMES)
        ));
    } else {
        for task in missing.iter().filter(has_similar_name) {
            found.push(format!(
                "scales: found no floor and ceiling of {task}{}; it is scaled by its own range",
                near(task)
            ));
        }
    }
    found.extend(alike_with_others(scales, &tasks));
    found
}

/// A warning if tasks of a log look alike but were measured only in sets that include tasks which the log lacks.
fn alike_with_others(scales: &Scales, tasks: &[String]) -> Option<String> {
    let mut uncovered: Vec<&str> = Vec::new();
    for (name, anchors) in scales.iter().filter(|(name, _)| tasks.contains(name)) {
        let in_log = |set: &[String]| set.iter().filter(|member| tasks.contains(member)).count();
        let is_covered = anchors
            .unlabelled
            .iter()
            .any(|set| in_log(&set.among) == set.among.len());
        if !is_covered && anchors.unlabelled.iter().any(|set| in_log(&set.among) > 1) {
            uncovered.push(name);
        }
    }
    (!uncovered.is_empty()).then(|| {
        format!(
            "scales: {} look alike, but their ceiling without a label is only known for larger sets of tasks; measure it with \
             `driftworld scales --unlabelled` for these tasks alone",
            uncovered.join(", ")
        )
    })
}
