//! Sanitises external text for display. Writers escape it for their own formats.

use driftworld_text::printable;

/// Maximum number of characters shown of a name.
const LONGEST: usize = 48;

/// Maximum number of characters shown of a sentence.
const LONGEST_SENTENCE: usize = 1000;

/// A name for display: on one line, cut to a readable length, with characters escaped that break a page, are invisible or
/// reverse the text direction.
pub(crate) fn shown(name: &str) -> String {
    cut(name, LONGEST)
}

/// Like [`shown`], for a sentence with names in it, which may be longer.
pub(crate) fn note_shown(text: &str) -> String {
    cut(text.trim_end_matches('.'), LONGEST_SENTENCE)
}

fn cut(name: &str, longest: usize) -> String {
    // Not allowed in XML.
    let calm = |letter: char| match letter {
        '\u{fffe}' | '\u{ffff}' => '\u{fffd}',
        letter => letter,
    };
    let name = printable(name);
    let mut letters = name.chars().map(calm);
    let mut text: String = letters.by_ref().take(longest).collect();
    if letters.next().is_some() {
        text.push('…');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_names_are_escaped_and_others_unchanged() {
        let check = |name: &str, expected: &str| assert_eq!(shown(name), expected);
        check("find_red", "find_red");
        check("größe 大", "größe 大");
        check("a\u{0}b\u{202e}c\n\u{ffff}", "a\\u{0}b\\u{202e}c\\n\u{fffd}");
        check("<script>", "<script>");
        assert_eq!(shown(&"x".repeat(1000)), "x".repeat(48) + "…");
    }
}
