//! Every block of the book's pages is tested: commands run in a shell, with the output that the page shows; documents are
//! parsed. Blocks of Rust are doc tests, blocks of Python run in `python/tests/test_readme.py`; this is checked here. The
//! book's build checks links.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails where it is wrong")]

mod blocks;
mod how_to;
mod recording;
mod shell;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use blocks::{Block, blocks};

/// One test per page with commands, and the list of these pages.
macro_rules! pages {
    ($($test:ident: $page:literal,)*) => {
        $(#[test]
        fn $test() {
            shell::run($page);
        })*

        const WITH_COMMANDS: &[&str] = &[$($page),*];
    };
}

pages! {
    assets_run: "docs/assets.md",
    commands_run: "docs/commands.md",
    concepts_run: "docs/concepts.md",
    curricula_run: "docs/curricula.md",
    metrics_run: "docs/metrics.md",
    readme_runs: "README.md",
    first_hour_runs: "docs/first-hour.md",
    how_to_curricula_runs: "docs/how-to/curricula.md",
    how_to_distances_runs: "docs/how-to/distances.md",
    how_to_learners_runs: "docs/how-to/learners.md",
    how_to_interoperate_runs: "docs/how-to/interoperate.md",
    how_to_scores_runs: "docs/how-to/scores.md",
    how_to_studio_runs: "docs/how-to/studio.md",
    how_to_tasks_runs: "docs/how-to/tasks.md",
    how_to_watch_runs: "docs/how-to/watch.md",
    similarity_run: "docs/similarity.md",
    task_specs_run: "docs/task-specs.md",
    tasks_run: "docs/tasks.md",
    worlds_run: "docs/worlds.md",
}

/// Blocks of commands marked `by-hand`: the number on a page, and what else runs them.
const BY_HAND: &[(&str, usize, &str)] = &[
    ("README.md", 2, ".ci/run, and the stage `wheel`"),
    ("docs/benchmarks.md", 9, "benches: the stage `benches`"),
    ("docs/comparison.md", 1, "an hour: six environments of Python"),
    ("docs/curricula.md", 1, "half a minute, and tests of `curriculum`"),
    ("docs/first-hour.md", 1, "how the command is installed"),
    (
        "docs/how-to/learners.md",
        4,
        "minutes: the stage `learners` runs a smaller one, and an exported network",
    ),
    ("docs/install.md", 2, "`scripts/empty_root.sh`, after `scripts/dist.sh`"),
    (
        "docs/how-to/studio.md",
        4,
        "want the built page and a browser: the stage `studio`",
    ),
    ("docs/l2explorer.md", 5, "the stage `unity`, with the published clients"),
    ("docs/python.md", 2, "`python/tests/`: windows and the checker"),
    ("docs/worlds.md", 1, "how its figures were measured"),
    ("docs/similarity.md", 1, "minutes: six matrices of 38 variants"),
];

/// Pages whose Rust is included into a crate as doc tests.
const WITH_RUST: &[(&str, &str)] = &[
    ("docs/rust.md", "src/lib.rs"),
    ("docs/metrics.md", "metrics/src/lib.rs"),
];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// README.md and every page of `docs/`, relative to the root, in order.
fn all_pages() -> Vec<String> {
    fn gather(folder: &Path, pages: &mut Vec<String>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                gather(&path, pages);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                pages.push(path.strip_prefix(root()).unwrap().to_str().unwrap().to_owned());
            }
        }
    }
    let mut pages = vec!["README.md".to_owned()];
    gather(&root().join("docs"), &mut pages);
    pages.sort();
    pages
}

fn read(page: &str) -> String {
    std::fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

fn pages_with(wanted: impl Fn(&Block) -> bool) -> BTreeSet<String> {
    let pages = all_pages().into_iter();
    pages.filter(|page| blocks(&read(page)).iter().any(&wanted)).collect()
}

fn names(list: impl IntoIterator<Item = &'static str>) -> BTreeSet<String> {
    list.into_iter().map(str::to_owned).collect()
}

#[test]
fn every_page_with_commands_has_a_test() {
    let found = pages_with(|block| block.language == "sh" && !block.has("by-hand"));
    assert_eq!(
        found,
        names(WITH_COMMANDS.iter().copied()),
        "add the page to `pages!` in tests/pages/mod.rs"
    );
}

#[test]
fn blocks_not_run_here_are_counted() {
    let by_hand = |block: &Block| block.language == "sh" && block.has("by-hand");
    for page in all_pages() {
        let count = blocks(&read(&page)).iter().filter(|block| by_hand(block)).count();
        let expected = BY_HAND
            .iter()
            .find(|(name, ..)| *name == page)
            .map_or(0, |(_, count, _)| *count);
        assert_eq!(count, expected, "{page}: blocks marked by-hand; every other block runs");
    }
}

/// README.md promises two commands and an installation: CI runs exactly these.
#[test]
fn commands_in_the_readme_are_run() {
    let [first, second] = &blocks(&read("README.md"))[..2] else {
        panic!("README.md has too few blocks")
    };
    let command = |line: &str| line.split('#').next().unwrap_or(line).trim().to_owned();
    for line in first.text.lines().map(command) {
        assert!(
            read(".ci/run").lines().any(|run| run.starts_with(&line)),
            ".ci/run runs no `{line}`"
        );
    }
    assert_eq!(command(&second.text), "pip install \"./python[learners]\"");
    assert!(read("xtask/src/python.rs").contains("\"install --quiet ./python\""));
}

#[test]
fn rust_blocks_are_doc_tests() {
    let found = pages_with(|block| block.language.starts_with("rust"));
    assert_eq!(
        found,
        names(WITH_RUST.iter().map(|(page, _)| *page)),
        "include the page into a crate, under cfg(doctest)"
    );
    for (page, source) in WITH_RUST {
        let name = Path::new(page).file_name().unwrap().to_str().unwrap();
        assert!(
            read(source).contains(&format!("docs/{name}\")]")),
            "{source} includes no {page}"
        );
    }
}

#[test]
fn every_block_language_is_tested() {
    for page in all_pages() {
        for block in blocks(&read(&page)) {
            let known = ["sh", "json", "text", "python", "rust", "rust,no_run"].contains(&block.language.as_str());
            assert!(known, "{page}:{}: {:?}", block.line, block.language);
        }
    }
}

/// A document, or a part of one: the contents of an object's braces.
#[test]
fn json_blocks_can_be_parsed() {
    for page in all_pages() {
        for block in blocks(&read(&page)).iter().filter(|block| block.language == "json") {
            let whole = serde_json::from_str::<serde_json::Value>(&block.text);
            let part = || serde_json::from_str::<serde_json::Value>(&format!("{{{}}}", block.text));
            let read = whole.or_else(|_| part());
            assert!(read.is_ok(), "{page}:{}: {read:?}", block.line);
        }
    }
}
