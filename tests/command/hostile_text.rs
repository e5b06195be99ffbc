//! Documents, logs, settings and file names that try to control the terminal: escape sequences, line breaks that forge a line,
//! text with reversed direction. No subcommand prints them unescaped.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use driftworld_text::is_unprintable;
use serde_json::{Value, json};

use super::run_files::write;
use super::terminal::{driftworld_in, output, root, scratch, subcommands, text};
use crate::is_turn;

/// A hostile text, without characters that file names cannot contain.
const HOSTILE: &str =
    "\u{1b}]0;owned\u{7}\u{1b}[2J\u{202e}dne\u{2066}\r\nerror: FAKE\u{9b}31m\u{7f}\u{200b}\u{feff}\u{e0041}";

/// With NUL, which a JSON document can contain as an escape, and a slash.
fn hostile() -> String {
    format!("{HOSTILE}\0/=1+2")
}

/// The test's folder, with the subcommands tried so far.
struct Stage {
    folder: tempfile::TempDir,
    tried: BTreeSet<String>,
    /// Hostile output that was found.
    leaks: Vec<String>,
}

/// Whether a character must not appear in the output.
fn is_hostile(c: char) -> bool {
    is_unprintable(c) && c != '\n' && c != '\t'
}

impl Stage {
    fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Writes a document and returns its name.
    fn document(&self, name: &str, json: &Value) -> String {
        write(&self.path().join(name), &json.to_string());
        name.to_owned()
    }

    /// Runs the command. Records output with control or invisible characters, and lines that we did not start.
    #[track_caller]
    fn run(&mut self, arguments: &[&str]) -> Output {
        self.tried.insert(arguments[0].to_owned());
        let done = output(driftworld_in(self.path(), arguments).env("COLUMNS", "200"));
        for bytes in [&done.stdout, &done.stderr] {
            let shown = String::from_utf8_lossy(bytes);
            let raw = shown.find(is_hostile);
            // A line break within a table's cell belongs to the cell.
            let is_table = arguments.get(1) == Some(&"aggregate");
            let faked = !is_table && shown.lines().any(|line| line.starts_with("error: FAKE"));
            if raw.is_some() || faked || shown.contains("panicked") {
                let from = shown.floor_char_boundary(raw.unwrap_or(0).saturating_sub(80));
                let part: String = shown[from..].chars().take(600).collect();
                self.leaks.push(format!("{arguments:?}: {part:?}"));
            }
        }
        assert!(
            matches!(done.status.code(), Some(0..=2)),
            "{arguments:?}: {:?}",
            done.status
        );
        done
    }

    /// Runs the command, which must succeed.
    #[track_caller]
    fn succeed(&mut self, arguments: &[&str]) -> String {
        let done = self.run(arguments);
        let error = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(0), "{arguments:?}: {error}");
        String::from_utf8(done.stdout).expect("the command prints UTF-8")
    }

    /// Runs the command, which must fail.
    #[track_caller]
    fn fail(&mut self, arguments: &[&str]) -> String {
        let done = self.run(arguments);
        assert_ne!(
            done.status.code(),
            Some(0),
            "{arguments:?}: {}",
            String::from_utf8_lossy(&done.stdout)
        );
        String::from_utf8(done.stderr).expect("the command prints UTF-8")
    }
}

/// A valid task with hostile text wherever possible.
fn sound_task() -> Value {
    let word = json!({
        "role": "variant", "type": "string", "affects": ["S"], "choices": ["plain", hostile()], "default": "plain", "description": hostile()
    });
    let object = json!({ "class": "geometric", "tag": HOSTILE.chars().take(40).collect::<String>() });
    let group = json!({ "name": "g", "count": 3, "object": object, "placement": { "disc": { "center": [0, 0], "radius": 9 } } });
    json!({
        "version": 2, "name": "task", "description": hostile(), "parameters": { "word": word }, "groups": [group],
        "variants": { "a": { "description": hostile(), "word": hostile() }, "b": {} }
    })
}

fn sound_world() -> Value {
    let name: String = HOSTILE.chars().take(60).collect();
    let object = json!({ "class": "geometric", "coordinates": [5, 5], "unique_name": name, "tag": name });
    json!({ "max_steps": 20, "objects": [object] })
}

