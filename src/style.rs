//! Colours printed text: decides whether to use colours, and which parts to highlight.

use std::io::IsTerminal;
use std::sync::atomic::{AtomicU8, Ordering};

use clap::ColorChoice;

/// Marks the end of highlighted text. Like the marks of styles, it is a Unicode noncharacter, which no text contains.
const END: char = '\u{fdd4}';

/// The value of `--color`.
static CHOICE: AtomicU8 = AtomicU8::new(0);

/// Applies `--color`.
pub(crate) fn follow(choice: ColorChoice) {
    let number = match choice {
        ColorChoice::Auto => 0,
        ColorChoice::Always => 1,
        ColorChoice::Never => 2,
    };
    CHOICE.store(number, Ordering::Relaxed);
}

/// Whether standard output gets colours.
pub(crate) fn of_stdout() -> bool {
    shows_colors(std::io::stdout().is_terminal())
}

/// Whether standard error gets colours.
pub(crate) fn of_stderr() -> bool {
    shows_colors(std::io::stderr().is_terminal())
}

/// `--color` overrides `NO_COLOR` and `TERM=dumb`, which override the kind of stream.
fn shows_colors(is_terminal: bool) -> bool {
    match CHOICE.load(Ordering::Relaxed) {
        1 => true,
        2 => false,
        _ => {
            let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
            is_terminal && !set("NO_COLOR") && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
        }
    }
}

/// A highlighting style.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// Headings.
    Strong,
    /// Success.
    Good,
    /// Warnings.
    Odd,
    /// Errors.
    Bad,
}

impl Style {
    const ALL: [Self; 4] = [Self::Strong, Self::Good, Self::Odd, Self::Bad];

    /// Marks the start of text in this style.
    fn mark(self) -> char {
        ['\u{fdd0}', '\u{fdd1}', '\u{fdd2}', '\u{fdd3}'][self as usize]
    }

    fn sequence(self) -> &'static str {
        match self {
            Self::Strong => "\u{1b}[1m",
            Self::Good => "\u{1b}[32m",
            Self::Odd => "\u{1b}[33m",
            Self::Bad => "\u{1b}[1;31m",
        }
    }

    /// The style of a verdict that stands alone in a cell.
    pub(crate) fn of_verdict(word: &str) -> Option<Self> {
        match word {
            "ok" | "sound" => Some(Self::Good),
            "idle" | "nothing to learn" => Some(Self::Odd),
            "FAILED" | "contradicted" => Some(Self::Bad),
            _ => None,
        }
    }

    /// The style of a message's prefix on standard error, and the prefix's length.
    pub(crate) fn of_message(line: &str) -> Option<(Self, usize)> {
        let kinds = [("error:", Self::Bad), ("warning:", Self::Odd), ("note:", Self::Strong)];
        let found = kinds.into_iter().find(|(word, _)| line.starts_with(word));
        found.map(|(word, style)| (style, word.len()))
    }

    /// Marks a text as highlighted if standard output gets colours.
    pub(crate) fn on(self, text: &str) -> String {
        if of_stdout() && !text.is_empty() {
            format!("{}{text}{END}", self.mark())
        } else {
            text.to_owned()
        }
    }

    /// Encloses a text in terminal codes.
    pub(crate) fn painted(self, text: &str) -> String {
        format!("{}{text}\u{1b}[0m", self.sequence())
    }
}

/// Whether any part of a text is highlighted.
pub(crate) fn is_highlighted(text: &str) -> bool {
    text.contains(END)
}

/// Replaces the marks of [`Style::on`] with terminal codes; `shown` is applied to all text between marks.
pub(crate) fn paint(text: &str, shown: impl Fn(&str) -> String) -> String {
    let pieces = text.split(END).map(|piece| {
        let mut styles = Style::ALL.into_iter();
        match styles.find_map(|style| Some((style, piece.split_once(style.mark())?))) {
            Some((style, (before, inside))) => shown(before) + &style.painted(&shown(inside)),
            None => shown(piece),
        }
    });
    pieces.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn highlighted_text_is_coloured_and_the_rest_is_escaped() {
        let text = format!("a{}b{END}c", Style::Strong.mark());
        assert_eq!(paint(&text, str::to_uppercase), "A\u{1b}[1mB\u{1b}[0mC");
        assert_eq!(paint("plain", str::to_owned), "plain");
    }
}
