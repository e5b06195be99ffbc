//! The stages `wheel`, `python` and `learners`: a wheel built as a user would build it, what a newcomer does with it, and pytest on it under
//! the newest and the oldest Gymnasium, then with the large packages of people who train. What is tested stands in `python/tests/`.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use crate::error::XtaskError;
use crate::outcome::Outcome;
use crate::process::run;
use crate::virtual_environment::{VirtualEnvironment, interpreter};
use crate::workspace::Workspace;

/// Set, they turn "cannot be had here" into a failure.
const REQUIRE_PYTHON: &str = "DRIFTWORLD_REQUIRE_PYTHON";
const REQUIRE_LEARNERS: &str = "DRIFTWORLD_REQUIRE_LEARNERS";

pub(crate) const NO_INTERPRETER: &str =
    "no Python from 3.10 on with venv and pip (Debian: apt install python3-venv), or name one in DRIFTWORLD_PYTHON";

/// The environment that holds what a newcomer installed, and nothing else.
const NEWCOMER: &str = "newcomer";

/// The tests that hold whatever version of Gymnasium there is: run once more with the oldest.
const ANY_GYMNASIUM: [&str; 4] = [
    "tests/test_gymnasium.py",
    "tests/test_vector.py",
    "tests/test_options.py",
    "tests/test_check.py",
];

/// Does what a newcomer does: an empty environment, the README's command, its examples, the command of the console.
pub(crate) fn wheel(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    match interpreter() {
        Some(interpreter) => newcomer(workspace, &interpreter).map(|()| Outcome::Passed),
        None => missing(REQUIRE_PYTHON, NO_INTERPRETER.to_owned()),
    }
}

/// Checks and tests the package with the libraries that are quick to install.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    let Some(interpreter) = interpreter() else {
        return missing(REQUIRE_PYTHON, NO_INTERPRETER.to_owned());
    };
    let newest =
        match VirtualEnvironment::with_requirements(workspace, &interpreter, "newest", &requirements("requirements")) {
            Ok(environment) => environment,
            Err(error) => return missing(REQUIRE_PYTHON, error.to_string()),
        };
    // Before anything is built: these take seconds.
    let project = workspace.root.join("python");
    let linted = [".", "../examples/python", "../unity/tests/clients"];
    for (arguments, folders) in [(&["-m", "ruff", "check"][..], &linted[..]), (&["-m", "mypy"], &[])] {
        let mut check = newest.python(arguments);
        check.args(folders).current_dir(&project);
        run(check)?;
    }
    let builder = VirtualEnvironment::kept(workspace, &interpreter, NEWCOMER)?;
    let wheel = build(workspace, &builder)?;
    install(&newest, &wheel)?;
    pytest(workspace, &newest, &["-m", "not learners"])?;
    let oldest = requirements("requirements-oldest");
    let oldest = VirtualEnvironment::with_requirements(workspace, &interpreter, "oldest", &oldest)?;
    install(&oldest, &wheel)?;
    let small = ["-m", "not learners"];
    pytest(workspace, &oldest, &[&small[..], &ANY_GYMNASIUM[..]].concat())?;
    Ok(Outcome::PassedWith(
        "under the newest and the oldest Gymnasium".to_owned(),
    ))
}

/// Tests with torch, Stable-Baselines3, Minari and Ray; they are gigabytes, so who cannot install them is not held up.
pub(crate) fn learners(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    let Some(interpreter) = interpreter() else {
        return missing(REQUIRE_LEARNERS, NO_INTERPRETER.to_owned());
    };
    let file = requirements("requirements-learners");
    let environment = match VirtualEnvironment::with_requirements(workspace, &interpreter, "learners", &file) {
        Ok(environment) => environment,
        Err(error) => return missing(REQUIRE_LEARNERS, error.to_string()),
    };
    install_wheel(workspace, &interpreter, &environment)?;
    pytest(workspace, &environment, &["-m", "learners"])?;
    Ok(Outcome::Passed)
}

/// Puts the wheel into an environment; what it needs is there already. Whatever the environment's own interpreter, the wheel is built
/// by the one that built it before, so that Cargo finds nothing to do.
pub(crate) fn install_wheel(
    workspace: &Workspace,
    interpreter: &Path,
    environment: &VirtualEnvironment,
) -> Result<(), XtaskError> {
    let builder = VirtualEnvironment::kept(workspace, interpreter, NEWCOMER)?;
    install(environment, &build(workspace, &builder)?)
}

