//! What a line of the console says: a command and its arguments, checked as far as that goes without a world.

use crate::env::{Action, Category};
use crate::spec::nearest;
use serde_json::{Map, Value, json};

use crate::modality::Kind;

/// The most steps of one command.
const MOST_STEPS: u32 = 100_000;

/// Every command: its name, its arguments, what it does.
pub(super) const COMMANDS: [(&str, &str, &str); 19] = [
    ("help", "[COMMAND]", "list the commands, or explain one"),
    ("info", "", "the world and its episode, in short"),
    (
        "objects",
        "",
        "every object: where it is, what it is worth, whether it is there",
    ),
    (
        "state",
        "[--json | FILE]",
        "the agent; the world as it is now as JSON, or written to a file",
    ),
    (
        "step",
        "[N] [A B C | ROW]",
        "N steps (1) of the action A B C (0 0 0), or of a row of the action table",
    ),
    (
        "action",
        "[-c N] -a A B C | ROW",
        "the same, by options: -c how often, -a which action",
    ),
    (
        "reset",
        "[INDEX | FILE]",
        "back to the start; to world number INDEX of the variant; to another world",
    ),
    (
        "spawn",
        "CLASS X Y [KEY=VALUE ...] | JSON",
        "put a new object into the world",
    ),
    ("destroy", "INDEX | NAME", "take an object away for good"),
    ("teleport", "X Y [HEADING]", "put the agent somewhere else"),
    ("show", "[MODALITY] [COLUMNS]", "what the agent sees, in the terminal"),
    ("map", "[COLUMNS]", "the world from above, in the terminal"),
    (
        "screenshot",
        "FILE [MODALITY | map] [WIDTHxHEIGHT]",
        "the same as a PNG file inside --out",
    ),
    ("snapshot", "[NAME]", "remember this moment, or list those remembered"),
    ("restore", "NAME", "go back to a moment"),
    (
        "send_message",
        "JSON | FILE",
        "send a message of L2Explorer's channels, or a file of them",
    ),
    (
        "log",
        "[CATEGORY on|off]",
        "show remarks: agent, communications, worldmaker, academy",
    ),
    ("quit", "", "leave; so does Ctrl-D"),
    ("exit", "", "the same"),
];

/// A picture for the terminal or for a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Picture {
    Seen(Kind),
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
            ("log", [category, "on"]) => Ok(Self::Log(Some((self::category(category)?, true)))),
            ("log", [category, "off"]) => Ok(Self::Log(Some((self::category(category)?, false)))),
            ("quit" | "exit", []) => Ok(Self::Quit),
            (name, _) => Err(misused(name)),
        }
    }
}

/// What to say about a command that is not known, or was called with other arguments than it takes.
fn misused(name: &str) -> String {
    let known = COMMANDS.map(|(name, _, _)| name);
    if let Some((name, usage, _)) = COMMANDS.iter().find(|(known, _, _)| *known == name) {
        let takes = if usage.is_empty() { "no arguments" } else { usage };
        return format!("{name}: expected {takes}");
    }
    let near = nearest(name, known).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    format!("found command {name:?}, expected one that help lists{near}")
}

/// A line cut at its blanks; what stands in quotes is one word.
fn words(text: &str) -> Result<Vec<String>, String> {
    let mut words = Vec::new();
    let (mut word, mut quote) = (None::<String>, None);
    for letter in text.chars() {
        match quote {
            Some(open) if letter == open => quote = None,
            None if letter == '"' || letter == '\'' => {
                quote = Some(letter);
                word.get_or_insert_default();
            }
            None if letter.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(letter),
        }
    }
    if let Some(open) = quote {
        return Err(format!("found {open} once, expected it twice: around a word"));
    }
    words.extend(word);
    Ok(words)
}

fn number(word: &str) -> Result<f64, String> {
    let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| format!("found {word:?}, expected a number"))
}

fn count(word: &str) -> Result<u32, String> {
    let count = word.parse().ok().filter(|count| (1..=MOST_STEPS).contains(count));
    count.ok_or_else(|| format!("found {word:?}, expected how many steps, 1 to {MOST_STEPS}"))
}

fn columns(word: &str) -> Result<u32, String> {
    let columns = word.parse().ok().filter(|columns| (8..=400).contains(columns));
    columns.ok_or_else(|| format!("found {word:?}, expected how many columns, 8 to 400"))
}

fn category(word: &str) -> Result<Category, String> {
    let names = Category::ALL.map(Category::name);
    let near = || nearest(word, names).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    Category::from_name(word).ok_or_else(|| {
        format!(
            "found category {word:?}, expected one of {}{}",
            names.join(", "),
            near()
        )
    })
}

fn step(words: &[&str]) -> Result<Line, String> {
    let (count, numbers) = match words {
        [] => (1, words),
        [steps, rest @ ..] => (count(steps)?, rest),
    };
    let action = match numbers {
        [] => Action::Continuous([0.0; 3]),
        numbers => an_action(numbers).ok_or_else(|| misused("step"))??,
    };
    Ok(Line::Act { action, count })
}

