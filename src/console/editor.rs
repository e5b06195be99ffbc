//! Line editing on a terminal: history and completion.

use crate::env::Category;
use rustyline::completion::Completer;
use rustyline::error::ReadlineError;
use rustyline::highlight::Highlighter;
use rustyline::hint::Hinter;
use rustyline::history::MemHistory;
use rustyline::validate::Validator;
use rustyline::{Config, Context, Helper};

use super::line;
use super::session::Names;
use crate::Failure;
use crate::modality;

/// Reads lines from a terminal.
pub(crate) struct Editor(rustyline::Editor<Completions, MemHistory>);

impl Editor {
    pub(crate) fn new() -> Result<Self, Failure> {
        let config = Config::builder().auto_add_history(true).build();
        let mut editor = rustyline::Editor::with_history(config.clone(), MemHistory::with_config(&config))?;
        editor.set_helper(Some(Completions(Names::default())));
        Ok(Self(editor))
    }

    /// Reads the next line that is neither empty nor a comment; `None` if the user quits. Ctrl-C discards the line.
    pub(crate) fn read(&mut self, names: Names) -> Result<Option<String>, Failure> {
        self.0.set_helper(Some(Completions(names)));
        loop {
            match self.0.readline("driftworld> ") {
                Ok(line) if line.trim().is_empty() || line.trim_start().starts_with('#') => {}
                Ok(line) => return Ok(Some(line)),
                Err(ReadlineError::Interrupted) => {}
                Err(ReadlineError::Eof) => return Ok(None),
                Err(error) => return Err(Failure::input(format!("terminal: {error}"))),
            }
        }
    }
}

/// Tab completion.
struct Completions(Names);

impl Completions {
    /// The candidates for the word after the given ones.
    fn after(&self, before: &[&str]) -> Vec<String> {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        match before {
            [] | ["help"] => owned(&line::names()),
            ["show"] => owned(&modality::NAMES),
            ["screenshot", _] => owned(&[&modality::NAMES[..], &["map"]].concat()),
            ["log"] => owned(&Category::names()),
            ["log", _] => owned(&["on", "off"]),
            ["state"] => owned(&["--json"]),
            ["action"] => owned(&["-c", "-a"]),
            ["destroy"] => self.0.objects.clone(),
            ["restore" | "snapshot"] => self.0.snapshots.clone(),
            ["spawn"] => crate::env::classes().map(|(class, _)| class.to_owned()).collect(),
            ["spawn", _, _, _, ..] => owned(&[
                "color=",
                "destroy_stimulus=",
                "heading=",
                "model=",
                "motion_model=",
                "reward=",
                "reward_stimulus=",
                "scale=",
                "solid=",
                "speed=",
                "tag=",
                "unique_name=",
            ]),
            _ => Vec::new(),
        }
    }
}

impl Completer for Completions {
    type Candidate = String;

    fn complete(&self, line: &str, pos: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<String>)> {
        let line = &line[..pos];
        let start = line.rfind(char::is_whitespace).map_or(0, |at| at + 1);
        let before: Vec<&str> = line[..start].split_whitespace().collect();
        let mut words = self.after(&before);
        words.retain(|word| word.starts_with(&line[start..]));
        // A complete word is followed by a space; a key, by its value.
        if let [only] = &mut words[..]
            && !only.ends_with('=')
        {
            only.push(' ');
        }
        Ok((start, words))
    }
}

impl Hinter for Completions {
    type Hint = String;
}

impl Highlighter for Completions {}

impl Validator for Completions {}

impl Helper for Completions {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn completions_depend_on_the_words_before() {
        let check = |line: &str, expected: &[&str]| {
            let words = Completions(Names {
                objects: vec!["oak".to_owned()],
                snapshots: vec!["before".to_owned()],
            });
            let history = MemHistory::new();
            let found = words
                .complete(line, line.len(), &Context::new(&history))
                .expect("completion does not fail");
            assert_eq!(found.1, expected, "{line}");
        };
        check("sta", &["state "]);
        check("show d", &["depth "]);
        check("log academy o", &["on", "off"]);
        check("destroy o", &["oak "]);
        check("restore ", &["before "]);
        check("spawn bar", &["barrel "]);
        check("spawn barrel 1 2 uni", &["unique_name="]);
        check("info x", &[]);
    }
}
