//! Virtual environments of Python below Cargo's build folder: made when missing or out of date, kept otherwise. What is run in
//! them is the business of `python.rs`.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{run, works};
use crate::workspace::Workspace;

/// Names the interpreter to make them with.
const PYTHON: &str = "DRIFTWORLD_PYTHON";

/// The names that interpreters go by.
const USUAL: [&str; 7] = [
    "python3",
    "python",
    "python3.14",
    "python3.13",
    "python3.12",
    "python3.11",
    "python3.10",
];

/// The name of the file that says what an environment was made from.
const STAMP: &str = "driftworld-made-from.txt";

/// The interpreter that `DRIFTWORLD_PYTHON` names, else the first of the usual names that is fit; `None` without one.
pub(crate) fn interpreter() -> Option<PathBuf> {
    fit("(3, 10) <= sys.version_info")
}

/// The same below a minor version of Python 3, for packages that have not come along.
pub(crate) fn interpreter_before(minor: u32) -> Option<PathBuf> {
    fit(&format!("(3, 10) <= sys.version_info < (3, {minor})"))
}

/// The first interpreter of such a version that can make virtual environments with pip in them.
fn fit(version: &str) -> Option<PathBuf> {
    let program = format!("import sys, venv, ensurepip; sys.exit(not ({version}))");
    let named = env::var_os(PYTHON).map(PathBuf::from);
    named
        .into_iter()
        .chain(USUAL.map(PathBuf::from))
        .find(|python| works(with(python, &["-c", &program])))
}

/// A folder with an interpreter and packages of its own.
#[derive(Debug, Clone)]
pub(crate) struct VirtualEnvironment {
    folder: PathBuf,
}

impl VirtualEnvironment {
    /// The one of that name with the packages of a requirements file; made anew only when either it or the interpreter changed.
    pub(crate) fn with_requirements(
        workspace: &Workspace,
        interpreter: &Path,
        name: &str,
        requirements: &Path,
    ) -> Result<Self, XtaskError> {
        Self::with_unwilling(workspace, interpreter, name, requirements, None)
    }

    /// The same, and then the packages of a second file: without what they depend on, and whatever Python they ask for. For those that
    /// run where their own lists say they do not.
    pub(crate) fn with_unwilling(
        workspace: &Workspace,
        interpreter: &Path,
        name: &str,
        requirements: &Path,
        unwilling: Option<&Path>,
    ) -> Result<Self, XtaskError> {
        let mut made_from = identity(interpreter);
        for file in [Some(requirements), unwilling].into_iter().flatten() {
            let path = workspace.root.join(file);
            let text = fs::read_to_string(&path).map_err(|source| XtaskError::File { path, source })?;
            made_from = format!("{made_from}\n{text}");
        }
        let this = Self {
            folder: folder(workspace, name),
        };
        let stamp = this.folder.join(STAMP);
        if fs::read_to_string(&stamp).is_ok_and(|stamp| stamp == made_from) && works(this.python(&["-c", ""])) {
            println!("{} is as {} asks", this.folder.display(), requirements.display());
            return Ok(this);
        }
        let this = Self::empty(workspace, interpreter, name)?;
        let mut install = this.pip(&["install", "--quiet", "--requirement"]);
        install.current_dir(&workspace.root).arg(requirements);
        run(install)?;
        if let Some(unwilling) = unwilling {
            let mut install = this.pip(&[
                "install",
                "--quiet",
                "--no-deps",
                "--ignore-requires-python",
                "--requirement",
            ]);
            install.current_dir(&workspace.root).arg(unwilling);
            run(install)?;
        }
        fs::write(&stamp, made_from).map_err(|source| XtaskError::File { path: stamp, source })?;
        Ok(this)
    }

    /// The one of that name as it is, or a new one with nothing in it.
    pub(crate) fn kept(workspace: &Workspace, interpreter: &Path, name: &str) -> Result<Self, XtaskError> {
        let this = Self {
            folder: folder(workspace, name),
        };
        if works(this.python(&["-m", "pip", "--version"])) {
            return Ok(this);
        }
        Self::empty(workspace, interpreter, name)
    }

    /// A new one of that name with nothing in it; what was there before goes.
    pub(crate) fn empty(workspace: &Workspace, interpreter: &Path, name: &str) -> Result<Self, XtaskError> {
        let folder = folder(workspace, name);
        if folder.exists() {
            fs::remove_dir_all(&folder).map_err(|source| XtaskError::File {
                path: folder.clone(),
                source,
            })?;
        }
        let mut make = with(interpreter, &["-m", "venv"]);
        make.arg(&folder);
        run(make)?;
        Ok(Self { folder })
    }

    /// Its interpreter with these arguments.
    pub(crate) fn python(&self, arguments: &[&str]) -> Command {
        with(&self.program("python"), arguments)
    }

    /// Its pip with these arguments.
    pub(crate) fn pip(&self, arguments: &[&str]) -> Command {
        let mut command = self.python(&["-m", "pip", "--disable-pip-version-check"]);
        command.args(arguments);
        command
    }

    /// A program that one of its packages brought.
    pub(crate) fn program(&self, name: &str) -> PathBuf {
        let programs = if cfg!(windows) { "Scripts" } else { "bin" };
        self.folder.join(programs).join(name)
    }
}

/// Which Python an interpreter is, whatever name it goes by: `python3` may be another tomorrow, and the same by another path.
fn identity(interpreter: &Path) -> String {
    let asked = with(interpreter, &["-c", "import sys; print(sys.base_prefix, sys.version)"]).output();
    asked.map_or_else(
        |_| interpreter.display().to_string(),
        |said| String::from_utf8_lossy(&said.stdout).trim().to_owned(),
    )
}

/// Where the environment of that name is.
fn folder(workspace: &Workspace, name: &str) -> PathBuf {
    workspace.target.join("python").join(name)
}

/// The interpreter with these arguments, without what a user's variables would mix in.
fn with(interpreter: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(interpreter);
    command
        .args(arguments)
        .env_remove("PYTHONPATH")
        .env_remove("PYTHONHOME")
        .env_remove("VIRTUAL_ENV");
    command
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn environments_live_below_the_build_folder_and_keep_users_variables_out() {
        let environment = VirtualEnvironment {
            folder: PathBuf::from("target/python/newest"),
        };
        let command = environment.pip(&["list"]);
        let program = Path::new(command.get_program());
        assert!(program.starts_with("target/python/newest"), "{program:?}");
        let removed = command.get_envs().filter(|(_, value)| value.is_none()).count();
        assert_eq!(removed, 3, "{command:?}");
    }

    #[test]
    fn an_interpreter_is_known_by_what_it_is_not_by_its_name() {
        if let Some(python) = interpreter() {
            let whole_path = with(&python, &["-c", "import sys; print(sys.executable)"])
                .output()
                .unwrap();
            let whole_path = String::from_utf8(whole_path.stdout).unwrap();
            assert_eq!(identity(&python), identity(Path::new(whole_path.trim())));
            assert!(identity(&python).contains(" 3."), "{}", identity(&python));
        }
        assert_eq!(identity(Path::new("no-such-python")), "no-such-python");
    }

    #[test]
    fn what_does_not_start_is_not_an_interpreter() {
        assert!(!works(with(Path::new("no-such-python"), &["-c", ""])));
    }
}
