//! `driftworld logs`: messages about broken logs, and tables for other programs.

use std::fs;
use std::path::Path;

use serde_json::json;

use super::run_files::write;
use super::terminal::{Says, driftworld_in, output, scratch};

const HEADER: &str = "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\treward\tdebug\n";

/// Standard output and standard error.
#[track_caller]
fn run(folder: &Path, code: i32, arguments: &str) -> (String, String) {
    let output = output(&mut driftworld_in(folder, arguments));
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("it is UTF-8"));
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {out}{error}");
    (out, error)
}

/// A log of two blocks and three rows, one of them incomplete and one without its number.
fn write_log(dir: &Path) {
    let info = r#"{"metrics_columns": ["reward"], "log_format_version": "1.1"}"#;
    write(&dir.join("logger_info.json"), info);
    let scenario = r#"{"complexity": "1-low", "difficulty": "1-easy", "scenario_type": "custom"}"#;
    write(&dir.join("scenario_info.json"), scenario);
    let params = r#""{""size"": 0.1}""#;
    let train = format!(
        "0\t0\tw\ttrain\twake\tA_b\t{params}\tincomplete\t20200101T000000.0\t1\thm\n\
         0\t0\tw\ttrain\twake\tA_b\t{params}\tcomplete\t20200101T000001.25\t0.1\t\"a, b\"\n"
    );
    write(&dir.join("w/0-train/data-log.tsv"), &(HEADER.to_owned() + &train));
    let test = "1\t1\tw\ttest\twake\ta_b\t{}\tcomplete\t20200101T000002.0\tnan\t\n";
    write(&dir.join("w/1-test/data-log.tsv"), &(HEADER.to_owned() + test));
}

#[test]
fn valid_log_is_summarised() {
    let base = scratch();
    write_log(&base.path().join("run"));
    let (out, error) = run(base.path(), 0, "logs validate run");
    let expected =
        "run: valid; 3 rows (1 incomplete) in 2 files, 1 worker, 2 blocks, 1 task; metrics reward; format 1.1\n";
    assert_eq!((out.as_str(), error.as_str()), (expected, ""));
}

#[test]
fn scoring_and_aggregating_agree_with_validation() {
    let base = scratch();
    let log = base.path().join("run");
    write_log(&log);
    let rows = |numbers: &[u64]| -> String {
        let row = |number: &u64| {
            format!("0\t{number}\tw\ttrain\twake\ta_b\t{{}}\tcomplete\t20200101T000001.{number:02}\t0.{number}\t\n")
        };
        HEADER.to_owned() + &numbers.iter().map(row).collect::<String>()
    };
    fs::remove_dir_all(log.join("w/1-test")).expect("it was written");
    for (numbers, code, message) in [
        (
            &[0, 1, 1, 2][..],
            1,
            "run/w/0-train/data-log.tsv:4: found another row of experience 1 of w after its complete one",
        ),
        (
            &[0, 1, 5, 6],
            0,
            "warning: run/w/0-train/data-log.tsv:4: found experience 5 after 1, expected 2; numbers without a row: 3",
        ),
    ] {
        write(&log.join("w/0-train/data-log.tsv"), &rows(numbers));
        for command in [
            "logs validate run",
            "metrics run --no-save",
            "report run -o page.html",
            "logs aggregate run -o - --format csv",
            "metrics run --ste run --no-save",
        ] {
            let (_, error) = run(base.path(), code, command);
            assert!(error.contains(message), "{command}: {error}");
        }
    }
}

#[test]
fn budgets_leave_numbers_unused_without_a_warning() {
    let base = scratch();
    let log = base.path().join("run");
    let learns = |mix: &str| {
        let regime =
            |name: &str| json!({ "task": "find_objects", "variant": name, "count": 9, "steps": 25, "max_steps": 10 });
        json!({ "type": "learning", "mix": mix, "regimes": [regime("blue"), regime("red")] })
    };
    let scenario = json!({ "name": "budget", "blocks": [learns("in_order"), learns("shuffled"), learns("in_order")] });
    write(&base.path().join("budget.json"), &scenario.to_string());
    run(base.path(), 0, "run budget.json --agent random -o run");
    let (out, error) = run(base.path(), 0, "logs validate run");
    assert_eq!(error, "");
    assert!(out.contains("3 blocks"), "{out}");
    // A row that is lost in the middle of a regime is still reported as missing.
    let path = log.join("worker-default/0-train/data-log.tsv");
    let text = fs::read_to_string(&path).expect("it was written");
    let rows: Vec<&str> = text.lines().collect();
    write(&path, &(rows[..2].join("\n") + "\n" + &rows[3..].join("\n") + "\n"));
    let (_, error) = run(base.path(), 0, "logs validate run");
    assert!(error.contains("numbers without a row: 1"), "{error}");
}

