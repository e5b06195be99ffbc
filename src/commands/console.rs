//! `driftworld console`: controls a running world by hand, with lines from a terminal, a pipe or a script.

use std::io::{BufRead, IsTerminal, Read};
use std::path::PathBuf;

use clap::Args;
use driftworld_text::ShownPath;

use crate::console::{Editor, Reply, Screen, Session};
use crate::worlds::WorldRequest;
use crate::{Failure, documents};

use super::output;

/// Maximum length of a line in bytes: a message may contain a whole world.
const MAX_LINE_BYTES: u64 = 64 << 20;

/// Step through a world by hand: act, observe, edit it.
///
/// On a terminal you can edit, recall and complete (Tab) lines. From a pipe or a script, each line is a command and `#`
/// starts a comment. Each command is echoed before its answer. The first error ends the session with exit code 1.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld console find_objects#red --seed 7
  driftworld console world.json --script tour.txt -o pictures
  printf 'step 10 2 0 0\\nobjects\\n' | driftworld console find_objects

Type help for the commands.")]
pub(crate) struct Console {
    #[command(flatten)]
    choice: WorldRequest,
    /// Read commands from this file.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// Continue after an error in a script or pipe. The exit code is still 1.
    #[arg(long)]
    keep_going: bool,
    /// Folder for screenshots and states. Nothing is written elsewhere.
    #[arg(short, long, default_value = "console-out", value_name = "DIR")]
    output: PathBuf,
}

impl Console {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let script = match &self.script {
            Some(path) => Some((path, documents::text(path)?)),
            None => None,
        };
        let choice = self.choice.clone();
        let warn = |text| output::warning(text);
        let world = choice.world(&warn)?;
        let mut session = Session::new((choice, &warn), world, &self.output, Screen::of_this_terminal());
        output::line(session.greeting())?;
        if let Some((path, text)) = script {
            let lines = text.lines().map(|line| Ok(line.to_owned()));
            return self.follow(&mut session, &path.shown().to_string(), lines);
        }
        if std::io::stdin().is_terminal() {
            return converse(&mut session);
        }
        self.follow(&mut session, "standard input", lines_of_standard_input())
    }

    /// Executes the lines of a pipe or script.
    fn follow(
        &self,
        session: &mut Session,
        name: &str,
        lines: impl Iterator<Item = Result<String, Failure>>,
    ) -> Result<(), Failure> {
        let mut failed = 0;
        for (number, line) in lines.enumerate() {
            let line = line?;
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            output::line(format!("> {line}"))?;
            match session.execute(line) {
                Ok(Reply::Quit) => break,
                Ok(reply) => print_reply(&reply)?,
                Err(text) => {
                    output::line(format!("error: {text}"))?;
                    failed += 1;
                    if !self.keep_going {
                        return Err(Failure::input(format!("{name}:{}: {text}", number + 1)));
                    }
                }
            }
        }
        if failed > 0 {
            return Err(Failure::input(format!("{name}: {failed} commands failed")));
        }
        Ok(())
    }
}

/// Executes lines from a terminal until the user quits.
fn converse(session: &mut Session) -> Result<(), Failure> {
    let mut editor = Editor::new()?;
    while let Some(line) = editor.read(session.names())? {
        match session.execute(&line) {
            Ok(Reply::Quit) => break,
            Ok(reply) => print_reply(&reply)?,
            Err(text) => output::line(format!("error: {text}"))?,
        }
    }
    Ok(())
}

fn print_reply(reply: &Reply) -> Result<(), Failure> {
    let (Reply::Text(text) | Reply::Json(text) | Reply::Picture(text)) = reply else {
        return Ok(());
    };
    if text.is_empty() {
        return Ok(());
    }
    let text = format!("{}\n", text.trim_end_matches('\n'));
    match reply {
        Reply::Json(_) => output::print_json(&text),
        Reply::Picture(_) => output::print_as_is(&text),
        Reply::Text(_) | Reply::Quit => output::print(&text),
    }
}

/// The lines of standard input, each returned as soon as it arrives.
fn lines_of_standard_input() -> impl Iterator<Item = Result<String, Failure>> {
    let mut number = 0;
    std::iter::from_fn(move || {
        number += 1;
        let failed = |what: String| Some(Err(Failure::input(format!("standard input:{number}: {what}"))));
        let mut bytes = Vec::new();
        let mut input = std::io::stdin().lock().take(MAX_LINE_BYTES + 1);
        match input.read_until(b'\n', &mut bytes) {
            Ok(0) => None,
            Ok(length) if length as u64 > MAX_LINE_BYTES => {
                failed(format!("found a longer line, expected at most {MAX_LINE_BYTES} bytes"))
            }
            Ok(_) => match String::from_utf8(bytes) {
                Ok(line) => Some(Ok(line)),
                Err(_) => failed("the line is not UTF-8 text".to_owned()),
            },
            Err(error) => failed(format!("cannot be read: {error}")),
        }
    })
}
