//! Unreadable logs, each with the exact message that a user sees.

use std::fs;
use std::path::Path;

use driftworld_metrics::{LogWriter, MetricsError, Options, read_log, read_ste_log, score};

const HEADER: &str =
    "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\treward\n";
const ROW: &str = "0\t0\tw\ttrain\twake\ta_b\t{}\tcomplete\t20200913T122640.0\t1\n";

/// A log with one data file.
fn write_log(dir: &Path, data: impl AsRef<[u8]>) {
    fs::create_dir_all(dir.join("w/0-train")).unwrap();
    fs::write(
        dir.join("logger_info.json"),
        r#"{"metrics_columns": ["reward"], "log_format_version": "1.1"}"#,
    )
    .unwrap();
    fs::write(dir.join("scenario_info.json"), "{}").unwrap();
    fs::write(dir.join("w/0-train/data-log.tsv"), data).unwrap();
}

/// The message without the directory, and with `/` between directories.
fn message(dir: &Path, error: &MetricsError) -> String {
    error
        .to_string()
        .replace(&dir.display().to_string(), "LOG")
        .replace('\\', "/")
}

fn check(data: impl AsRef<[u8]>, code: &str, expected: &str) {
    let base = tempfile::tempdir().unwrap();
    write_log(base.path(), data);
    let error = read_log(base.path()).unwrap_err();
    assert_eq!(message(base.path(), &error), expected);
    assert_eq!(error.code(), code);
}

/// The valid row with one cell changed.
fn with_cell(index: usize, text: &str) -> String {
    let mut cells: Vec<&str> = ROW.trim_end().split('\t').collect();
    cells[index] = text;
    format!("{HEADER}{}\n", cells.join("\t"))
}

#[test]
fn header_without_tabs_is_one_problem() {
    let data = format!("{HEADER}{ROW}").replace('\t', ",");
    check(
        data,
        "metrics/no-tabs",
        "LOG/w/0-train/data-log.tsv:1: found the header \"block_num,exp_num,worker_id,block_type,block_subtype,task_na\"… without \
         a tab, expected a tab between columns",
    );
}

#[test]
fn bad_cell_is_named_with_the_expected_contents() {
    for row in r#"
0 | block_num | one | a whole number, 0 or more
1 | exp_num | -1 | a whole number, 0 or more
2 | worker_id | a b | a worker's name of letters, digits, _, - and .
1 | exp_num | 18446744073709551616 | a whole number of at most 18446744073709551615
3 | block_type | eval | one of train, test
4 | block_subtype | nap | one of wake, sleep
6 | task_params | [1] | a JSON object
6 | task_params | {"a": [1, NaN]} | a JSON object; not valid JSON: JSON has no NaN or Infinity; numbers are finite
7 | exp_status | done | one of complete, incomplete
8 | timestamp | 20200931T122640.0 | a time stamp as in 20200913T122640.000000
9 | reward | much | a finite number, or nothing for a missing one
9 | reward | 1e999 | a finite number, or nothing for a missing one"#
        .trim()
        .lines()
    {
        let [index, column, text, expected] = row.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        // `message` turns the backslashes that escape quotes into slashes.
        let found = text.replace('"', "/\"");
        let place = format!("LOG/w/0-train/data-log.tsv:2, column {column}");
        let message = format!("{place}: found \"{found}\", expected {expected}");
        check(with_cell(index.parse().unwrap(), text), "metrics/cell", &message);
    }
}

#[test]
fn malformed_table_is_refused_with_file_and_line() {
    check(
        "",
        "metrics/empty-file",
        "LOG/w/0-train/data-log.tsv:1: found an empty file, expected a header line that begins with block_num",
    );
    check(
        HEADER.replace("\treward", "\tscore"),
        "metrics/missing-column",
        "LOG/w/0-train/data-log.tsv:1: found the columns block_num, exp_num, worker_id, block_type, block_subtype, \
         task_name, task_params, exp_status, timestamp, score, expected reward as well",
    );
    check(
        HEADER.replace("exp_num\t", ""),
        "metrics/missing-column",
        "LOG/w/0-train/data-log.tsv:1: found the columns block_num, worker_id, block_type, block_subtype, \
         task_name, task_params, exp_status, timestamp, reward, expected exp_num as well",
    );
    check(
        HEADER.replace("exp_num", "block_num"),
        "metrics/repeated-column",
        "LOG/w/0-train/data-log.tsv:1: found the column block_num twice, expected every column once",
    );
    check(
        format!("{HEADER}{ROW}0\t1\tw\n"),
        "metrics/ragged-row",
        "LOG/w/0-train/data-log.tsv:3: found 3 cells, expected 10 as in the header; is a tab or a quote missing?",
    );
    check(
        format!("{HEADER}{ROW}0\t1\tw\ttra"),
        "metrics/torn-last-line",
        "LOG/w/0-train/data-log.tsv:3: found a last line without a line ending, expected complete rows; its writer was interrupted, or an editor omitted the line ending: add one if the line is complete; otherwise delete the line, or continue the log, which deletes it (`driftworld run … --resume`, LogWriter::resume)",
    );
    check(
        format!("{HEADER}{ROW}").replace('\n', "\r"),
        "metrics/carriage-returns",
        "LOG/w/0-train/data-log.tsv:1: found lines that end in a lone carriage return, expected LF or CRLF; save the \
         file with such line endings",
    );
    check(
        [HEADER.as_bytes(), b"0\t\xff\n"].concat(),
        "metrics/not-utf8",
        "LOG/w/0-train/data-log.tsv:2: found bytes that are not UTF-8, expected text",
    );
    check(
        format!(
            "{HEADER}{}{}",
            ROW.replacen("0\t0", "1\t0", 1),
            ROW.replacen("0\t0", "0\t1", 1)
        ),
        "metrics/block-order",
        "LOG/w/0-train/data-log.tsv:3, column block_num: found 0, expected at least 1: \
         in order of exp_num, block numbers never decrease",
    );
}