fn scenario(task: &str, variant: &str, world: Option<&str>) -> Value {
    let mut regime = json!({ "task": task, "variant": variant, "count": 1 });
    if let Some(world) = world {
        regime["world"] = world.into();
    }
    let learning = json!({ "type": "learning", "regimes": [regime] });
    let evaluation = json!({ "type": "evaluation", "regimes": [regime] });
    json!({ "name": "s", "description": hostile(), "blocks": [evaluation, learning, evaluation] })
}

/// A readable log whose names and texts are as hostile as a table allows.
fn write_log(folder: &Path, column: &str, task: &str) {
    let info = json!({ "metrics_columns": [column], "log_format_version": "1.1" });
    write(&folder.join("logger_info.json"), &info.to_string());
    let scenario =
        json!({ "complexity": hostile(), "difficulty": "1-easy", "scenario_type": "custom", "author": hostile() });
    write(&folder.join("scenario_info.json"), &scenario.to_string());
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let header = format!(
        "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\t{}\tnote\n",
        quoted(column)
    );
    for (block, kind) in [(0, "test"), (1, "train"), (2, "test")] {
        let rows = (0..4).map(|row| {
            let number = block * 4 + row;
            let (task, note) = (quoted(task), quoted(HOSTILE));
            format!("{block}\t{number}\tw\t{kind}\twake\t{task}\t{{}}\tcomplete\t20200101T000000.0\t{number}\t{note}\n")
        });
        write(
            &folder.join(format!("w/{block}-{kind}/data-log.tsv")),
            &(header.clone() + &rows.collect::<String>()),
        );
    }
}

/// Subcommands that print nothing hostile but file names and arguments.
const OF_ARGUMENTS: &str = "bench completions demo doctor export new play schema";

/// Subcommands that are tried with logs.
const OF_LOGS: [&str; 4] = ["logs", "metrics", "report", "transfer-report"];

impl Stage {
    fn new() -> Self {
        Self {
            folder: scratch(),
            tried: BTreeSet::new(),
            leaks: Vec::new(),
        }
    }

    /// Fails with all hostile output found, and if one of these subcommands was not tried.
    #[track_caller]
    fn close(self, commands: impl IntoIterator<Item = String>) {
        assert!(self.leaks.is_empty(), "{}", self.leaks.join("\n"));
        for command in commands {
            assert!(self.tried.contains(&command), "{command} was not tried");
        }
    }
}

#[test]
fn no_subcommand_prints_hostile_documents_unescaped() {
    let mut stage = Stage::new();
    documents(&mut stage);
    worlds(&mut stage);
    runs(&mut stage);
    // New subcommands must be tried here, too.
    let mut commands = subcommands();
    let others: Vec<&str> = OF_ARGUMENTS.split(' ').chain(OF_LOGS).collect();
    commands.retain(|command| !others.contains(&command.as_str()));
    stage.close(commands);
}

#[test]
fn no_subcommand_prints_hostile_logs_or_matrices_unescaped() {
    let mut stage = Stage::new();
    logs(&mut stage);
    matrices(&mut stage);
    stage.close(OF_LOGS.map(str::to_owned));
}

#[test]
fn no_subcommand_prints_hostile_file_names_unescaped() {
    let mut stage = Stage::new();
    names_of_files(&mut stage);
    stage.close(["demo", "schema", "run", "report"].map(str::to_owned));
}

#[test]
fn no_subcommand_prints_hostile_arguments_unescaped() {
    let mut stage = Stage::new();
    arguments(&mut stage);
    stage.close(["bench", "doctor"].map(str::to_owned));
}

