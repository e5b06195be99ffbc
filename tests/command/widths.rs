//! Tables at 80 and at 120 columns: every line fits and no word is broken. The tables are snapshots.

use super::terminal::{driftworld_in, output, scratch, succeed_in};
use crate::tier::quick_or_full;

/// The text output of a command at this width.
fn at(columns: usize, folder: &std::path::Path, arguments: &str) -> String {
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let mut command = driftworld_in(folder, &arguments);
    let done = output(command.env("COLUMNS", columns.to_string()));
    let error = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(0), "{arguments:?}: {error}");
    String::from_utf8(done.stdout).expect("the command prints UTF-8")
}

/// A quick lifetime in a folder: `scenario.json`, `log`.
fn lifetime(folder: &std::path::Path) {
    let task = include_str!("../../examples/tasks/blue_red_green.json");
    let (four, _) = task
        .split_once(",\n    \"many\"")
        .expect("the paper's variants come first");
    let mine = format!("{}}} }}", four.replace("\"blue_red_green\"", "\"mine\""));
    std::fs::write(folder.join("mine.json"), mine).expect("the folder is writable");
    let design = "curriculum mine.json --learn 2 --eval-episodes 2 -o scenario.json";
    succeed_in(folder, &design.split(' ').collect::<Vec<_>>());
    let run = "run scenario.json --agent random -o log";
    succeed_in(folder, &run.split(' ').collect::<Vec<_>>());
}

/// The commands whose tables are checked, each with the name of its snapshot.
const TABLES: [(&str, &str); 11] = [
    ("help", "--help"),
    ("tasks", "tasks"),
    ("tasks_show", "tasks show find_objects"),
    ("tasks_show_one", "tasks show find_objects#turned"),
    ("distance", "distance find_objects#blue dusk --explain"),
    ("order", "order get_to_goal#plain soft dusk far"),
    ("order_compare", "order get_to_goal#plain soft dusk far --compare"),
    (
        "curriculum",
        "curriculum mine.json --learn 2 --eval-episodes 2 --force -o again.json",
    ),
    ("run", "run scenario.json --agent random -o log --resume"),
    ("metrics", "metrics log"),
    ("validate", "validate mine.json --worlds 2"),
];

#[test]
fn tables_fit_80_and_120_columns_without_broken_words() {
    let folder = scratch();
    lifetime(folder.path());
    for (number, (name, arguments)) in TABLES.into_iter().enumerate() {
        let words = |text: &str| -> Vec<String> { text.split_whitespace().map(str::to_owned).collect() };
        let whole = words(&at(10_000, folder.path(), arguments));
        // The quick tier checks each table at one width.
        let widths = [80, 120].into_iter().skip(quick_or_full(number % 2, 0));
        for columns in widths.take(quick_or_full(1, 2)) {
            let shown = at(columns, folder.path(), arguments);
            for line in shown.lines() {
                assert!(line.chars().count() <= columns, "{arguments} at {columns}: {line}");
            }
            // A cell that wraps after a comma is two words instead of one.
            let known = |word: &str| {
                whole.iter().any(|one| {
                    one == word
                        || one.contains(&format!("{word},"))
                        || one.ends_with(&format!(",{word}"))
                        || one.contains(&format!(",{word}"))
                        || word.ends_with(',') && one.contains(word)
                })
            };
            for word in words(&shown) {
                assert!(known(&word), "{arguments} at {columns}: {word:?} is not a whole word");
            }
            insta::assert_snapshot!(format!("{name}_{columns}"), shown);
        }
    }
}

/// Values are shown in full at every width: none is cut, separated from its unit, or broken inside brackets.
#[test]
fn values_of_tasks_are_never_broken() {
    let folder = scratch();
    for task in ["find_objects", "moving_object", "select_object"] {
        for columns in [80, 100, 120, 160, 10_000].into_iter().step_by(quick_or_full(2, 1)) {
            let shown = at(columns, folder.path(), &format!("tasks show {task}"));
            assert!(!shown.contains(['…', '\u{a0}', '{']), "{task} at {columns}: {shown}");
            for line in shown.lines() {
                let count = |letter: char| line.chars().filter(|other| *other == letter).count();
                assert_eq!(count('['), count(']'), "{task} at {columns}: {line}");
                let units = ["m", "s", "m/s", "deg/s", "×", "%"];
                let first = line.split_whitespace().next().unwrap_or_default();
                assert!(
                    !units.contains(&first.trim_end_matches([',', ';'])),
                    "{task} at {columns}: {line}"
                );
            }
        }
    }
}