#[test]
fn line_numbers_are_right_for_any_line_endings_and_blank_lines() {
    let at_line = |data: String, line: u64| {
        let message = "expected a finite number, or nothing for a missing one";
        let place = format!("LOG/w/0-train/data-log.tsv:{line}, column reward: found \"much\", {message}");
        check(data, "metrics/cell", &place);
    };
    let bad = with_cell(9, "much").replace(HEADER, "");
    let two_lines = ROW.replace("a_b", "\"a\nb\"");
    at_line(format!("{HEADER}{ROW}{bad}"), 3);
    at_line(format!("{HEADER}{ROW}{bad}").replace('\n', "\r\n"), 3);
    at_line(format!("{HEADER}\n\n{ROW}\n{bad}"), 6);
    at_line(format!("{HEADER}{two_lines}{bad}{ROW}"), 4);
    at_line(format!("{HEADER}{two_lines}{bad}").replace('\n', "\r\n"), 4);
    at_line(format!("{HEADER}{}", bad.replace("a_b", "\"a\nb\"")), 2);
}

#[test]
fn advice_for_a_torn_last_line_works() {
    let base = tempfile::tempdir().unwrap();
    write_log(base.path(), format!("{HEADER}{ROW}0\t1\tw\ttra"));
    LogWriter::resume(base.path()).unwrap();
    assert_eq!(read_log(base.path()).unwrap().rows.len(), 1);
}

#[test]
fn directory_without_a_log_names_what_is_missing() {
    let base = tempfile::tempdir().unwrap();
    let check = |expected: &str| {
        let error = read_log(base.path()).unwrap_err();
        assert_eq!(message(base.path(), &error), expected);
    };
    check("LOG/logger_info.json: found no such file, expected a JSON object with the list metrics_columns");
    fs::write(base.path().join("logger_info.json"), "{\"metrics_columns\": [1]}").unwrap();
    check(
        "logger_info.json, metrics_columns: found [1], expected a list of at least one name, without duplicates \
         or standard columns",
    );
    fs::write(base.path().join("logger_info.json"), "{\"metrics_columns\"").unwrap();
    check(
        "LOG/logger_info.json:1:18: not valid JSON: EOF while parsing an object; the document ends too early, is it cut off?",
    );
    fs::write(
        base.path().join("logger_info.json"),
        "{\"metrics_columns\": [\"reward\"]}",
    )
    .unwrap();
    check(
        "LOG: found no data-log.tsv, expected at least one as WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv; \
         is this the directory of one log, and has its run begun?",
    );
}

#[test]
fn log_without_usable_rows_names_the_requested_column() {
    let base = tempfile::tempdir().unwrap();
    let run_id = base.path().file_name().unwrap().to_string_lossy().into_owned();
    let check = |data: String, column: &str, expected: &str| {
        write_log(base.path(), data);
        let log = read_log(base.path()).unwrap();
        let options = Options {
            perf_measure: column.to_owned(),
            ..Options::default()
        };
        let error = score(&log, &[], &options).unwrap_err().to_string();
        assert_eq!(error.strip_prefix(&format!("log {run_id}")).unwrap(), expected);
    };
    check(
        format!("{HEADER}{ROW}"),
        "score",
        ": found no metrics column \"score\", expected one of reward",
    );
    let none = ": found no complete row with a number in column \"reward\", expected at least one";
    check(HEADER.to_owned(), "reward", none);
    check(with_cell(9, "nan"), "reward", none);
    check(with_cell(7, "incomplete"), "reward", none);
    check(
        with_cell(9, "1e200"),
        "reward",
        ", task a_b: found a performance of 1e200 as logged, expected less than 1e100 in magnitude",
    );
}

