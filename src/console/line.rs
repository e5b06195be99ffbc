//! What a line of the console says: a command and its arguments, checked as far as that goes without a world.

use crate::env::{Action, Category};
use crate::spec::did_you_mean;

use crate::spec::Modality;

use super::arguments::{self, action, columns, number, object, screenshot, show, step, words};

/// Every command: its name, its arguments, what it does.
pub(super) const COMMANDS: [(&str, &str, &str); 19] = [
    ("help", "[COMMAND]", "list the commands, or explain one"),
    ("info", "", "summarise the world and its episode"),
    ("objects", "", "list the objects: position, reward, whether present"),
    (
        "state",
        "[--json | FILE]",
        "show the agent; with an argument, the current world as JSON, or write it to a file",
    ),
    (
        "step",
        "[N] [A B C | ROW]",
        "take N steps (1) with action A B C (0 0 0), or with a row of the action table",
    ),
    (
        "action",
        "[-c N] -a A B C | ROW",
        "the same with options: -c count, -a action",
    ),
    (
        "reset",
        "[INDEX | FILE]",
        "reset to the start, to world INDEX of the variant, or to another world",
    ),
    (
        "spawn",
        "CLASS X Y [KEY=VALUE ...] | JSON",
        "add an object to the world",
    ),
    ("destroy", "INDEX | NAME", "take an object away for good"),
    ("teleport", "X Y [HEADING]", "put the agent somewhere else"),
    ("show", "[MODALITY] [COLUMNS]", "show the agent's view in the terminal"),
    ("map", "[COLUMNS]", "show the world from above in the terminal"),
    (
        "screenshot",
        "FILE [MODALITY | map] [WIDTHxHEIGHT]",
        "write a picture into a PNG file inside --out",
    ),
    ("snapshot", "[NAME]", "take a snapshot, or list the snapshots"),
    ("restore", "NAME", "go back to a moment"),
    (
        "send_message",
        "JSON | FILE",
        "send a message of L2Explorer's channels, or a file of them",
    ),
    (
        "log",
        "[CATEGORY on|off]",
        "show log messages: agent, communications, worldmaker, academy",
    ),
    ("quit", "", "leave; so does Ctrl-D"),
    ("exit", "", "the same"),
];

/// A picture for the terminal or for a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Picture {
    Seen(Modality),
    Map,
}

/// One line, understood.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Line {
    Help(Option<String>),
    Info,
    Objects,
    Agent,
    StateJson,
    StateFile(String),
    Act {
        action: Action,
        count: u32,
    },
    Reset(Option<String>),
    /// The object as JSON.
    Spawn(String),
    Destroy(String),
    Teleport {
        position: [f64; 2],
        heading: Option<f64>,
    },
    Show {
        picture: Picture,
        columns: Option<u32>,
    },
    Screenshot {
        file: String,
        picture: Picture,
        size: Option<[u32; 2]>,
    },
    Snapshot(Option<String>),
    Restore(String),
    /// A message itself, or the name of a file.
    Send(String),
    Log(Option<(Category, bool)>),
    Quit,
}

impl Line {
    /// Reads a line that is neither empty nor a comment.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        let inline = rest.starts_with(['{', '[']);
        match name {
            "send_message" if inline => return Ok(Self::Send(rest.to_owned())),
            "spawn" if inline => return Ok(Self::Spawn(rest.to_owned())),
            _ => {}
        }
        let words = words(rest)?;
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        match (name, &words[..]) {
            ("help", []) => Ok(Self::Help(None)),
            ("help", [command]) => Ok(Self::Help(Some((*command).to_owned()))),
            ("info", []) => Ok(Self::Info),
            ("objects", []) => Ok(Self::Objects),
            ("state", []) => Ok(Self::Agent),
            ("state", ["--json"]) => Ok(Self::StateJson),
            ("state", [file]) if !file.starts_with('-') => Ok(Self::StateFile((*file).to_owned())),
            ("step", words) => step(words),
            ("action", words) => action(words),
            ("reset", []) => Ok(Self::Reset(None)),
            ("reset", [world]) => Ok(Self::Reset(Some((*world).to_owned()))),
            ("spawn", [class, x, y, keys @ ..]) => object(class, [number(x)?, number(y)?], keys).map(Self::Spawn),
            ("destroy", [object]) => Ok(Self::Destroy((*object).to_owned())),
            ("teleport", [x, y, rest @ ..]) if rest.len() < 2 => Ok(Self::Teleport {
                position: [number(x)?, number(y)?],
                heading: rest.first().map(|heading| number(heading)).transpose()?,
            }),
            ("show", words) if words.len() <= 2 => show(words),
            ("map", words) if words.len() <= 1 => Ok(Self::Show {
                picture: Picture::Map,
                columns: words.first().map(|word| columns(word)).transpose()?,
            }),
            ("screenshot", [file, rest @ ..]) if rest.len() <= 2 => screenshot(file, rest),
            ("snapshot", []) => Ok(Self::Snapshot(None)),
            ("snapshot", [name]) => Ok(Self::Snapshot(Some((*name).to_owned()))),
            ("restore", [name]) => Ok(Self::Restore((*name).to_owned())),
            ("send_message", [file]) => Ok(Self::Send((*file).to_owned())),
            ("log", []) => Ok(Self::Log(None)),
            ("log", [category, "on"]) => Ok(Self::Log(Some((arguments::category(category)?, true)))),
            ("log", [category, "off"]) => Ok(Self::Log(Some((arguments::category(category)?, false)))),
            ("quit" | "exit", []) => Ok(Self::Quit),
            (name, _) => Err(misused(name)),
        }
    }
}

