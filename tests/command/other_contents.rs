//! Every command that takes a document reports one of the wrong kind: what it is, what was expected, and what to do.

use std::fs;
use std::path::Path;

use super::terminal::{Says, driftworld_in, fail_in, output, root, scratch, succeed_in};
use crate::is_turn;

/// Each kind: an example in the scratch folder, and its name in messages.
const KINDS: [(&str, &str); 7] = [
    ("task.json", "a task spec"),
    ("world.json", "a world"),
    ("scenario.json", "a scenario"),
    ("maps.json", "a maps file"),
    ("settings.json", "scoring settings"),
    ("matrix.json", "a distance matrix"),
    ("log", "a log"),
];

/// Each command with `DOC` in place of the document, and the kinds that it accepts.
const COMMANDS: [(&str, &[&str]); 27] = [
    ("run DOC -o new", &["scenario.json"]),
    ("render DOC", &["task.json", "world.json"]),
    ("render task.json --maps DOC", &["maps.json"]),
    ("console DOC", &["task.json", "world.json"]),
    ("photograph DOC", &["task.json", "world.json"]),
    ("convert DOC", &["task.json", "world.json", "scenario.json"]),
    ("sample DOC", &["task.json"]),
    ("sample task.json --maps DOC", &["maps.json"]),
    ("tasks show DOC", &["task.json"]),
    ("vary DOC#red --element R --distance 0.1", &["task.json"]),
    ("elements DOC --worlds 1", &["task.json"]),
    ("sheet DOC", &["task.json"]),
    ("sheet --scenario DOC", &["scenario.json"]),
    ("distance DOC task.json", &["task.json", "world.json"]),
    ("distance world.json DOC", &["task.json", "world.json"]),
    ("distance DOC world.json --by pictures", &["task.json", "world.json"]),
    ("order DOC", &["task.json"]),
    ("order --from-matrix DOC", &["matrix.json"]),
    ("curriculum DOC", &["task.json"]),
    (
        "validate DOC",
        &["task.json", "world.json", "scenario.json", "maps.json"],
    ),
    ("logs validate DOC", &["log"]),
    ("logs aggregate DOC -o table.tsv", &["log"]),
    ("metrics DOC", &["log"]),
    ("metrics log --load-settings DOC", &["settings.json"]),
    ("report DOC -o page.html", &["log"]),
    ("transfer-report DOC --distances matrix.json", &["log"]),
    ("transfer-report log --distances DOC", &["matrix.json"]),
];

