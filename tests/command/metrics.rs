//! `driftworld metrics`: one lifetime, many, stored experts, settings, two agents.

use std::path::Path;

use super::terminal::{Says, driftworld_in, fail_in, json_in, output, read, scratch, succeed_in};
use crate::reference_data::reference;
use driftworld::metrics::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp};
use serde_json::{Value, json};

/// A lifetime in which tasks are learned in turn, all evaluated before and after each; `skill` sets its level.
fn live(folder: &Path, tasks: &[&str], skill: f64) {
    let info = LoggerInfo::new(["reward"]).expect("the columns are valid");
    let mut log = LogWriter::create(folder, &info, &ScenarioInfo::default()).expect("the folder is new");
    let mut exp_num = 0;
    let mut experience = |block: u64, kind: BlockType, task: &str, reward: f64| {
        let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + exp_num as i64).expect("it is a valid time");
        let record = Record::new(block, exp_num, kind, task, when).with_metric("reward", reward);
        log.write(&record).expect("the folder can be written");
        exp_num += 1;
    };
    for (round, learned) in (0..).zip(tasks) {
        for task in tasks {
            for k in 0..3 {
                let reward = skill * (round + 1) as f64 + f64::from(k);
                experience(2 * round, BlockType::Test, task, reward);
            }
        }
        (0..20).for_each(|k| experience(2 * round + 1, BlockType::Train, learned, skill * f64::from(k) / 10.0));
    }
    for task in tasks {
        experience(2 * tasks.len() as u64, BlockType::Test, task, skill * 4.0);
    }
}

const TASKS: [&str; 2] = ["find_red", "find_blue"];

/// A folder with `mine/run0` to `run3`, and the worse `theirs/run0` to `run2`.
fn two_agents() -> tempfile::TempDir {
    let folder = scratch();
    for k in 0..4_u8 {
        live(&folder.path().join(format!("mine/run{k}")), &TASKS, 5.0 + f64::from(k));
    }
    for k in 0..3_u8 {
        live(
            &folder.path().join(format!("theirs/run{k}")),
            &TASKS,
            1.0 + f64::from(k),
        );
    }
    folder
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).expect("it prints JSON")
}

#[test]
fn l2metrics_example_gives_its_files() {
    let Some(dir) = reference("l2metrics") else { return };
    let folder = scratch();
    let of = |name: &str| dir.join(name).display().to_string();
    let log = of("ll_logs/multi_task");
    let experts =
        ["task1_1_run1", "task2_1_run1", "task3_1_run1", "task3_1_run2"].map(|run| of(&format!("ste_logs/ste_{run}")));
    let mut arguments = vec!["metrics", "-l", &log, "-p", "performance", "-O", "results", "--ste"];
    arguments.extend(experts.iter().map(String::as_str));
    let shown = succeed_in(folder.path(), &arguments);
    let efficiency = shown.lines().find(|line| line.starts_with("sample_efficiency"));
    let value = efficiency.and_then(|line| line.split_whitespace().nth(1));
    assert_eq!(value, Some("0.913"), "{shown}");
    let file = |name: &str| parsed(&read(folder.path().join("results").join(name)));
    let expected = parsed(&read(dir.join("expected/multi_task_metrics.json")));
    assert_eq!(
        file("multi_task_metrics.json")["perf_recovery"],
        expected["perf_recovery"]
    );
    let check_near = |name: &str| {
        let value = |document: &Value| document[name].as_f64().expect("it is a number");
        let (found, expected) = (value(&file("multi_task_metrics.json")), value(&expected));
        assert!(
            (found - expected).abs() <= 1e-9 * expected.abs(),
            "{name}: {found}, {expected}"
        );
    };
    for name in "avg_train_perf avg_eval_perf forward_transfer_ratio ste_rel_perf sample_efficiency".split(' ') {
        check_near(name);
    }
    let settings = file("multi_task_settings.json");
    let expected = parsed(&read(dir.join("expected/multi_task_settings.json")));
    for (name, value) in expected
        .as_object()
        .expect("these are settings")
        .iter()
        .filter(|(name, _)| *name != "log_dir")
    {
        assert_eq!(&settings[name], value, "{name}");
    }
    // The saved settings reproduce the results.
    let settings = folder
        .path()
        .join("results/multi_task_settings.json")
        .display()
        .to_string();
    let mut rerun = vec!["metrics", "-c", &settings, "--ste"];
    rerun.extend(experts.iter().map(String::as_str));
    // The list of written files follows.
    assert!(shown.starts_with(&succeed_in(folder.path(), &rerun)), "{shown}");
}

