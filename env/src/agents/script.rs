//! Parses and checks scripts for the scripted agent. Scripts have one command per line.

use std::str::FromStr;

use driftworld_spec::nearest;
use driftworld_text::{is_unprintable, quoted};

use crate::EnvError;
use crate::sim::Action;

/// Maximum number of steps of one command.
const MAX_STEPS: u32 = 100_000;

/// Default maximum number of steps of a walk to an object.
const WALK_STEPS: u32 = 300;

/// Maximum number of lines of a script.
const MAX_LINES: usize = 100_000;

/// Maximum length of an object's name in characters, as in worlds.
const MAX_NAME_CHARS: usize = 100;

/// Every command with its arguments.
const COMMANDS: [(&str, &str); 7] = [
    ("step", "[N] [A B C | ROW]"),
    ("action", "[-c N] -a A B C | ROW"),
    ("touch", "NAME [N]"),
    ("interact", "NAME [N]"),
    ("near", "NAME METRES [N]"),
    ("tour", "[N]"),
    ("repeat", "no arguments"),
];

/// One command.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Command {
    /// Repeats one action for `steps` steps.
    Act { action: Action, steps: u32 },
    /// Walks to the nearest object with a name, until a condition holds.
    Go { name: String, until: Until, steps: u32 },
    /// Acts like the agent on rails until nothing worth visiting is left.
    Tour { steps: u32 },
    /// Starts again from the first line.
    Repeat,
}

/// When a walk to an object ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Until {
    /// The agent has touched it.
    Touched,
    /// The agent has interacted with it.
    Interacted,
    /// Its centre is within this many metres.
    Near(f32),
}

/// Parses a script. Error messages refer to it as `name`.
pub(super) fn parse(name: &str, text: &str) -> Result<Vec<Command>, EnvError> {
    let wrong = |index: usize, (found, expected): (String, String)| EnvError::BadScript {
        script: name.to_owned(),
        line: index + 1,
        found,
        expected,
    };
    let mut commands = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if index == MAX_LINES {
            let expected = format!("at most {MAX_LINES} lines");
            return Err(wrong(index, ("another line".to_owned(), expected)));
        }
        let code = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = code.split_whitespace().collect();
        let [first, rest @ ..] = &words[..] else { continue };
        if commands.last() == Some(&Command::Repeat) {
            let expected = "no command after repeat, which restarts the script".to_owned();
            return Err(wrong(index, (format!("{first:?}"), expected)));
        }
        commands.push(command(first, rest).map_err(|problem| wrong(index, problem))?);
    }
    if matches!(commands[..], [] | [Command::Repeat]) {
        let last = text.lines().count().saturating_sub(1);
        let found = "a script without a command".to_owned();
        return Err(wrong(last, (found, format!("one of {}", names()))));
    }
    Ok(commands)
}

/// A faulty command: what was found, and what was expected.
type Problem = (String, String);

fn command(name: &str, words: &[&str]) -> Result<Command, Problem> {
    let go = |object: &str, until, rest: &[&str]| -> Result<Command, Problem> {
        // Worlds allow any object name, as the original environment does, so only unprintable names are refused.
        if object.chars().count() > MAX_NAME_CHARS || object.contains(is_unprintable) {
            let expected = format!("the name of an object: 1 to {MAX_NAME_CHARS} printable characters");
            return Err((quoted(object), expected));
        }
        Ok(Command::Go {
            name: object.to_owned(),
            until,
            steps: rest.first().map_or(Ok(WALK_STEPS), |word| steps(word))?,
        })
    };
    match (name, words) {
        ("step", []) => act(1, &["0", "0", "0"]),
        ("step", [count]) => act(steps(count)?, &["0", "0", "0"]),
        ("step", [count, action @ ..]) if [1, 3].contains(&action.len()) => act(steps(count)?, action),
        ("action", ["-c", count, "-a", action @ ..] | ["-a", action @ .., "-c", count])
            if [1, 3].contains(&action.len()) =>
        {
            act(steps(count)?, action)
        }
        ("action", ["-a", action @ ..]) if [1, 3].contains(&action.len()) => act(1, action),
        ("touch", [object, rest @ ..]) if rest.len() < 2 => go(object, Until::Touched, rest),
        ("interact", [object, rest @ ..]) if rest.len() < 2 => go(object, Until::Interacted, rest),
        ("near", [object, metres, rest @ ..]) if rest.len() < 2 => {
            let is_valid = |metres: &f32| metres.is_finite() && *metres > 0.0;
            let metres = parsed(metres, is_valid, "a number of metres above 0")?;
            go(object, Until::Near(metres), rest)
        }
        ("tour", []) => Ok(Command::Tour { steps: MAX_STEPS }),
        ("tour", [count]) => Ok(Command::Tour { steps: steps(count)? }),
        ("repeat", []) => Ok(Command::Repeat),
        _ => Err(unknown_or_misused(name, words)),
    }
}

