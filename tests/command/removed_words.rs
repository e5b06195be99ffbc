//! Words that earlier releases took are refused with what to use instead.

use driftworld_text::{WordKind, removed_words};

use super::terminal::fail;

#[test]
fn every_removed_word_names_what_to_use_instead() {
    for (kind, word, instead) in removed_words() {
        let arguments = match kind {
            WordKind::Command | WordKind::Option => word.to_owned(),
            WordKind::Format => format!("sample find_objects#red -o worlds.{word}"),
        };
        let said = fail(2, &arguments.split(' ').collect::<Vec<_>>());
        let expected = format!("removed in 0.3; use {instead}");
        assert!(
            said.split_whitespace()
                .collect::<Vec<_>>()
                .join(" ")
                .contains(&expected),
            "{arguments}: {said}"
        );
    }
}
