//! Writes tables and summaries of trial draws.

use std::path::Path;

use driftworld_curriculum::{Failed, Trial};
use driftworld_text::{ShownPath, when};

use crate::table::table;
use crate::tasks;

/// Maximum number of failures listed.
const MAX_LISTED: usize = 10;

/// A table of how often drawing failed, with a row for each variant or regime, then the reasons of the first failures.
pub(crate) fn shown(trials: &[Trial]) -> String {
    let share = |failed: u64, of: u64| match failed {
        0 => "0".to_owned(),
        _ => format!("{failed} ({:.0}%)", 100.0 * failed as f64 / of.max(1) as f64),
    };
    let rows = trials.iter().map(|trial| {
        [
            trial.block.map_or_else(|| "-".to_owned(), |block| block.to_string()),
            trial.variant.clone(),
            trial.seed.to_string(),
            trial.worlds.to_string(),
            share(trial.placement, trial.worlds),
            share(trial.requirement, trial.worlds),
            share(trial.other, trial.worlds),
            trial.expert.as_ref().map_or_else(
                || "-".to_owned(),
                |expert| {
                    if expert.worlds == 0 {
                        "no success".to_owned()
                    } else {
                        format!("{} of {}", expert.succeeded, expert.worlds)
                    }
                },
            ),
        ]
    });
    let headings = [
        "block",
        "variant",
        "seed",
        "worlds",
        "no place",
        "requirement",
        "other",
        "planner finishes",
    ];
    let mut lines = vec![table(headings, rows, &[0, 2, 3, 4, 5, 6, 7])];
    // List the first failure of each kind: worlds may fail in several ways.
    let failed = trials.iter().flat_map(|trial| {
        let is_first =
            |(index, one): &(usize, &Failed)| !trial.failed[..*index].iter().any(|other| other.code == one.code);
        let first_failures = trial.failed.iter().enumerate().filter(is_first);
        first_failures.map(move |(_, first)| (trial, first))
    });
    for (trial, first) in failed.take(MAX_LISTED) {
        let experience = first
            .experience
            .map_or_else(String::new, |experience| format!(", experience {experience}"));
        let progress = when(first.progress != 0.0, || format!(", at progress {}", first.progress));
        lines.push(format!(
            "{}{experience}, world {}{progress}: {}",
            trial.variant, first.index, first.reason
        ));
    }
    lines.join("\n")
}

/// A short note that some worlds cannot be drawn; `None` if all can.
pub(crate) fn summary(trials: &[Trial]) -> Option<String> {
    let failed: u64 = trials.iter().map(Trial::num_failed).sum();
    let worlds: u64 = trials.iter().map(|trial| trial.worlds).sum();
    (failed > 0).then(|| format!("{failed} of {worlds} worlds cannot be drawn"))
}

/// The worlds in which the planner missed a possible success, of the task in this file; `None` if it missed none.
pub(crate) fn unfinished(trial: &Trial, file: &Path) -> Option<String> {
    let expert = trial
        .expert
        .as_ref()
        .filter(|expert| expert.succeeded < expert.worlds)?;
    let listed: Vec<String> = expert.failed.iter().take(MAX_LISTED).map(u64::to_string).collect();
    let more = if expert.failed.len() > listed.len() {
        " and more"
    } else {
        ""
    };
    let (variant, seed) = (&trial.variant, trial.seed);
    let own = tasks::split(variant).1.unwrap_or_default();
    Some(format!(
        "{variant}: the planner succeeded in {} of {} worlds, but not in {}{more}; look at one: driftworld render \
         '{}#{own}' --seed {seed} --index {} -o world.png",
        expert.succeeded,
        expert.worlds,
        listed.join(", "),
        file.shown(),
        listed.first().map_or("0", String::as_str)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_curriculum::Finished;

    #[test]
    fn suggested_command_names_the_file_of_the_task() {
        let trial = Trial {
            variant: "park#red".to_owned(),
            seed: 7,
            expert: Some(Finished {
                worlds: 4,
                succeeded: 3,
                failed: vec![2],
            }),
            ..Trial::default()
        };
        let said = unfinished(&trial, Path::new("tasks/my park.json")).expect("a world was missed");
        let command = "driftworld render 'tasks/my park.json#red' --seed 7 --index 2 -o world.png";
        assert!(said.starts_with("park#red: ") && said.ends_with(command), "{said}");
    }
}
