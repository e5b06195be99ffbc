//! Every path of this repository that a page names in backticks is there. Links are checked by `links.rs`.

use super::links::prose;
use super::tree::{Tree, ending};
use crate::finding::Finding;

/// The pages for people who change the code: what looks like a path there is one of this repository. Other pages also name
/// files of their readers.
const PAGES: [&str; 3] = ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"];

/// Where builds and fuzzing put what no repository keeps.
const BUILT: [&str; 2] = ["target/", "fuzz/corpus/"];

pub(super) fn check(tree: &Tree) -> Vec<Finding> {
    let pages = tree.texts(&["md"]);
    pages.flat_map(|(page, text)| missing(tree, page, text)).collect()
}

fn missing(tree: &Tree, file: &str, text: &str) -> Vec<Finding> {
    let spans = prose(text).flat_map(|(number, line)| code_spans(line).map(move |span| (number, span)));
    let is_meant = |span: &str| is_path(span) && (PAGES.contains(&file) || is_ours(tree, span));
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    let is_there = |span: &str| exists(tree, span) || exists(tree, &format!("{folder}/{span}"));
    let missing = spans.filter(|(_, span)| is_meant(span) && !is_there(span));
    let finding = |(line, span): (usize, &str)| {
        let advice = "name the path as it is now, or take what is no path out of the backticks";
        Finding::new(file, line, format!("`{span}`"), "a path of this repository", advice)
    };
    missing.map(finding).collect()
}

/// What stands between pairs of backticks.
pub(super) fn code_spans(line: &str) -> impl Iterator<Item = &str> {
    let closed = line.matches('`').count() / 2;
    line.split('`').skip(1).step_by(2).take(closed)
}

/// Whether it looks like a path of this repository: not one beside it, nor one from the root of the machine.
fn is_path(span: &str) -> bool {
    let is_one_word = !span.is_empty() && !span.contains(|letter: char| letter.is_whitespace() || letter == '<');
    let ends_like_one = [".rs", ".md", ".toml", ".json"]
        .iter()
        .any(|ending| span.ends_with(ending));
    let is_built = BUILT.iter().any(|folder| span.starts_with(folder));
    let elsewhere = span.contains("://") || span.starts_with(['/', '-']) || span.starts_with("../") || is_built;
    is_one_word && !elsewhere && (span.contains('/') || ends_like_one)
}

/// Whether it begins with a folder of this repository and ends like a file or a folder, unlike codes of errors; or is a
/// source.
fn is_ours(tree: &Tree, span: &str) -> bool {
    let first = span.split_once('/').map(|(first, _)| first);
    let last = span.rsplit('/').next().unwrap_or(span);
    ending(span) == "rs" || first.is_some_and(|first| tree.has(first)) && (last.is_empty() || last.contains('.'))
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
        for page in PAGES {
            let tree = Tree::of(&[
                (page, text),
                ("spec/src/lib.rs", ""),
                ("src/lib.rs", ""),
                ("Cargo.toml", ""),
            ]);
            let found: Vec<String> = check(&tree).into_iter().map(|finding| finding.found).collect();
            assert_eq!(found, expected, "{page}: {text}");
        }
    }

    #[test]
    fn paths_that_are_there_pass() {
        check_text("`src/`, `spec/src/lib.rs`, `lib.rs`, `Cargo.toml`\n", &[]);
        check_text("`spec/`, `src/*.rs`, `spec/src/{lib,gone}.rs`, `src/lib.rs:12`\n", &[]);
    }

    #[test]
    fn what_is_no_path_of_ours_is_left_alone() {
        check_text(
            "`spec` `https://a.b/c` `cargo run -- a/b` `World` `//!` `../shared/gone` `target/gone` `bad/<kind>/`\n```\n`gone/away.rs`\n```\n",
            &[],
        );
    }

    #[test]
    fn other_pages_name_files_of_their_readers_and_codes_of_errors() {
        let text = "`spec/too-large` `out/log.tsv` `world.json` `near.md` `spec/src/` `spec/gone.json` `spec/gone/` `gone.rs`\n";
        let tree = Tree::of(&[("docs/page.md", text), ("docs/near.md", ""), ("spec/src/lib.rs", "")]);
        let found: Vec<String> = check(&tree).into_iter().map(|finding| finding.found).collect();
        assert_eq!(found, ["`spec/gone.json`", "`spec/gone/`", "`gone.rs`"]);
    }

    #[test]
    fn a_path_that_leads_nowhere_is_reported_on_every_page() {
        let text = "`spec`\n`spec/gone.rs` `gone.json` `gone/*.rs`\n";
        check_text(text, &["`spec/gone.rs`", "`gone.json`", "`gone/*.rs`"]);
    }
}
