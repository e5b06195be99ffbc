//! Words that come from outside, made fit to be shown. Escaping them is left to what writes them.

use driftworld_text::printable;

/// Letters of a name that are shown.
const LONGEST: usize = 48;

/// Letters of a sentence that are shown.
const LONGEST_SENTENCE: usize = 1000;

/// A name as it is shown: in one line, cut to a readable length, with characters escaped that break a page, hide in it
/// or turn its direction around.
pub(crate) fn shown(name: &str) -> String {
    cut(name, LONGEST)
}

/// A sentence with names in it as it is shown: the same, but longer.
pub(crate) fn note_shown(text: &str) -> String {
    cut(text.trim_end_matches('.'), LONGEST_SENTENCE)
}

/// A number with at most so many digits, one or more, behind its point.
pub(crate) fn short(number: f64, digits: usize) -> String {
    let text = format!("{number:.digits$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn cut(name: &str, longest: usize) -> String {
    // What XML has no character for.
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
    fn hostile_names_are_tamed_and_others_stay() {
        let check = |name: &str, expected: &str| assert_eq!(shown(name), expected);
        check("find_red", "find_red");
        check("größe 大", "größe 大");
        check("a\u{0}b\u{202e}c\n\u{ffff}", "a\\u{0}b\\u{202e}c\\n\u{fffd}");
        check("<script>", "<script>");
        assert_eq!(shown(&"x".repeat(1000)), "x".repeat(48) + "…");
    }
}