fn action(words: &[&str]) -> Result<Line, String> {
    let (count, words) = match words {
        ["-c", steps, rest @ ..] | [rest @ .., "-c", steps] => (count(steps)?, rest),
        _ => (1, words),
    };
    let ["-a", numbers @ ..] = words else {
        return Err(misused("action"));
    };
    let action = an_action(numbers).ok_or_else(|| misused("action"))??;
    Ok(Line::Act { action, count })
}

/// Three numbers, or one row.
fn an_action(words: &[&str]) -> Option<Result<Action, String>> {
    match words {
        [row] => {
            let row = row
                .parse()
                .map_err(|_| format!("found {row:?}, expected the number of a row"));
            Some(row.map(Action::Discrete))
        }
        [a, b, c] => {
            let numbers = [a, b, c].map(|word| number(word));
            let [a, b, c] = numbers;
            Some(a.and_then(|a| Ok(Action::Continuous([a, b?, c?]))))
        }
        _ => None,
    }
}

fn picture(word: &str) -> Result<Picture, String> {
    if word == "map" {
        return Ok(Picture::Map);
    }
    let kind = Kind::ALL.into_iter().find(|kind| kind.name() == word);
    let names = Kind::ALL.map(Kind::name);
    let near = || nearest(word, names).map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    kind.map(Picture::Seen).ok_or_else(|| {
        format!(
            "found modality {word:?}, expected one of {}{}",
            names.join(", "),
            near()
        )
    })
}

fn show(words: &[&str]) -> Result<Line, String> {
    let is_number = |word: &str| word.starts_with(|letter: char| letter.is_ascii_digit());
    let (kind, width) = match words {
        [width] if is_number(width) => (None, Some(*width)),
        words => (words.first().copied(), words.get(1).copied()),
    };
    Ok(Line::Show {
        picture: kind.map_or(Ok(Picture::Seen(Kind::Rgb)), picture)?,
        columns: width.map(columns).transpose()?,
    })
}

fn screenshot(file: &str, words: &[&str]) -> Result<Line, String> {
    let (mut kind, mut size) = (Picture::Seen(Kind::Rgb), None);
    for word in words {
        if word.starts_with(|letter: char| letter.is_ascii_digit()) {
            let sides = word
                .split_once('x')
                .and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
            let sides = sides.ok_or_else(|| format!("found size {word:?}, expected WIDTHxHEIGHT such as 320x240"))?;
            size = Some(sides);
        } else {
            kind = picture(word)?;
        }
    }
    let file = file.to_owned();
    Ok(Line::Screenshot {
        file,
        picture: kind,
        size,
    })
}

/// An object as JSON, from `key=value` words.
fn object(class: &str, coordinates: [f64; 2], keys: &[&str]) -> Result<String, String> {
    let mut object = Map::new();
    object.insert("class".into(), json!(class));
    object.insert("coordinates".into(), json!(coordinates));
    for word in keys {
        let (key, text) = word
            .split_once('=')
            .ok_or_else(|| format!("found {word:?}, expected KEY=VALUE such as reward=1"))?;
        if object.insert(key.to_owned(), value(key, text)).is_some() {
            return Err(format!("found {key} twice, expected it once"));
        }
    }
    Ok(Value::Object(object).to_string())
}

/// A value as it is typed: JSON, a list with commas, or a plain word.
fn value(key: &str, text: &str) -> Value {
    let one = |text: &str| serde_json::from_str(text).unwrap_or_else(|_| json!(text));
    match one(text) {
        Value::String(text) if text.contains(',') => text.split(',').map(one).collect(),
        single @ Value::String(_) if key.ends_with("_stimulus") => json!([single]),
        // A model or a name may look like a number.
        Value::Number(_) if ["model", "tag", "unique_name"].contains(&key) => json!(text),
        other => other,
    }
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
        refuse("step 1 2 3", "step: expected [N]");
        refuse("step 1 2 nan 3", "found \"nan\", expected a number");
        refuse("action 2 0 1", "action: expected [-c N] -a");
    }

    #[test]
    fn an_object_is_spawned_by_words_or_by_json() {
        check(
            "spawn barrel 1 -2.5 color=1,0,0 reward=1 reward_stimulus=AgentCollide model=2 tag='red things' solid=false",
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
                picture: Picture::Seen(Kind::Depth),
                size: Some([320, 240]),
            },
        );
        check(
            "show 40",
            &Line::Show {
                picture: Picture::Seen(Kind::Rgb),
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
        refuse("xyzzy", "expected one that help lists");
        refuse("objects all", "objects: expected no arguments");
        refuse("log agnet on", "did you mean \"agent\"?");
        refuse("destroy 'oak", "found ' once");
    }
}