fn documents(stage: &mut Stage) {
    let hostile = hostile();
    let task = stage.document("task.json", &sound_task());
    assert!(stage.succeed(&["validate", &task]).contains("a valid task spec"));
    let shown = stage.succeed(&["tasks", "show", &task]);
    assert!(shown.contains("\\u{202e}dne"), "{shown}");
    stage.succeed(&["tasks", "show", &task, "--json"]);
    // JSON keeps its meaning.
    let world = stage.succeed(&["sample", &format!("{task}#a")]);
    let world: Value = serde_json::from_str(&world).expect("worlds are JSON");
    assert!(
        world["objects"][0]["tag"].as_str().expect("a tag").contains('\u{202e}'),
        "{world}"
    );
    stage.succeed(&["sample", &format!("{task}#a"), "--count", "3", "--jsonl"]);
    stage.run(&[
        "vary",
        &format!("{task}#a"),
        "--parameters",
        "word",
        "--distance",
        "0.5",
    ]);
    stage.succeed(&["elements", &task, "--worlds", "1"]);
    stage.run(&["scales", &task, "--worlds", "2"]);
    stage.succeed(&["distance", &format!("{task}#a"), &format!("{task}#b")]);
    stage.succeed(&["sheet", &task, "--size", "32"]);
    stage.succeed(&["order", &task]);
    stage.succeed(&["curriculum", &task]);

    let documents = [
        ("key.json", json!({ "name": "t", hostile.as_str(): 1 })),
        (
            "variant.json",
            json!({ "version": 2, "name": "t", "variants": { hostile.as_str(): { hostile.as_str(): hostile } } }),
        ),
        (
            "value.json",
            json!({ "version": 2, "name": hostile, "require": [hostile], "groups": [hostile] }),
        ),
        (
            "extends.json",
            json!({ "version": 2, "name": "t", "variants": { "a": { "extends": hostile } } }),
        ),
        (
            "world.json",
            json!({ "max_steps": hostile, "objects": [{ "class": hostile, "color": hostile, hostile.as_str(): 0 }] }),
        ),
        (
            "scenario.json",
            json!({ "name": hostile, "blocks": [{ "type": hostile, hostile.as_str(): [] }] }),
        ),
        ("maps.json", json!({ "maps": [{ "id": hostile, hostile.as_str(): 1 }] })),
        (
            "original.json",
            json!({ "logging_base_dir": hostile, "scenario": [{ "type": hostile, "regimes": [{ "task": hostile }] }] }),
        ),
    ];
    for (number, (name, bad)) in documents.into_iter().enumerate() {
        let name = stage.document(name, &bad);
        stage.run(&["validate", &name]);
        let json = stage.run(&["validate", &name, "--json"]);
        serde_json::from_slice::<Value>(&json.stdout).expect("--json prints JSON");
        // The quick tier runs one command for each document.
        let commands = "sample render console photograph sheet order curriculum convert";
        let tried = commands.split(' ').enumerate();
        for (_, command) in tried.filter(|(turn, _)| is_turn(turn + number, 8)) {
            stage.run(&[command, &name]);
        }
    }
    write(
        &stage.path().join("syntax.json"),
        &format!("{{\"{HOSTILE}\": {HOSTILE}"),
    );
    stage.fail(&["validate", "syntax.json"]);
}

fn worlds(stage: &mut Stage) {
    let world = stage.document("w.json", &sound_world());
    stage.succeed(&["validate", &world]);
    let shown = stage.succeed(&["convert", &world, "-o", "-"]);
    serde_json::from_str::<Value>(&shown).expect("it is JSON");
    stage.run(&["render", &world, "--size", "32"]);
    stage.run(&["photograph", &world, "--output", "photos"]);
    stage.run(&["film", &world, "--agent", "still", "--size", "32", "-o", "film.gif"]);
    let recordings = stage.document("r.jsonl", &sound_world());
    stage.fail(&["replay", &recordings]);
    write(
        &stage.path().join("script.txt"),
        &format!("objects\ninfo\nstate\nlog\nstep 3\nsend {{\"{HOSTILE}\"\n{HOSTILE}\ndestroy {HOSTILE}\nagent\n"),
    );
    stage.run(&["console", &world, "--script", "script.txt", "--keep-going"]);
    stage.run(&["assets", "show", HOSTILE]);
    stage.fail(&["studio", HOSTILE, "--no-open"]);
    let library = stage.path().join("bad.assets");
    fs::write(&library, HOSTILE).expect("the folder can be written");
    stage.fail(&["assets", "list", text(&library)]);
}

fn runs(stage: &mut Stage) {
    let script = format!("touch {}\n", HOSTILE.replace(['\r', '\n'], ""));
    write(&stage.path().join("agent.txt"), &script);
    let name: String = HOSTILE.chars().take(60).collect();
    for (file, document) in [
        ("task_lived.json", scenario("task.json", "a", None)),
        ("world_lived.json", scenario("t", "a", Some("w.json"))),
        ("hostile_world.json", scenario(&name, &name, Some("w.json"))),
        ("unknown_variant.json", scenario("task.json", &name, None)),
        ("unknown_task.json", scenario(&name, "a", None)),
        ("unknown_world.json", scenario("t", "a", Some(&name))),
    ] {
        let file = stage.document(file, &document);
        stage.run(&["validate", &file, "--worlds", "2"]);
        let logs = format!("logs-{file}");
        stage.run(&["run", &file, "--agent", "random", "--output", &logs]);
        stage.run(&["audit", &file, "--lifetimes", "1", "--repeats", "2"]);
        stage.run(&[
            "run",
            &file,
            "--agent",
            "scripted:agent.txt",
            "--output",
            &format!("{logs}-scripted"),
        ]);
        stage.run(&[
            "run",
            &file,
            "--agent",
            &format!("scripted:{HOSTILE}"),
            "--output",
            "none",
        ]);
    }
    assert!(
        stage.path().join("logs-world_lived.json/logger_info.json").exists(),
        "it was run"
    );
    stage.succeed(&["metrics", "logs-world_lived.json"]);
}

