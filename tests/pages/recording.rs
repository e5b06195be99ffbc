//! The recording of the first hour matches the commands' current output: `first_hour_runs` compares them.

use super::read;

const CAST: &str = "docs/recordings/first-hour.cast";

/// A command of a recording, and its output.
#[derive(Debug, PartialEq)]
pub(crate) struct Recorded {
    /// The command as on a page: continuation lines are indented.
    pub(crate) command: String,
    /// The output, with a line break after each line.
    pub(crate) output: String,
}

/// Every command of the first hour, in order.
pub(crate) fn first_hour() -> Vec<Recorded> {
    commands(&screen(&sent(&read(CAST))))
}

/// The output sent to a terminal, from an asciicast v2.
fn sent(cast: &str) -> String {
    let mut lines = cast.lines();
    let header: serde_json::Value = serde_json::from_str(lines.next().unwrap()).unwrap();
    assert_eq!((&header["version"], &header["width"]), (&2.into(), &80.into()));
    let events: Vec<(f64, String, String)> = lines.map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(events.is_sorted_by(|a, b| a.0 <= b.0), "times increase");
    events.into_iter().map(|(_, _, text)| text).collect()
}

/// The final lines of a terminal: characters, line breaks, erased lines; colours are ignored.
fn screen(sent: &str) -> Vec<String> {
    let mut lines: Vec<Vec<char>> = vec![Vec::new()];
    let mut column = 0;
    let mut chars = sent.chars();
    while let Some(c) = chars.next() {
        let line = lines.last_mut().unwrap();
        match c {
            '\r' => column = 0,
            '\n' => lines.push(Vec::new()),
            '\u{1b}' => {
                // Colour codes end with an m.
                if chars.by_ref().find(char::is_ascii_alphabetic) == Some('K') {
                    line.clear();
                }
            }
            c => {
                line.resize(line.len().max(column + 1), ' ');
                line[column] = c;
                column += 1;
            }
        }
    }
    let text = |line: Vec<char>| line.into_iter().collect::<String>().trim_end().to_owned();
    lines.into_iter().map(text).collect()
}

fn commands(screen: &[String]) -> Vec<Recorded> {
    let mut found: Vec<Recorded> = Vec::new();
    let mut is_saving = false;
    for line in screen {
        is_saving |= line.starts_with("(save ");
        if let Some(command) = line.strip_prefix("$ ") {
            is_saving = false;
            found.push(Recorded {
                command: command.to_owned(),
                output: String::new(),
            });
        } else if let Some(last) = found.last_mut() {
            match line.strip_prefix("> ") {
                Some(more) if last.output.is_empty() => last.command.extend(["\n    ", more]),
                _ if is_saving => {}
                _ => last.output.extend([line.as_str(), "\n"]),
            }
        }
    }
    for command in &mut found {
        command.output.truncate(command.output.trim_end().len());
        command.output.push('\n');
    }
    found
}

#[test]
fn recording_is_read_as_a_terminal_shows_it() {
    let sent = "(save a: 1 line)\r\n\r\n$ a \\\r\n> -b\r\nbar 1\r\u{1b}[2Kbar 22\r\u{1b}[2K\u{1b}[1mhead\u{1b}[0m\r\n\
                x\u{1b}[2m\u{1b}[0m\r\n\r\n(save b: 2 lines)\r\n\r\n$ c\r\ny\r\n\r\n";
    let recorded = |command: &str, output: &str| Recorded {
        command: command.to_owned(),
        output: output.to_owned(),
    };
    let found = commands(&screen(sent));
    assert_eq!(found, [recorded("a \\\n    -b", "head\nx\n"), recorded("c", "y\n")]);
}
