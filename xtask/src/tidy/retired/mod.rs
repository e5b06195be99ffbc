//! Words that were retired stay so: no file, no identifier, no page and no help text uses one again. Which words, and
//! which rooms still have to part with them, is in `table.rs`. Other comments are left to readers.

mod table;

use std::collections::{BTreeMap, BTreeSet};
use std::iter;

use super::tree::Tree;
use crate::finding::Finding;
use table::{RETIRED, Retired, Where};

/// Where the table of words is, for findings.
const TABLE: &str = "xtask/src/tidy/retired/table.rs";

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    check_words(tree, RETIRED)
}

fn check_words(tree: &Tree, words: &[Retired]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut needed = BTreeSet::new();
    for (path, line, used) in uses(tree, words) {
        if used.still_in.contains(&room(path)) {
            needed.insert((used.word, room(path)));
            continue;
        }
        let found = format!("the retired word `{}`", used.word);
        findings.push(Finding::new(
            path,
            line,
            found,
            used.instead,
            "say it in the field's word",
        ));
    }
    if !tree.has(TABLE) {
        return findings;
    }
    let rooms = |word: &Retired| word.still_in.iter().map(|room| (word.word, *room)).collect::<Vec<_>>();
    let spare = words
        .iter()
        .flat_map(rooms)
        .filter(|exception| !needed.contains(exception));
    findings.extend(spare.map(|(word, room)| {
        let found = format!("an exception for `{word}` in {room}, where it is used no more");
        Finding::new(
            TABLE,
            1,
            found,
            "exceptions that are needed",
            "take it out of the table",
        )
    }));
    findings
}

/// Every use of a word: the file, the line, the word.
fn uses<'a>(tree: &'a Tree, words: &'a [Retired]) -> Vec<(&'a str, usize, &'a Retired)> {
    let of = |kind: Where| words.iter().filter(move |word| word.kind == kind);
    let mut uses = Vec::new();
    for (path, _) in tree.texts(&["rs", "py"]) {
        let stem = path.rsplit('/').next().and_then(|name| name.split('.').next());
        uses.extend(
            of(Where::File)
                .filter(|word| stem == Some(word.word))
                .map(|word| (path, 1, word)),
        );
    }
    let names: BTreeMap<&str, &Retired> = of(Where::Name).map(|word| (word.word, word)).collect();
    let said = |line: &str| {
        of(Where::Prose)
            .filter(|word| is_said(line, word.word))
            .collect::<Vec<_>>()
    };
    for (path, lines) in tree.shipped_sources("fuzz/") {
        let mut in_text = false;
        for (number, line) in lines {
            let mut found: Vec<&Retired> = words_of(line, &mut in_text)
                .into_iter()
                .filter_map(|word| names.get(word).copied())
                .collect();
            // The command's help is made of these.
            if path.starts_with("src/commands/") && line.trim_start().starts_with("///") {
                found.extend(said(&line.to_lowercase()));
            }
            found.dedup_by_key(|word| word.word);
            uses.extend(found.into_iter().map(|word| (path, number, word)));
        }
    }
    let pages = tree
        .texts(&["md"])
        .filter(|(path, _)| *path == "README.md" || path.starts_with("docs/"));
    for (path, text) in pages {
        let mut in_signature = false;
        for (number, line) in (1..).zip(text.lines()) {
            // Generated pages show names of Python, which are kept for those who use them.
            in_signature = line == "```py" || in_signature && line != "```";
            if in_signature {
                continue;
            }
            // Keys of documents stand between backticks.
            let prose: String = line.to_lowercase().split('`').step_by(2).collect::<Vec<_>>().join(" ");
            uses.extend(said(&prose).into_iter().map(|word| (path, number, word)));
        }
    }
    uses
}

/// The first folder of a path, or the file itself where it lies in none.
fn room(path: &str) -> &str {
    path.split_once('/').map_or(path, |(room, _)| room)
}

