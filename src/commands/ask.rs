//! The command asked by a program instead of run by a person: what it has to say is handed back, nothing is shown.

use std::ffi::OsString;
use std::sync::{Mutex, MutexGuard, PoisonError};

use driftworld_text::printable_lines;

use super::{Cause, output};

/// What the command said.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answer {
    /// What it would have printed on standard output.
    pub output: String,
    /// Warnings and the like, which it would have printed on standard error.
    pub notes: Vec<String>,
}

/// What the command refused to do, and why.
#[derive(Clone, Debug, thiserror::Error)]
#[error("{message}")]
pub struct Refusal {
    /// What it would have printed as its error.
    pub message: String,
    /// Whether the arguments were wrong, not what they name.
    pub in_arguments: bool,
    /// Warnings that came before.
    pub notes: Vec<String>,
    /// The error behind it, where there is one: of one of the crates, with its code and its place.
    pub cause: Option<Cause>,
}

/// Asks the command: runs it, keeps what it would print, and prints nothing. `args` does not begin with the program's name.
///
/// One question is answered at a time; others wait. Files that the arguments name are written as ever. Not for subcommands that
/// ask the person at the terminal or catch signals: `console`, `demo` and `run`.
///
/// # Errors
/// [`Refusal`] with the message that the command fails with.
///
/// # Example
/// ```
/// let answer = driftworld::commands::ask(["tasks", "--json"].map(Into::into))?;
/// assert!(answer.output.contains("find_objects"));
/// let refusal = driftworld::commands::ask(["sample", "find_object"].map(Into::into)).unwrap_err();
/// assert!(refusal.message.ends_with("did you mean \"find_objects\"?"));
/// # Ok::<(), driftworld::commands::Refusal>(())
/// ```
pub fn ask(args: impl IntoIterator<Item = OsString>) -> Result<Answer, Refusal> {
    let _one_at_a_time = alone();
    let command = super::parse(std::iter::once("driftworld".into()).chain(args)).map_err(|error| Refusal {
        message: plain(&printable_lines(&error.to_string())),
        in_arguments: true,
        notes: Vec::new(),
        cause: None,
    })?;
    let (done, answer) = output::kept(|| command.run());
    match done {
        Ok(()) => Ok(answer),
        Err(failure) => Err(Refusal {
            message: printable_lines(failure.text()).into_owned(),
            in_arguments: matches!(failure, super::Failure::Usage(_)),
            notes: answer.notes,
            cause: failure.cause(),
        }),
    }
}

/// One command at a time: what another says meanwhile would be taken for its answer.
pub(super) fn alone() -> MutexGuard<'static, ()> {
    static BUSY: Mutex<()> = Mutex::new(());
    BUSY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What the parser of arguments says, without the word that it begins with and the advice to read the help that it ends with.
fn plain(text: &str) -> String {
    let text = text.strip_prefix("error: ").unwrap_or(text);
    let end = text
        .find("\n\nUsage:")
        .or_else(|| text.find("\n\nFor more information"));
    text[..end.unwrap_or(text.len())].trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(args: &[&str]) -> Result<Answer, Refusal> {
        ask(args.iter().map(Into::into))
    }

    #[test]
    fn what_would_be_printed_is_handed_back() {
        let answer =
            asked(&["distance", "find_objects#blue", "find_objects#red", "--json"]).expect("both are built in");
        let found: serde_json::Value = serde_json::from_str(&answer.output).expect("it is JSON");
        assert!(found["total"].as_f64().expect("it is a number") > 0.0);
        assert!(answer.notes.is_empty());
    }

    #[test]
    fn a_refusal_says_what_the_command_says() {
        let refused = |args: &[&str]| asked(args).expect_err("it is wrong");
        let found = refused(&["sample", "find_object"]);
        assert!(found.message.contains("did you mean \"find_objects\"?") && !found.in_arguments);
        let found = refused(&["order", "find_objects", "--method", "nearby"]);
        assert!(found.message.starts_with("invalid value 'nearby'") && found.in_arguments);
        assert!(!found.message.contains("--help"), "{}", found.message);
        assert!(found.cause.is_none());
    }

    #[test]
    fn a_refusal_carries_the_error_behind_it() {
        let refused = asked(&["sample", "find_object"]).expect_err("it is wrong");
        let cause = refused.cause.expect("a task's error is behind it");
        assert!(cause.downcast_ref::<crate::tasks::TaskError>().is_some());
    }
}