fn unknown_or_misused(name: &str, words: &[&str]) -> Problem {
    if let Some((_, takes)) = COMMANDS.iter().find(|(known, _)| *known == name) {
        let found = std::iter::once(name)
            .chain(words.iter().copied())
            .collect::<Vec<_>>()
            .join(" ");
        return (format!("{found:?}"), format!("{name} {takes}"));
    }
    let near = nearest(name, COMMANDS.map(|(known, _)| known));
    let near = near.map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    (format!("command {name:?}"), format!("one of {}{near}", names()))
}

fn names() -> String {
    COMMANDS.map(|(known, _)| known).join(", ")
}

/// Parses three numbers, or one row.
fn act(steps: u32, words: &[&str]) -> Result<Command, Problem> {
    let action = match words {
        [a, b, c] => Action::Continuous([number(a)?, number(b)?, number(c)?]),
        words => {
            let expected = "the number of a row of the action table, or three numbers";
            Action::Discrete(parsed(words.first().copied().unwrap_or_default(), |_| true, expected)?)
        }
    };
    Ok(Command::Act { action, steps })
}

fn number(word: &str) -> Result<f64, Problem> {
    parsed(word, |number: &f64| number.is_finite(), "a number")
}

fn steps(word: &str) -> Result<u32, Problem> {
    let expected = format!("a number of steps, 1 to {MAX_STEPS}");
    parsed(word, |steps| (1..=MAX_STEPS).contains(steps), &expected)
}

fn parsed<T: FromStr>(word: &str, is_valid: impl Fn(&T) -> bool, expected: &str) -> Result<T, Problem> {
    let found = word.parse().ok().filter(is_valid);
    found.ok_or_else(|| (format!("{word:?}"), expected.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &[Command]) {
        assert_eq!(parse("script", text).expect("the script is valid"), expected, "{text}");
    }

    #[test]
    fn actions_parse_as_in_the_console() {
        let action = Action::Continuous([2.0, 0.0, 1.0]);
        let act = |action, steps| [Command::Act { action, steps }];
        for text in [
            "action -c 20 -a 2 0 1",
            "action -a 2 0 1 -c 20",
            "step 20 2 0 1 # ahead",
        ] {
            check(text, &act(action, 20));
        }
        check("# nothing yet\n\naction -a 4", &act(Action::Discrete(4), 1));
        check("step", &act(Action::Continuous([0.0; 3]), 1));
    }

    #[test]
    fn walks_and_tours_have_step_limits() {
        let go = |until, steps| Command::Go {
            name: "goal".to_owned(),
            until,
            steps,
        };
        check("touch goal", &[go(Until::Touched, WALK_STEPS)]);
        check("interact goal 40", &[go(Until::Interacted, 40)]);
        check("near goal 2.5 9\nrepeat", &[go(Until::Near(2.5), 9), Command::Repeat]);
        check(
            "tour\ntour 7",
            &[Command::Tour { steps: MAX_STEPS }, Command::Tour { steps: 7 }],
        );
    }

    #[test]
    fn impossible_commands_are_refused_with_their_line() {
        for row in r#"
step | tuch goal => 2: found command "tuch", expected one of step, action, touch, interact, near, tour, repeat; did you mean "touch"?
step 0 => 1: found "0", expected a number of steps, 1 to 100000
step 5 1 2 => 1: found "step 5 1 2", expected step [N] [A B C | ROW]
step 5 1 nan 0 => 1: found "nan", expected a number
step 5 north => 1: found "north", expected the number of a row of the action table, or three numbers
near goal => 1: found "near goal", expected near NAME METRES [N]
touch go\u{202e}al => 1: found "go\u{202e}al", expected the name of an object: 1 to 100 printable characters
near goal -1 => 1: found "-1", expected a number of metres above 0
near goal 0 => 1: found "0", expected a number of metres above 0
near goal inf => 1: found "inf", expected a number of metres above 0
near goal far => 1: found "far", expected a number of metres above 0
tour | repeat | step => 3: found "step", expected no command after repeat, which restarts the script
# nothing |  |  => 2: found a script without a command, expected one of step, action, touch, interact, near, tour, repeat"#
            .trim()
            .lines()
        {
            let (text, expected) = row.split_once(" => ").expect("a row has two parts");
            let text = text.replace(" | ", "\n").replace("\\u{202e}", "\u{202e}");
            let message = parse("way.txt", &text).expect_err("the script is invalid").to_string();
            assert_eq!(message, format!("way.txt:{expected}"), "{text}");
        }
    }
}
