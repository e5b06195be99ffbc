//! Regression tests of defects that newcomers found in their first hour with the command (issue 24).

use std::path::Path;

use super::terminal::{
    self, Says, driftworld, driftworld_in, fail_in, json_in, output, scratch, subcommands, succeed, succeed_in,
};
use crate::tier::quick_or_full;

/// A small task with a family.
const BERRIES: &str = r#"{ "name": "berries",
    "parameters": {
        "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 1 },
        "count": { "role": "variant", "type": "integer", "affects": ["S"], "range": [1, 4], "default": 2 } },
    "world": { "max_steps": 20, "environment_params": { "light_intensity": { "param": "light" } } },
    "groups": [{ "name": "berries", "count": { "param": "count" }, "object": { "class": "cube" },
        "placement": { "box": { "low": [-5, -5], "high": [5, 5] } } }],
    "variants": { "plain": {}, "all": { "name": "l{light}-n{count}", "grid": { "light": [0.5, 2], "count": [1, 3] } } } }"#;

fn with_berries() -> tempfile::TempDir {
    let folder = scratch();
    std::fs::write(folder.path().join("bush.json"), BERRIES).expect("the folder is writable");
    folder
}

/// Runs the command with a text on standard input: returns code, standard output, standard error.
fn fed(folder: &Path, input: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let done = terminal::fed(driftworld_in(folder, arguments), input.as_bytes());
    let shown = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    (done.status.code(), shown(done.stdout), shown(done.stderr))
}

// 5. The commands.

#[test]
fn commands_are_listed_in_groups_and_never_twice() {
    let help = succeed("--help");
    for group in ["Author", "Measure", "Teach", "Score", "Watch", "Work with other tools"] {
        assert!(help.lines().any(|line| line.starts_with(group)), "{group}: {help}");
    }
    assert!(
        !help.contains("Others:"),
        "a command is in no group; see src/commands/help.rs: {help}"
    );
    let mut names = subcommands();
    let all = names.len();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all);
}

#[test]
fn completions_know_every_shell_and_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = succeed(&["completions", shell]);
        for command in ["transfer-report", "curriculum", "completions"] {
            assert!(script.contains(command), "{shell} completes {command}");
        }
    }
}

// 7. Colours.

#[test]
fn colours_appear_only_on_request() {
    let colored = |arguments: &[&str], variable: Option<&str>| {
        let mut command = driftworld(arguments);
        let done = output(command.envs(variable.map(|name| (name, "1"))));
        [done.stdout, done.stderr].map(|bytes| bytes.contains(&b'\x1b'))
    };
    let order = ["order", "find_objects#red", "dusk"];
    assert_eq!(colored(&order, None), [false, false], "a pipe is not a terminal");
    assert_eq!(
        colored(&[&order[..], &["--color", "always"]].concat(), Some("NO_COLOR")),
        [true, false]
    );
    assert_eq!(
        colored(&[&order[..], &["--color=never"]].concat(), None),
        [false, false]
    );
    assert_eq!(colored(&["order", "nowhere", "--color", "always"], None), [false, true]);
    assert_eq!(colored(&["ordre", "--color", "always"], None), [false, true]);
    assert_eq!(colored(&["ordre", "--color", "never"], None), [false, false]);
}

#[test]
fn colours_do_not_change_the_text() {
    let plain = succeed(&["tasks", "show", "get_to_goal"]);
    let colored = succeed(&["tasks", "show", "get_to_goal", "--color", "always"]);
    let mut stripped = String::new();
    let mut inside = false;
    for letter in colored.chars() {
        match letter {
            '\u{1b}' => inside = true,
            'm' if inside => inside = false,
            _ if inside => {}
            _ => stripped.push(letter),
        }
    }
    assert_eq!(stripped, plain);
}

#[test]
fn tasks_show_has_one_table_of_variants_and_refuses_unknown_ones() {
    let shown = succeed(&["tasks", "show", "find_objects"]);
    let headings = shown.lines().filter(|line| line.starts_with("variant ")).count();
    assert_eq!(headings, 1, "{shown}");
    let one = succeed(&["tasks", "show", "find_objects#turned"]);
    assert!(
        one.contains("rock_reward = 100") && !one.contains("Red cubes at dusk"),
        "{one}"
    );
}

#[test]
fn explain_prints_no_rows_of_zeros() {
    let shown = succeed(&["distance", "find_objects#blue", "dusk", "--explain"]);
    let parts = shown.split("\n\n").nth(2).unwrap_or_default();
    assert!(parts.contains("light") && !parts.contains("0.0000"), "{shown}");
}

// 8. Consistent spelling of arguments.

