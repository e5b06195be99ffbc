//! [`Failure`]: the reason why an operation of this library failed. Each interface renders its text with its own argument
//! names.

use std::error::Error;
use std::fmt;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::Arc;

use driftworld_text::ShownPath;

/// The error behind a failure, for programs that need more than its text.
pub type Cause = Arc<dyn Error + Send + Sync>;

/// Receives warnings during an operation, from any thread.
pub type Warn<'a> = &'a (dyn Fn(String) + Sync);

/// Encloses the name of an argument in a text. A pair that encloses anything else is ordinary text.
const MARK: char = '\u{1}';

/// The name of an argument in the text of a failure, such as `window_length`: the command writes `--window-length`, Python
/// `window_length`.
pub(crate) fn argument(name: &str) -> String {
    format!("{MARK}{name}{MARK}")
}

/// Refuses a number that is out of an argument's range.
pub(crate) fn within(name: &str, found: u64, range: RangeInclusive<u64>) -> Result<(), Failure> {
    if range.contains(&found) {
        return Ok(());
    }
    let (name, first, last) = (argument(name), range.start(), range.end());
    Err(Failure::usage(format!(
        "{name}: found {found}, expected a whole number in {first}..={last}"
    )))
}

/// Why an operation failed.
///
/// # Example
/// ```
/// use driftworld::scoring::{ScoringRequest, score};
/// let failure = score(&ScoringRequest::of(["nowhere"]), &|_| {}).unwrap_err();
/// assert_eq!(
///     failure.to_string(),
///     "nowhere: found nothing, expected the folder of a log, which holds logger_info.json"
/// );
/// ```
#[derive(Clone, Debug)]
pub struct Failure {
    /// The names of arguments are marked.
    text: String,
    cause: Option<Cause>,
    is_usage: bool,
}

fn is_name(text: &str) -> bool {
    !text.is_empty()
        && text
            .bytes()
            .all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_')
}

impl Failure {
    /// The text with arguments as command options: `--window-length`. Displayed, they are as in Rust and Python: `window_length`.
    pub fn for_command(&self) -> String {
        self.with(|name| match name {
            // The option `--order` takes purposes and methods.
            "method" => "--order".to_owned(),
            name => format!("--{}", name.replace('_', "-")),
        })
    }

    fn with(&self, named: impl Fn(&str) -> String) -> String {
        let (mut shown, mut rest) = (String::with_capacity(self.text.len()), self.text.as_str());
        while let Some((before, behind)) = rest.split_once(MARK) {
            shown.push_str(before);
            rest = match behind.split_once(MARK) {
                Some((name, behind)) if is_name(name) => {
                    shown.push_str(&named(name));
                    behind
                }
                _ => {
                    shown.push(MARK);
                    behind
                }
            };
        }
        shown + rest
    }

    /// Whether the arguments contradict each other; otherwise, the input or the output path is invalid.
    pub fn is_usage(&self) -> bool {
        self.is_usage
    }

    /// The error that caused the failure, if any.
    pub fn cause(&self) -> Option<Cause> {
        self.cause.clone()
    }

    /// The exit code of a command that fails with this.
    pub(crate) fn exit_code(&self) -> u8 {
        if self.is_usage { 2 } else { 1 }
    }

    pub(crate) fn usage(text: impl Into<String>) -> Self {
        Self {
            is_usage: true,
            ..Self::input(text)
        }
    }

    pub(crate) fn input(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            cause: None,
            is_usage: false,
        }
    }

    /// The failure of a file or a folder.
    pub(crate) fn in_file(path: &Path, what: impl fmt::Display) -> Self {
        Self::input(format!("{}: {what}", path.shown()))
    }

    /// The failure of an argument's value.
    pub(crate) fn in_argument(name: &str, what: impl fmt::Display) -> Self {
        Self::usage(format!("{}: {what}", argument(name)))
    }

    /// A failure with its own text, caused by an error.
    pub(crate) fn because(text: impl Into<String>, error: impl Error + Send + Sync + 'static) -> Self {
        Self {
            cause: Some(Arc::new(error)),
            ..Self::input(text)
        }
    }

    /// Prefixes the folder unless the text already names it.
    pub(crate) fn at(mut self, folder: &Path) -> Self {
        let shown = folder.shown().to_string();
        if !self.is_usage && !self.text.contains(&shown) {
            self.text = format!("{shown}: {}", self.text);
        }
        self
    }

    /// Combines several failures; keeps the cause of the first.
    pub(crate) fn of_several(failures: &[&Self]) -> Self {
        let texts: Vec<&str> = failures.iter().map(|failure| failure.text.as_str()).collect();
        Self {
            cause: failures.first().and_then(|failure| failure.cause()),
            ..Self::input(texts.join("\n"))
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.with(str::to_owned))
    }
}

// `Failure` does not implement `Error`: this impl would then conflict with the conversion of a type into itself.
impl<E: Error + Send + Sync + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::because(error.to_string(), error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interfaces_name_arguments_in_their_own_way() {
        let failure = Failure::usage(format!(
            "{}: found 0, expected 1 or more; leave {} out",
            argument("window_length"),
            argument("noise")
        ));
        assert_eq!(
            failure.for_command(),
            "--window-length: found 0, expected 1 or more; leave --noise out"
        );
        assert_eq!(
            failure.to_string(),
            "window_length: found 0, expected 1 or more; leave noise out"
        );
    }

    /// Every text of up to four of these characters: the mark, one that no name contains, and one with which options begin.
    fn texts() -> Vec<String> {
        let mut all = vec![String::new()];
        let mut longest = all.clone();
        for _ in 0..4 {
            let longer = |text: &String| [MARK, 'A', '-'].map(|c| format!("{text}{c}"));
            longest = longest.iter().flat_map(longer).collect();
            all.extend(longest.iter().cloned());
        }
        all
    }

    #[test]
    fn text_around_an_argument_is_unchanged() {
        let shown = |text: String| Failure::input(text).for_command();
        for before in texts() {
            assert_eq!(shown(before.clone()), before);
            for behind in texts() {
                let text = format!("{before}{}{behind}", argument("window_length"));
                assert_eq!(shown(text), format!("{before}--window-length{behind}"));
            }
        }
    }
}
