//! The stage `size` and `cargo xtask size`: check or update `SIZE.md`, which lists the lines of code of each room with a limit.

use std::fs;

use crate::process::{Result, Workspace, about};
use crate::sources::{Line, Sources, extension, lines_of_code};
use crate::stage::Outcome;

const FILE: &str = "SIZE.md";

const OPENING: &str = "\
# Size

Lines of code in each room: Rust, except where the name says another language. A line of code is neither blank nor a comment. Tests
are counted separately: the folders `tests/`, `test/`, `benches/`, `examples/` and `fuzz/`, files named `tests.rs`, and modules under
`#[cfg(test)]`.

`cargo xtask test` fails if a room is over its limit: raise the limit in the same commit and say why in the last column.
It also fails if a count is more than 2% out of date: `cargo xtask size` updates the counts.

| room | lines | limit | why the limit was raised |
|---|--:|--:|---|
";

/// The rooms: a file belongs to the first room with a prefix of its path.
const ROOMS: [(&str, &[&str]); 25] = [
    ("spec", &["spec/", "schema_errors/"]),
    ("generator", &["generator/"]),
    ("similarity", &["similarity/"]),
    ("env: agents", &["env/src/agents/"]),
    ("env: assets", &["env/src/assets/"]),
    ("env: render", &["env/src/render/"]),
    ("env: sim", &["env/src/sim/"]),
    ("env: batch", &["env/src/batch/"]),
    ("env: channel", &["env/src/channel/"]),
    (
        "env: experiment, abstraction, behavior",
        &["env/src/experiment/", "env/src/abstraction/", "env/src/behavior/"],
    ),
    ("env: rest", &["env/"]),
    ("metrics", &["metrics/"]),
    ("curriculum", &["curriculum/"]),
    ("report", &["report/"]),
    ("src: commands", &["src/commands/"]),
    ("src: console", &["src/console/"]),
    ("src: rest", &["src/"]),
    ("python (Rust)", &["python/src/"]),
    (PYTHON, &["python/package/"]),
    ("unity", &["unity/"]),
    ("studio: wasm (Rust)", &["studio/wasm/"]),
    (TYPESCRIPT, &["studio/"]),
    ("xtask", &["xtask/"]),
    ("text, files, atomic_files", &["text/", "files/", "atomic_files/"]),
    ("elsewhere", &[""]),
];

const PYTHON: &str = "python (Python)";
const TYPESCRIPT: &str = "studio: page (TypeScript)";
const TESTS: &str = "tests (Rust)";
const TOTAL: &str = "all Rust outside tests";

/// A row of the table. The rows are those of [`ROOMS`] that have any code, then the tests and the total.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Row {
    room: String,
    lines: usize,
    limit: usize,
    reason: String,
}

/// Fails if a room exceeds its limit or the counts in the file are out of date.
pub(crate) fn check(workspace: &Workspace) -> Result<Outcome> {
    let counts = count(&Sources::read(&workspace.root)?);
    let old_rows = fs::read_to_string(workspace.root.join(FILE)).unwrap_or_default();
    report(&complaints(&counts, &rows(&old_rows), true))?;
    Ok(Outcome::Passed(summary(&counts)))
}

/// Updates the counts and keeps limits and reasons; fails if a room exceeds its limit.
pub(crate) fn rewrite(workspace: &Workspace) -> Result {
    let counts = count(&Sources::read(&workspace.root)?);
    let path = workspace.root.join(FILE);
    let old_rows = rows(&fs::read_to_string(&path).unwrap_or_default());
    fs::write(&path, table(&counts, &old_rows)).map_err(about(&path))?;
    println!("wrote {FILE}: {}", summary(&counts));
    report(&complaints(&counts, &old_rows, false))
}

/// Lines of code per room, without empty rooms.
fn count(sources: &Sources) -> Vec<(&'static str, usize)> {
    let mut counts: Vec<(&str, usize)> = ROOMS.iter().map(|(room, _)| (*room, 0)).collect();
    let (mut tests, mut total) = (0, 0);
    for (path, text) in sources.with_extensions(&["rs", "py", "ts", "tsx", "mjs"]) {
        let is_home = |(_, prefixes): &(&str, &[&str])| prefixes.iter().any(|prefix| path.starts_with(prefix));
        let home = ROOMS.iter().position(is_home).unwrap_or(ROOMS.len() - 1);
        if !endings(ROOMS[home].0).contains(&extension(path)) {
            continue;
        }
        let lines = lines_of_code(path, text);
        let of = |kind| lines.iter().filter(|line| **line == kind).count();
        counts[home].1 += of(Line::Code);
        if extension(path) == "rs" {
            total += of(Line::Code);
            tests += of(Line::Test);
        }
    }
    counts.retain(|(_, lines)| *lines > 0);
    counts.extend([(TESTS, tests), (TOTAL, total)]);
    counts
}

/// The extensions of the files that count in a room.
fn endings(room: &str) -> &'static [&'static str] {
    match room {
        PYTHON => &["py"],
        TYPESCRIPT => &["ts", "tsx", "mjs"],
        _ => &["rs"],
    }
}

