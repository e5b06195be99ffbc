//! Escapes characters that a terminal treats as control codes or does not show.

use std::borrow::Cow;
use std::fmt::{self, Display, Write};
use std::path::Path;

/// Ranges, in ascending order, of control characters, characters that change the direction of text, and characters of zero width.
///
/// C0, DEL and C1; the soft hyphen; the bidirectional marks, embeddings, overrides and isolates (Unicode Standard Annex 9);
/// joiners, fillers and other characters of zero width; line and paragraph separators; interlinear marks; tags. Of the variation
/// selectors, the two that choose between text and emoji style (U+FE0E, U+FE0F) are printable; the others can hide text.
const UNPRINTABLE: [(char, char); 27] = [
    ('\0', '\u{1f}'),
    ('\u{7f}', '\u{9f}'),
    ('\u{ad}', '\u{ad}'),
    ('\u{34f}', '\u{34f}'),
    ('\u{600}', '\u{605}'),
    ('\u{61c}', '\u{61c}'),
    ('\u{6dd}', '\u{6dd}'),
    ('\u{70f}', '\u{70f}'),
    ('\u{890}', '\u{891}'),
    ('\u{8e2}', '\u{8e2}'),
    ('\u{115f}', '\u{1160}'),
    ('\u{17b4}', '\u{17b5}'),
    ('\u{180b}', '\u{180f}'),
    ('\u{200b}', '\u{200f}'),
    ('\u{2028}', '\u{202e}'),
    ('\u{2060}', '\u{206f}'),
    ('\u{3164}', '\u{3164}'),
    ('\u{fe00}', '\u{fe0d}'),
    ('\u{feff}', '\u{feff}'),
    ('\u{ffa0}', '\u{ffa0}'),
    ('\u{fff0}', '\u{fffb}'),
    ('\u{110bd}', '\u{110bd}'),
    ('\u{110cd}', '\u{110cd}'),
    ('\u{13430}', '\u{1343f}'),
    ('\u{1bca0}', '\u{1bca3}'),
    ('\u{1d173}', '\u{1d17a}'),
    ('\u{e0000}', '\u{e01ef}'),
];

/// Whether a terminal treats this character as a control code or does not show it. Line feed and tab are included.
pub fn is_unprintable(c: char) -> bool {
    // Almost all text is ASCII.
    if matches!(c, ' '..='~') {
        return false;
    }
    let end = UNPRINTABLE.partition_point(|(first, _)| *first <= c);
    end > 0 && c <= UNPRINTABLE[end - 1].1
}

/// The text on one line: every unprintable character is escaped in the notation of Rust and Swift, `\u{202e}`, except
/// line feed, carriage return and tab, which become `\n`, `\r` and `\t`.
///
/// For untrusted text inside a sentence: it cannot end the line and forge one of ours. Text that is already escaped
/// stays as it is.
///
/// # Example
/// ```
/// use driftworld_text::printable;
/// assert_eq!(printable("red"), "red");
/// assert_eq!(printable("a\nerror: \u{1b}[2Jb"), r"a\nerror: \u{1b}[2Jb");
/// ```
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_unprintable, |out, c| match c {
        '\n' => out.push_str("\\n"),
        '\r' => out.push_str("\\r"),
        '\t' => out.push_str("\\t"),
        _ => braces(out, c),
    })
}

/// Multi-line text: like [`printable`], but keeps line feeds and tabs.
///
/// For whole messages, right before they are printed.
pub fn printable_lines(text: &str) -> Cow<'_, str> {
    let hostile = |c: char| is_unprintable(c) && !matches!(c, '\n' | '\t');
    escaped(text, hostile, braces)
}

/// A JSON text: like [`printable_lines`], but with JSON escapes, so that its meaning does not change.
///
/// In valid JSON such characters occur only in strings, where an escape stands for the same character.
///
/// # Example
/// ```
/// assert_eq!(driftworld_text::printable_json("{\"a\":\"\u{202e}\"}"), r#"{"a":"\u202e"}"#);
/// ```
pub fn printable_json(json: &str) -> Cow<'_, str> {
    // Between values a carriage return is white space, and an escape would be an error.
    let hostile = |c: char| is_unprintable(c) && !matches!(c, '\n' | '\t' | '\r');
    escaped(json, hostile, write_utf16_escapes)
}

/// JSON text with escapes for all characters outside ASCII, which old clients cannot decode.
///
/// # Example
/// ```
/// assert_eq!(driftworld_text::ascii_json("[\"ä🙂\"]"), r#"["\u00e4\ud83d\ude42"]"#);
/// ```
pub fn ascii_json(json: &str) -> Cow<'_, str> {
    escaped(json, |c| !c.is_ascii(), write_utf16_escapes)
}

fn write_utf16_escapes(out: &mut String, c: char) {
    for unit in c.encode_utf16(&mut [0; 2]) {
        write!(out, "\\u{unit:04x}").expect("writing to a String does not fail");
    }
}

/// Displays any value on one line like [`printable`], without a copy.
///
/// # Example
/// ```
/// assert_eq!(driftworld_text::one_line("a\tb").to_string(), r"a\tb");
/// ```
pub fn one_line<T: Display>(shown: T) -> OneLine<T> {
    OneLine(shown)
}