/// A folder with an example of every kind, each made by the appropriate command.
fn everything() -> tempfile::TempDir {
    let folder = scratch();
    let path = folder.path();
    fs::copy(root().join("examples/tasks/find_objects.json"), path.join("task.json")).expect("it is committed");
    succeed_in(path, &["sample", "task.json", "-o", "world.json"]);
    let short = ["--learn", "1", "--eval-episodes", "1"];
    let curriculum = ["curriculum", "task.json#red", "task.json#blue", "-o", "scenario.json"];
    succeed_in(path, &[&curriculum[..], &short[..]].concat());
    succeed_in(path, &["order", "task.json", "--matrix", "matrix.json"]);
    succeed_in(path, &["run", "scenario.json", "--agent", "random", "--output", "log"]);
    fs::write(path.join("settings.json"), r#"{ "perf_measure": "reward" }"#).expect("the folder is writable");
    let maps = root().join("tests/documents/good/maps/one_map.json");
    fs::copy(maps, path.join("maps.json")).expect("the document is committed");
    folder
}

fn arguments(command: &str, document: &str) -> Vec<String> {
    command.split(' ').map(|word| word.replace("DOC", document)).collect()
}

#[test]
fn document_of_the_wrong_kind_is_named() {
    let folder = everything();
    for (number, (command, accepted)) in COMMANDS.into_iter().enumerate() {
        for (kind, (document, name)) in KINDS.into_iter().enumerate() {
            // The quick tier runs each command with every third kind.
            if accepted.contains(&document) || !is_turn(number + kind, 3) {
                continue;
            }
            let arguments = arguments(command, document);
            let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
            let error = fail_in(folder.path(), 1, &arguments);
            let line = error.lines().next().unwrap_or_default();
            assert!(
                line.contains(document) && line.contains(&format!(": found {name}, expected a"))
                    || line.contains(&format!(": found {name}, expected scoring settings")),
                "{arguments:?}: {error}"
            );
            assert!(line.contains("`driftworld "), "{arguments:?} says what to do: {error}");
            // `validate` prints counts on a separate line.
            assert!(error.lines().count() <= 2, "{arguments:?}: {error}");
        }
    }
    assert!(!folder.path().join("new").exists(), "no log was started");
}

#[test]
fn advice_in_messages_works() {
    let folder = everything();
    let path = folder.path();
    let error = fail_in(path, 1, &["run", "task.json"]);
    let advised = error.split('`').nth(1).expect("the advice has a command in backticks");
    fs::remove_file(path.join("scenario.json")).expect("it exists");
    succeed_in(path, &advised.split(' ').skip(1).collect::<Vec<_>>());
    assert!(fs::read_to_string(path.join("scenario.json")).is_ok_and(|text| text.contains("\"blocks\"")));
}

/// Gives the documents the byte order mark that some editors add.
fn marked(folder: &Path) {
    for (document, _) in KINDS.into_iter().filter(|(document, _)| *document != "log") {
        let path = folder.join(document);
        let text = fs::read_to_string(&path).expect("it was written");
        fs::write(&path, format!("\u{feff}{text}")).expect("the folder is writable");
    }
}

#[test]
fn byte_order_mark_is_ignored() {
    let folder = everything();
    let path = folder.path();
    marked(path);
    let stdout = succeed_in(
        path,
        &["validate", "task.json", "world.json", "scenario.json", "maps.json"],
    );
    assert_eq!(
        stdout.lines().filter(|line| line.contains(": a valid ")).count(),
        4,
        "{stdout}"
    );
    for command in [
        "sample task.json#red",
        "distance world.json task.json#red",
        "run scenario.json --agent random -o again",
        "convert scenario.json",
        "convert world.json --maps maps.json",
        "order --from-matrix matrix.json",
        "metrics log --load-settings settings.json",
    ] {
        succeed_in(
            path,
            &arguments(command, "").iter().map(String::as_str).collect::<Vec<_>>(),
        );
    }
    // Lines and columns match those in an editor.
    fs::write(path.join("broken.json"), "\u{feff}{ \"name\": \"t\", \"grups\": [] }").expect("the folder is writable");
    let error = fail_in(path, 1, &["validate", "broken.json"]);
    assert!(error.starts_with("broken.json:1:16 (/grups)"), "{error}");
}

#[test]
fn every_file_is_judged_independently() {
    let folder = everything();
    let path = folder.path();
    fs::write(path.join("latin.json"), b"{ \"name\": \"caf\xe9\" }").expect("the folder is writable");
    let files = ["task.json", "missing.json", "latin.json", "matrix.json", "world.json"];
    let judged = output(&mut driftworld_in(path, &[&["validate"], &files[..]].concat()));
    let (stdout, error) = (
        String::from_utf8_lossy(&judged.stdout),
        String::from_utf8_lossy(&judged.stderr),
    );
    assert_eq!(judged.status.code(), Some(1));
    assert_eq!(stdout.lines().count(), 2, "{stdout}");
    error.says("missing.json: cannot be read");
    error.says("latin.json: byte 14 (line 1) is not UTF-8");
    error.says("matrix.json: found a distance matrix");
    error.says("3 of 5 files refused");
    let judged = output(&mut driftworld_in(
        path,
        &[&["validate", "--json"], &files[..]].concat(),
    ));
    let verdicts: serde_json::Value = serde_json::from_slice(&judged.stdout).expect("it is JSON");
    let valid: Vec<bool> = verdicts
        .as_array()
        .into_iter()
        .flatten()
        .map(|verdict| verdict["valid"] == true)
        .collect();
    assert_eq!(valid, [true, false, false, false, true]);
    // One bad file in a folder does not suppress the other verdicts.
    let judged = output(&mut driftworld_in(path, &["validate", "."]));
    assert!(String::from_utf8_lossy(&judged.stdout).contains("scenario.json: a valid scenario"));
}
