//! The `deny` stage: `cargo deny check` where it is installed. The rules themselves stand in `deny.toml`.

use crate::error::XtaskError;
use crate::process::{cargo, run, works};
use crate::stage::Outcome;
use crate::workspace::Workspace;

/// Checks licences, advisories, bans and sources, or says that the tool is missing.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    if works(cargo(workspace, &["deny", "--version"])) {
        return run(cargo(workspace, &["deny", "--all-features", "check"])).map(|()| Outcome::Passed);
    }
    Ok(Outcome::Skipped(
        "cargo-deny is not installed (cargo install cargo-deny)".into(),
    ))
}
