//! Marks of unfinished work are refused: the three macros, and a to-do that names no issue. What clippy can refuse is
//! refused there as well; this rule also sees comments and other languages.

use super::tree::{Tree, ending};
use crate::finding::Finding;

// Written in two pieces, for this file is judged too.
const MACROS: [&str; 3] = [
    concat!("todo", "!("),
    concat!("unimplemented", "!("),
    concat!("dbg", "!("),
];
const TO_DO: &str = concat!("TO", "DO");

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.texts(&["rs", "py", "toml", "sh", ""]) {
        for (index, line) in text.lines().enumerate() {
            findings.extend(judge(path, index + 1, line));
        }
    }
    findings
}

fn judge(path: &str, number: usize, line: &str) -> Vec<Finding> {
    let left: Vec<&str> = if ending(path) == "rs" {
        MACROS.to_vec()
    } else {
        Vec::new()
    };
    let macros = left
        .into_iter()
        .filter(|mark| word_ends(line, mark).next().is_some())
        .map(|mark| {
            let advice = "write the code, return an error, or take the line out";
            Finding::new(path, number, format!("`{mark}`"), "finished code", advice)
        });
    let bare = word_ends(line, TO_DO).any(|rest| !rest.starts_with("(#") && !continues(rest));
    let to_do = bare.then(|| {
        let found = format!("a bare `{TO_DO}`");
        Finding::new(
            path,
            number,
            found,
            format!("`{TO_DO}(#123): …`"),
            "do it now, or name its issue",
        )
    });
    macros.chain(to_do).collect()
}

/// What follows the mark, wherever it begins a word of the line.
fn word_ends<'a>(line: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    let begins_word = |at: usize| !line[..at].ends_with(|letter: char| letter.is_alphanumeric() || letter == '_');
    line.match_indices(mark)
        .filter(move |(at, _)| begins_word(*at))
        .map(|(at, mark)| &line[at + mark.len()..])
}

/// Whether the word goes on, and so is another word.
fn continues(rest: &str) -> bool {
    rest.starts_with(|letter: char| letter.is_alphanumeric() || letter == '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_line(path: &str, line: &str, expected: usize) {
        let findings = check(&Tree::of(&[(path, line)]));
        assert_eq!(findings.len(), expected, "{path}: {line}: {findings:?}");
    }

    #[test]
    fn unfinished_macros_are_refused_in_rust() {
        for mark in MACROS {
            check_line("a.rs", &format!("    {mark})"), 1);
            check_line("a.rs", &format!("    my_{mark})"), 0);
            check_line("a.py", mark, 0);
        }
    }

    #[test]
    fn a_to_do_names_its_issue() {
        check_line("a.rs", &format!("// {TO_DO}: later"), 1);
        check_line("a.py", &format!("# {TO_DO}"), 1);
        check_line(".ci/run", &format!("# {TO_DO} (#1)"), 1);
        check_line("a.rs", &format!("// {TO_DO}(#12): later"), 0);
        check_line("a.rs", &format!("const {TO_DO}S: u8 = 1;"), 0);
        check_line("a.md", TO_DO, 0);
    }

    #[test]
    fn a_finding_names_the_line() {
        let text = format!("//! Fine.\n// {TO_DO}\n");
        assert_eq!(check(&Tree::of(&[("a.rs", &text)]))[0].line, 2);
    }
}