/// What to say about a command that is not known, or was called with other arguments than it takes.
pub(super) fn misused(name: &str) -> String {
    let known = COMMANDS.map(|(name, _, _)| name);
    if let Some((name, usage, _)) = COMMANDS.iter().find(|(known, _, _)| *known == name) {
        let takes = if usage.is_empty() { "no arguments" } else { usage };
        return format!("{name}: expected {takes}");
    }
    let near = did_you_mean(name, known);
    format!("found command {name:?}, expected one listed by help{near}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &Line) {
        assert_eq!(&Line::parse(text).expect("the line is sound"), expected, "{text}");
    }

    fn refuse(text: &str, expected: &str) {
        let said = Line::parse(text).expect_err("the line is not sound");
        assert!(said.contains(expected), "{text}: {said}");
    }

    #[test]
    fn actions_can_be_given_both_ways() {
        let action = Action::Continuous([2.0, 0.0, 1.0]);
        for text in ["action -c 20 -a 2 0 1", "action -a 2 0 1 -c 20", "step 20 2 0 1"] {
            check(text, &Line::Act { action, count: 20 });
        }
        let row = Action::Discrete(4);
        check("action -a 4", &Line::Act { action: row, count: 1 });
        let still = Action::Continuous([0.0; 3]);
        check(
            "step",
            &Line::Act {
                action: still,
                count: 1,
            },
        );
        refuse("step 0", "1 to 100000");
        refuse("step 1 2 3", "write: step 1 1 2 3");
        refuse("step 1 2 nan 3", "found \"nan\", expected a number");
        refuse("action 2 0 1", "action: expected [-c N] -a");
    }

    #[test]
    fn an_object_is_spawned_by_words_or_by_json() {
        check(
            "spawn barrel 1 -2.5 color=1,0,0 reward=1 reward_stimulus=AgentCollide model=2 tag='red things' \
             solid=false",
            &Line::Spawn(
                r#"{"class":"barrel","coordinates":[1.0,-2.5],"color":[1,0,0],"reward":1,"reward_stimulus":["AgentCollide"],"model":"2","tag":"red things","solid":false}"#
                    .to_owned(),
            ),
        );
        let json = r#"{ "class": "tree", "coordinates": [1, 2], "tag": "a b" }"#;
        check(&format!("spawn  {json}"), &Line::Spawn(json.to_owned()));
        refuse("spawn barrel 1", "spawn: expected CLASS X Y");
        refuse("spawn barrel 1 north", "found \"north\", expected a number");
        refuse("spawn barrel 1 2 reward", "expected KEY=VALUE");
        refuse("spawn barrel 1 2 class=tree", "found class twice");
    }

    #[test]
    fn pictures_have_a_kind_and_a_size() {
        check(
            "screenshot 'my view.png' depth 320x240",
            &Line::Screenshot {
                file: "my view.png".to_owned(),
                picture: Picture::Seen(Modality::Depth),
                size: Some([320, 240]),
            },
        );
        check(
            "show 40",
            &Line::Show {
                picture: Picture::Seen(Modality::Rgb),
                columns: Some(40),
            },
        );
        refuse("show dept", "did you mean \"depth\"?");
        refuse("screenshot a.png 3by4", "expected WIDTHxHEIGHT");
        refuse("map 4", "8 to 400");
    }

    #[test]
    fn a_misspelt_command_is_told_the_one_it_is_near_to() {
        refuse("telport 1 2", "did you mean \"teleport\"?");
        refuse("xyzzy", "expected one listed by help");
        refuse("objects all", "objects: expected no arguments");
        refuse("log agnet on", "did you mean \"agent\"?");
        refuse("destroy 'oak", "found ' once");
    }
}