#[test]
fn experts_are_stored_replaced_and_found() {
    let folder = scratch();
    for run in ["one", "two", "three"] {
        live(
            &folder.path().join(run),
            &["find_red"],
            if run == "one" { 2.0 } else { 4.0 },
        );
    }
    live(&folder.path().join("life"), &TASKS, 5.0);
    let store =
        |mode: &str, runs: &str| succeed_in(folder.path(), &format!("metrics {runs} -s {mode} --ste-data experts"));
    let relative = || {
        let scored = succeed_in(folder.path(), "metrics life --ste-data experts --json");
        parsed(&scored)["task_metrics"]["find_red"]["ste_rel_perf_vals"]
            .as_array()
            .map(Vec::len)
    };
    assert_eq!(
        store("w", "one"),
        "wrote experts/find_red/one (an expert of find_red)\n"
    );
    assert_eq!(relative(), Some(1));
    store("a", "two");
    assert_eq!(relative(), Some(2));
    store("w", "three");
    assert_eq!(relative(), Some(1));
    // Together they are the runs of one expert, even when replacing others.
    store("w", "one two three");
    assert_eq!(relative(), Some(3));
    let error = fail_in(folder.path(), 1, "metrics life -s w --ste-data experts");
    assert_eq!(
        error,
        "error: single-task expert log life: found find_red, find_blue, expected exactly one trained task; give one log \
         per task, or compare with an agent that ran the same blocks (--against), or with floors and ceilings (--scales)\n"
    );
}

#[test]
fn many_lifetimes_have_intervals_and_tables() {
    let folder = two_agents();
    let arguments = "metrics -R mine -O out --resamples 500";
    let shown = succeed_in(folder.path(), arguments);
    assert!(
        shown.starts_with("4 lifetimes: 160 learning and 56 evaluation experiences in all, scored by reward"),
        "{shown}"
    );
    let row = shown
        .lines()
        .find(|line| line.starts_with("avg_eval_perf"))
        .expect("the metric has a row");
    assert!(row.contains(" to ") && row.contains("4 x 2"), "{row}");
    assert_eq!(
        succeed_in(folder.path(), arguments),
        shown,
        "the same seed gives the same intervals"
    );
    // Four whole runs have so few distinct resamples that their percentiles hardly depend on the seed; resampling within tasks
    // has more.
    let by_strata = |seed: u8| {
        let line = format!("metrics -R mine --resamples 500 --resampling strata --bootstrap-seed {seed}");
        succeed_in(folder.path(), &line)
    };
    assert_ne!(by_strata(1), by_strata(0));
    assert!(
        row.matches(" to ").count() == 3,
        "one bootstrap interval and two Student intervals: {row}"
    );
    assert!(shown.contains("as logged") && shown.contains("mean reward"), "{shown}");
    let table = read(folder.path().join("out/ll_metrics.tsv"));
    assert_eq!(table.lines().count(), 5);
    assert!(table.starts_with("run_id\t") && table.contains("\nrun3\t"), "{table}");
    let all = parsed(&read(folder.path().join("out/ll_metrics.json")));
    assert_eq!(all.as_array().map(Vec::len), Some(4));
    let regimes = read(folder.path().join("out/ll_metrics_regime.tsv"));
    assert!(regimes.starts_with("run_id\tblock_num"), "{regimes}");
    assert_eq!(regimes.lines().count(), 1 + 4 * 8);
    let json = json_in(folder.path(), "metrics mine/run0 mine/run1 --json");
    assert_eq!(
        (
            json["repeats"][0]["num_runs"].clone(),
            json["lifetimes"][1]["run_id"].clone()
        ),
        (json!(2), json!("run1"))
    );
}

