//! Parses the arguments of a console line: words, numbers, actions, pictures, objects.

use crate::env::{Action, Category};
use crate::modality;
use crate::spec::{Modality, did_you_mean};
use serde_json::{Map, Value, json};

use super::line::misused;

/// A picture for the terminal or for a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Picture {
    Seen(Modality),
    Map,
}

/// Maximum number of steps per command.
const MAX_STEPS: u32 = 100_000;

/// Splits a line at spaces; quoted text is one word.
pub(super) fn words(text: &str) -> Result<Vec<String>, String> {
    let mut words = Vec::new();
    let (mut word, mut quote) = (None::<String>, None);
    for c in text.chars() {
        match quote {
            Some(open) if c == open => quote = None,
            None if c == '"' || c == '\'' => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            None if c.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(c),
        }
    }
    if let Some(open) = quote {
        return Err(format!("found {open} once, expected it twice, around a word"));
    }
    words.extend(word);
    Ok(words)
}

pub(super) fn number(word: &str) -> Result<f64, String> {
    let number = word.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| format!("found {word:?}, expected a number"))
}

fn count(word: &str) -> Result<u32, String> {
    let count = word.parse().ok().filter(|count| (1..=MAX_STEPS).contains(count));
    count.ok_or_else(|| format!("found {word:?}, expected a number of steps, 1 to {MAX_STEPS}"))
}

pub(super) fn columns(word: &str) -> Result<u32, String> {
    let columns = word.parse().ok().filter(|columns| (8..=400).contains(columns));
    columns.ok_or_else(|| format!("found {word:?}, expected a number of columns, 8 to 400"))
}

pub(super) fn category(word: &str) -> Result<Category, String> {
    word.parse()
        .map_err(|_| not_one_of("category", word, &Category::names()))
}

fn not_one_of(what: &str, word: &str, names: &[&str]) -> String {
    let near = did_you_mean(word, names.iter().copied());
    format!("found {what} {word:?}, expected one of {}{near}", names.join(", "))
}

/// An action and its number of repeats.
pub(super) fn step(words: &[&str]) -> Result<(Action, u32), String> {
    let (count, numbers) = match words {
        [] => (1, words),
        [_, _, _] if words.iter().all(|word| number(word).is_ok()) => {
            return Err(format!(
                "found three numbers, expected a number of steps before them; for one step of that action write: step 1 {}",
                words.join(" ")
            ));
        }
        [steps, rest @ ..] => (count(steps)?, rest),
    };
    let action = match numbers {
        [] => Action::Continuous([0.0; 3]),
        numbers => parse_action("step", numbers)?,
    };
    Ok((action, count))
}

/// An action and its number of repeats, given as options.
pub(super) fn action(words: &[&str]) -> Result<(Action, u32), String> {
    let (count, words) = match words {
        ["-c", steps, rest @ ..] | [rest @ .., "-c", steps] => (count(steps)?, rest),
        _ => (1, words),
    };
    let ["-a", numbers @ ..] = words else {
        return Err(misused("action"));
    };
    Ok((parse_action("action", numbers)?, count))
}

/// Parses an action: three numbers, or the number of a row in the action table.
fn parse_action(command: &str, words: &[&str]) -> Result<Action, String> {
    match words {
        [row] => {
            let found = row.parse().map(Action::Discrete);
            found.map_err(|_| format!("found {row:?}, expected the number of a row"))
        }
        [a, b, c] => Ok(Action::Continuous([number(a)?, number(b)?, number(c)?])),
        _ => Err(misused(command)),
    }
}

fn picture(word: &str) -> Result<Picture, String> {
    if word == "map" {
        return Ok(Picture::Map);
    }
    let kind = modality::ALL.into_iter().find(|kind| modality::name(*kind) == word);
    kind.map(Picture::Seen)
        .ok_or_else(|| not_one_of("modality", word, &modality::NAMES))
}

/// A picture and its width in columns.
pub(super) fn show(words: &[&str]) -> Result<(Picture, Option<u32>), String> {
    let is_number = |word: &str| word.starts_with(|c: char| c.is_ascii_digit());
    let (kind, width) = match words {
        [width] if is_number(width) => (None, Some(*width)),
        words => (words.first().copied(), words.get(1).copied()),
    };
    let picture = kind.map_or(Ok(Picture::Seen(Modality::Rgb)), picture)?;
    Ok((picture, width.map(columns).transpose()?))
}

/// A picture with its width and height.
pub(super) fn screenshot(words: &[&str]) -> Result<(Picture, Option<[u32; 2]>), String> {
    let (mut kind, mut size) = (Picture::Seen(Modality::Rgb), None);
    for word in words {
        if word.starts_with(|c: char| c.is_ascii_digit()) {
            let sides = word
                .split_once('x')
                .and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
            let sides = sides.ok_or_else(|| format!("found size {word:?}, expected WIDTHxHEIGHT such as 320x240"))?;
            size = Some(sides);
        } else {
            kind = picture(word)?;
        }
    }
    Ok((kind, size))
}

/// An object as JSON, from its class, position and `key=value` words.
pub(super) fn object(class: &str, coordinates: [f64; 2], keys: &[&str]) -> Result<String, String> {
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

/// A value as JSON: parsed as JSON, as a list separated by commas, or as a plain word.
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

    #[test]
    fn step_and_action_parse_the_same_actions() {
        let twenty = (Action::Continuous([2.0, 0.0, 1.0]), 20);
        assert_eq!(action(&["-c", "20", "-a", "2", "0", "1"]), Ok(twenty));
        assert_eq!(action(&["-a", "2", "0", "1", "-c", "20"]), Ok(twenty));
        assert_eq!(step(&["20", "2", "0", "1"]), Ok(twenty));
        assert_eq!(action(&["-a", "4"]), Ok((Action::Discrete(4), 1)));
        assert_eq!(step(&[]), Ok((Action::Continuous([0.0; 3]), 1)));
    }

    #[test]
    fn object_from_key_value_words_is_json() {
        let words = words(
            "color=1,0,0 reward=1 reward_stimulus=AgentCollide model=2 tag='red things' \
             solid=false",
        )
        .expect("each quote is closed");
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let expected = r#"{"class":"barrel","coordinates":[1.0,-2.5],"color":[1,0,0],"reward":1,"reward_stimulus":["AgentCollide"],"model":"2","tag":"red things","solid":false}"#;
        assert_eq!(object("barrel", [1.0, -2.5], &words), Ok(expected.to_owned()));
    }

    #[test]
    fn pictures_have_a_kind_and_a_size() {
        let depth = Picture::Seen(Modality::Depth);
        assert_eq!(screenshot(&["depth", "320x240"]), Ok((depth, Some([320, 240]))));
        assert_eq!(show(&["40"]), Ok((Picture::Seen(Modality::Rgb), Some(40))));
    }
}