/// Paths for messages.
pub trait ShownPath {
    /// The path on one line. Use it instead of `Path::display`, which does not escape file names.
    ///
    /// # Example
    /// ```
    /// use driftworld_text::ShownPath;
    /// assert_eq!(std::path::Path::new("logs/a\nb").shown().to_string(), r"logs/a\nb");
    /// ```
    fn shown(&self) -> OneLine<std::path::Display<'_>>;
}

impl ShownPath for Path {
    fn shown(&self) -> OneLine<std::path::Display<'_>> {
        one_line(self.display())
    }
}

/// The text in double quotes and on one line, with backslashes and quotes escaped as in a Rust string.
///
/// # Example
/// ```
/// assert_eq!(driftworld_text::quoted("a\"b\u{202e}"), r#""a\"b\u{202e}""#);
/// ```
pub fn quoted(text: &str) -> String {
    printable(&format!("{text:?}")).into_owned()
}

/// Displays the inner value on one line, see [`one_line`].
#[derive(Clone, Copy, Debug)]
pub struct OneLine<T>(T);

impl<T: Display> Display for OneLine<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// Forwards what is written to it, escaped.
        struct Escaping<'a, 'f>(&'a mut fmt::Formatter<'f>);
        impl Write for Escaping<'_, '_> {
            fn write_str(&mut self, text: &str) -> fmt::Result {
                self.0.write_str(&printable(text))
            }
        }
        write!(Escaping(f), "{}", self.0)
    }
}

fn braces(out: &mut String, c: char) {
    write!(out, "\\u{{{:x}}}", u32::from(c)).expect("writing to a String does not fail");
}

/// The text with hostile characters replaced; borrowed if there are none.
fn escaped(text: &str, is_hostile: impl Fn(char) -> bool, write: impl Fn(&mut String, char)) -> Cow<'_, str> {
    let Some(first) = text.find(&is_hostile) else {
        return Cow::Borrowed(text);
    };
    let mut out = String::with_capacity(text.len() + 16);
    out.push_str(&text[..first]);
    for c in text[first..].chars() {
        if is_hostile(c) {
            write(&mut out, c);
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Strings in which about one character in three is unprintable.
    fn texts() -> impl Strategy<Value = String> {
        let hostile = (0..UNPRINTABLE.len(), any::<u8>()).prop_map(|(range, offset)| {
            let (first, last) = UNPRINTABLE[range];
            let span = u32::from(last) - u32::from(first) + 1;
            char::from_u32(u32::from(first) + u32::from(offset) % span).expect("no range contains a surrogate")
        });
        let c = prop_oneof![hostile, any::<char>(), proptest::char::range(' ', '~')];
        proptest::collection::vec(c, 0..40).prop_map(String::from_iter)
    }

    #[test]
    fn unprintable_ranges_are_sorted_and_disjoint() {
        for pair in UNPRINTABLE.windows(2) {
            assert!(pair[0].0 <= pair[0].1 && pair[0].1 < pair[1].0, "{pair:?}");
        }
    }

    #[test]
    fn control_and_invisible_characters_are_unprintable_and_letters_are_not() {
        for hostile in
            "\0\x07\x08\t\n\r\x1b\x7f\u{80}\u{9b}\u{9f}\u{ad}\u{61c}\u{200b}\u{200d}\u{200e}\u{200f}\u{2028}\u{2029}\
                        \u{202a}\u{202e}\u{2060}\u{2066}\u{2069}\u{206f}\u{feff}\u{e0041}"
                .chars()
        {
            assert!(is_unprintable(hostile), "{hostile:?}");
        }
        for plain in " ~aZ0é한語ש\u{5b0}ش₂→×°½▀…«”‰\u{2027}\u{202f}\u{fe0f}😀".chars() {
            assert!(!is_unprintable(plain), "{plain:?}");
        }
        // Every control character according to the standard library is unprintable.
        for c in '\0'..=char::MAX {
            assert!(!c.is_control() || is_unprintable(c), "{c:?}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn escaping_removes_all_unprintable_and_keeps_the_rest(text in texts()) {
            let line = printable(&text);
            prop_assert!(!line.contains(is_unprintable));
            prop_assert_eq!(printable(&line), line.as_ref());
            let display = one_line(&text).to_string();
            prop_assert_eq!(display.as_str(), line.as_ref());
            let lines = printable_lines(&text);
            prop_assert!(!lines.contains(|c| is_unprintable(c) && c != '\n' && c != '\t'));
            // An independent implementation, character by character.
            let expected: String = text.chars().map(|c| match c {
                '\n' => "\\n".to_owned(),
                '\r' => "\\r".to_owned(),
                '\t' => "\\t".to_owned(),
                c if is_unprintable(c) => c.escape_unicode().to_string(),
                c => c.to_string(),
            }).collect();
            prop_assert_eq!(line.as_ref(), expected.as_str());
            prop_assert!(!quoted(&text).contains(is_unprintable));
        }
    }
}