#[test]
fn figures_are_written_beside_the_results() {
    let folder = two_agents();
    succeed_in(folder.path(), "metrics mine/run0 -P -T raw lb");
    let plots = folder.path().join("results/plots");
    let mut names: Vec<String> = std::fs::read_dir(&plots)
        .expect("the folder was created")
        .map(|entry| {
            entry
                .expect("it can be listed")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    assert_eq!(
        names,
        ["run0_learning.png", "run0_learning.svg", "run0_raw.png", "run0_raw.svg"]
    );
    assert!(read(plots.join("run0_raw.svg")).contains("find_red"));
    // Lifetimes with the same name do not overwrite each other.
    succeed_in(folder.path(), "metrics mine/run0 theirs/run0 -P -T raw -O both");
    let both = folder.path().join("both/plots");
    assert!(both.join("mine_run0_raw.png").is_file() && both.join("theirs_run0_raw.png").is_file());
}

#[test]
fn two_agents_are_compared() {
    let folder = two_agents();
    let json = json_in(folder.path(), "metrics -R mine --against theirs -n none --json");
    let improvement = json["improvement"].as_array().expect("a list of metrics");
    let of = |name: &str| {
        let row = improvement
            .iter()
            .find(|row| row["name"] == name)
            .unwrap_or_else(|| panic!("no {name}"));
        row["improvement"]["probability"]["value"].as_f64()
    };
    assert_eq!(
        (of("avg_train_perf"), of("avg_eval_perf")),
        (Some(1.0), Some(1.0)),
        "every run of the first agent beats every run of the second"
    );
    let shown = succeed_in(folder.path(), "metrics -R theirs --against mine -n none");
    assert!(shown.contains("against 4 lifetimes of another agent"), "{shown}");
    let row = shown
        .lines()
        .rev()
        .find(|line| line.starts_with("avg_eval_perf"))
        .expect("the metric has a row");
    let cells: Vec<&str> = row.split_whitespace().collect();
    assert_eq!(
        cells.join(" "),
        "avg_eval_perf 0.000 0.000 to 0.000 0.057 no clear difference 2"
    );
}

#[test]
fn agents_of_different_levels_are_compared_on_one_scale() {
    let folder = scratch();
    for k in 0..3_u8 {
        live(
            &folder.path().join(format!("weak/run{k}")),
            &TASKS,
            1.0 + f64::from(k) / 10.0,
        );
        live(
            &folder.path().join(format!("strong/run{k}")),
            &TASKS,
            50.0 + f64::from(k),
        );
    }
    let arguments = ["metrics", "-R", "weak", "--against", "strong", "-O", "out", "--json"];
    let json = json_in(folder.path(), &arguments);
    let improvement = &json["improvement"][0];
    assert_eq!(improvement["name"], "avg_train_perf");
    assert_eq!(improvement["improvement"]["probability"]["value"], 0.0);
    let saved = parsed(&read(folder.path().join("out/ll_metrics_repeats.json")));
    assert_eq!(
        (&saved["improvement"], saved.get("lifetimes")),
        (&json["improvement"], None)
    );
    let settings = parsed(&read(folder.path().join("out/ll_metrics_settings.json")));
    let range = &settings["data_range"]["find_red"];
    let width = range["max"]
        .as_f64()
        .zip(range["min"].as_f64())
        .map(|(max, min)| max - min);
    assert!(width > Some(90.0), "the range of both agents: {range}");
    let shown = succeed_in(folder.path(), "metrics -R weak");
    assert!(shown.contains("Each lifetime is scaled by its own"), "{shown}");
    let error = {
        live(&folder.path().join("foreign/run"), &["a_1", "b_1"], 1.0);
        fail_in(folder.path(), 1, "metrics -R weak --against foreign")
    };
    assert_eq!(
        error,
        "error: --against: found no task that both agents have, find_blue, find_red here and a_1, b_1 there, expected the same \
         tasks\n"
    );
}

#[test]
fn lifetimes_with_the_same_name_are_distinguished() {
    let folder = scratch();
    for seed in ["a", "b"] {
        live(&folder.path().join(seed).join("log"), &TASKS, 1.0);
    }
    succeed_in(folder.path(), "metrics -R . -S -P -T raw");
    let table = read(folder.path().join("results/ll_metrics.tsv"));
    assert!(table.contains("\na/log\t") && table.contains("\nb/log\t"), "{table}");
    assert!(folder.path().join("results/plots/b_log_raw.png").is_file());
}

#[test]
fn ignored_input_is_reported() {
    let folder = scratch();
    live(&folder.path().join("life"), &TASKS, 1.0);
    live(&folder.path().join("expert"), &["find_green"], 1.0);
    let table = folder.path().join("life/worker-default/0-test/data-log.tsv");
    let holed = read(&table).replacen("\t1.0\n", "\tnan\n", 1);
    std::fs::write(&table, holed).expect("the folder can be written");
    let output = output(&mut driftworld_in(folder.path(), "metrics life --ste expert"));
    let stderr = String::from_utf8_lossy(&output.stderr);
    stderr.says("warning: life: 1 of 54 complete rows have no number in column reward");
    assert!(
        stderr.contains(
            "the expert expert of find_green is ignored: the lifetime has no such task, only find_red, find_blue"
        ),
        "{stderr}"
    );
}

#[test]
fn strict_definitions_and_noise_affect_the_result() {
    let folder = scratch();
    live(&folder.path().join("life"), &TASKS, 5.0);
    let scored = |more: &str| json_in(folder.path(), &format!("metrics life --json {more}"));
    assert_eq!(scored("--strict-definitions")["definitions"], "published");
    assert_eq!(scored("").get("definitions"), None);
    let noisy = scored("-N 0 0.5");
    assert_ne!(noisy["avg_eval_perf"], scored("")["avg_eval_perf"]);
    assert_eq!(noisy, scored("-N 0 0.5 --noise-seed 0"));
    std::fs::write(
        folder.path().join("range.json"),
        r#"{"Find_Red": {"min": 0, "max": 100}, "find_blue": {"min": 0, "max": 50}}"#,
    )
    .expect("the folder can be written");
    let ranged = scored("-d range.json");
    assert_eq!(
        ranged["normalization_data_range"]["find_blue"],
        json!({ "min": 0.0, "max": 50.0 })
    );
}

#[test]
fn every_unscorable_log_is_reported() {
    let folder = two_agents();
    for run in ["mine/run1", "mine/run3"] {
        std::fs::remove_file(folder.path().join(run).join("logger_info.json")).expect("it exists");
    }
    let lacks = |run: &str| {
        format!("{run}/logger_info.json: found no such file, expected a JSON object with the list metrics_columns")
    };
    let error = fail_in(folder.path(), 1, "metrics -R mine");
    let lines: Vec<&str> = error.lines().collect();
    assert_eq!(lines.len(), 2, "{error}");
    assert!(
        lines[0].contains(&lacks("mine/run1")) && lines[1].contains(&lacks("mine/run3")),
        "{error}"
    );
}

#[test]
fn experts_of_variants_serve_a_task_without_a_variant() {
    let folder = scratch();
    live(&folder.path().join("life"), &["ferry", "find_blue"], 1.0);
    live(&folder.path().join("red"), &["ferry_red"], 2.0);
    live(&folder.path().join("blue"), &["ferry_blue"], 3.0);
    let shown = json_in(folder.path(), "metrics life --ste red blue --json");
    let values = &shown["task_metrics"]["ferry"]["ste_rel_perf_vals"];
    assert_eq!(values.as_array().map(Vec::len), Some(2), "{shown}");
    assert_eq!(shown["task_metrics"]["find_blue"]["ste_rel_perf_vals"], json!([]));
    for expert in ["red", "blue"] {
        succeed_in(folder.path(), &format!("metrics {expert} -s w --ste-data experts"));
    }
    let stored = json_in(folder.path(), "metrics life --ste-data experts --json");
    assert_eq!(stored["lifetime"], shown["lifetime"]);
    assert_eq!(stored["ste_rel_perf"], shown["ste_rel_perf"]);
}

#[test]
fn logged_values_come_first_and_negative_transfer_is_noted() {
    let folder = scratch();
    live(&folder.path().join("life"), &TASKS, -5.0);
    let shown = succeed_in(folder.path(), "metrics life -t both -n none");
    let place = |words: &str| shown.find(words).unwrap_or_else(|| panic!("no {words} in {shown}"));
    assert!(place("mean reward") < place("avg_train_perf"), "{shown}");
    assert!(
        place("forward_transfer_contrast") < place("forward_transfer_ratio"),
        "{shown}"
    );
    assert!(place("note: some performances are negative") > 0);
    let scaled = succeed_in(folder.path(), "metrics life -t both");
    assert!(!scaled.contains("negative (down"), "{scaled}");
    let json = json_in(folder.path(), "metrics life -n none --json");
    assert_eq!(json["notes"].as_array().map(Vec::len), Some(1), "{json}");
    assert!(json["as_logged"]["reward"]["evaluation"].is_number(), "{json}");
}
