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

/// What an interpreter has to be able to do: be new enough, and make virtual environments with pip in them.
const FIT: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 10))";

/// The name of the file that says what an environment was made from.
const STAMP: &str = "driftworld-made-from.txt";

/// The interpreter that `DRIFTWORLD_PYTHON` names, else the first of the usual names that is fit; `None` without one.
pub(crate) fn interpreter() -> Option<PathBuf> {
    let named = env::var_os(PYTHON).map(PathBuf::from);
    let usual = [
        "python3",
        "python",
        "python3.14",
        "python3.13",
        "python3.12",
        "python3.11",
        "python3.10",
    ];
    named
        .into_iter()
        .chain(usual.map(PathBuf::from))
        .find(|python| works(with(python, &["-c", FIT])))
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
        let path = workspace.root.join(requirements);
        let text = fs::read_to_string(&path).map_err(|source| XtaskError::File { path, source })?;
        let made_from = format!("{}\n{text}", interpreter.display());
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
    fn what_does_not_start_is_not_an_interpreter() {
        assert!(!works(with(Path::new("no-such-python"), &["-c", FIT])));
    }
}
