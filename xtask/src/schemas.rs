//! The `schemas` stage and `cargo xtask schemas`: the committed schema files against the Rust types. How a schema is
//! made is the business of `driftworld-spec`; the command `driftworld schema` writes and compares it.

use crate::error::XtaskError;
use crate::process::{cargo, run};
use crate::workspace::Workspace;

const COMMAND: [&str; 6] = ["run", "--quiet", "--package", "driftworld", "--", "schema"];

/// Fails when a file in `schemas/` is stale or missing.
pub(crate) fn check(workspace: &Workspace) -> Result<(), XtaskError> {
    let checked = driftworld_schema(workspace, &["--check", "schemas"]);
    if checked.is_err() {
        eprintln!("schemas/: if the Rust types changed on purpose, rewrite the files: cargo xtask schemas");
    }
    checked
}

/// Writes every schema anew.
pub(crate) fn rewrite(workspace: &Workspace) -> Result<(), XtaskError> {
    driftworld_schema(workspace, &["-o", "schemas"])
}

fn driftworld_schema(workspace: &Workspace, arguments: &[&str]) -> Result<(), XtaskError> {
    let mut command = cargo(workspace, &COMMAND);
    command.args(arguments);
    run(command)
}
