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
    /// `cargo metadata` says something else than expected.
    #[error("`cargo metadata` was not understood: {source}; is this Cargo newer than xtask?")]
    Metadata { source: serde_json::Error },
    /// A file or folder of the checkout could not be read or written.
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    /// A generated file is not what its sources make.
    #[error("{path}: found other text than {made_from} makes; write it anew: {command}")]
    Stale {
        path: &'static str,
        made_from: &'static str,
        command: &'static str,
    },
    /// Cargo built a crate of others again, with other features.
    #[error(
        "built more than once: {packages}; see who asks which features of it (cargo tree -e features -i CRATE --workspace), and name it \
         with all of them in features/Cargo.toml"
    )]
    BuiltTwice { packages: String },
    /// The workspace has no program to show.
    #[error("examples/: found no example, expected at least one; add examples/<name>.rs")]
    NoExamples,
    /// An example went on past its limit.
    #[error("example `{name}` still ran after {limit_secs} s and was ended; an example ends by itself, and soon")]
    ExampleTooSlow { name: String, limit_secs: u64 },
    /// A stage lacks what it needs, on a machine that promised to have it.
    #[error("{reason}; {variable} is set, so that this is not skipped")]
    Required { variable: &'static str, reason: String },
    /// A command lacks what it needs.
    #[error("{what}: {reason}")]
    Missing { what: &'static str, reason: &'static str },
    /// A stage failed; the last line a user reads.
    #[error("stage `{stage}` failed after {seconds:.1} s: {source}; rerun it alone: cargo xtask test --only {stage}")]
    Stage {
        stage: &'static str,
        seconds: f64,
        source: Box<XtaskError>,
    },
}
