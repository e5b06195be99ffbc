//! Tables of each task's results compared with its expert, and of its evaluation curve.

use std::collections::{BTreeMap, BTreeSet};

use crate::metrics::{EvaluationCell, LEARNED_SHARE, LifetimeMetrics, Reached, Unlabelled};

use driftworld_text::{rounded, when, whole};

use super::tables::{mean, number, with_error};
use crate::table::without_empty;
use crate::variant_names::VariantNames;

/// Maximum number of rows; further tasks are in the JSON only.
const MOST_ROWS: usize = 40;

/// Shown for a task that was never learned.
const NEVER_LEARNED: &str = "never learned";

/// A row per evaluated task: its first evaluation, the best after learning, the last, and the expert's level if there is one.
/// `None` without evaluations.
pub(super) fn reached(scores: &LifetimeMetrics, names: &VariantNames) -> Option<String> {
    let evaluated = || scores.reached.iter().filter(|(_, task)| !task.evaluations.is_empty());
    let has_expert = evaluated().any(|(_, task)| task.expert.is_some());
    let is_scaled = evaluated().any(|(_, task)| task.is_scaled());
    let has_own = evaluated().any(|(_, task)| has_own_expert(task));
    let relearns = evaluated().any(|(_, task)| task.plasticity_loss().is_some());
    let rows = evaluated().take(MOST_ROWS).map(|(name, task)| {
        let of = |evaluation: Option<&EvaluationCell>| evaluation.map_or_else(String::new, |found| cell(task, found));
        let expert = task.expert.filter(|_| has_own);
        let shares = task.shares.iter().filter(|_| has_expert && relearns);
        let is_not = task.is_never_learned() == Some(true);
        vec![
            names.shown(name).to_owned(),
            of(task.evaluations.first()),
            of(task.best()),
            of(task.last()),
            when(is_scaled, || scale(task)),
            expert.map_or_else(String::new, |level| in_units_of(task, level)),
            task.share.filter(|_| has_own).map_or_else(String::new, percent),
            shares.copied().map(percent).collect::<Vec<_>>().join(", "),
            when(is_not, || NEVER_LEARNED.to_owned()),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return None;
    }
    let column = driftworld_text::one_line(&scores.metrics_column);
    let mut notes = vec![format!("In units of {column}, ± the standard error over worlds.")];
    if is_scaled {
        notes = vec![format!(
            "In % of the way from floor to ceiling where these are known, else in units of {column}; ± the standard error over worlds."
        )];
    }
    if has_expert {
        notes.push(format!(
            "A task that never reaches {:.0}% of its {} counts as never learned; ignore its maintenance and transfer.",
            100.0 * LEARNED_SHARE,
            if has_own { "expert" } else { "ceiling" }
        ));
    }
    if evaluated().count() > MOST_ROWS {
        notes.push(format!(
            "{} more tasks are in the output of --json.",
            evaluated().count() - MOST_ROWS
        ));
    }
    let headings = [
        "reached",
        "first evaluation",
        "best after learning",
        "last evaluation",
        "scale",
        "expert",
        "best / expert",
        "after each learning",
        "",
    ];
    let table = without_empty(&headings, &rows, &[1, 2, 3, 5, 6]);
    let mut lines = vec![table, notes.join(" ")];
    lines.extend(unlabelled(scores, names));
    Some(lines.join("\n"))
}

/// Rewards of agents that cannot distinguish tasks that look alike: a line for each set of such tasks.
fn unlabelled(scores: &LifetimeMetrics, names: &VariantNames) -> Vec<String> {
    let tasks = &scores.reached;
    let mut sets: Vec<&Vec<String>> = Vec::new();
    for set in tasks.values().filter_map(|task| task.unlabelled.as_ref()) {
        if !sets.contains(&&set.among) {
            sets.push(&set.among);
        }
    }
    let line = |among: &Vec<String>| {
        let mean = |of: fn(&Unlabelled) -> f64| {
            let scores = among.iter().map(|name| {
                let task = tasks.get(name)?;
                task.score(of(task.unlabelled.as_ref()?))
            });
            let scores: Option<Vec<f64>> = scores.collect();
            scores.map(|scores| scores.iter().sum::<f64>() / scores.len().max(1) as f64)
        };
        Some(format!(
            "{} look alike. Without a label, the best known agent gets {} of the way on average, and one that behaves \
             alike in all, for lack of memory, {}.",
            driftworld_text::one_line(
                among
                    .iter()
                    .map(|name| names.shown(name))
                    .collect::<Vec<_>>()
                    .join(", ")
            ),
            percent(mean(|set| set.finds_out)?),
            percent(mean(|set| set.fixed)?)
        ))
    };
    sets.into_iter().filter_map(line).collect()
}

/// A row per task that is evaluated in any of these lifetimes: means over them, and in how many it was never learned.
/// `None` without any. `agent` is appended to the heading.
pub(super) fn reached_by_several(agent: &str, lifetimes: &[LifetimeMetrics], names: &VariantNames) -> Option<String> {
    let mut tasks: BTreeMap<&str, Vec<&Reached>> = BTreeMap::new();
    for (name, task) in lifetimes.iter().flat_map(|lifetime| &lifetime.reached) {
        if !task.evaluations.is_empty() {
            tasks.entry(name).or_default().push(task);
        }
    }
    let has_own = tasks.values().flatten().any(|task| has_own_expert(task));
    let rows = tasks.iter().take(MOST_ROWS).map(|(name, found)| {
        let mean = |of: &dyn Fn(&Reached) -> Option<f64>, show: fn(f64) -> String| {
            mean(&found.iter().filter_map(|task| of(task)).collect::<Vec<_>>(), show)
        };
        let is_scaled = found.iter().all(|task| task.is_scaled());
        let level = |of: fn(&Reached) -> Option<&EvaluationCell>| {
            if is_scaled {
                mean(&|task| of(task)?.score, percent)
            } else {
                mean(&|task| Some(of(task)?.mean), number)
            }
        };
        let known = found.iter().filter_map(|task| task.is_never_learned());
        let (not, all) = known.fold((0, 0), |(not, all), is_not| (not + usize::from(is_not), all + 1));
        vec![
            names.shown(name).to_owned(),
            level(Reached::best),
            level(Reached::last),
            match (has_own, is_scaled) {
                (false, _) => String::new(),
                (true, true) => mean(&|task| task.score(task.expert?), percent),
                (true, false) => mean(&|task| task.expert, number),
            },
            when(has_own, || mean(&|task| task.share, percent)),
            when(not > 0, || format!("{NEVER_LEARNED} in {not} of {all}")),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    let headings = [
        &*format!("reached{agent}"),
        "best after learning",
        "last evaluation",
        "expert",
        "best / expert",
        "",
    ];
    let is_scaled = tasks.values().flatten().any(|task| task.is_scaled());
    let unit = if is_scaled { UNITS } else { "" };
    let alike: BTreeSet<String> = lifetimes.iter().flat_map(|scores| unlabelled(scores, names)).collect();
    let table = |rows: Vec<Vec<String>>| without_empty(&headings, &rows, &[1, 2, 3, 4]) + unit;
    (!rows.is_empty()).then(|| std::iter::once(table(rows)).chain(alike).collect::<Vec<_>>().join("\n"))
}

/// Explains numbers with and without %.
const UNITS: &str = "\nIn % of the way from floor to ceiling where these are known, else in the log's unit.";

/// A row per evaluated task: measures of its curve. `None` unless a task is evaluated more than once.
pub(super) fn curves(scores: &LifetimeMetrics, names: &VariantNames) -> Option<String> {
    let shown = || scores.curves.iter().filter(|(_, curve)| curve.points.len() > 1);
    let rows = shown().take(MOST_ROWS).map(|(name, curve)| {
        let level = if curve.is_scaled { percent } else { number };
        let is_noise =
            curve.forgetting > 0.0 && (curve.forgetting_error).is_some_and(|error| curve.forgetting < 2.0 * error);
        vec![
            names.shown(name).to_owned(),
            level(curve.area),
            with_error(level(curve.forgetting), curve.forgetting_error.map(level)),
            curve.lag.map_or_else(String::new, |lag| format!("{lag:.0}")),
            curve.regret.map_or_else(String::new, level),
            when(is_noise, || "forgetting within 2 standard errors".to_owned()),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return None;
    }
    let headings = ["curve", "area", "forgetting", "lag", "regret", ""];
    let lag = when(shown().any(|(_, curve)| curve.lag.is_some()), || {
        " lag: learning experiences, of any task, from the start of learning this task (or else from its first \
         evaluation) until half of its eventual gain."
            .to_owned()
    });
    let regret = when(shown().any(|(_, curve)| curve.regret.is_some()), || {
        " regret: expert, or else ceiling, minus curve while the task was present.".to_owned()
    });
    Some(format!(
        "{}\nFrom evaluation curves alone. area: mean height. forgetting: highest minus last.{lag}{regret}",
        without_empty(&headings, &rows, &[1, 2, 3, 4])
    ))
}

/// Whether a task's expert differs from its ceiling: shares of the ceiling would only repeat the best evaluation.
fn has_own_expert(task: &Reached) -> bool {
    task.expert.is_some() && task.expert != task.ceiling
}

/// In whole percent; zero has no sign.
fn percent(share: f64) -> String {
    rounded(100.0 * share, 0) + "%"
}

/// Mean and standard error of an evaluation, as the position between floor and ceiling if these are known.
fn cell(task: &Reached, found: &EvaluationCell) -> String {
    let (mean, error) = match (found.score, task.floor.zip(task.ceiling)) {
        (Some(score), Some((floor, ceiling))) => {
            let error = found.standard_error.map(|error| percent(error / (ceiling - floor)));
            (percent(score), error)
        }
        _ => (number(found.mean), found.standard_error.map(number)),
    };
    with_error(mean, error)
}

/// A level in the unit in which the evaluations of its task are shown.
fn in_units_of(task: &Reached, level: f64) -> String {
    task.score(level).map_or_else(|| number(level), percent)
}

/// Explains 0 % and 100 %.
fn scale(task: &Reached) -> String {
    match task.floor.zip(task.ceiling) {
        Some((floor, ceiling)) => whole(&format!("{floor:.1} to {ceiling:.1}")),
        None => "as logged".to_owned(),
    }
}
