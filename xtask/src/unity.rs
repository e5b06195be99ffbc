//! The stage `unity`: runs the tests in `unity/tests/clients/`, in which published clients of ML-Agents, old and new, drive the
//! optimised `driftworld-unity`.

use crate::process::{Result, Workspace, run};
use crate::python::{ANY_VERSION, Environment, NO_INTERPRETER, interpreter};
use crate::stage::{Outcome, missing};

/// The versions of `mlagents-envs`: the last one without a Python requirement, the newest, and the one that L2Explorer uses.
const CLIENTS: [&str; 3] = ["0.28", "1.1", ORIGINAL];
/// The version that L2Explorer uses, with which observations are compared with those of the package `driftworld`.
const ORIGINAL: &str = "0.16";

/// Builds the executable, and runs the tests once per client, one after the other in one environment.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome> {
    // The clients need numpy below 1.24, which does not exist for Python 3.12.
    let Some(interpreter) = interpreter("(3, 10) <= sys.version_info < (3, 12)").or_else(|| interpreter(ANY_VERSION))
    else {
        return missing("UNITY_CLIENTS", NO_INTERPRETER.into());
    };
    let environment = match Environment::with(workspace, &interpreter, "unity", &[]) {
        Ok(environment) => environment,
        Err(reason) => return missing("UNITY_CLIENTS", reason),
    };
    environment.pip(workspace, "uninstall --quiet --yes driftworld", &[])?;
    run(workspace.cargo(&["build", "--release", "-p", "driftworld-unity"]))?;
    let executable = workspace.target.join("release/driftworld-unity");
    for client in CLIENTS {
        println!("  with mlagents-envs {client}");
        if let Err(reason) = install(workspace, &environment, client) {
            return missing("UNITY_CLIENTS", reason);
        }
        if client == ORIGINAL {
            environment.install_driftworld(workspace)?;
            // If the package could not be imported, its tests would be skipped silently.
            run(environment.python(workspace, &["-c", "import driftworld, gymnasium"]))?;
        }
        let mut pytest = environment.python(
            workspace,
            &["-m", "pytest", "--quiet", "--disable-warnings", "tests/clients"],
        );
        pytest
            .current_dir(workspace.root.join("unity"))
            .env("DRIFTWORLD_UNITY", &executable);
        run(pytest)?;
    }
    Ok(Outcome::Passed(format!("by mlagents-envs {}", CLIENTS.join(", "))))
}

/// Installs a client. Some clients work with this Python although their requirements exclude it; their packages are installed
/// without dependencies.
fn install(workspace: &Workspace, environment: &Environment, client: &str) -> Result {
    let list = |kind: &str| format!("unity/tests/clients/{kind}-{client}.txt");
    environment.pip(workspace, "install --quiet --requirement", &[&list("requirements")])?;
    let unlisted = list("without-dependencies");
    if workspace.root.join(&unlisted).exists() {
        let alone = "install --quiet --no-deps --ignore-requires-python --requirement";
        environment.pip(workspace, alone, &[&unlisted])?;
    }
    Ok(())
}
