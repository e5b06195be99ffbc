//! Runs other programs. Errors are sentences that name the command and how it ended.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use serde_json::Value;

/// A result with a message as its error, because errors are only printed and end the command.
pub(crate) type Result<T = ()> = std::result::Result<T, String>;

/// The checkout that xtask runs in.
pub(crate) struct Workspace {
    /// The folder of the root `Cargo.toml`.
    pub(crate) root: PathBuf,
    /// Cargo's build folder.
    pub(crate) target: PathBuf,
    /// Whether `--all` is given: everything is checked, with all features and at full size.
    pub(crate) is_full: bool,
}

impl Workspace {
    /// `cargo` with these arguments, in the root.
    pub(crate) fn cargo(&self, arguments: &[&str]) -> Command {
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = self.program(cargo.as_ref(), arguments);
        // A stage builds only once, so incremental files would cost time and disk space for nothing.
        if env::var_os("CARGO_INCREMENTAL").is_none() {
            command.env("CARGO_INCREMENTAL", "0");
        }
        command
    }

    /// `cargo` for all crates with one set of features, so that stages share their builds. Without `--all`, excludes
    /// `driftworld-unity` and the fuzz targets: nothing depends on them, and they need fifty further crates.
    pub(crate) fn cargo_everywhere(&self, arguments: &[&str]) -> Command {
        let mut command = self.cargo(arguments);
        command.arg("--workspace");
        if self.is_full {
            command.args(["--features", "full"]);
        } else {
            command.args(["--exclude", "driftworld-unity", "--exclude", "driftworld-fuzz"]);
        }
        command
    }

    /// A program with these arguments, in the root.
    pub(crate) fn program(&self, program: &Path, arguments: &[&str]) -> Command {
        let mut command = Command::new(program);
        command.args(arguments).current_dir(&self.root);
        command
    }
}

/// Prints the command, runs it with our own input and output, and fails if it fails.
pub(crate) fn run(mut command: Command) -> Result {
    println!("$ {}", shown(&command));
    let status = command.status();
    ended(&command, status)
}

/// Whether the command starts and succeeds; its output is discarded.
pub(crate) fn works(mut command: Command) -> bool {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

/// The command's standard output; standard error is passed through.
pub(crate) fn output(mut command: Command) -> Result<String> {
    let done = command.stderr(Stdio::inherit()).output();
    let text = done.as_ref().map_or_else(
        |_| String::new(),
        |done| String::from_utf8_lossy(&done.stdout).into_owned(),
    );
    ended(&command, done.map(|done| done.status)).map(|()| text)
}

/// An error unless the command started and exited with status 0.
pub(crate) fn ended(command: &Command, status: std::io::Result<ExitStatus>) -> Result {
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{}` ended with {status}", shown(command))),
        Err(error) => Err(format!("`{}` could not be started: {error}", shown(command))),
    }
}

/// The command as a user would type it: variables, program and arguments.
fn shown(command: &Command) -> String {
    let variables = command.get_envs().filter_map(|(name, value)| Some((name, value?)));
    let variables = variables.map(|(name, value)| format!("{}='{}'", name.display(), value.display()));
    let program = Path::new(command.get_program()).file_stem().unwrap_or_default();
    let arguments = command.get_args().map(|argument| argument.display().to_string());
    let words = variables.chain([program.display().to_string()]).chain(arguments);
    words.collect::<Vec<_>>().join(" ")
}

/// Turns an error about a file into a sentence.
pub(crate) fn about(path: &Path) -> impl Fn(std::io::Error) -> String {
    move |error| format!("{}: {error}", path.display())
}

/// Cargo's metadata of the current folder's workspace. Dependencies are not resolved, so no network is needed.
pub(crate) fn metadata() -> Result<Value> {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["metadata", "--no-deps", "--format-version", "1"]);
    serde_json::from_str(&output(cargo)?).map_err(|error| format!("`cargo metadata` could not be parsed: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_show_the_command_as_typed() {
        let mut command = Command::new("/opt/rust/bin/no-such-cargo");
        command.args(["doc", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
        let error = run(command).unwrap_err();
        assert!(
            error.starts_with("`RUSTDOCFLAGS='-D warnings' no-such-cargo doc --no-deps` could not be started: "),
            "{error}"
        );
        let mut shell = Command::new("sh");
        shell.args(["-c", "exit 3"]);
        assert!(
            run(shell)
                .unwrap_err()
                .starts_with("`sh -c exit 3` ended with exit status: 3")
        );
    }
}
