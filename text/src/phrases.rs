//! Phrases for messages and tables: counts with plurals, and lists cut to a length.

/// A number with its noun, in the plural unless it is 1.
///
/// ```
/// # use driftworld_text::counted;
/// assert_eq!((counted(1, "row"), counted(2, "row")), ("1 row".to_owned(), "2 rows".to_owned()));
/// ```
pub fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

/// The parts joined by `separator`, or `none` if there are none.
pub fn joined_or<S: AsRef<str>>(parts: &[S], separator: &str, none: &str) -> String {
    let parts: Vec<&str> = parts.iter().map(AsRef::as_ref).collect();
    if parts.is_empty() {
        none.to_owned()
    } else {
        parts.join(separator)
    }
}

/// The first `most` names, and the number of remaining ones.
///
/// ```
/// # use driftworld_text::first_of;
/// assert_eq!(first_of(&["a", "b", "c"], 2), "a, b and 1 more");
/// ```
pub fn first_of<S: AsRef<str>>(names: &[S], most: usize) -> String {
    let shown = joined_or(&names[..names.len().min(most)], ", ", "");
    match names.len().saturating_sub(most) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

/// Text for a message, cut to its first `most` characters.
///
/// ```
/// # use driftworld_text::shortened;
/// assert_eq!((shortened("äöü", 3), shortened("äöüß", 3)), ("äöü".to_owned(), "äöü…".to_owned()));
/// ```
pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// The words with their first letter in upper case.
///
/// ```
/// # use driftworld_text::capitalized;
/// assert_eq!(capitalized("ärger over it"), "Ärger over it");
/// ```
pub fn capitalized(words: &str) -> String {
    let mut chars = words.chars();
    chars
        .next()
        .into_iter()
        .flat_map(char::to_uppercase)
        .collect::<String>()
        + chars.as_str()
}

/// The words if a condition holds, otherwise an empty string.
pub fn when(condition: bool, words: impl FnOnce() -> String) -> String {
    if condition { words() } else { String::new() }
}
