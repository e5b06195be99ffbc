//! [`Outcome`]: how a stage ended. What the stages are is in `stage.rs`.

/// How a stage that did not fail ended: a closing line for the summary, or why it had nothing to run.
pub(crate) enum Outcome {
    Passed,
    PassedWith(String),
    /// What was checked was as it should be; what was not is said.
    Partly(String),
    Skipped(String),
}
