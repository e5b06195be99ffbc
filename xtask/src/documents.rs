//! The `documents` stage: the committed schemas judge `tests/documents` once more, through the `jsonschema` package of
//! Python. What the documents and their messages are is the business of `spec/tests/documents.rs`.

use std::env;
use std::process::Command;

use crate::error::XtaskError;
use crate::outcome::Outcome;
use crate::process::{program, run, works};
use crate::workspace::Workspace;

/// Names the interpreter that has the package, such as that of a virtual environment.
const PYTHON: &str = "DRIFTWORLD_PYTHON";

/// Validates every document, or says what is missing.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    if !works(python(
        workspace,
        &["-c", "from jsonschema import Draft202012Validator"],
    )) {
        return Ok(Outcome::Skipped(format!(
            "{} cannot import jsonschema 4 (python3 -m pip install -r tests/documents/requirements.txt, or name an \
             interpreter that can in {PYTHON})",
            program(&python(workspace, &[]))
        )));
    }
    run(python(workspace, &["tests/documents/validate.py"])).map(|()| Outcome::Passed)
}

/// The interpreter that `DRIFTWORLD_PYTHON` names, else `python3`, in the workspace's root.
fn python(workspace: &Workspace, arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os(PYTHON).unwrap_or_else(|| "python3".into()));
    command.current_dir(&workspace.root).args(arguments);
    command
}
