//! The `driftworld` command as its users meet it: output, exit codes, messages, files that are whole or absent.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn driftworld(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_driftworld"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the command was built by cargo and starts")
}

#[track_caller]
fn succeed(arguments: &[&str]) -> String {
    let output = driftworld(arguments);
    let error = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {error}");
    String::from_utf8(output.stdout).expect("the command prints UTF-8")
}

/// What a failing command says on standard error.
#[track_caller]
fn fail(code: i32, arguments: &[&str]) -> String {
    let output = driftworld(arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    assert!(!error.contains("panicked"), "{error}");
    error
}

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("the machine has a folder for temporary files")
}

fn text(path: &Path) -> &str {
    path.to_str().expect("temporary paths are UTF-8")
}

/// The original's files, or a visible skip.
fn reference(file: &str) -> Option<PathBuf> {
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference");
    let root = std::env::var_os("DRIFTWORLD_REFERENCE").map_or(default, PathBuf::from);
    let path = root.join("l2explorer").join(file);
    if !path.exists() {
        #[expect(clippy::print_stdout, reason = "a skip must be seen")]
        {
            println!("skipped: {} is not there; set DRIFTWORLD_REFERENCE", path.display());
        }
        return None;
    }
    Some(path)
}

#[test]
fn every_subcommand_has_help_with_an_example() {
    let all = succeed(&["--help"]);
    for name in [
        "demo",
        "tasks",
        "validate",
        "sample",
        "render",
        "distance",
        "order",
        "curriculum",
        "run",
        "metrics",
        "schema",
    ] {
        assert!(all.contains(&format!("  {name} ")), "{name} is listed");
        let help = succeed(&[name, "--help"]);
        assert!(help.contains("Example"), "{name} shows an example:\n{help}");
    }
}

#[test]
fn usage_errors_exit_with_2() {
    fail(2, &["sampel"]);
    fail(2, &["sample"]);
    fail(2, &["sample", "find_objects", "--count", "0"]);
    assert!(fail(2, &["sample", "find_objects", "--count", "3"]).contains("--jsonl"));
    fail(2, &["schema"]);
}

#[test]
fn validate_accepts_the_examples_and_the_maps_of_the_original() {
    let said = succeed(&["validate", "examples/tasks"]);
    assert_eq!(said.lines().count(), 2, "{said}");
    for map in ["map_findobjects_0.json", "map_simple.json", "map_spawning.json"] {
        let Some(path) = reference(map) else { return };
        succeed(&["validate", "--l2explorer", text(&path)]);
        let refused = fail(1, &["validate", text(&path)]);
        assert!(
            refused.contains("pickup_range"),
            "the strict reader names the old key: {refused}"
        );
    }
}

#[test]
fn a_trailing_comma_is_refused_with_line_and_column() {
    let folder = scratch();
    let path = folder.path().join("world.json");
    std::fs::write(&path, "{\n  \"max_steps\": 3,\n}\n").expect("the scratch folder can be written");
    let error = fail(1, &["validate", text(&path)]);
    assert!(
        error.contains("world.json:3:1: not valid JSON: trailing comma"),
        "{error}"
    );
    let json = driftworld(&["validate", "--json", text(&path)]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).expect("--json prints JSON also for bad files");
    assert_eq!(json[0]["valid"], false);
}

#[test]
fn a_world_has_the_same_bytes_alone_again_and_in_a_stream() {
    let alone = [
        "sample",
        "find_objects#red",
        "--seed",
        "7",
        "--index",
        "1234",
        "-o",
        "-",
    ];
    let first = succeed(&alone);
    assert_eq!(first, succeed(&alone));
    let stream = succeed(&[
        "sample",
        "find_objects#red",
        "--seed",
        "7",
        "--count",
        "1235",
        "--jsonl",
    ]);
    assert_eq!(stream.lines().count(), 1235);
    assert_eq!(stream.lines().last(), first.strip_suffix('\n'));
    let shard = [
        "sample",
        "find_objects#red",
        "--seed",
        "7",
        "--index",
        "1200",
        "--count",
        "35",
        "--jsonl",
    ];
    assert_eq!(succeed(&shard).lines().last(), first.strip_suffix('\n'));
}

