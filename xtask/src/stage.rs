//! [`Stage`]: one step of `cargo xtask test`, and its possible outcomes.

use std::env;

use crate::process::{Result, Workspace};

/// The outcome of a stage that did not fail.
pub(crate) enum Outcome {
    /// All checks passed; the note for the summary may be empty.
    Passed(String),
    /// Some checks were skipped; the note says which.
    Partly(String),
    /// The stage was skipped; the note says what is missing.
    Skipped(String),
}

/// One step of `cargo xtask test`.
pub(crate) struct Stage {
    /// The word after `--only`.
    pub(crate) name: &'static str,
    /// Whether it also runs without `--all`.
    pub(crate) is_quick: bool,
    /// What a pass means.
    pub(crate) about: &'static str,
    pub(crate) run: fn(&Workspace) -> Result<Outcome>,
}

/// Skips a stage that lacks something, or fails if `DRIFTWORLD_REQUIRE_…` is set.
pub(crate) fn missing(what: &str, reason: String) -> Result<Outcome> {
    let variable = format!("DRIFTWORLD_REQUIRE_{what}");
    match env::var_os(&variable) {
        Some(_) => Err(format!("{reason}; {variable} is set, so this is not skipped")),
        None => Ok(Outcome::Skipped(reason)),
    }
}