/// The identifiers of a line of Rust, but for those in comments and texts, and their parts between underscores. `in_text` is
/// whether the line begins within a text, and then whether it ends in one.
fn words_of<'a>(line: &'a str, in_text: &mut bool) -> Vec<&'a str> {
    // What begins at the margin like an item is outside of any text, whatever was counted before.
    *in_text &= !["pub ", "fn ", "impl", "}"].iter().any(|start| line.starts_with(start));
    let mut words = Vec::new();
    for part in quoted(line) {
        if !*in_text {
            let code = part.split_once("//").map_or(part, |(code, _)| code);
            let names = code.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
            words.extend(names.flat_map(|name| iter::once(name).chain(name.split('_').filter(|_| name.contains('_')))));
            if code.len() < part.len() {
                return words;
            }
        }
        *in_text = !*in_text;
    }
    // As many quotes as parts, less one.
    *in_text = !*in_text;
    words
}

/// The parts of a line between its quotes, but for those that are escaped or letters of their own.
fn quoted(line: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut from = 0;
    for (at, _) in line.match_indices('"') {
        if !line[..at].ends_with('\\') && !line[..at].ends_with('\'') {
            parts.push(&line[from..at]);
            from = at + 1;
        }
    }
    parts.push(&line[from..]);
    parts
}

/// Whether a line has the word, not as a part of another.
fn is_said(line: &str, word: &str) -> bool {
    let is_letter = |letter: char| letter.is_alphanumeric() || letter == '_';
    line.match_indices(word)
        .any(|(at, _)| !line[..at].ends_with(is_letter) && !line[at + word.len()..].starts_with(is_letter))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORDS: [Retired; 4] = [
        Retired::file("sight", "visibility.rs", &[]),
        Retired::name("chance", "rng", &["env"]),
        Retired::name("Losers", "LossCount", &[]),
        Retired::prose("lived", "run", &[]),
    ];

    fn check_tree(files: &[(&str, &str)], expected: &[&str]) {
        let needed = [("env/src/lib.rs", "fn f(chance: u64) {}"), (TABLE, "//! Words.")];
        let tree = Tree::of(&[files, &needed].concat());
        let found = check_words(&tree, &WORDS).into_iter();
        let found: Vec<String> = found
            .map(|finding| format!("{}: {}", finding.file, finding.found))
            .collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn words_are_found_in_names_of_files_in_identifiers_and_on_pages() {
        check_tree(
            &[("env/src/sight.rs", "//! What is seen.")],
            &["env/src/sight.rs: the retired word `sight`"],
        );
        check_tree(
            &[("spec/src/a.rs", "let by_chance = Losers(2);")],
            &[
                "spec/src/a.rs: the retired word `chance`",
                "spec/src/a.rs: the retired word `Losers`",
            ],
        );
        check_tree(
            &[("docs/a.md", "A lifetime is Lived.")],
            &["docs/a.md: the retired word `lived`"],
        );
        check_tree(
            &[("docs/a.md", "```py\nchance: int\n```\nLived.")],
            &["docs/a.md: the retired word `lived`"],
        );
    }

    #[test]
    fn other_words_comments_texts_and_tests_pass() {
        check_tree(
            &[
                (
                    "spec/src/b.rs",
                    "const TEXT: &str = \"\nLeft to chance.\";\nlet a = '\"'; let b = \"chance\";",
                ),
                (
                    "spec/src/a.rs",
                    "let chances = say(\"by chance\"); // chance\n#[cfg(test)]\nlet chance = 1;",
                ),
                ("spec/tests/a.rs", "let chance = 1;"),
                ("docs/a.md", "It is short-lived_ and outlived; `lived` is a key."),
            ],
            &[],
        );
    }

    #[test]
    fn an_exception_that_nothing_needs_is_reported() {
        let found = check_words(&Tree::of(&[(TABLE, "//! Words.")]), &WORDS);
        assert_eq!(found.len(), 1);
        assert!(found[0].found.contains("`chance` in env"), "{}", found[0].found);
    }
}
