//! The stage `unity`: published clients of ML-Agents, old and new, drive the `driftworld-unity` that the README's command builds.
//! What they ask of it stands in `unity/tests/clients/`.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::XtaskError;
use crate::outcome::Outcome;
use crate::process::{cargo, output, run};
use crate::python::{NO_INTERPRETER, install_wheel, missing};
use crate::virtual_environment::{VirtualEnvironment, interpreter, interpreter_before};
use crate::workspace::Workspace;

/// Set, it turns "cannot be had here" into a failure.
const REQUIRE_CLIENTS: &str = "DRIFTWORLD_REQUIRE_UNITY_CLIENTS";

/// Where the tests find the executable.
const EXECUTABLE: &str = "DRIFTWORLD_UNITY";

/// The versions of `mlagents-envs`: the original's, the last that asks for no certain Python, the newest.
const CLIENTS: [&str; 3] = ["0.16", "0.28", "1.1"];

/// The client beside which the package `driftworld` is installed, for what its environments see is what the client should.
const COMPARED: &str = "0.16";

/// The first minor version of Python 3 that has no numpy below 1.24, which the clients were written for.
const WITHOUT_OLD_NUMPY: u32 = 12;

/// Where the tests are run, as in `pytest tests/clients`.
const FOLDER: &str = "unity";
const TESTS: &str = "tests/clients";

/// Builds the executable, and runs the tests once with each client.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    let Some(usual) = interpreter() else {
        return missing(REQUIRE_CLIENTS, NO_INTERPRETER.to_owned());
    };
    let interpreter = interpreter_before(WITHOUT_OLD_NUMPY).unwrap_or_else(|| usual.clone());
    let environments = CLIENTS.map(|client| environment(workspace, &interpreter, client));
    let mut ready = Vec::new();
    for environment in environments {
        match environment {
            Ok(environment) => ready.push(environment),
            Err(error) => return missing(REQUIRE_CLIENTS, error.to_string()),
        }
    }
    run(cargo(workspace, &["build", "--release", "-p", "driftworld-unity"]))?;
    let mut python = String::new();
    for (client, environment) in CLIENTS.into_iter().zip(&ready) {
        println!("  with mlagents-envs {client}");
        if client == COMPARED {
            install_wheel(workspace, &usual, environment)?;
            // Said here: a test that misses the package would be skipped.
            run(environment.python(&["-c", "import driftworld, gymnasium"]))?;
            installed_by_the_command(workspace, environment)?;
            python = output(environment.python(&["--version"]))?;
        }
        pytest(workspace, environment)?;
    }
    Ok(Outcome::PassedWith(format!(
        "by mlagents-envs {}, with {}",
        CLIENTS.join(", "),
        python.trim()
    )))
}

/// The virtual environment of a client.
fn environment(workspace: &Workspace, interpreter: &Path, client: &str) -> Result<VirtualEnvironment, XtaskError> {
    let without_dependencies = list("without-dependencies", client);
    let without_dependencies = workspace
        .root
        .join(&without_dependencies)
        .exists()
        .then_some(without_dependencies);
    VirtualEnvironment::with_unwilling(
        workspace,
        interpreter,
        &format!("unity-{client}"),
        &list("requirements", client),
        without_dependencies.as_deref(),
    )
}

/// Has the wheel's command put the executable where the original client finds it: it has to know it for what it is.
fn installed_by_the_command(workspace: &Workspace, environment: &VirtualEnvironment) -> Result<(), XtaskError> {
    let mut install = Command::new(environment.program("driftworld"));
    install
        .args(["unity", "install"])
        .arg(workspace.target.join("python").join("l2explorer"))
        .arg("--executable")
        .arg(executable(workspace));
    run(install)
}

/// Where Cargo puts the optimised executable.
fn executable(workspace: &Workspace) -> PathBuf {
    let name = format!("driftworld-unity{}", std::env::consts::EXE_SUFFIX);
    workspace.target.join("release").join(name)
}

/// Runs the tests with a client, on the optimised executable.
fn pytest(workspace: &Workspace, environment: &VirtualEnvironment) -> Result<(), XtaskError> {
    // What these old packages are warned of is no news.
    let mut pytest = environment.python(&["-m", "pytest", "--quiet", "--disable-warnings", TESTS]);
    pytest
        .current_dir(workspace.root.join(FOLDER))
        .env(EXECUTABLE, executable(workspace));
    run(pytest)
}

/// Where a client's list of packages is, from the workspace's root.
fn list(kind: &str, client: &str) -> PathBuf {
    Path::new(FOLDER).join(TESTS).join(format!("{kind}-{client}.txt"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_list_asks_for_the_client_that_it_is_named_after_or_leaves_it_to_the_other() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let text = |kind, client| std::fs::read_to_string(root.join(list(kind, client))).unwrap_or_default();
        for client in CLIENTS {
            let [required, unwilling] = ["requirements", "without-dependencies"].map(|kind| text(kind, client));
            assert!(
                required.contains("protobuf==3.20."),
                "{client}: the clients' messages want an old protobuf"
            );
            let versions: Vec<String> = [required, unwilling]
                .iter()
                .flat_map(|text| text.lines())
                .filter_map(|line| Some(line.strip_prefix("mlagents-envs==")?.to_owned()))
                .collect();
            assert!(!versions.is_empty(), "{client} is asked for");
            for version in versions {
                assert!(version.starts_with(&format!("{client}.")), "{client}: {version}");
            }
        }
        assert!(text("requirements", COMPARED).contains("gymnasium=="));
    }
}
