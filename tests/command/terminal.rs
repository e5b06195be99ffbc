//! Helpers for tests of the command: running it, and reading its output.

use std::io::Write;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;

/// The project's folder.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Arguments of a command: one string, split at spaces, or a list.
pub(crate) trait Arguments {
    fn words(&self) -> Vec<&str>;
}

impl Arguments for str {
    fn words(&self) -> Vec<&str> {
        self.split_whitespace().collect()
    }
}

impl Arguments for String {
    fn words(&self) -> Vec<&str> {
        self.as_str().words()
    }
}

impl Arguments for [&str] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl<const N: usize> Arguments for [&str; N] {
    fn words(&self) -> Vec<&str> {
        self.to_vec()
    }
}

impl Arguments for Vec<&str> {
    fn words(&self) -> Vec<&str> {
        self.clone()
    }
}

/// Checks that a command's output contains a text; shows the whole output if not.
pub(crate) trait Says {
    fn says(&self, part: &str);
}

impl Says for str {
    #[track_caller]
    fn says(&self, part: &str) {
        assert!(self.contains(part), "found no {part:?} in: {self}");
    }
}

/// The command with these arguments, to be run in the project's folder.
pub(crate) fn driftworld(arguments: &(impl Arguments + ?Sized)) -> Command {
    driftworld_in(root(), arguments)
}

/// The command, to be run in this folder.
pub(crate) fn driftworld_in(folder: &Path, arguments: &(impl Arguments + ?Sized)) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_driftworld"));
    // The developer's terminal may be narrow, or have colours configured.
    command
        .args(arguments.words())
        .current_dir(folder)
        .env_remove("COLUMNS");
    command
}

/// Runs the command to its end.
pub(crate) fn output(command: &mut Command) -> Output {
    command.output().expect("the command was built by cargo and starts")
}

/// Runs the command, which must succeed, and returns its standard output.
#[track_caller]
pub(crate) fn succeed(arguments: &(impl Arguments + ?Sized)) -> String {
    succeed_in(root(), arguments)
}

/// Runs the command in this folder, like [`succeed`].
#[track_caller]
pub(crate) fn succeed_in(folder: &Path, arguments: &(impl Arguments + ?Sized)) -> String {
    let output = output(&mut driftworld_in(folder, arguments));
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{:?}: {error}", arguments.words());
    String::from_utf8(output.stdout).expect("the command prints UTF-8")
}

/// Runs the command, which must succeed, and returns the JSON that it prints.
#[track_caller]
pub(crate) fn json(arguments: &(impl Arguments + ?Sized)) -> Value {
    json_in(root(), arguments)
}

/// Runs the command in this folder, like [`json`].
#[track_caller]
pub(crate) fn json_in(folder: &Path, arguments: &(impl Arguments + ?Sized)) -> Value {
    serde_json::from_str(&succeed_in(folder, arguments)).expect("--json prints JSON")
}

/// The subcommands that `driftworld --help` lists.
pub(crate) fn subcommands() -> Vec<String> {
    let help = succeed("--help");
    let listed = help.lines().take_while(|line| *line != "Options:");
    let names = listed.filter_map(|line| line.strip_prefix("  ")?.split(' ').next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Runs the command, which must end with this exit code, and returns its standard error.
#[track_caller]
pub(crate) fn fail(code: i32, arguments: &(impl Arguments + ?Sized)) -> String {
    fail_in(root(), code, arguments)
}

/// Its standard error when run in this folder; it must end with this exit code.
#[track_caller]
pub(crate) fn fail_in(folder: &Path, code: i32, arguments: &(impl Arguments + ?Sized)) -> String {
    let output = output(&mut driftworld_in(folder, arguments));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{:?}: {error}", arguments.words());
    assert!(!error.contains("panicked"), "{error}");
    error
}

/// The signals that stop a command, by name for `kill` and by number. Without the hang-up if the tests run under `nohup`: then
/// the command ignores it, as it should.
#[cfg(unix)]
pub(crate) fn signals() -> impl Iterator<Item = (&'static str, i32)> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    let hangs_up = ignored.is_some_and(|mask| mask & 1 == 0);
    let all = [("-HUP", 1), ("-INT", 2), ("-TERM", 15)];
    all.into_iter().skip(usize::from(!hangs_up))
}

/// Starts a command with pipes for its input and outputs.
pub(crate) fn piped(mut command: Command) -> Child {
    let command = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command.spawn().expect("the command was built by cargo and starts")
}

/// Runs a command with this standard input; it need not read all of it.
pub(crate) fn fed(command: Command, input: &[u8]) -> Output {
    let mut child = piped(command);
    let _ = child.stdin.take().map(|mut pipe| pipe.write_all(input));
    child.wait_with_output().expect("the command ends")
}

/// Sends a signal to a child, such as `-INT`.
#[cfg(unix)]
pub(crate) fn signal(child: &Child, signal: &str) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.is_ok_and(|sent| sent.success()));
}

/// A temporary folder.
pub(crate) fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("the machine has a folder for temporary files")
}

/// A path as an argument.
pub(crate) fn text(path: &Path) -> &str {
    path.to_str().expect("temporary paths are UTF-8")
}

/// The contents of a file.
pub(crate) fn read(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
