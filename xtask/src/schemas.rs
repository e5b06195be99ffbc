//! The stage `schemas` and `cargo xtask schemas`: run `driftworld schema` to check or write the committed schema files and reference
//! pages.

use crate::process::{Result, Workspace, run};
use crate::stage::Outcome;

/// Fails if a file in `schemas/` or `docs/reference/` is out of date or missing.
pub(crate) fn check(workspace: &Workspace) -> Result<Outcome> {
    driftworld_schema(workspace, "--check")
        .map_err(|error| format!("{error}; to rewrite the files: cargo xtask schemas"))?;
    Ok(Outcome::Passed(String::new()))
}

/// Writes all schemas and reference pages.
pub(crate) fn rewrite(workspace: &Workspace) -> Result {
    driftworld_schema(workspace, "--output")
}

fn driftworld_schema(workspace: &Workspace, option: &str) -> Result {
    // The stage `examples` uses the same build.
    run(workspace.cargo_everywhere(&["build", "--quiet", "--bins", "--examples"]))?;
    let program = workspace.target.join("debug/driftworld");
    run(workspace.program(&program, &["schema", option, "schemas"]))?;
    run(workspace.program(&program, &["schema", "--reference", option, "docs/reference"]))
}
