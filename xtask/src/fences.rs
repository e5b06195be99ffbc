//! The stage `fences`: project rules that neither rustfmt, clippy nor cargo-deny can check.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::process::{Result, Workspace, metadata};
use crate::sources::{Sources, extension, is_name_char, is_test_file, shipped_lines};
use crate::stage::Outcome;
use crate::{rooms, unreached};

const MAP: &str = "ARCHITECTURE.md";
const UNSAFE: &str = "docs/unsafe.md";
// In two pieces, because this file is checked as well.
const TO_DO: &str = concat!("TO", "DO");

/// Developer tools, which only read files of the developers who run them.
const TOOL_FOLDERS: [&str; 1] = ["xtask/"];

/// Pages on which every path in backticks belongs to this repository. Other pages also name their readers' files.
const CHECKED_PAGES: [&str; 3] = ["ARCHITECTURE.md", "CONTRIBUTING.md", "README.md"];

/// Calls that only one crate may make. An exception needs a comment `not through CRATE:` above it, with the reason.
const RESERVED_CALLS: [(&str, &str, &str); 4] = [
    (
        "fs::read(",
        "files",
        "driftworld_files::read, because a pipe may never end",
    ),
    (
        "fs::read_to_string(",
        "files",
        "driftworld_files::text, because a pipe may never end",
    ),
    (
        "File::open(",
        "files",
        "driftworld_files::open, because a pipe may never end",
    ),
    (
        ".display()",
        "text",
        "driftworld_text::ShownPath, because a name may contain escape sequences",
    ),
];

/// Checks the whole checkout.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome> {
    let sources = Sources::read(&workspace.root)?;
    let metadata = metadata()?;
    let mut findings = rooms::check(&metadata);
    for package in metadata["packages"].as_array().into_iter().flatten() {
        let name = package["name"].as_str().unwrap_or_default();
        let manifest = Path::new(package["manifest_path"].as_str().unwrap_or_default());
        let path = manifest
            .strip_prefix(&workspace.root)
            .unwrap_or(manifest)
            .display()
            .to_string();
        findings.extend(rooms::versions(&path, sources.text(&path)));
        let folder = path.trim_end_matches("Cargo.toml");
        let is_on_map = |span: &str| span == name || span == folder;
        if !prose(sources.text(MAP))
            .flat_map(|(_, line)| code_spans(line))
            .any(is_on_map)
        {
            findings.push(format!("{MAP}: found no `{name}`, expected every crate"));
        }
    }
    findings.extend(check(&sources));
    findings.extend(unreached::find(&sources).into_iter().map(|item| {
        let (path, line, name) = (item.path, item.line, item.name);
        format!("{path}:{line}: found public `{name}`, used only in tests if at all; remove it, or see xtask/src/unreached.rs")
    }));
    for finding in &findings {
        eprintln!("{finding}");
    }
    match findings.len() {
        0 => Ok(Outcome::Passed(String::new())),
        count => Err(format!("{count} findings, listed above")),
    }
}

/// Violations in the text of files.
fn check(sources: &Sources) -> Vec<String> {
    let mut findings = Vec::new();
    for (path, text) in sources.with_extensions(&["rs"]) {
        if !text.starts_with("//! ") {
            findings.push(format!(
                "{path}:1: found no `//! `, expected a first line that states the file's purpose"
            ));
        }
        if !is_test_file(path) && !TOOL_FOLDERS.iter().any(|folder| path.starts_with(folder)) {
            findings.extend(reserved_calls(path, text));
        }
    }
    for (path, text) in sources.with_extensions(&["rs", "py", "toml", "sh", ""]) {
        let bare = (1..).zip(text.lines()).filter(|(_, line)| is_bare_to_do(line));
        findings.extend(
            bare.map(|(number, _)| format!("{path}:{number}: found a bare {TO_DO}, expected `{TO_DO}(#123): …`")),
        );
    }
    for (path, text) in sources.with_extensions(&["md"]) {
        for (line, span) in prose(text).flat_map(|(number, line)| code_spans(line).map(move |span| (number, span))) {
            if is_dangling(sources, path, span) {
                findings.push(format!(
                    "{path}:{line}: found `{span}`, expected a path of this repository"
                ));
            }
        }
    }
    findings.extend(unsafe_mismatches(sources));
    findings
}