#[test]
fn outputs_are_whole_files_or_none() {
    let folder = scratch();
    let worlds = folder.path().join("worlds");
    succeed(&["sample", "get_to_goal#soft", "--count", "3", "-o", text(&worlds)]);
    let mut names: Vec<_> = std::fs::read_dir(&worlds)
        .expect("the folder was made")
        .map(|entry| entry.expect("the folder can be listed").file_name())
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["00000000.json", "00000001.json", "00000002.json"],
        "and no temporary file is left"
    );
    let blocked = folder.path().join("blocked");
    std::fs::write(&blocked, "a file where a folder is wanted").expect("the scratch folder can be written");
    let error = fail(1, &["sample", "find_objects", "-o", text(&blocked.join("world.json"))]);
    assert!(error.contains("cannot be written"), "{error}");
}

#[test]
fn unknown_names_are_answered_with_those_there_are() {
    let error = fail(1, &["sample", "find_objects#rde"]);
    assert!(
        error.contains("expected one of blue, red, green") && error.contains("did you mean \"red\"?"),
        "{error}"
    );
    let error = fail(1, &["tasks", "show", "find_object"]);
    assert!(error.contains("did you mean \"find_objects\"?"), "{error}");
}

#[test]
fn a_group_that_cannot_be_placed_says_which_and_what_to_loosen() {
    let folder = scratch();
    let path = folder.path().join("crowd.json");
    let spec = r#"{ "name": "crowd", "world": { "environment_params": { "map_size": [10, 10] } },
        "groups": [{ "name": "crowd", "count": 100, "object": { "class": "cube" },
                     "placement": { "box": { "low": [-5, -5], "high": [5, 5] } }, "separation": 3 }] }"#;
    std::fs::write(&path, spec).expect("the scratch folder can be written");
    let error = fail(1, &["sample", text(&path)]);
    assert!(error.contains("crowd") && error.contains("separation"), "{error}");
}

#[test]
fn render_draws_a_map_of_the_original() {
    let Some(map) = reference("map_findobjects_0.json") else {
        return;
    };
    let folder = scratch();
    let picture = folder.path().join("map.png");
    succeed(&[
        "render",
        text(&map),
        "--l2explorer",
        "--size",
        "64",
        "-o",
        text(&picture),
    ]);
    let bytes = std::fs::read(&picture).expect("the picture was written");
    assert_eq!(&bytes[1..4], b"PNG");
}

#[test]
fn from_variants_to_scores_step_by_step() {
    let folder = scratch();
    let at = |name: &str| folder.path().join(name);
    succeed(&["distance", "find_objects#blue", "find_objects#dusk", "--explain"]);
    succeed(&["order", "find_objects", "--json"]);
    let scenario = at("scenario.json");
    let few = ["--learn", "2", "--evaluate-with", "1", "--seed", "3"];
    let names = [
        "curriculum",
        "find_objects#blue",
        "find_objects#red",
        "-o",
        text(&scenario),
    ];
    succeed(&[&names[..], &few[..]].concat());
    succeed(&["validate", text(&scenario)]);
    let log = at("log");
    succeed(&["run", text(&scenario), "--agent", "random", "--logs", text(&log)]);
    let metrics = succeed(&["metrics", text(&log), "--json"]);
    let metrics: serde_json::Value = serde_json::from_str(&metrics).expect("--json prints JSON");
    assert_eq!(metrics["num_lx"], 4);
    let again = fail(1, &["run", text(&scenario), "--agent", "random", "--logs", text(&log)]);
    assert!(again.contains("--logs"), "a log is not written over: {again}");
}