fn logs(stage: &mut Stage) {
    let task: String = HOSTILE.replace(['\r', '\n'], "");
    for (number, column) in ["reward", HOSTILE, "re\u{202e}ward", "=1+2"].into_iter().enumerate() {
        let log = format!("log{number}");
        write_log(&stage.path().join(&log), column, &task);
        stage.run(&["logs", "validate", &log]);
        stage.run(&["logs", "validate", &log, "--json"]);
        stage.run(&["logs", "aggregate", &log, "-o", "-", "--format", "csv"]);
        stage.run(&["logs", "aggregate", &log, "-o", "-", "--format", "tsv"]);
        stage.run(&["logs", "aggregate", &log, "-o", &format!("{log}.csv")]);
        let raw = output(&mut driftworld_in(
            stage.path(),
            &["logs", "aggregate", &log, "-o", "-", "--format", "csv", "--raw-cells"],
        ));
        assert!(
            String::from_utf8_lossy(&raw.stdout).contains('\u{202e}'),
            "raw output is unchanged"
        );
        stage.run(&["metrics", &log]);
        stage.run(&["metrics", &log, "--json"]);
        stage.run(&["metrics", &log, "--perf-measure", column]);
        stage.run(&["metrics", &log, "--perf-measure", HOSTILE]);
        stage.run(&["metrics", &log, "log0"]);
        stage.run(&[
            "report",
            &log,
            "-o",
            &format!("{log}.html"),
            "--title",
            HOSTILE,
            "--plots",
            "plots",
        ]);
        let page = fs::read_to_string(stage.path().join(format!("{log}.html"))).unwrap_or_default();
        let hostile = |c: char| is_unprintable(c) && c != '\n' && c != '\t';
        assert_eq!(
            page.find(hostile)
                .map(|at| page[at..].chars().take(60).collect::<String>()),
            None,
            "{log}: the page"
        );
        let shown = stage.run(&["report", &log, "-o", "-"]).stdout;
        assert!(number > 0 || !shown.is_empty());
    }
    let plots = fs::read_dir(stage.path().join("plots")).expect("figures were written");
    for plot in plots.map(|plot| plot.expect("the folder can be listed").path()) {
        if plot.extension().is_some_and(|ending| ending == "svg") {
            let drawn = fs::read_to_string(&plot).expect("SVG is text");
            assert!(
                !drawn.contains(|c: char| is_unprintable(c) && c != '\n' && c != '\t'),
                "{}",
                plot.display()
            );
        }
    }
    for (name, settings) in [
        ("keys.json", json!({ hostile(): 1, "perf_measure": hostile() })),
        (
            "words.json",
            json!({ "perf_measure": "reward", "maintenance_method": hostile(), "normalization_method": hostile() }),
        ),
    ] {
        let name = stage.document(name, &settings);
        stage.run(&["metrics", "log0", "--load-settings", &name]);
    }
    // Names in a log are no more trusted than its texts.
    write(
        &stage.path().join("log0/scenario_info.json"),
        &json!({ "scenario_type": hostile(), "task": hostile(), hostile(): 1 }).to_string(),
    );
    stage.run(&["logs", "validate", "log0"]);
    stage.run(&["report", "log0", "-o", "again.html"]);
    stage.run(&["metrics", "log0", "--ste", "log1"]);
}

fn matrices(stage: &mut Stage) {
    let matrix = stage.document(
        "matrix.json",
        &json!({ "labels": [hostile(), "=1+2", "c"], "values": [[0, 1, 2], [1, 0, 1], [2, 1, 0]] }),
    );
    stage.run(&["order", "--from-matrix", &matrix]);
    stage.run(&["order", "--from-matrix", &matrix, "--json"]);
    stage.run(&["order", "--from-matrix", &matrix, "--matrix", "matrix.csv"]);
    stage.run(&["order", "--from-matrix", "matrix.csv"]);
    stage.run(&["order", "--from-matrix", &matrix, "--first", HOSTILE]);
    stage.run(&["transfer-report", "log0", "--distances", &matrix]);
    stage.run(&["transfer-report", "log0", "--distances", "matrix.csv", "--json"]);
    let bad = stage.document(
        "bad_matrix.json",
        &json!({ "labels": [hostile(), hostile()], "values": [[0, hostile()]] }),
    );
    stage.fail(&["order", "--from-matrix", &bad]);
}