#[test]
fn expert_must_train_exactly_one_task() {
    let base = tempfile::tempdir().unwrap();
    let run_id = base.path().file_name().unwrap().to_string_lossy().into_owned();
    let check = |data: String, expected: &str| {
        write_log(base.path(), data);
        let message = format!("single-task expert log {run_id}: found {expected}, expected exactly one trained task; ");
        let found = read_ste_log(base.path()).unwrap_err().to_string();
        assert!(found.starts_with(&message), "{found}");
    };
    check(with_cell(3, "test"), "no trained task");
    check(
        format!("{}{}", with_cell(5, "B_x"), ROW.replacen("0\t0", "0\t1", 1)),
        "b_x, a_b",
    );
    write_log(base.path(), with_cell(5, "Find_Red"));
    assert_eq!(read_ste_log(base.path()).unwrap().task_name(), "find_red");
}

#[test]
fn unscorable_expert_is_named_by_its_folder() {
    let base = tempfile::tempdir().unwrap();
    let (life, expert) = (base.path().join("life"), base.path().join("experts/log"));
    write_log(&life, format!("{HEADER}{ROW}"));
    write_log(&expert, with_cell(9, "nan"));
    let (life, experts) = (read_log(&life).unwrap(), [read_ste_log(&expert).unwrap()]);
    let error = score(&life, &experts, &Options::default()).unwrap_err();
    assert_eq!(
        message(base.path(), &error),
        "log LOG/experts/log: found no complete row with a number in column \"reward\", expected at least one"
    );
}

#[test]
fn too_many_regimes_from_alternating_tasks_are_refused() {
    let base = tempfile::tempdir().unwrap();
    let mut data = HEADER.to_owned();
    for exp_num in 0..=driftworld_metrics::MAX_REGIMES {
        let row = ROW.replacen("0\t0", &format!("0\t{exp_num}"), 1);
        data += &row.replace("a_b", ["a_1", "b_1"][exp_num % 2]);
    }
    write_log(base.path(), data);
    let error = score(&read_log(base.path()).unwrap(), &[], &Options::default()).unwrap_err();
    assert_eq!(error.code(), "metrics/too-many-regimes");
}

#[cfg(unix)]
#[test]
fn named_pipes_are_refused_without_blocking() {
    let base = tempfile::tempdir().unwrap();
    for name in ["logger_info.json", "scenario_info.json", "w/0-train/data-log.tsv"] {
        let dir = base.path().join(name.replace('/', "_"));
        write_log(&dir, [HEADER, ROW].concat());
        fs::remove_file(dir.join(name)).unwrap();
        let made = std::process::Command::new("mkfifo").arg(dir.join(name)).status();
        assert!(made.unwrap().success(), "{name}");
        let expected =
            format!("LOG/{name}: found a named pipe, expected a file; put the file in its place, or remove it");
        assert_eq!(message(&dir, &read_log(&dir).unwrap_err()), expected);
        let found = driftworld_metrics::validate_log(&dir);
        assert_eq!(message(&dir, &found.problems[0]), expected);
        if name != "scenario_info.json" {
            assert_eq!(message(&dir, &LogWriter::resume(&dir).unwrap_err()), expected);
        }
    }
}

#[cfg(unix)]
#[test]
fn linked_data_file_is_read_before_it_is_continued() {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("log");
    write_log(&dir, [HEADER, ROW].concat());
    let (file, target) = (dir.join("w/0-train/data-log.tsv"), base.path().join("kept.tsv"));
    fs::rename(&file, &target).unwrap();
    std::os::unix::fs::symlink("../../../kept.tsv", &file).unwrap();
    assert_eq!(read_log(&dir).unwrap().rows.len(), 1);
    let mut writer = LogWriter::resume(&dir).unwrap();
    let record = |exp_num: u64| {
        let stamp = driftworld_metrics::Timestamp::from_unix_micros(0).unwrap();
        let record = driftworld_metrics::Record::new(0, exp_num, driftworld_metrics::BlockType::Train, "a_b", stamp);
        record.with_worker("w").with_metric("reward", 1.0)
    };
    let again = writer.write(&record(0)).unwrap_err();
    assert_eq!(again.code(), "metrics/record", "experience 0 is known to be complete");
    writer.write(&record(1)).unwrap();
    writer.finish().unwrap();
    assert_eq!(fs::read_to_string(&target).unwrap().lines().count(), 3);
    assert_eq!(read_log(&dir).unwrap().rows.len(), 2);
}

#[test]
fn foreign_line_endings_are_not_cut_off_as_torn() {
    let base = tempfile::tempdir().unwrap();
    let text = [HEADER, ROW].concat().replace('\n', "\r");
    write_log(base.path(), &text);
    assert_eq!(
        LogWriter::resume(base.path()).unwrap_err().code(),
        "metrics/carriage-returns"
    );
    assert_eq!(
        fs::read_to_string(base.path().join("w/0-train/data-log.tsv")).unwrap(),
        text
    );
}
