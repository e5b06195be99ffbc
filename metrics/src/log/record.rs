//! One row of a log: the result of one experience.

use std::sync::Arc;

use indexmap::IndexMap;
use serde_json::{Map, Value};

use super::timestamp::Timestamp;
use crate::choice::choice;

/// Worker id of records if there is only one worker.
pub const DEFAULT_WORKER: &str = "worker-default";

/// Parameters of a task, as a JSON object. Shared, because all experiences of a block usually have the same ones.
pub type TaskParams = Arc<Map<String, Value>>;

choice! {
    /// Whether the agent may learn in a block.
    BlockType, "block type" {
        /// Learning block.
        Train = "train",
        /// Evaluation block: the agent acts, but does not learn.
        Test = "test",
    }
}

choice! {
    /// Whether the agent is awake, or consolidates what it learned without new experience.
    BlockSubtype, "block subtype" {
        /// Awake: the default, and the only value in logs of format 1.0.
        Wake = "wake",
        /// Asleep. In logs with sleep blocks, wake evaluations are left out of most metrics.
        Sleep = "sleep",
    }
}

choice! {
    /// Whether a row closes its experience.
    ExpStatus, "experience status" {
        /// The experience is finished. Exactly one row of each experience is complete, and only that row is scored.
        Complete = "complete",
        /// An intermediate row.
        Incomplete = "incomplete",
    }
}

/// One row of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Number of the block, from 0; never decreases within a log.
    pub block_num: u64,
    /// Number of the experience (episode) within the lifetime, from 0; never decreases within a log.
    pub exp_num: u64,
    /// The worker that gathered the experience: letters, digits, `_`, `-` and `.`; default [`DEFAULT_WORKER`].
    pub worker_id: String,
    /// Learning or evaluation.
    pub block_type: BlockType,
    /// Awake (default) or asleep.
    pub block_subtype: BlockSubtype,
    /// Name of the task, by convention `task_variant`, letters and digits on both sides.
    pub task_name: String,
    /// Parameters of the task; default none.
    pub task_params: TaskParams,
    /// Complete (default) or incomplete.
    pub exp_status: ExpStatus,
    /// End of the experience.
    pub timestamp: Timestamp,
    /// Numeric columns: at least every metrics column of the log, and the same names in every record. NaN means "no value".
    pub metrics: IndexMap<String, f64>,
    /// Text columns: the same names in every record, distinct from the numbers' names. They are not declared as metrics
    /// columns.
    pub texts: IndexMap<String, String>,
}

impl Record {
    /// A complete record of an awake block by the default worker, without parameters or numbers.
    pub fn new(
        block_num: u64,
        exp_num: u64,
        block_type: BlockType,
        task_name: impl Into<String>,
        timestamp: Timestamp,
    ) -> Self {
        Self {
            block_num,
            exp_num,
            worker_id: DEFAULT_WORKER.to_owned(),
            block_type,
            block_subtype: BlockSubtype::Wake,
            task_name: task_name.into(),
            task_params: TaskParams::default(),
            exp_status: ExpStatus::Complete,
            timestamp,
            metrics: IndexMap::new(),
            texts: IndexMap::new(),
        }
    }

    /// This record with this number added or replaced.
    #[must_use]
    pub fn with_metric(mut self, name: impl Into<String>, value: f64) -> Self {
        self.metrics.insert(name.into(), value);
        self
    }

    /// This record with this text column added or replaced.
    #[must_use]
    pub fn with_text(mut self, name: impl Into<String>, text: impl Into<String>) -> Self {
        self.texts.insert(name.into(), text.into());
        self
    }

    /// This record with these task parameters.
    #[must_use]
    pub fn with_task_params(mut self, task_params: impl Into<TaskParams>) -> Self {
        self.task_params = task_params.into();
        self
    }

    /// This record with this worker id.
    #[must_use]
    pub fn with_worker(mut self, worker_id: impl Into<String>) -> Self {
        self.worker_id = worker_id.into();
        self
    }
}

/// Whether a worker id is valid: it becomes the name of a directory.
pub(super) fn is_worker_id(text: &str) -> bool {
    let allowed = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'-' | b'.');
    !text.is_empty() && text.bytes().all(allowed) && text.bytes().any(|byte| byte != b'.')
}

/// Whether a task's name follows `task_variant`, with letters and digits on both sides.
pub(super) fn is_conventional_task_name(text: &str) -> bool {
    let word = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_alphanumeric());
    text.split_once('_')
        .is_some_and(|(task, variant)| word(task) && word(variant))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worker_ids_are_safe_directory_names() {
        let check = |text: &str, expected: bool| assert_eq!(is_worker_id(text), expected, "{text:?}");
        check("worker-default", true);
        check("driver.py_0", true);
        check("0", true);
        check("", false);
        check("..", false);
        check("a/b", false);
        check("a b", false);
        check("é", false);
    }

    #[test]
    fn task_names_have_two_words() {
        let check = |text: &str, expected: bool| assert_eq!(is_conventional_task_name(text), expected, "{text:?}");
        check("find_red", true);
        check("task1_1", true);
        check("find", false);
        check("find_", false);
        check("find_red_far", false);
        check("find-it_red", false);
    }
}
