//! The `schemas` stage and `cargo xtask schemas`: the committed schema files and reference pages against the Rust types. How a schema is
//! made is the business of `driftworld-spec`; the command `driftworld schema` writes and compares it.

use std::process::Command;

use crate::error::XtaskError;
use crate::process::AS_TESTED;
use crate::process::{cargo, run};
use crate::workspace::Workspace;

/// Fails when a file in `schemas/` or `docs/reference/` is stale or missing.
pub(crate) fn check(workspace: &Workspace) -> Result<(), XtaskError> {
    let checked = driftworld_schema(workspace, &["--check", "schemas"])
        .and_then(|()| driftworld_schema(workspace, &["--reference", "--check", "docs/reference"]));
    if checked.is_err() {
        eprintln!("if the Rust types changed on purpose, rewrite the files: cargo xtask schemas");
    }
    checked
}

/// Writes every schema and every page of the reference anew.
pub(crate) fn rewrite(workspace: &Workspace) -> Result<(), XtaskError> {
    driftworld_schema(workspace, &["-o", "schemas"])?;
    driftworld_schema(workspace, &["--reference", "-o", "docs/reference"])
}

fn driftworld_schema(workspace: &Workspace, arguments: &[&str]) -> Result<(), XtaskError> {
    // With the features of the tests, which have built it already; with the examples, for Cargo asks those of tests
    // only then.
    run(cargo(
        workspace,
        &[&["build", "--quiet", "--bins", "--examples"], &AS_TESTED[..]].concat(),
    ))?;
    let program = format!("driftworld{}", std::env::consts::EXE_SUFFIX);
    let mut command = Command::new(workspace.target.join("debug").join(program));
    command.current_dir(&workspace.root).arg("schema").args(arguments);
    run(command)
}
