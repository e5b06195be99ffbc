//! Starts other programs and turns their exit status into an error. Which programs, the stages say.

use std::env;
use std::process::{Command, ExitStatus, Stdio};

use crate::error::XtaskError;
use crate::workspace::Workspace;

/// What is built for tests: everything but the renderer for graphics cards, whose driver and whose crates few have.
pub(crate) const AS_TESTED: [&str; 3] = ["--workspace", "--features", "gltf,line-editor,parquet"];

/// The Cargo that started us, in the workspace's root, with these arguments.
pub(crate) fn cargo(workspace: &Workspace, arguments: &[&str]) -> Command {
    let mut command = bare_cargo();
    command.current_dir(&workspace.root).args(arguments);
    command
}

/// The Cargo that started us.
pub(crate) fn bare_cargo() -> Command {
    Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// A program by its name.
pub(crate) fn bare(program: &str) -> Command {
    Command::new(program)
}

/// Prints the command, runs it with our own input and output, and fails when it does.
pub(crate) fn run(mut command: Command) -> Result<(), XtaskError> {
    let shown = shown(&command);
    println!("$ {shown}");
    let status = command.status().map_err(|source| not_started(&command, source))?;
    succeeded(&shown, status)
}

/// Whether the command can be started and ends well; what it prints is thrown away.
pub(crate) fn works(mut command: Command) -> bool {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

/// The error for a command that the system would not start.
pub(crate) fn not_started(command: &Command, source: std::io::Error) -> XtaskError {
    XtaskError::NotStarted {
        command: shown(command),
        program: program(command),
        source,
    }
}

/// `Ok` for exit status 0.
pub(crate) fn succeeded(command: &str, status: ExitStatus) -> Result<(), XtaskError> {
    if status.success() {
        Ok(())
    } else {
        Err(XtaskError::Failed {
            command: command.to_owned(),
            status,
        })
    }
}

/// The command as a user would type it: variables, program, arguments.
pub(crate) fn shown(command: &Command) -> String {
    let variables = command.get_envs().filter_map(|(name, value)| {
        value.map(|value| format!("{}='{}'", name.to_string_lossy(), value.to_string_lossy()))
    });
    let arguments = command
        .get_args()
        .map(|argument| argument.to_string_lossy().into_owned());
    variables
        .chain([program(command)])
        .chain(arguments)
        .collect::<Vec<_>>()
        .join(" ")
}

/// The program's name without its folders.
pub(crate) fn program(command: &Command) -> String {
    let path = std::path::Path::new(command.get_program());
    path.file_stem()
        .unwrap_or(path.as_os_str())
        .to_string_lossy()
        .into_owned()
}

/// What a command prints; its errors are shown as they come.
pub(crate) fn output(command: Command) -> Result<String, XtaskError> {
    println!("$ {}", shown(&command));
    let text = quiet_output(command)?;
    print!("{text}");
    Ok(text)
}

/// What a command prints, shown to nobody; its errors are.
pub(crate) fn quiet_output(mut command: Command) -> Result<String, XtaskError> {
    let line = shown(&command);
    let done = command
        .stderr(Stdio::inherit())
        .output()
        .map_err(|source| not_started(&command, source))?;
    succeeded(&line, done.status)?;
    Ok(String::from_utf8_lossy(&done.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_shown_as_a_user_would_type_it() {
        let mut command = Command::new("/opt/rust/bin/cargo");
        command.args(["doc", "--no-deps"]).env("RUSTDOCFLAGS", "-D warnings");
        assert_eq!(shown(&command), "RUSTDOCFLAGS='-D warnings' cargo doc --no-deps");
    }

    #[test]
    fn a_missing_program_is_named() {
        let error = run(Command::new("no-such-program-of-ours")).unwrap_err().to_string();
        assert!(
            error.contains("`no-such-program-of-ours` could not be started"),
            "{error}"
        );
        assert!(!works(Command::new("no-such-program-of-ours")));
    }
}
