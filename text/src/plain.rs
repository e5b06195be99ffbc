//! Rewords serde's error messages without names of Rust types: `struct ScalesFile` becomes "an object".

use std::fmt::Display;

/// Kinds of values as serde names them, and in plain words.
const KINDS: [(&str, &str); 12] = [
    ("u8", "a whole number"),
    ("u16", "a whole number"),
    ("u32", "a whole number"),
    ("u64", "a whole number"),
    ("usize", "a whole number"),
    ("i64", "a whole number"),
    ("f32", "a number"),
    ("f64", "a number"),
    ("a sequence", "a list"),
    ("sequence", "a list"),
    ("a map", "an object"),
    ("map", "an object"),
];

/// The message in plain words; quoted parts stay as they are.
///
/// # Example
/// ```
/// let message = "invalid type: string \"u64\", expected struct Scales at line 1 column 3";
/// assert_eq!(driftworld_text::in_plain_words(message), "invalid type: string \"u64\", expected an object at line 1 column 3");
/// ```
pub fn in_plain_words(message: impl Display) -> String {
    let message = message.to_string();
    let mut plain = String::new();
    for (index, part) in message.split_inclusive(['"', '`']).enumerate() {
        if index % 2 == 1 {
            plain.push_str(part);
            continue;
        }
        let mut words: Vec<&str> = part.split(' ').collect();
        // The type's name follows: `struct Name`, `internally tagged enum Name`.
        while let Some(at) = words.iter().position(|word| ["struct", "enum"].contains(word)) {
            let qualifiers = words[..at]
                .iter()
                .rev()
                .take_while(|word| ["tuple", "internally", "tagged", "unit"].contains(word));
            let first = at - qualifiers.count();
            let end = if words.get(at + 1).is_some_and(|name| name.ends_with(',')) {
                "an object,"
            } else {
                "an object"
            };
            words.splice(first..words.len().min(at + 2), [end]);
        }
        let mut reworded = format!(" {} ", words.join(" "));
        for (serde_name, plain_name) in KINDS {
            for end in [" ", ", "] {
                reworded = reworded.replace(&format!(" {serde_name}{end}"), &format!(" {plain_name}{end}"));
            }
        }
        plain.push_str(&reworded[1..reworded.len() - 1]);
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::in_plain_words;

    #[test]
    fn serde_kinds_become_plain_words() {
        for (message, expected) in [
            (
                "invalid type: map, expected u64 at line 2",
                "invalid type: an object, expected a whole number at line 2",
            ),
            ("expected struct ScalesFile", "expected an object"),
            (
                "invalid type: sequence, expected a map",
                "invalid type: a list, expected an object",
            ),
            (
                "invalid type: string \"a map of u64\", expected f64",
                "invalid type: string \"a map of u64\", expected a number",
            ),
            (
                "unknown field `struct`, expected `u64`",
                "unknown field `struct`, expected `u64`",
            ),
            ("expected internally tagged enum Line", "expected an object"),
        ] {
            assert_eq!(in_plain_words(message), expected);
        }
    }
}
