//! What can end an xtask early. How a broken house rule reads is in `finding.rs`.

use std::path::PathBuf;
use std::process::ExitStatus;

/// Why a stage, or xtask itself, could not go on.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum XtaskError {
    /// Rules were broken; each is already printed.
    #[error("{count} {}, listed above", if *count == 1 { "finding" } else { "findings" })]
    Findings { count: usize },
    /// A program ran and said no.
    #[error("`{command}` ended with {status}")]
    Failed { command: String, status: ExitStatus },
    /// A program could not be started at all.
    #[error("`{command}` could not be started: {source}; install {program}, or put it on the PATH")]
    NotStarted {
        command: String,
        program: String,
        source: std::io::Error,
    },
    /// `cargo metadata` refused the workspace.
    #[error("`cargo metadata` could not read the workspace: {source}")]
    Metadata { source: Box<cargo_metadata::Error> },
    /// A file or folder of the checkout could not be read or written.
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    /// The workspace has no program to show.
    #[error("examples/: found no example, expected at least one; add examples/<name>.rs")]
    NoExamples,
    /// An example went on past its limit.
    #[error("example `{name}` still ran after {limit_secs} s and was ended; an example ends by itself, and soon")]
    ExampleTooSlow { name: String, limit_secs: u64 },
    /// A stage lacks what it needs, on a machine that promised to have it.
    #[error("{reason}; {variable} is set, so that this is not skipped")]
    Required { variable: &'static str, reason: String },
    /// A stage failed; the last line a user reads.
    #[error("stage `{stage}` failed after {seconds:.1} s: {source}; rerun it alone: cargo xtask test --only {stage}")]
    Stage {
        stage: &'static str,
        seconds: f64,
        source: Box<XtaskError>,
    },
}