/// Names of files and folders may contain anything but NUL and a slash.
#[cfg(unix)]
fn names_of_files(stage: &mut Stage) {
    write_log(&stage.path().join("log1"), "reward", "a_b");
    let inside = |name: &str| PathBuf::from(HOSTILE).join(name);
    write(&stage.path().join(inside("task.json")), &sound_task().to_string());
    write(&stage.path().join(inside("bad.json")), "{");
    write(&stage.path().join(inside("w.json")), &sound_world().to_string());
    write_log(&stage.path().join(inside("log")), "reward", "a_b");
    let scenario_text = scenario("task.json", "a", None).to_string();
    write(&stage.path().join(inside("s.json")), &scenario_text);
    let names = ["task.json", "bad.json", "w.json", "s.json", "log", "none"].map(|name| text(&inside(name)).to_owned());
    for (number, name) in names.iter().enumerate() {
        let commands = [
            &["validate"][..],
            &["validate", "--json"],
            &["sample"],
            &["tasks", "show"],
            &["render", "--size", "32"],
            &["sheet", "--size", "32"],
            &["order"],
            &["curriculum"],
            &["convert"],
            &["console", "--script"],
            &["photograph"],
            &["metrics"],
            &["metrics", "-R"],
            &["logs", "validate"],
            &["logs", "validate", "-R"],
            &["report", "-o", "r.html"],
            &["assets", "list"],
            &["assets", "pack"],
            &["run", "--agent", "random", "--output", "x"],
            &["order", "--from-matrix"],
            &["metrics", "log1", "--load-settings"],
            &["sample", "find_objects#red", "--maps"],
            &["sample", "find_objects#red", "-o"],
            &["order", "find_objects", "--matrix"],
            &["logs", "aggregate", "log1", "-o"],
            &["distance", "find_objects#red"],
            &["vary", "--element", "R", "--distance", "0.5"],
        ];
        let tried = commands.iter().enumerate();
        for (_, command) in tried.filter(|(turn, _)| is_turn(turn + number, 3)) {
            stage.run(&[*command, &[name.as_str()]].concat());
        }
    }
    stage.run(&["metrics", "-R", HOSTILE]);
    stage.run(&["schema", "--check", HOSTILE]);
    stage.run(&["schema", "-o", &format!("{HOSTILE}-schemas")]);
    stage.run(&["sample", "find_objects#red", "--count", "2", "-o", HOSTILE]);
    stage.run(&["demo", "-o", text(&inside("task.json"))]);
}

#[cfg(not(unix))]
fn names_of_files(stage: &mut Stage) {
    for command in ["schema", "demo"] {
        stage.run(&[command, "--help"]);
    }
}

/// Messages of the argument parser.
fn arguments(stage: &mut Stage) {
    stage.fail(&[HOSTILE]);
    for arguments in [
        &["sample"][..],
        &["sample", "find_objects#red", "--seed"],
        &["order", "find_objects", "--order"],
        &["run", "s.json", "--agent"],
        &["tasks"],
        &["vary", "find_objects#red", "--element"],
        &["bench"],
        &["doctor"],
        &["metrics", "log1", "--variant-mode"],
        &["distance", "find_objects#red"],
    ] {
        stage.fail(&[arguments, &[HOSTILE]].concat());
    }
    stage.run(&["doctor"]);
    stage.run(&["bench", "--help"]);
}

#[test]
fn unprintable_characters_of_an_option_are_escaped_once() {
    for arguments in [
        ["curriculum", "find_objects", "--name", "a\u{202e}b"],
        ["sample", "find_objects", "--count", "\u{202e}"],
        ["run", "s.json", "--agent", "\u{1b}[2J"],
    ] {
        let said = String::from_utf8(output(&mut driftworld_in(root(), &arguments[..])).stderr).expect("it is UTF-8");
        assert!(said.contains(r"\u{") && !said.contains(r"\\u{"), "{said}");
    }
}
