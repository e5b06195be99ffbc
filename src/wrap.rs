//! Wraps text between words to the width of the terminal.

use driftworld_text::{NO_BREAK, with_blanks};
use unicode_width::UnicodeWidthStr;

use crate::style;

/// Minimum width in columns; narrower terminals count as this wide.
const MIN_COLUMNS: usize = 40;

/// The width of standard output in columns: from `COLUMNS`, else the terminal's; `None` if lines may have any length.
pub(crate) fn columns_of_stdout() -> Option<usize> {
    requested_columns().or_else(|| terminal_size::terminal_size_of(std::io::stdout()).map(columns))
}

/// The width of standard error in columns.
pub(crate) fn columns_of_stderr() -> Option<usize> {
    requested_columns().or_else(|| terminal_size::terminal_size_of(std::io::stderr()).map(columns))
}

fn columns((width, _): (terminal_size::Width, terminal_size::Height)) -> usize {
    usize::from(width.0).max(MIN_COLUMNS)
}

fn requested_columns() -> Option<usize> {
    let columns: usize = std::env::var("COLUMNS").ok()?.parse().ok()?;
    (columns > 0).then(|| columns.max(MIN_COLUMNS))
}

/// The width of a text in columns.
pub(crate) fn columns_of(text: &str) -> usize {
    text.width()
}

/// The width of the longest unbreakable piece of a text.
pub(crate) fn longest_piece(text: &str) -> usize {
    pieces(text)
        .map(|piece| columns_of(piece.trim_end()))
        .max()
        .unwrap_or(0)
}

/// Wraps a text to lines of at most `width` columns, breaking only after spaces and commas: a longer word stays whole. No-break
/// spaces become spaces.
pub(crate) fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for piece in pieces(text) {
        if !line.is_empty() && columns_of(&line) + columns_of(piece.trim_end()) > width {
            lines.push(with_blanks(line.trim_end()));
            line.clear();
        }
        line.push_str(piece);
    }
    lines.push(with_blanks(line.trim_end()));
    lines
}

/// Wraps every line of a text; continuation lines keep its indentation.
pub(crate) fn wrap_lines(text: &str, width: Option<usize>) -> String {
    let Some(width) = width else {
        return text.to_owned();
    };
    let wrapped = text.split('\n').map(|line| {
        // Highlighted text has already been laid out.
        if columns_of(line) <= width || style::is_highlighted(line) {
            return line.to_owned();
        }
        let blank = line.len() - line.trim_start_matches(' ').len();
        let (indent, rest) = line.split_at(blank.min(width / 2));
        wrap(rest, width - indent.len())
            .iter()
            .map(|line| format!("{indent}{line}"))
            .collect::<Vec<_>>()
            .join("\n")
    });
    wrapped.collect::<Vec<_>>().join("\n")
}

/// Splits a text into unbreakable pieces, each with the spaces after it.
fn pieces(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let mut chars = rest.char_indices().peekable();
        let end = loop {
            let (_, c) = chars.next()?;
            match (c, chars.peek()) {
                (_, None) => break rest.len(),
                (' ', Some((next, after))) if *after != ' ' => break *next,
                // Break between the elements of a list, but not in a number such as 1,200.
                (',', Some((next, after))) if ![' ', NO_BREAK].contains(after) && !after.is_ascii_digit() => {
                    break *next;
                }
                _ => {}
            }
        };
        let (piece, behind) = rest.split_at(end);
        rest = behind;
        Some(piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lines_break_after_spaces_and_commas() {
        assert_eq!(wrap("one two  three", 8), ["one two", "three"]);
        assert_eq!(
            wrap("[\"rgb\",\"depth\"], 1,200", 10),
            ["[\"rgb\",", "\"depth\"],", "1,200"]
        );
        assert_eq!(wrap("immeasurable", 5), ["immeasurable"]);
        assert_eq!(wrap("in [-5,\u{a0}-12]\u{a0}m", 9), ["in", "[-5, -12] m"]);
        assert_eq!(wrap("", 5), [""]);
        assert_eq!(wrap_lines("  a b c\nd", Some(5)), "  a b\n  c\nd");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn nothing_is_lost_and_no_word_is_broken(words in proptest::collection::vec("[a-zäß漢]{1,9}", 0..20), width in 1_usize..30) {
            let text = words.join(" ");
            let lines = wrap(&text, width);
            prop_assert_eq!(lines.join(" "), text);
            for line in lines {
                prop_assert!(columns_of(&line) <= width || !line.contains(' '), "{}", line);
            }
        }
    }
}