/// Reserved calls in other crates that have no reason above them.
fn reserved_calls(path: &str, text: &str) -> Vec<String> {
    let raw: Vec<&str> = text.lines().collect();
    let mut findings = Vec::new();
    for (number, line) in shipped_lines(text).into_iter().enumerate() {
        for (call, home, instead) in RESERVED_CALLS {
            let mut places = line
                .match_indices(call)
                .map(|(at, _)| (&line[..at], &line[at + call.len()..]));
            let is_call = |(before, after): (&str, &str)| {
                !after.starts_with(".to_string()") && (call.starts_with('.') || !before.ends_with(is_name_char))
            };
            let mut comment = raw[..number]
                .iter()
                .rev()
                .take_while(|line| line.trim_start().starts_with("//"));
            let reason = format!("not through driftworld-{home}:");
            if places.any(is_call)
                && !path.starts_with(&format!("{home}/"))
                && !comment.any(|line| line.contains(&reason))
            {
                findings.push(format!(
                    "{path}:{}: found `{call}`, expected {instead}, or a comment with `{reason}`",
                    number + 1
                ));
            }
        }
    }
    findings
}

/// Whether a line contains a to-do that names no issue.
fn is_bare_to_do(line: &str) -> bool {
    line.match_indices(TO_DO).any(|(at, _)| {
        let rest = &line[at + TO_DO.len()..];
        !line[..at].ends_with(is_name_char) && !rest.starts_with("(#") && !rest.starts_with(is_name_char)
    })
}

/// Differences between the table in `docs/unsafe.md` and the number of unsafe blocks, functions, implementations, traits and
/// extern blocks in each Rust file.
fn unsafe_mismatches(sources: &Sources) -> Vec<String> {
    let in_line = |line: &str| {
        let code = line.split("//").next().unwrap_or_default();
        let follows = [" {", " fn ", " impl ", " extern ", " trait "].map(|next| format!("unsafe{next}"));
        follows.iter().map(|words| code.matches(words).count()).sum::<usize>()
    };
    let counted = sources
        .with_extensions(&["rs"])
        .map(|(path, text)| (path, text.lines().map(in_line).sum()));
    let found: BTreeMap<&str, usize> = counted.filter(|(_, count)| *count > 0).collect();
    let entry = |row: &'_ str| {
        let mut cells = row.split('|').map(str::trim).skip(1);
        let file = cells.next()?.strip_prefix('`')?.strip_suffix('`')?;
        Some((file.to_owned(), cells.next()?.parse().ok()?))
    };
    let in_table: BTreeMap<String, usize> = sources.text(UNSAFE).lines().filter_map(entry).collect();
    let files: BTreeSet<&str> = found
        .keys()
        .copied()
        .chain(in_table.keys().map(String::as_str))
        .collect();
    let difference = |file| {
        let (found, in_table) = (found.get(file).unwrap_or(&0), in_table.get(file).unwrap_or(&0));
        (found != in_table)
            .then(|| format!("{UNSAFE}: found {in_table} unsafe places listed for {file}, expected {found}"))
    };
    files.into_iter().filter_map(difference).collect()
}

/// Lines of a Markdown text outside fenced blocks, numbered from 1.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut fence: Option<&str> = None;
    (1..).zip(text.lines()).filter(move |(_, line)| {
        let mark = ["```", "~~~"]
            .into_iter()
            .find(|mark| line.trim_start().starts_with(mark));
        match (fence, mark) {
            (None, None) => return true,
            (None, opened) => fence = opened,
            (open, mark) if open == mark => fence = None,
            _ => {}
        }
        false
    })
}

/// The texts between pairs of backticks.
fn code_spans(line: &str) -> impl Iterator<Item = &str> {
    let closed = line.matches('`').count() / 2;
    line.split('`').skip(1).step_by(2).take(closed)
}