#[test]
fn elements_are_accepted_by_letter_or_name_everywhere() {
    for element in ["R", "reward", "r", "Reward"].into_iter().take(quick_or_full(2, 4)) {
        succeed(&format!("vary find_objects#red --element {element} --distance 0.5"));
        succeed(&format!("distance find_objects#red penalty --weight {element}=2"));
        succeed(&format!(
            "curriculum find_objects#red penalty --probe {element} --worlds 0 -o -"
        ));
    }
}

#[test]
fn variants_need_no_task_where_it_is_known() {
    let folder = with_berries();
    for (bare, whole) in [
        (
            "distance find_objects#blue dusk --json",
            "distance find_objects#blue find_objects#dusk --json",
        ),
        (
            "order bush.json --start plain --end l2-n3 --json",
            "order bush.json --start berries#plain --end bush.json#l2-n3 --json",
        ),
        (
            "curriculum find_objects#red blue dusk --start blue --hold-out dusk --worlds 0",
            "curriculum find_objects#red find_objects#blue find_objects#dusk --start find_objects#blue \
             --hold-out find_objects#dusk --worlds 0",
        ),
        (
            "sample bush.json --drift-to l2-n3 --count 3 --jsonl",
            "sample bush.json --drift-to bush.json#l2-n3 --count 3 --jsonl",
        ),
    ] {
        assert_eq!(succeed_in(folder.path(), bare), succeed_in(folder.path(), whole));
    }
}

#[test]
fn families_and_patterns_expand_everywhere() {
    let folder = with_berries();
    for named in ["bush.json#all", "bush.json#l*"] {
        let here = |line: String| succeed_in(folder.path(), &line);
        for shown in [
            here(format!("order {named}")),
            here(format!("tasks show {named}")),
            here(format!("curriculum {named} --worlds 0 -o -")),
            here(format!("scales {named} --worlds 2")),
        ] {
            assert!(shown.contains("l0.5-n1") && shown.contains("l2-n3"), "{shown}");
        }
        here(format!("sheet {named} --size 32 -o sheet.png"));
    }
}

#[test]
fn every_written_file_is_reported_in_one_line() {
    let folder = with_berries();
    let path = folder.path();
    for (command, files) in [
        ("sample bush.json -o w.json", &["w.json"][..]),
        ("sample bush.json --count 2 -o worlds", &["worlds"]),
        ("sample bush.json --count 2 --jsonl -o w.jsonl", &["w.jsonl"]),
        ("render w.json --size 32 -o r.png", &["r.png"]),
        ("sheet bush.json --size 32 -o s.png", &["s.png"]),
        ("convert w.json -o c.json", &["c.json"]),
        ("vary bush.json --element O --distance 0.1 -o v.json", &["v.json"]),
        ("order bush.json --matrix m.csv --plot p.png", &["m.csv", "p.png"]),
        (
            "curriculum bush.json#all --learn 1 --eval-episodes 1 -o scenario.json --plot b.png",
            &["scenario.json", "b.png"],
        ),
        ("run scenario.json --agent still -o log", &["log"]),
        ("report log -o report.html --plots figures", &["report.html", "figures"]),
        ("metrics log --save results --plots plots", &["results/", "plots"]),
        ("scales bush.json#plain --worlds 2 -o scales.json", &["scales.json"]),
        ("transfer-report log --distances m.csv --plot t.png", &["t.png"]),
        ("logs aggregate log -o rows.tsv", &["rows.tsv"]),
        ("photograph w.json --modalities rgb -o photographs", &["photographs"]),
        ("assets show cube -o cubes.png", &["cubes.png"]),
        ("schema -o schemas", &["schemas"]),
        ("new other", &["other.json"]),
        ("export find_objects", &["find_objects.json"]),
    ] {
        let shown = succeed_in(path, command);
        for file in files {
            let is_report = |line: &str| line.starts_with(&format!("wrote {file}"));
            assert!(shown.lines().any(is_report), "{command}: {shown}");
        }
    }
    // If standard output holds data, the line is on standard error.
    let done = output(&mut driftworld_in(path, "order bush.json --matrix m.json --json"));
    let stderr = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(stderr.contains("wrote m.json"), "{stderr}");
    serde_json::from_slice::<serde_json::Value>(&done.stdout).expect("standard output is JSON alone");
}