#[test]
fn every_problem_of_every_log_is_located() {
    let base = scratch();
    write_log(&base.path().join("logs/good"));
    let bad = base.path().join("logs/bad");
    write_log(&bad);
    let rows = "0\t0\tw\ttrain\twake\ta_b\t{}\tcomplete\t20200101T000000.0\t1\tok\n\
                0\tx\tw\ttrain\twake\ta_b\t{}\tcomplete\tnow\t1\t\n0\t1\n";
    write(&bad.join("w/0-train/data-log.tsv"), &(HEADER.to_owned() + rows));
    let version = base.path().join("logs/version");
    write_log(&version);
    write(
        &version.join("logger_info.json"),
        r#"{"metrics_columns": ["reward"], "log_format_version": "2.0"}"#,
    );

    let (out, error) = run(base.path(), 1, "logs validate --recursive logs");
    let lines: Vec<&str> = error.lines().collect();
    let file = "logs/bad/w/0-train/data-log.tsv";
    assert_eq!(lines.len(), 5, "{error}");
    assert_eq!(
        lines[0],
        format!("{file}:3, column exp_num: found \"x\", expected a whole number, 0 or more")
    );
    assert!(
        lines[1].starts_with(&format!("{file}:3, column timestamp: found \"now\"")),
        "{error}"
    );
    assert!(
        lines[2].starts_with(&format!("{file}:4: found 2 cells, expected 11")),
        "{error}"
    );
    assert!(
        lines[3].starts_with("logs/version: logger_info.json, log_format_version"),
        "{error}"
    );
    assert_eq!(lines[4], "error: 2 of 3 logs have problems");
    out.says("logs/bad: 3 problems;");
    out.says("logs/good: valid;");

    let (out, _) = run(base.path(), 1, "logs validate -R logs --json");
    let found: serde_json::Value = serde_json::from_str(&out).expect("it is JSON");
    let valid: Vec<_> = found
        .as_array()
        .into_iter()
        .flatten()
        .map(|log| &log["valid"])
        .collect();
    assert_eq!(valid, [false, true, false]);
    assert_eq!(found[0]["problems"][0]["code"], "metrics/cell");
    assert_eq!(found[1]["rows"], 3);
}

const COLUMNS: &str = "block_num,regime_num,exp_num,worker_id,block_type,block_subtype,task_name,task_params,exp_status,timestamp,debug,reward";

#[test]
fn rows_are_written_as_text_under_l2loggers_columns() {
    let base = scratch();
    write_log(&base.path().join("run"));
    let (out, _) = run(base.path(), 0, "logs aggregate run -o table.csv");
    assert_eq!(out, "wrote table.csv (2 rows of 1 log)\n");
    let text = fs::read_to_string(base.path().join("table.csv")).expect("it was written");
    let expected = format!(
        "{COLUMNS}\n0,0,0,w,train,wake,a_b,\"{{\"\"size\"\": 0.1}}\",complete,20200101T000001.250000,\"a, b\",0.1\n\
         1,1,1,w,test,wake,a_b,{{}},complete,20200101T000002.000000,,\n"
    );
    assert_eq!(text, expected);
    let (out, _) = run(base.path(), 0, "logs aggregate run --incomplete --format tsv -o -");
    assert_eq!(out.lines().count(), 4);
    assert_eq!(
        out.lines().next().map(|header| header.replace('\t', ",")).as_deref(),
        Some(COLUMNS)
    );
}

#[test]
fn several_logs_make_one_table_with_their_names() {
    let base = scratch();
    write_log(&base.path().join("logs/one"));
    write_log(&base.path().join("logs/two"));
    run(base.path(), 0, "logs aggregate -R logs -o all.tsv");
    let text = fs::read_to_string(base.path().join("all.tsv")).expect("it was written");
    let first: Vec<&str> = text.lines().filter_map(|line| line.split('\t').next()).collect();
    assert_eq!(first, ["run_id", "one", "one", "two", "two"]);
    // `driftworld run -o` often writes logs in this way: into separate folders, all with the same name.
    write_log(&base.path().join("runs/x/log"));
    write_log(&base.path().join("runs/y/log"));
    let (out, _) = run(base.path(), 0, "logs aggregate -R runs --format tsv -o -");
    let first: Vec<&str> = out.lines().filter_map(|line| line.split('\t').next()).collect();
    assert_eq!(first, ["run_id", "x/log", "x/log", "y/log", "y/log"]);
}