fn summary(counts: &[(&str, usize)]) -> String {
    let of = |room| counts.iter().find(|(name, _)| *name == room).map_or(0, |found| found.1);
    format!("{} lines of Rust, {} of its tests", of(TOTAL), of(TESTS))
}

/// The rows of the table in the file.
fn rows(text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [room, lines, limit, reason] = cells[..] else {
            return None;
        };
        Some(Row {
            room: room.to_owned(),
            lines: lines.parse().ok()?,
            limit: limit.parse().ok()?,
            reason: reason.to_owned(),
        })
    };
    text.lines().filter_map(row).collect()
}

/// The contents of the file. A new room gets a limit a little above its count.
fn table(counts: &[(&str, usize)], old_rows: &[Row]) -> String {
    let mut text = OPENING.to_owned();
    for (room, lines) in counts {
        let old = old_rows.iter().find(|row| row.room == *room);
        let limit = old.map_or(lines.next_multiple_of(50), |row| row.limit);
        let reason = old.map_or("", |row| row.reason.as_str());
        text += &format!("| {room} | {lines} | {limit} | {reason} |\n").replace("  ", " ");
    }
    text
}

/// Problems in the rows of the file. Counts that differ by at most 20 lines never count as out of date.
fn complaints(counts: &[(&str, usize)], old_rows: &[Row], are_counts_compared: bool) -> Vec<String> {
    let mut complaints = Vec::new();
    for &(room, lines) in counts {
        let Some(row) = old_rows.iter().find(|row| row.room == room) else {
            if are_counts_compared {
                complaints.push(format!("found no row for `{room}`; run: cargo xtask size"));
            }
            continue;
        };
        if lines > row.limit {
            complaints.push(format!(
                "found {lines} lines of code in `{room}`, expected at most {}; shorten it, or raise the limit in this commit and say \
                 why in the last column",
                row.limit
            ));
        }
        if are_counts_compared && row.lines.abs_diff(lines) > 20.max(lines / 50) {
            complaints.push(format!(
                "found {} lines written for `{room}`, expected {lines}; run: cargo xtask size",
                row.lines
            ));
        }
    }
    complaints
}

fn report(complaints: &[String]) -> Result {
    for complaint in complaints {
        eprintln!("{FILE}: {complaint}");
    }
    match complaints.len() {
        0 => Ok(()),
        count => Err(format!("{count} findings, listed above")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(room: &str, lines: usize, limit: usize, reason: &str) -> Row {
        Row {
            room: room.to_owned(),
            lines,
            limit,
            reason: reason.to_owned(),
        }
    }

    #[test]
    fn each_file_counts_in_one_room() {
        let sources = Sources::of(&[
            ("spec/src/a.rs", "fn f() {}\n#[cfg(test)]\nmod tests {\n}\n"),
            ("spec/tests/a.rs", "fn f() {}\n"),
            ("env/src/sim/a.rs", "fn f() {\n}\n"),
            ("env/src/a.rs", "fn f() {}\n"),
            ("python/src/a.rs", "fn f() {}\n"),
            ("python/package/driftworld/a.py", "a = 1\nb = 2\nc = 3\n"),
            ("python/api_pages.py", "a = 1\n"),
            ("studio/wasm/src/a.rs", "fn f() {}\n"),
            ("studio/src/a.tsx", "// A.\nconst a = 1;\n/* B.\n */\nconst b = 2;\n"),
            ("studio/test/a.mjs", "const a = 1;\n"),
        ]);
        let expected = [
            ("spec", 1),
            ("env: sim", 2),
            ("env: rest", 1),
            ("python (Rust)", 1),
            (PYTHON, 3),
            ("studio: wasm (Rust)", 1),
            (TYPESCRIPT, 2),
            (TESTS, 4),
            (TOTAL, 6),
        ];
        assert_eq!(count(&sources), expected);
    }

    #[test]
    fn table_round_trips() {
        let old_rows = [row("spec", 90, 120, "a new law"), row("gone", 1, 1, "")];
        let text = table(&[("spec", 100), ("generator", 30)], &old_rows);
        assert!(text.starts_with(OPENING));
        assert_eq!(
            rows(&text),
            [row("spec", 100, 120, "a new law"), row("generator", 30, 50, "")]
        );
    }

    #[test]
    fn only_limits_and_old_counts_are_problems() {
        let found = |lines, old_rows: &[Row]| complaints(&[("spec", lines)], old_rows, true).join("\n");
        let old_rows = [row("spec", 10_000, 10_100, "")];
        assert_eq!(found(10_100, &old_rows), "");
        assert!(found(10_101, &old_rows).starts_with("found 10101 lines of code in `spec`, expected at most 10100; "));
        assert_eq!(found(9_810, &old_rows), "");
        assert_eq!(
            found(9_700, &old_rows),
            "found 10000 lines written for `spec`, expected 9700; run: cargo xtask size"
        );
        assert_eq!(found(80, &[row("spec", 100, 100, "")]), "");
        assert_eq!(found(1, &[]), "found no row for `spec`; run: cargo xtask size");
        assert_eq!(complaints(&[("spec", 9_000)], &old_rows, false), [""; 0]);
    }
}