#[test]
fn every_command_with_a_result_prints_json() {
    let folder = with_berries();
    let path = folder.path();
    for command in [
        "tasks --json",
        "tasks show bush.json --json",
        "validate bush.json --json",
        "vary bush.json --element O --distance 0.1 --json",
        "sample bush.json --json -o w.json",
        "sample bush.json --json",
        "render w.json --size 32 --json",
        "sheet bush.json --size 32 --json",
        "convert w.json --json -o c.json",
        "distance bush.json#plain l2-n3 --json",
        "order bush.json --json",
        "elements bush.json --worlds 1 --json",
        "curriculum bush.json#all --learn 1 --eval-episodes 1 -o scenario.json --json",
        "run scenario.json --agent still -o log --json",
        "metrics log --json",
        "report log --json",
        "scales bush.json#plain --worlds 2 --json",
        "logs validate log --json",
        "logs aggregate log -o rows.tsv --json",
        "photograph w.json --modalities rgb --json",
        "assets list --json",
        "assets show cube --json",
        "schema -o schemas --json",
        "new other --json",
        "export find_objects --json",
        "doctor --json",
    ] {
        json_in(path, command);
    }
}

#[test]
fn documents_are_read_from_standard_input() {
    let folder = with_berries();
    let path = folder.path();
    let read = |input: &str, arguments: &[&str]| {
        let (code, shown, stderr) = fed(path, input, arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {stderr}");
        shown
    };
    assert!(read(BERRIES, &["validate", "-"]).contains("standard input: a valid task spec"));
    let world = read(BERRIES, &["sample", "-#l2-n3"]);
    assert_eq!(world, succeed_in(path, &["sample", "bush.json#l2-n3"]));
    assert_eq!(
        read(&world, &["convert", "-"]),
        succeed_in(path, &["convert", "bush.json#l2-n3"])
    );
    read(&world, &["render", "-", "--size", "32", "-o", "r.png"]);
    assert!(read(BERRIES, &["order", "-"]).contains("berries#plain"));
    assert!(read(BERRIES, &["tasks", "show", "-"]).contains("l0.5-n1"));
    let scenario = r#"{ "name": "s", "blocks": [{ "type": "learning", "regimes": [{ "task": "bush.json", "variant": "plain", "count": 1 }] }] }"#;
    read(scenario, &["run", "-", "--agent", "still", "-o", "log"]);
    let matrix = succeed_in(path, &["order", "bush.json", "--json"]);
    let matrix: serde_json::Value = serde_json::from_str(&matrix).expect("it is JSON");
    read(&matrix["matrix"].to_string(), &["order", "--from-matrix", "-"]);
    let (code, _, stderr) = fed(path, "{", &["validate", "-"]);
    assert!(code == Some(1) && stderr.contains("standard input:1:"), "{stderr}");
}

// 9. Documents that validate but then fail.

#[test]
fn documents_from_new_and_export_validate_sample_and_run() {
    let folder = scratch();
    let path = folder.path();
    let stdout = succeed_in(path, &["new", "berries"]);
    stdout.says("wrote berries.json");
    stdout.says("driftworld validate berries.json");
    // Follow the advice in the output.
    let advised: Vec<Vec<&str>> = stdout
        .lines()
        .filter_map(|line| line.strip_prefix("  driftworld "))
        .map(|line| line.split(' ').collect())
        .collect();
    assert_eq!(advised.len(), 6, "{stdout}");
    for arguments in advised {
        // Shorten the run, so that the test takes little time.
        let small: Vec<&str> = arguments
            .iter()
            .map(|word| match *word {
                "20" => "2",
                "5" => "1",
                "sarsa" => "random",
                word => word,
            })
            .collect();
        succeed_in(path, &small);
    }
    let error = fail_in(path, 1, &["new", "berries"]);
    assert!(error.contains("--force"), "{error}");
    succeed_in(path, &["export", "select_object", "--name", "mine"]);
    succeed_in(path, &["validate", "mine.json"]);
}

#[test]
fn all_mistakes_are_reported_at_once() {
    let folder = scratch();
    let task = r#"{ "name": "t",
        "parameters": { "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": "bright" } },
        "require": ["ligth < 3"],
        "world": { "max_steps": "x", "environment_params": { "light_intensity": { "param": "lihgt" } } },
        "groups": [{ "name": "g", "count": 1, "object": { "class": "bushh" }, "placement": { "box": { "low": [0, 0], "high": [1, 1] } } }],
        "variants": { "a": { "extends": "c" } } }"#;
    std::fs::write(folder.path().join("t.json"), task).expect("the folder is writable");
    let error = fail_in(folder.path(), 1, &["validate", "t.json"]);
    for place in "/parameters/light/default /require/0 /world/max_steps \
         /world/environment_params/light_intensity /groups/0/object/class /variants/a/extends"
        .split(' ')
    {
        assert!(error.contains(place), "{place}: {error}");
    }
}

