//! The rows of a log that count for its score.
//!
//! Not here: what is made of them, see `regime`.

use crate::MetricsError;
use crate::log::{ExpStatus, Log, Rows, TaskParams};

/// Parameter of a task by which a row says which part of the life it belongs to, and the part that is not scored.
const PHASE: (&str, &str) = ("phase", "pre_deployment");

/// The rows of a log that count, and the column of their performance.
pub(crate) struct Usable<'a> {
    pub(crate) rows: &'a Rows,
    /// Which rows count, in order.
    pub(crate) indices: Vec<usize>,
    /// Performance of every row of the log.
    pub(crate) performance: &'a [f64],
}

/// The rows that count: complete, with a number in the performance column, and not of the time before deployment, which prepares
/// a lifetime and is no part of it. Rows of that time have the task parameter `phase`, `pre_deployment`. Messages call the log `name`.
pub(crate) fn usable_rows<'a>(log: &'a Log, name: &str, column: &str) -> Result<Usable<'a>, MetricsError> {
    let mut usable = complete_rows(log, name, column)?;
    let performance = usable.performance;
    usable.indices.retain(|&row| !performance[row].is_nan());
    Ok(usable)
}

/// Whether rows with these parameters are part of the lifetime, and not of the time before deployment.
pub(super) fn is_deployed(params: &TaskParams) -> bool {
    params.get(PHASE.0).is_none_or(|phase| phase != PHASE.1)
}

/// The same with complete rows that have no number; at least one has a number.
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
    let counts = |&row: &usize| rows.exp_statuses()[row] == ExpStatus::Complete && deployed[params.ids()[row] as usize];
    let indices: Vec<usize> = (0..rows.len()).filter(counts).collect();
    if indices.iter().all(|&row| performance[row].is_nan()) {
        return Err(MetricsError::NoUsableRows {
            run_id: name.to_owned(),
            column: column.to_owned(),
        });
    }
    Ok(Usable {
        rows,
        indices,
        performance,
    })
}
