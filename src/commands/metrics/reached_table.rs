//! What each task of a lifetime came to beside its expert, as the first table that people see. The numbers are `metrics`'.

use crate::metrics::{EvaluationCell, LEARNED_SHARE, LifetimeMetrics};

use super::tables::number;
use crate::table::wide_table;

/// Tasks beyond these are in the JSON only.
const MOST_ROWS: usize = 40;

/// A row per evaluated task: its first evaluation, the best after learning, the last, and the expert's level where there is one.
/// `None` without evaluations.
pub(super) fn reached(scores: &LifetimeMetrics) -> Option<String> {
    let evaluated = || scores.reached.iter().filter(|(_, task)| !task.evaluations.is_empty());
    let has_expert = evaluated().any(|(_, task)| task.expert.is_some());
    let rows = evaluated().take(MOST_ROWS).map(|(name, task)| {
        let mut cells = vec![
            name.clone(),
            cell(task.evaluations.first()),
            cell(task.best()),
            cell(task.last()),
        ];
        if has_expert {
            cells.push(task.expert.map_or_else(String::new, number));
            cells.push(
                task.share
                    .map_or_else(String::new, |share| format!("{:.0}%", 100.0 * share)),
            );
            let word = if task.is_never_learned() == Some(true) {
                "never learned"
            } else {
                ""
            };
            cells.push(word.to_owned());
        }
        cells
    });
    let rows: Vec<Vec<String>> = rows.collect();
    if rows.is_empty() {
        return None;
    }
    let mut headings = vec!["reached", "first evaluation", "best after learning", "last evaluation"];
    let mut numbers = vec![1, 2, 3];
    let mut notes = vec![format!(
        "In units of {}, ± the standard error over worlds.",
        driftworld_text::one_line(&scores.metrics_column)
    )];
    if has_expert {
        headings.extend(["expert", "best / expert", ""]);
        numbers.extend([4, 5]);
        notes.push(format!(
            "Below {:.0}% of the expert a task was never learned, and its maintenance and transfer say nothing.",
            100.0 * LEARNED_SHARE
        ));
    }
    if evaluated().count() > MOST_ROWS {
        notes.push(format!(
            "And {} tasks more: see --json.",
            evaluated().count() - MOST_ROWS
        ));
    }
    let headings = headings.into_iter().map(str::to_owned).collect();
    Some(format!("{}\n{}", wide_table(headings, rows, &numbers), notes.join(" ")))
}

/// Mean and standard error of an evaluation.
fn cell(evaluation: Option<&EvaluationCell>) -> String {
    let Some(found) = evaluation else { return String::new() };
    match found.standard_error {
        Some(error) => format!("{} ± {}", number(found.mean), number(error)),
        None => number(found.mean),
    }
}