#[test]
fn unknown_class_error_names_the_nearest() {
    let folder = scratch();
    let world = |class: &str| format!(r#"{{ "objects": [{{ "class": "{class}", "coordinates": [3, 4] }}] }}"#);
    for (class, near) in [
        ("tre", "tree"),
        ("rok", "rock"),
        ("barrell", "barrel"),
        ("bushh", "shrub"),
        ("house", "building"),
    ] {
        std::fs::write(folder.path().join("w.json"), world(class)).expect("the folder is writable");
        let error = fail_in(folder.path(), 1, &["validate", "w.json"]);
        assert!(error.contains(&format!("did you mean {near:?}?")), "{error}");
    }
}

#[test]
fn readable_files_are_judged_beside_unreadable_ones() {
    let folder = with_berries();
    let done = output(&mut driftworld_in(folder.path(), "validate missing.json bush.json"));
    let [shown, stderr] = [done.stdout, done.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(shown.contains("bush.json: a valid task spec"), "{shown}");
    stderr.says("missing.json: cannot be read");
    stderr.says("1 of 2 files refused");
}

// 10. Helpful answers.

#[test]
fn byte_order_mark_and_three_numbers_are_handled() {
    let folder = scratch();
    std::fs::write(folder.path().join("bom.json"), format!("\u{feff}{BERRIES}")).expect("the folder is writable");
    succeed_in(folder.path(), "validate bom.json");
    succeed_in(folder.path(), "sample bom.json");
    let (_, _, stderr) = fed(folder.path(), "step 1 2.5 0\n", &["console", "find_objects"]);
    assert!(stderr.contains("write: step 1 1 2.5 0"), "{stderr}");
}

// 11. The order of named variants.

#[test]
fn variant_named_first_is_learned_first() {
    let folder = scratch();
    for names in ["red blue dusk", "dusk red blue", "blue dusk red"] {
        let found = json_in(
            folder.path(),
            &format!("curriculum find_objects#{names} --worlds 0 --force -o s.json --json"),
        );
        let first = names.split(' ').next().expect("there are three names");
        assert_eq!(found["variants"][0]["variant"], first, "{found}");
    }
}

#[test]
fn probe_takes_the_named_variants_and_prints_the_values_of_generated_ones() {
    let folder = scratch();
    let probe = |line: &str| {
        let line = format!("curriculum find_objects#red {line} --probe O --worlds 0 --force -o s.json");
        succeed_in(folder.path(), &line)
    };
    let shown = probe("blue dusk");
    assert_eq!(
        shown.lines().filter(|line| line.contains(" declared ")).count(),
        3,
        "{shown}"
    );
    let shown = probe("--step-distance 0.2 --steps 2");
    let sets = |line: &&str| line.contains(" sets ") && line.contains(" = ");
    assert_eq!(shown.lines().filter(sets).count(), 2, "{shown}");
}

// 12. One name per variant.

#[test]
fn variant_has_one_spelling_in_all_tables() {
    let folder = with_berries();
    let path = folder.path();
    let order = succeed_in(path, "order bush.json#plain bush.json#l2-n3");
    let design = "curriculum bush.json#plain bush.json#l2-n3 --learn 1 --eval-episodes 1 -o s.json";
    let design = succeed_in(path, design);
    let run = succeed_in(path, "run s.json --agent random -o log");
    let metrics = succeed_in(path, "metrics log");
    let scales = succeed_in(path, "scales bush.json#plain bush.json#l2-n3 --worlds 2");
    for shown in [order, design, run, metrics, scales] {
        shown.says("berries#plain");
        shown.says("berries#l2-n3");
        assert!(!shown.contains("bush.json#") && !shown.contains("berries_"), "{shown}");
    }
    // The log's own name occurs only in the files.
    let rows = succeed_in(path, &["logs", "aggregate", "log", "--format", "csv", "-o", "-"]);
    assert!(rows.contains("berries_l2n3"), "{rows}");
}

#[test]
fn matrix_of_a_task_file_fits_the_log_of_its_variants() {
    let folder = with_berries();
    let path = folder.path();
    succeed_in(path, "curriculum bush.json#all --learn 1 --eval-episodes 1 -o s.json");
    succeed_in(path, &["run", "s.json", "--agent", "random", "-o", "log"]);
    succeed_in(path, &["order", "bush.json", "--matrix", "m.csv"]);
    let matrix = std::fs::read_to_string(path.join("m.csv")).expect("it was written");
    assert!(matrix.contains("berries#plain"), "{matrix}");
    succeed_in(path, &["transfer-report", "log", "--distances", "m.csv"]);
}
