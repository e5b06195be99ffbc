//! The stage `schemas` and `cargo xtask schemas`: the committed schema files and reference pages against the Rust types, by
//! the command `driftworld schema`.

use crate::process::{Result, Workspace, run};
use crate::stage::Outcome;

/// Fails when a file in `schemas/` or `docs/reference/` is stale or missing.
pub(crate) fn check(workspace: &Workspace) -> Result<Outcome> {
    driftworld_schema(workspace, "--check")
        .map_err(|error| format!("{error}; to write the files anew: cargo xtask schemas"))?;
    Ok(Outcome::Passed(String::new()))
}

/// Writes every schema and every page of the reference anew.
pub(crate) fn rewrite(workspace: &Workspace) -> Result {
    driftworld_schema(workspace, "--output")
}

fn driftworld_schema(workspace: &Workspace, option: &str) -> Result {
    // As the stage `examples` builds it.
    run(workspace.cargo_everywhere(&["build", "--quiet", "--bins", "--examples"]))?;
    let program = workspace.target.join("debug/driftworld");
    run(workspace.program(&program, &["schema", option, "schemas"]))?;
    run(workspace.program(&program, &["schema", "--reference", option, "docs/reference"]))
}
