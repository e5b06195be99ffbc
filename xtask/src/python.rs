//! The stages that need Python. Their virtual environments are in Cargo's build folder.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use crate::process::{Result, Workspace, about, output, run, works};
use crate::stage::{Outcome, missing};

pub(crate) const NO_INTERPRETER: &str =
    "found no Python 3.10 or later with venv and pip (Debian: apt install python3-venv; or set DRIFTWORLD_PYTHON)";

/// Any Python version that the package supports.
pub(crate) const ANY_VERSION: &str = "(3, 10) <= sys.version_info";

/// Tests that pass with every supported version of Gymnasium; they are repeated with the oldest.
const ANY_GYMNASIUM: [&str; 4] = [
    "tests/test_gymnasium.py",
    "tests/test_vector.py",
    "tests/test_options.py",
    "tests/test_check.py",
];

/// The requirements of the package's quick tests.
const PACKAGE_LIST: &str = "python/tests/requirements.txt";

/// Disk space needed to install the learners' environment (10 GiB), and for the builds that run at the same time.
const LEARNERS_GIB: u64 = 20;

/// A virtual environment.
pub(crate) struct Environment {
    interpreter: PathBuf,
}

/// The first interpreter with a suitable version, venv and pip: the one in `DRIFTWORLD_PYTHON`, or one of the usual names.
pub(crate) fn interpreter(version: &str) -> Option<PathBuf> {
    let usual = "python3 python python3.13 python3.12 python3.11 python3.10".split(' ');
    let names = env::var_os("DRIFTWORLD_PYTHON")
        .into_iter()
        .chain(usual.map(Into::into));
    let program = format!("import sys, venv, ensurepip; sys.exit(not ({version}))");
    names
        .map(PathBuf::from)
        .find(|name| works(python(name, &["-c", &program])))
}

/// A command that runs the interpreter with these arguments, without the variables of the user's own environment.
fn python(interpreter: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(interpreter);
    command
        .args(arguments)
        .env_remove("PYTHONPATH")
        .env_remove("PYTHONHOME")
        .env_remove("VIRTUAL_ENV");
    command
}

impl Environment {
    /// The environment of this name, with the packages of all these lists installed. It is recreated if it does not work.
    pub(crate) fn with(workspace: &Workspace, interpreter: &Path, name: &str, lists: &[&str]) -> Result<Self> {
        // With `--all`, the learners' environment is created while other stages run.
        static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
        let _turn = ONE_AT_A_TIME.lock();
        let folder = workspace.target.join("python").join(name);
        let environment = Self {
            interpreter: folder.join(if cfg!(windows) { "Scripts/python" } else { "bin/python" }),
        };
        if !works(environment.python(workspace, &["-m", "pip", "--version"])) {
            let mut make = python(interpreter, &["-m", "venv", "--clear"]);
            make.arg(&folder);
            run(make)?;
        }
        for list in lists {
            // Modules are compiled when they are first imported, and most never are.
            environment.pip(workspace, "install --quiet --no-compile --requirement", &[list])?;
        }
        Ok(environment)
    }

    /// A command that runs its interpreter with these arguments, in the root.
    pub(crate) fn python(&self, workspace: &Workspace, arguments: &[&str]) -> Command {
        let mut command = python(&self.interpreter, arguments);
        command.current_dir(&workspace.root);
        command
    }

    /// Runs its pip in the root, with `words` split at spaces, followed by arguments that may contain spaces.
    pub(crate) fn pip(&self, workspace: &Workspace, words: &str, rest: &[&str]) -> Result {
        let mut pip = self.python(workspace, &["-m", "pip", "--disable-pip-version-check"]);
        // Downloads may be larger than a temporary folder that is kept in memory.
        pip.args(words.split(' '))
            .args(rest)
            .env("TMPDIR", workspace.target.join("python"));
        run(pip)
    }

    /// Installs the wheel without its dependencies, which are already installed. One interpreter builds the wheel for all
    /// environments, so that Cargo has nothing to rebuild.
    pub(crate) fn install_driftworld(&self, workspace: &Workspace) -> Result {
        let builder = Self::with(
            workspace,
            &interpreter(ANY_VERSION).ok_or(NO_INTERPRETER)?,
            "newcomer",
            &[],
        )?;
        let wheels = workspace.target.join("python/wheels");
        let wheels = wheels.to_str().ok_or("the build folder's path is not UTF-8")?;
        builder.pip(workspace, "wheel --quiet --no-deps ./python --wheel-dir", &[wheels])?;
        let reinstall = "install --quiet --no-deps --force-reinstall --no-index --find-links";
        self.pip(workspace, reinstall, &[wheels, "driftworld"])
    }

    /// Runs tests of the package on the installed wheel, in parallel by file and without a display.
    fn pytest(&self, workspace: &Workspace, arguments: &[&str]) -> Result {
        let mut pytest = self.python(workspace, &["-m", "pytest", "--quiet"]);
        pytest
            .args(["--numprocesses", "auto", "--dist", "loadfile"])
            .args(arguments)
            .current_dir(workspace.root.join("python"))
            .env("SDL_VIDEODRIVER", "dummy");
        run(pytest)
    }
}