/// What somebody does who has just read the README.
fn newcomer(workspace: &Workspace, interpreter: &Path) -> Result<(), XtaskError> {
    let newcomer = VirtualEnvironment::empty(workspace, interpreter, NEWCOMER)?;
    let mut by_the_readme = newcomer.pip(&["install", "--quiet", "./python"]);
    by_the_readme.current_dir(&workspace.root);
    run(by_the_readme)?;
    let mut first_steps = newcomer.python(&["-W", "error"]);
    first_steps.arg(workspace.root.join("python/tests/newcomer.py"));
    // From a folder outside the checkout's packages: what runs is what was installed.
    first_steps.current_dir(workspace.target.join("python"));
    run(first_steps)
}

/// The wheel, by the pip of that environment; Cargo builds only what changed.
fn build(workspace: &Workspace, environment: &VirtualEnvironment) -> Result<PathBuf, XtaskError> {
    let wheels = workspace.target.join("python").join("wheels");
    if wheels.exists() {
        fs::remove_dir_all(&wheels).map_err(|source| file_error(&wheels, source))?;
    }
    let mut wheel = environment.pip(&["wheel", "--quiet", "--no-deps", "./python", "--wheel-dir"]);
    wheel.arg(&wheels).current_dir(&workspace.root);
    run(wheel)?;
    let entries = fs::read_dir(&wheels).map_err(|source| file_error(&wheels, source))?;
    let mut paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    paths
        .find(|path| path.extension().is_some_and(|ending| ending == "whl"))
        .ok_or_else(|| file_error(&wheels, std::io::ErrorKind::NotFound.into()))
}

/// Puts a wheel in place of the one that is there.
fn install(environment: &VirtualEnvironment, wheel: &Path) -> Result<(), XtaskError> {
    let mut install = environment.pip(&["install", "--quiet", "--no-deps", "--force-reinstall"]);
    install.arg(wheel);
    run(install)
}

/// Runs the tests on the installed wheel, without a display.
fn pytest(workspace: &Workspace, environment: &VirtualEnvironment, arguments: &[&str]) -> Result<(), XtaskError> {
    let mut pytest = environment.python(&["-m", "pytest", "--quiet"]);
    pytest
        .args(arguments)
        .current_dir(workspace.root.join("python"))
        .env("SDL_VIDEODRIVER", "dummy");
    run(pytest)
}

/// Where a list of packages is, from the workspace's root.
fn requirements(name: &str) -> PathBuf {
    Path::new("python").join("tests").join(name).with_extension("txt")
}

/// A stage without what it needs: skipped, or a failure where the variable asks for it.
pub(crate) fn missing(variable: &'static str, reason: String) -> Result<Outcome, XtaskError> {
    outcome(env::var_os(variable).is_some(), variable, reason)
}

fn outcome(is_required: bool, variable: &'static str, reason: String) -> Result<Outcome, XtaskError> {
    if is_required {
        Err(XtaskError::Required { variable, reason })
    } else {
        Ok(Outcome::Skipped(reason))
    }
}

fn file_error(path: &Path, source: std::io::Error) -> XtaskError {
    XtaskError::File {
        path: path.to_owned(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_fails_only_where_it_is_required() {
        let ending = |is_required| outcome(is_required, REQUIRE_LEARNERS, "no room".to_owned());
        assert!(matches!(ending(false), Ok(Outcome::Skipped(reason)) if reason == "no room"));
        let message = ending(true).err().map(|error| error.to_string());
        assert_eq!(
            message.as_deref(),
            Some("no room; DRIFTWORLD_REQUIRE_LEARNERS is set, so that this is not skipped")
        );
    }

    #[test]
    fn lists_of_packages_are_where_they_are_looked_for() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for name in ["requirements", "requirements-oldest", "requirements-learners"] {
            assert!(root.join(requirements(name)).is_file(), "{name}");
        }
        for test in ANY_GYMNASIUM {
            assert!(root.join("python").join(test).is_file(), "{test}");
        }
    }
}
