//! Selects the rows of a log that count for its score.

use indexmap::IndexSet;

use crate::MetricsError;
use crate::log::{ExpStatus, Log, Rows, TaskParams};

/// Task parameter with a row's phase, and the phase that is not scored.
const PHASE: (&str, &str) = ("phase", "pre_deployment");

/// Task parameter and value that mark a shuffled block.
const MIX: (&str, &str) = ("mix", "shuffled");

/// The rows of a log that count, with the performance column.
pub(crate) struct Usable<'a> {
    pub(crate) rows: &'a Rows,
    /// Indices of the rows that count, in order. Rows of a shuffled block are grouped by task.
    pub(crate) indices: Vec<usize>,
    /// Performance of every row of the log.
    pub(crate) performance: &'a [f64],
}

/// The rows that count: complete ones with a number in the performance column. Rows from before deployment, whose task parameter
/// `phase` is `pre_deployment`, prepare a lifetime but are not part of it. `name` is the log's name in messages.
pub(crate) fn usable_rows<'a>(log: &'a Log, name: &str, column: &str) -> Result<Usable<'a>, MetricsError> {
    let mut usable = complete_rows(log, name, column)?;
    let performance = usable.performance;
    usable.indices.retain(|&row| !performance[row].is_nan());
    Ok(usable)
}

/// Whether rows with these parameters belong to the lifetime itself, not to the time before deployment.
pub(super) fn is_deployed(params: &TaskParams) -> bool {
    params.get(PHASE.0).is_none_or(|phase| phase != PHASE.1)
}

/// Like [`usable_rows`], but keeps complete rows without a number; an error if no row has a number.
pub(crate) fn complete_rows<'a>(log: &'a Log, name: &str, column: &str) -> Result<Usable<'a>, MetricsError> {
    let declared = log.logger_info.metrics_columns();
    let performance = (declared.iter().any(|name| name == column))
        .then(|| log.rows.metric(column))
        .flatten()
        .ok_or_else(|| MetricsError::UnknownColumn {
            run_id: name.to_owned(),
            column: column.to_owned(),
            available: declared.join(", "),
        })?;
    let rows = &log.rows;
    let params = rows.task_params();
    let deployed: Vec<bool> = params.values().iter().map(is_deployed).collect();
    let is_counted =
        |&row: &usize| rows.exp_statuses()[row] == ExpStatus::Complete && deployed[params.ids()[row] as usize];
    let indices: Vec<usize> = (0..rows.len()).filter(is_counted).collect();
    if indices.iter().all(|&row| performance[row].is_nan()) {
        return Err(MetricsError::NoUsableRows {
            run_id: name.to_owned(),
            column: column.to_owned(),
        });
    }
    Ok(Usable {
        rows,
        indices: grouped_by_task(rows, indices),
        performance,
    })
}

/// Reorders rows so that those of one task are adjacent within each shuffled block, in the order of the tasks' first rows.
pub(super) fn grouped_by_task(rows: &Rows, indices: Vec<usize>) -> Vec<usize> {
    let (params, names) = (rows.task_params(), rows.task_names());
    let is_shuffled = |params: &TaskParams| params.get(MIX.0).is_some_and(|mix| mix == MIX.1);
    let shuffled: Vec<bool> = params.values().iter().map(is_shuffled).collect();
    if !shuffled.contains(&true) {
        return indices;
    }
    let block = |row: usize| {
        let kind = (rows.block_types()[row], rows.block_subtypes()[row]);
        shuffled[params.ids()[row] as usize].then(|| (rows.block_nums()[row], kind))
    };
    let blocks = indices.chunk_by(|&a, &b| block(a) == block(b));
    let grouped = blocks.flat_map(|rows_of_block| {
        if rows_of_block.first().is_none_or(|row| block(*row).is_none()) {
            return rows_of_block.to_vec();
        }
        let mut tasks = IndexSet::new();
        let number = |row: &usize| (tasks.insert_full(names.of(*row)).0, *row);
        let mut numbered: Vec<_> = rows_of_block.iter().map(number).collect();
        numbered.sort_unstable();
        numbered.into_iter().map(|(_, row)| row).collect()
    });
    grouped.collect()
}
