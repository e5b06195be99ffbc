//! Logs are read back as written: awkward strings and numbers, several workers, interrupted runs.

use std::fs;
use std::path::Path;

use driftworld_metrics::{
    BlockSubtype, BlockType, ExpStatus, LogWarning, LogWriter, LoggerInfo, Record, Row, ScenarioInfo, ScenarioType,
    Timestamp, read_log,
};
use proptest::prelude::*;

fn stamp(micros: i64) -> Timestamp {
    Timestamp::from_unix_micros(1_600_000_000_000_000 + micros).unwrap()
}

fn record(block_num: u64, exp_num: u64, block_type: BlockType) -> Record {
    Record::new(block_num, exp_num, block_type, "find_red", stamp(exp_num as i64)).with_metric("reward", 0.5)
}

fn info() -> LoggerInfo {
    LoggerInfo::new(["reward"]).unwrap()
}

fn create(dir: &Path) -> LogWriter {
    LogWriter::create(dir, &info(), &ScenarioInfo::default()).unwrap()
}

/// The rows of a log as records.
fn read_records(dir: &Path) -> Vec<Record> {
    read_log(dir).unwrap().rows.iter().map(Row::to_record).collect()
}

#[test]
fn bytes_follow_the_format() {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("walk-1600000000-5");
    let scenario = ScenarioInfo {
        scenario_type: Some(ScenarioType::Custom),
        ..ScenarioInfo::default()
    };
    let mut writer = LogWriter::create(&dir, &info(), &scenario).unwrap();
    let params = serde_json::Map::from_iter([("a".to_owned(), 1.into()), ("b".to_owned(), "x y".into())]);
    let first = record(0, 0, BlockType::Train)
        .with_task_params(params)
        .with_metric("Steps", 12.0);
    writer.write(&first).unwrap();
    writer
        .write(&record(1, 1, BlockType::Test).with_metric("Steps", f64::NAN))
        .unwrap();
    let read = |path: &str| fs::read_to_string(dir.join(path)).unwrap();
    let header = "block_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\tSteps\treward\n";
    let row = "0\t0\tworker-default\ttrain\twake\tfind_red\t\"{\"\"a\"\": 1, \"\"b\"\": \"\"x \
         y\"\"}\"\tcomplete\t20200913T122640.000000\t12.0\t0.5\n";
    assert_eq!(read("worker-default/0-train/data-log.tsv"), format!("{header}{row}"));
    let row = "1\t1\tworker-default\ttest\twake\tfind_red\t{}\tcomplete\t20200913T122640.000001\tnan\t0.5\n";
    assert_eq!(read("worker-default/1-test/data-log.tsv"), format!("{header}{row}"));
    assert_eq!(
        read("logger_info.json"),
        "{\n  \"metrics_columns\": [\n    \"reward\"\n  ],\n  \"log_format_version\": \"1.1\"\n}\n"
    );
    assert_eq!(read("scenario_info.json"), "{\n  \"scenario_type\": \"custom\"\n}\n");
    assert_eq!(fs::read_dir(&dir).unwrap().count(), 3, "no temporary file is left");
}

#[test]
fn record_can_be_read_as_soon_as_it_is_written() {
    let base = tempfile::tempdir().unwrap();
    let mut writer = create(base.path());
    for exp_num in 0..3 {
        writer.write(&record(0, exp_num, BlockType::Train)).unwrap();
        assert_eq!(read_log(base.path()).unwrap().rows.len() as u64, exp_num + 1);
    }
    writer.finish().unwrap();
}

#[test]
fn non_empty_directory_is_not_written_into() {
    let base = tempfile::tempdir().unwrap();
    create(base.path()).write(&record(0, 0, BlockType::Train)).unwrap();
    let error = LogWriter::create(base.path(), &info(), &ScenarioInfo::default()).unwrap_err();
    assert_eq!(
        error.to_string(),
        format!(
            "{}: found a directory that is not empty, expected a new or an empty one; choose another name, or \
             continue its log with LogWriter::resume",
            base.path().display()
        )
    );
    // Following the advice works.
    LogWriter::resume(base.path())
        .unwrap()
        .write(&record(0, 1, BlockType::Train))
        .unwrap();
    assert_eq!(read_log(base.path()).unwrap().rows.len(), 2);
}

#[test]
fn interrupted_log_is_continued_where_it_stopped() {
    let base = tempfile::tempdir().unwrap();
    let mut writer = create(base.path());
    writer.write(&record(2, 5, BlockType::Train)).unwrap();
    writer.write(&record(3, 6, BlockType::Test)).unwrap();
    drop(writer);
    let torn = base.path().join("worker-default/3-test/data-log.tsv");
    let whole = fs::read_to_string(&torn).unwrap();
    fs::write(&torn, format!("{whole}3\t7\tworker-def")).unwrap();
    assert_eq!(read_log(base.path()).unwrap_err().code(), "metrics/torn-last-line");

    let mut writer = LogWriter::resume(base.path()).unwrap();
    assert_eq!(fs::read_to_string(&torn).unwrap(), whole);
    let message = |writer: &mut LogWriter, record: &Record| writer.write(record).unwrap_err().to_string();
    assert_eq!(
        message(&mut writer, &record(2, 7, BlockType::Train)),
        "record of experience 7, block_num: found 2, expected at least 3, the previous number: numbers never decrease"
    );
    assert_eq!(
        message(&mut writer, &record(3, 6, BlockType::Test)),
        "record of experience 6, exp_num: found another row by worker-default, expected no row after the complete \
         one: give the next experience a new number"
    );
    assert_eq!(
        message(&mut writer, &record(3, 7, BlockType::Test).with_metric("steps", 1.0)),
        "record of experience 7, metrics: found reward, steps, expected reward as in the first record"
    );
    writer.write(&record(3, 7, BlockType::Test)).unwrap();
    let log = read_log(base.path()).unwrap();
    assert_eq!(log.rows.exp_nums(), [5, 6, 7]);
}

