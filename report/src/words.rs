//! Words that come from outside, made fit to be shown. Escaping them is left to what writes them.

/// Letters of a name that are shown.
const LONGEST: usize = 48;

/// A name as it is shown: cut to a readable length, without characters that break a page or turn its direction around.
pub(crate) fn shown(name: &str) -> String {
    let calm = |letter: char| {
        let turns =
            matches!(letter, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}');
        let forbidden = matches!(letter, '\u{fffe}' | '\u{ffff}');
        if letter.is_control() || turns || forbidden {
            '\u{fffd}'
        } else {
            letter
        }
    };
    let mut letters = name.chars().map(calm);
    let mut text: String = letters.by_ref().take(LONGEST).collect();
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
        check("a\u{0}b\u{202e}c\n", "a\u{fffd}b\u{fffd}c\u{fffd}");
        check("<script>", "<script>");
        assert_eq!(shown(&"x".repeat(1000)), "x".repeat(48) + "…");
    }
}
