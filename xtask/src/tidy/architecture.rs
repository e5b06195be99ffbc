//! `ARCHITECTURE.md` stays a true map: short, with every crate on it, and no path that leads nowhere.

use super::links::prose;
use super::tree::Tree;
use crate::finding::Finding;

const FILE: &str = "ARCHITECTURE.md";
const MOST_LINES: usize = 200;

/// `members` are the crates' names and folders.
pub(super) fn check(tree: &Tree, members: &[(String, String)]) -> Vec<Finding> {
    let Some(text) = tree.text(FILE) else {
        let advice = "write it: the idea, how data flows, a code map, invariants, where to change what";
        return vec![Finding::new(FILE, 1, "no such file", "the map of the code", advice)];
    };
    let mut findings = missing_paths(tree, text);
    findings.extend(missing_members(text, members));
    let lines = text.lines().count();
    if lines >= MOST_LINES {
        let expected = format!("fewer than {MOST_LINES}");
        findings.push(Finding::new(
            FILE,
            MOST_LINES,
            format!("{lines} lines"),
            expected,
            "move detail into docs/",
        ));
    }
    findings
}

fn missing_members(text: &str, members: &[(String, String)]) -> Vec<Finding> {
    let named = |name: &str, folder: &str| {
        let mut spans = prose(text).flat_map(|(_, line)| code_spans(line));
        spans.any(|span| span == name || (!folder.is_empty() && span.trim_end_matches('/') == folder))
    };
    let missing = members.iter().filter(|(name, folder)| !named(name, folder));
    let finding = |name: &str| {
        let advice = format!("add `{name}` or its folder to the code map");
        Finding::new(
            FILE,
            1,
            format!("no mention of the crate `{name}`"),
            "every crate in backticks",
            advice,
        )
    };
    missing.map(|(name, _)| finding(name)).collect()
}

fn missing_paths(tree: &Tree, text: &str) -> Vec<Finding> {
    let spans = prose(text).flat_map(|(number, line)| code_spans(line).map(move |span| (number, span)));
    let missing = spans.filter(|(_, span)| looks_like_path(span) && !exists(tree, span));
    let finding = |(line, span): (usize, &str)| {
        let advice = "name the path as it is now, or take what is no path out of the backticks";
        Finding::new(FILE, line, format!("`{span}`"), "a path of this repository", advice)
    };
    missing.map(finding).collect()
}

/// What stands between pairs of backticks.
fn code_spans(line: &str) -> impl Iterator<Item = &str> {
    let closed = line.matches('`').count() / 2;
    line.split('`').skip(1).step_by(2).take(closed)
}

fn looks_like_path(span: &str) -> bool {
    let is_one_word = !span.is_empty() && !span.contains(|letter: char| letter.is_whitespace() || letter == '<');
    let ends_like_one = [".rs", ".md", ".toml", ".json"]
        .iter()
        .any(|ending| span.ends_with(ending));
    is_one_word && !span.contains("://") && (span.contains('/') || ends_like_one)
}

/// A path from the root; the name of a file anywhere; or a pattern whose folder exists.
fn exists(tree: &Tree, span: &str) -> bool {
    let path = span.trim_start_matches("./").split(':').next().unwrap_or(span);
    match path.split_once(['*', '{']) {
        Some((before, _)) => before.rsplit_once('/').is_some_and(|(folder, _)| tree.has(folder)),
        None if path.contains('/') => tree.has(path),
        None => tree.has_name(path),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_text(text: &str, expected: &[&str]) {
        let members = [("driftworld", ""), ("driftworld-spec", "spec")].map(|(a, b)| (a.to_owned(), b.to_owned()));
        let tree = Tree::of(&[
            (FILE, text),
            ("spec/src/lib.rs", ""),
            ("src/lib.rs", ""),
            ("Cargo.toml", ""),
        ]);
        let found: Vec<String> = check(&tree, &members)
            .into_iter()
            .map(|finding| finding.found)
            .collect();
        assert_eq!(found, expected, "{text}");
    }

    #[test]
    fn a_true_map_passes() {
        check_text(
            "`driftworld` in `src/`, `driftworld-spec` in `spec/src/lib.rs`, `lib.rs`, `Cargo.toml`\n",
            &[],
        );
        check_text(
            "`driftworld`: `spec/`, `src/*.rs`, `spec/src/{lib,gone}.rs`, `src/lib.rs:12`\n",
            &[],
        );
    }

    #[test]
    fn what_is_no_path_is_left_alone() {
        check_text(
            "`driftworld` `spec` `https://a.b/c` `cargo run -- a/b` `World`\n```\n`gone/away.rs`\n```\n",
            &[],
        );
    }

    #[test]
    fn a_path_that_leads_nowhere_is_reported() {
        let text = "`driftworld` `spec`\n`spec/gone.rs` `gone.json` `gone/*.rs`\n";
        check_text(text, &["`spec/gone.rs`", "`gone.json`", "`gone/*.rs`"]);
    }

    #[test]
    fn a_crate_off_the_map_is_reported() {
        check_text(
            "`driftworld` and its specification\n",
            &["no mention of the crate `driftworld-spec`"],
        );
    }

    #[test]
    fn the_map_is_short() {
        check_text(
            &("`driftworld` `spec`\n".to_owned() + &"\n".repeat(MOST_LINES - 2)),
            &[],
        );
        check_text(
            &("`driftworld` `spec`\n".to_owned() + &"\n".repeat(MOST_LINES - 1)),
            &["200 lines"],
        );
    }

    #[test]
    fn its_absence_is_reported() {
        let findings = check(&Tree::of(&[]), &[]);
        assert_eq!(findings.len(), 1);
        assert_eq!(findings[0].file, FILE);
    }
}