#[test]
fn rows_of_an_experience_are_in_one_block() {
    let base = tempfile::tempdir().unwrap();
    let begun = Record {
        exp_status: ExpStatus::Incomplete,
        ..record(4, 8, BlockType::Train)
    };
    create(base.path()).write(&begun).unwrap();
    let mut writer = LogWriter::resume(base.path()).unwrap();
    assert_eq!(
        writer.write(&record(4, 8, BlockType::Test)).unwrap_err().to_string(),
        "record of experience 8, block_type: found test, expected train, as in the previous row of this experience"
    );
    writer.write(&record(4, 8, BlockType::Train)).unwrap();
    // The next experience may be in a block of a different type.
    writer.write(&record(4, 9, BlockType::Test)).unwrap();
    assert_eq!(read_log(base.path()).unwrap().rows.exp_nums(), [8, 8, 9]);
}

#[test]
fn log_torn_within_its_header_is_started_again() {
    let base = tempfile::tempdir().unwrap();
    drop(create(base.path()));
    let block = base.path().join("worker-default/0-train");
    fs::create_dir_all(&block).unwrap();
    fs::write(block.join("data-log.tsv"), "block_num\texp").unwrap();
    LogWriter::resume(base.path())
        .unwrap()
        .write(&record(0, 0, BlockType::Train))
        .unwrap();
    assert_eq!(read_records(base.path()), [record(0, 0, BlockType::Train)]);
}

#[test]
fn log_of_format_1_0_is_read_but_not_continued() {
    let base = tempfile::tempdir().unwrap();
    let block = base.path().join("w/0-train");
    fs::create_dir_all(&block).unwrap();
    fs::write(
        base.path().join("logger_info.json"),
        r#"{"metrics_columns": ["reward"]}"#,
    )
    .unwrap();
    let text = "block_num\texp_num\tworker_id\tblock_type\ttask_name\ttask_params\texp_status\ttimestamp\treward\r\n\
                0\t0\tw\ttrain\tA\t{}\tcomplete\t20200913T122640.0\t1\r\n";
    fs::write(block.join("data-log.tsv"), text).unwrap();
    let log = read_log(base.path()).unwrap();
    assert_eq!(
        (log.rows.block_subtypes()[0], log.rows.metric("reward").unwrap()[0]),
        (BlockSubtype::Wake, 1.0)
    );
    assert_eq!(
        log.warnings,
        [
            LogWarning::NoScenarioInfo,
            LogWarning::TaskName { found: "A".to_owned() }
        ]
    );
    assert_eq!(
        LogWriter::resume(base.path()).unwrap_err().code(),
        "metrics/other-columns"
    );
}

#[test]
fn workers_are_merged_in_the_order_of_experiences() {
    let base = tempfile::tempdir().unwrap();
    let mut writer = create(base.path());
    for exp_num in 0..6 {
        let worker = if exp_num % 2 == 0 { "b.0" } else { "a-1" };
        writer
            .write(&record(exp_num / 3, exp_num, BlockType::Train).with_worker(worker))
            .unwrap();
    }
    // Two workers may complete an experience of the same number.
    writer.write(&record(1, 5, BlockType::Train).with_worker("c")).unwrap();
    let log = read_log(base.path()).unwrap();
    let found: Vec<_> = log.rows.iter().map(|row| (row.exp_num(), row.worker_id())).collect();
    assert_eq!(
        found,
        [
            (0, "b.0"),
            (1, "a-1"),
            (2, "b.0"),
            (3, "a-1"),
            (4, "b.0"),
            (5, "a-1"),
            (5, "c")
        ]
    );
}

#[test]
fn invalid_records_are_refused_and_nothing_is_written() {
    let base = tempfile::tempdir().unwrap();
    let mut writer = create(base.path());
    let mut check = |record: Record, expected: &str| {
        assert_eq!(writer.write(&record).unwrap_err().to_string(), expected);
    };
    check(
        record(0, 4, BlockType::Train).with_worker("../up"),
        "record of experience 4, worker_id: found \"../up\", expected letters, digits, _, - and ., not only dots",
    );
    check(
        Record::new(0, 4, BlockType::Train, "a_b", stamp(0)),
        "record of experience 4, metrics: found none, expected them to include reward, a metrics column of the log",
    );
    check(
        record(0, 4, BlockType::Train).with_metric("reward", f64::INFINITY),
        "record of experience 4, reward: found inf, expected a finite number, or NaN for a missing one",
    );
    check(
        record(0, 4, BlockType::Train).with_metric("exp_num", 1.0),
        "record of experience 4, metrics: found \"exp_num\", expected a non-empty name that is not a standard \
         column's",
    );
    assert_eq!(
        fs::read_dir(base.path()).unwrap().count(),
        2,
        "only the info files are there"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn no_file_makes_the_reader_panic(text in "([0-9a-z\t\"{}:.]|\n){0,80}", with_header in any::<bool>()) {
        let base = tempfile::tempdir().unwrap();
        create(base.path()).write(&record(0, 0, BlockType::Train)).unwrap();
        let path = base.path().join("worker-default/0-train/data-log.tsv");
        let header = fs::read_to_string(&path).unwrap();
        fs::write(&path, if with_header { header + &text } else { text }).unwrap();
        let _ = read_log(base.path());
        let _ = LogWriter::resume(base.path());
    }
}