/// Whether a text in backticks on a page looks like a path of this repository but does not exist.
fn is_dangling(sources: &Sources, page: &str, span: &str) -> bool {
    let is_one_word = !span.is_empty() && !span.contains(|c: char| c.is_whitespace() || c == '<');
    let is_file = ["rs", "md", "toml", "json"].contains(&extension(span));
    let is_outside_path = ["/", "-", "../", "target/", "fuzz/corpus/"]
        .iter()
        .any(|start| span.starts_with(start))
        || span.contains("://");
    if !is_one_word || is_outside_path || !(span.contains('/') || is_file) {
        return false;
    }
    let (first, last) = (
        span.split_once('/').map(|(first, _)| first),
        span.rsplit('/').next().unwrap_or(span),
    );
    let names_one_of_ours = first.is_some_and(|first| sources.has(first)) && (last.is_empty() || last.contains('.'));
    if !CHECKED_PAGES.contains(&page) && extension(span) != "rs" && !names_one_of_ours {
        return false;
    }
    let folder = page.rsplit_once('/').map_or("", |(folder, _)| folder);
    let exists = |path: &str| match path.split(':').next().unwrap_or(path).split_once(['*', '{']) {
        Some((before, _)) => before.rsplit_once('/').is_some_and(|(folder, _)| sources.has(folder)),
        None if path.contains('/') => sources.has(path.split(':').next().unwrap_or(path)),
        None => sources.has_name(path),
    };
    let path = span.trim_start_matches("./");
    !exists(path) && !exists(&format!("{folder}/{path}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_files(files: &[(&str, &str)], expected: &[&str]) {
        let found = check(&Sources::of(files));
        assert_eq!(found.len(), expected.len(), "{files:?}: {found:?}");
        assert!(
            found
                .iter()
                .zip(expected)
                .all(|(found, start)| found.starts_with(start)),
            "{files:?}: {found:?}"
        );
    }

    fn check_page(page: &str, text: &str, expected: &[&str]) {
        let mut files = vec![("docs/near.md", ""), (UNSAFE, ""), ("spec/src/lib.rs", "//! Spec.\n")];
        files.push((page, text));
        check_files(&files, expected);
    }

    #[test]
    fn files_start_with_their_purpose_and_to_dos_name_an_issue() {
        check_files(
            &[
                ("a.rs", "//! Purpose.\n"),
                ("b.rs", "fn main() {}\n"),
                ("c.rs", "\n//! Late.\n"),
            ],
            &["b.rs:1: ", "c.rs:1: "],
        );
        let to_do = format!("# {TO_DO}(#12): later\n# {TO_DO}: later\nS{TO_DO} = {TO_DO}S\n");
        check_files(&[("a.py", &to_do), ("a.md", TO_DO)], &["a.py:2: "]);
    }

    #[test]
    fn reserved_calls_need_a_reason() {
        let text = "//! A.\nlet a = std::fs::read(path);\n// Locked, not through driftworld-files: it is a folder.\nlet a = File::open(path);\n\
                    let b = BlockFile::open(path.display().to_string());\nformat!(\"{}\", path.display());\n";
        check_files(&[("spec/src/a.rs", text)], &["spec/src/a.rs:2: ", "spec/src/a.rs:6: "]);
        check_files(&[("files/src/a.rs", text)], &["files/src/a.rs:6: "]);
        check_files(&[("tests/a.rs", text), ("xtask/src/a.rs", text)], &[]);
    }

    #[test]
    fn paths_in_backticks_exist() {
        let valid = "`spec/src/lib.rs:12` `lib.rs` `spec/` `spec/src/*.rs` `spec/{a,b}` `near.md` `World` `a b/c` `../gone` `target/gone` `bad/<kind>/`\n";
        check_page("ARCHITECTURE.md", valid, &[]);
        check_page(
            "ARCHITECTURE.md",
            "`spec/gone.rs`\n`gone.json` `gone/*.rs`\n",
            &["ARCHITECTURE.md:1: ", "ARCHITECTURE.md:2: ", "ARCHITECTURE.md:2: "],
        );
        check_page(
            "docs/near.md",
            "`near.md` `out/log.tsv` `world.json` `spec/too-large`\n",
            &[],
        );
        check_page(
            "docs/near.md",
            "`spec/gone.json` `gone.rs`\n",
            &["docs/near.md:1: ", "docs/near.md:1: "],
        );
    }

    #[test]
    fn list_of_unsafe_code_is_complete() {
        let code = concat!(
            "//! A.\n// un",
            "safe { }\nfn f() { un",
            "safe { g() } }\nun",
            "safe fn g() {}\n"
        );
        let check_list = |list: &str, expected: &[&str]| {
            let found = unsafe_mismatches(&Sources::of(&[(UNSAFE, list), ("env/src/x.rs", code)]));
            assert_eq!(found, expected);
        };
        check_list("| `env/src/x.rs` | 2 | why |\n", &[]);
        check_list(
            "",
            &["docs/unsafe.md: found 0 unsafe places listed for env/src/x.rs, expected 2"],
        );
        check_list(
            "| `env/src/x.rs` | 2 | why |\n| `env/src/y.rs` | 1 | |\n",
            &["docs/unsafe.md: found 1 unsafe places listed for env/src/y.rs, expected 0"],
        );
    }
}
