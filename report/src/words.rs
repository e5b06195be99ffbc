//! Sanitises external text for display. Writers escape it for their own formats.

use driftworld_text::{printable, shortened};

/// Maximum number of characters shown of a name.
const MAX_NAME_CHARS: usize = 48;

/// Maximum number of characters shown of a sentence.
const MAX_SENTENCE_CHARS: usize = 1000;

/// A name for display: on one line and cut to a readable length. Characters that would break a page, are invisible or reverse the
/// text direction are escaped.
pub(crate) fn shown(name: &str) -> String {
    cut(name, MAX_NAME_CHARS)
}

/// Like [`shown`], for a sentence with names in it, which may be longer.
pub(crate) fn note_shown(text: &str) -> String {
    cut(text.trim_end_matches('.'), MAX_SENTENCE_CHARS)
}

fn cut(name: &str, limit: usize) -> String {
    // These two characters are not allowed in XML.
    shortened(&printable(name).replace(['\u{fffe}', '\u{ffff}'], "\u{fffd}"), limit)
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