/// Follows a newcomer's steps: creates an empty environment, and runs the README's command, its examples and the console command.
pub(crate) fn wheel(workspace: &Workspace) -> Result<Outcome> {
    let Some(interpreter) = interpreter(ANY_VERSION) else {
        return missing("PYTHON", NO_INTERPRETER.into());
    };
    let folder = workspace.target.join("python/newcomer");
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(about(&folder))?;
    }
    let newcomer = Environment::with(workspace, &interpreter, "newcomer", &[])?;
    newcomer.pip(workspace, "install --quiet ./python", &[])?;
    let mut first_steps = newcomer.python(workspace, &["-W", "error"]);
    first_steps.arg(workspace.root.join("python/tests/newcomer.py"));
    // Runs in a folder outside the checkout's packages, so that the installed package is used.
    first_steps.current_dir(workspace.target.join("python"));
    run(first_steps)?;
    Ok(Outcome::Passed(String::new()))
}

/// Checks `tests/documents` against the committed schemas, with Python's `jsonschema`.
pub(crate) fn documents(workspace: &Workspace) -> Result<Outcome> {
    let list = "tests/documents/requirements.txt";
    match quick_environment(workspace, list) {
        Ok(tests) => {
            run(tests.python(workspace, &["tests/documents/validate.py"])).map(|()| Outcome::Passed(String::new()))
        }
        Err(reason) => missing("PYTHON", reason),
    }
}

/// Lints, type-checks and tests the package with the libraries that are quick to install, then tests it with the oldest Gymnasium.
pub(crate) fn package(workspace: &Workspace) -> Result<Outcome> {
    let tests = match quick_environment(workspace, PACKAGE_LIST) {
        Ok(tests) => tests,
        Err(reason) => return missing("PYTHON", reason),
    };
    let linted = [".", "../examples/python", "../scripts", "../unity/tests/clients"];
    for (arguments, folders) in [(&["-m", "ruff", "check"][..], &linted[..]), (&["-m", "mypy"], &[])] {
        let mut check = tests.python(workspace, arguments);
        check.args(folders).current_dir(workspace.root.join("python"));
        run(check)?;
    }
    tests.install_driftworld(workspace)?;
    let not_learners = ["-m", "not learners"];
    tests.pytest(workspace, &not_learners)?;
    let oldest = ["python/tests/requirements-oldest.txt"];
    tests.pip(workspace, "install --quiet --requirement", &oldest)?;
    // Variants differ in their worlds, which no version of Gymnasium sees.
    let not_each_variant = ["-k", "not every_variant"];
    tests.pytest(
        workspace,
        &[&not_learners, &not_each_variant, &ANY_GYMNASIUM[..]].concat(),
    )?;
    Ok(Outcome::Passed("with the newest and the oldest Gymnasium".into()))
}

/// The environment with torch, Stable-Baselines3, Minari and Ray, which take gigabytes.
pub(crate) fn learners_environment(workspace: &Workspace) -> Result<Environment> {
    let interpreter = interpreter(ANY_VERSION).ok_or(NO_INTERPRETER)?;
    let folder = workspace.target.join("python/learners");
    if !folder.exists()
        && let Some(free) = free_gib(&workspace.target)
        && free < LEARNERS_GIB
    {
        return Err(format!(
            "found {free} GiB of free disk space for torch and Ray, expected {LEARNERS_GIB}"
        ));
    }
    let list = ["python/tests/requirements-learners.txt"];
    Environment::with(workspace, &interpreter, "learners", &list).inspect_err(|_| {
        // An incomplete environment would only take disk space from other stages.
        let _ = fs::remove_dir_all(&folder);
    })
}

/// Free disk space for a folder, in GiB; `None` if `df` fails.
fn free_gib(folder: &Path) -> Option<u64> {
    let mut df = Command::new("df");
    df.arg("-Pk").arg(folder);
    let free = output(df).ok()?.lines().last()?.split_whitespace().nth(3)?.parse();
    free.ok().map(|kib: u64| kib >> 20)
}

/// Tests the package with the libraries that people train with.
pub(crate) fn learners(workspace: &Workspace) -> Result<Outcome> {
    match learners_environment(workspace) {
        Ok(learners) => {
            learners.install_driftworld(workspace)?;
            learners.pytest(workspace, &["-m", "learners"])?;
            Ok(Outcome::Passed(String::new()))
        }
        Err(reason) => missing("LEARNERS", reason),
    }
}

/// An interpreter that imports the installed package, for tests in other languages.
pub(crate) fn with_package(workspace: &Workspace) -> Result<PathBuf> {
    let tests = quick_environment(workspace, PACKAGE_LIST)?;
    tests.install_driftworld(workspace)?;
    Ok(tests.interpreter)
}

/// The environment of the quick tests, with the packages of a list.
fn quick_environment(workspace: &Workspace, list: &str) -> Result<Environment> {
    let interpreter = interpreter(ANY_VERSION).ok_or(NO_INTERPRETER)?;
    Environment::with(workspace, &interpreter, "tests", &[list])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn users_own_environment_is_ignored() {
        let command = python(Path::new("python3"), &["-c", ""]);
        assert_eq!(command.get_envs().filter(|(_, value)| value.is_none()).count(), 3);
        assert!(!works(python(Path::new("no-such-python"), &["-c", ""])));
    }

    #[cfg(unix)]
    #[test]
    fn free_space_is_read_from_df() {
        assert!(free_gib(Path::new("/")).is_some());
        assert_eq!(free_gib(Path::new("/no/such/folder")), None);
    }

    #[test]
    fn lists_and_tests_exist() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../python");
        for test in ANY_GYMNASIUM {
            assert!(folder.join(test).is_file(), "{test}");
        }
    }
}
