//! The links of a page, found by the parser that the book is made with, and led to where their targets are in the book.
//! Where that is, `places.rs` knows.

use std::ops::Range;

use pulldown_cmark::{Event, Options, Parser, Tag};

use crate::places::Target;

/// A page whose links lead to places in the book.
#[derive(Debug, Default)]
pub(crate) struct Rewritten {
    pub(crate) text: String,
    /// Files of the repository that are shown as pages of their own.
    pub(crate) linked: Vec<String>,
    /// Targets that there are not.
    pub(crate) missing: Vec<String>,
}

/// Asks for the target of every link and picture of a page.
pub(crate) fn links(text: &str, target: impl Fn(&str) -> Target) -> Rewritten {
    let mut rewritten = Rewritten::default();
    let mut changes: Vec<(Range<usize>, String)> = Vec::new();
    for (place, link) in places(text) {
        match target(&link) {
            Target::AsItIs => {}
            Target::InTheBook(new) => changes.push((place, new)),
            Target::Source(new, file) => {
                rewritten.linked.push(file);
                changes.push((place, new));
            }
            Target::Missing => rewritten.missing.push(link),
        }
    }
    changes.sort_by_key(|(place, _)| place.start);
    text.clone_into(&mut rewritten.text);
    for (place, new) in changes.into_iter().rev() {
        rewritten.text.replace_range(place, &new);
    }
    rewritten
}

/// Every target with its place in the text: those of links, pictures and definitions.
fn places(text: &str) -> Vec<(Range<usize>, String)> {
    let parser = Parser::new_ext(text, Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES);
    let definitions = parser.reference_definitions().iter();
    let mut places: Vec<(Range<usize>, String)> = definitions
        .filter_map(|(_, definition)| last(text, definition.span.clone(), &definition.dest))
        .collect();
    for (event, range) in parser.into_offset_iter() {
        if let Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) = event {
            places.extend(last(text, range, &dest_url));
        }
    }
    places.sort_by_key(|(place, _)| place.start);
    places.dedup();
    places
}

/// Where a target stands last in a range: what is before it is the text of the link, or another link within it.
fn last(text: &str, range: Range<usize>, target: &str) -> Option<(Range<usize>, String)> {
    let start = range.start + text[range].rfind(target)?;
    (!target.is_empty()).then(|| (start..start + target.len(), target.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let found = links(text, |link| match link.strip_prefix("old") {
            Some(rest) => Target::InTheBook(format!("new{rest}")),
            None if link == "gone" => Target::Missing,
            None => Target::AsItIs,
        });
        assert_eq!(found.text, expected);
        assert_eq!(found.missing.len(), text.matches("(gone)").count());
    }

    #[test]
    fn links_of_every_kind_are_led_on() {
        check(
            "[old](old.md) and ![x](old/y.png \"old\")",
            "[old](new.md) and ![x](new/y.png \"old\")",
        );
        check("[![old](old.png)](old.md)\n", "[![old](new.png)](new.md)\n");
        check("[a][b]\n\n[b]: old.md\n", "[a][b]\n\n[b]: new.md\n");
        check("| a |\n|---|\n| [x](old.md#y) |\n", "| a |\n|---|\n| [x](new.md#y) |\n");
        check("[x](gone) [y](other.md)", "[x](gone) [y](other.md)");
    }

    #[test]
    fn code_is_no_link() {
        check(
            "`[x](old.md)`\n\n```\n[x](old.md)\n```\n",
            "`[x](old.md)`\n\n```\n[x](old.md)\n```\n",
        );
    }
}
