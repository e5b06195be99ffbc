//! Fuzz target for logs with any contents: writing, reading, scoring and resuming.

use std::fs;
use std::path::Path;

use driftworld_metrics::{
    AggregationMethod, Log, LogWriter, LoggerInfo, MaintenanceMethod, NormalizationMethod, Options, Row,
    SmoothingMethod, SteAveragingMethod, SteLog, TransferMethod, VariantMode, read_log, read_log_with_texts, score,
    validate_log,
};

/// Separates the files of a log in the input.
const SEPARATOR: &[u8] = b"\n%%\n";

/// The files in the order of the input; `%` marks a missing one.
const FILES: [&str; 4] = [
    "logger_info.json",
    "scenario_info.json",
    "v/0-train/data-log.tsv",
    "w/0-train/data-log.tsv",
];

/// Writes the log that the bytes describe, and checks all properties.
pub(crate) fn check(bytes: &[u8]) {
    let base = tempfile::tempdir().expect("a temporary folder can be created");
    let dir = base.path().join("log");
    write_files(&dir, bytes);
    let valid = validate_log(&dir).is_valid();
    let log = match read_log(&dir) {
        Ok(log) => {
            check_reading_with_texts(&dir, &log);
            check_scores(&log);
            check_writing(&base.path().join("copy"), &log);
            Some(log)
        }
        Err(error) => {
            assert!(!valid, "a valid log can be read: {error}");
            assert!(!error.to_string().is_empty());
            None
        }
    };
    check_resuming(&dir, log.as_ref());
}

pub(crate) fn write_files(dir: &Path, bytes: &[u8]) {
    let mut rest = bytes;
    for name in FILES {
        let end = rest.windows(SEPARATOR.len()).position(|part| part == SEPARATOR);
        let (text, after) = match end {
            Some(end) => (&rest[..end], &rest[end + SEPARATOR.len()..]),
            None => (rest, &b"%"[..]),
        };
        rest = after;
        let path = dir.join(name);
        fs::create_dir_all(path.parent().expect("the path has a parent folder")).expect("the folder can be created");
        if text != b"%" {
            fs::write(path, text).expect("the file can be written");
        }
    }
}

fn check_reading_with_texts(dir: &Path, log: &Log) {
    let whole = read_log_with_texts(dir).expect("reading texts causes no error");
    assert!(
        whole.rows.iter().map(shown).eq(log.rows.iter().map(shown)),
        "reading texts changes nothing else"
    );
    let order = |row: Row<'_>| (row.exp_num(), row.block_num());
    assert!(
        log.rows
            .iter()
            .zip(log.rows.iter().skip(1))
            .all(|(a, b)| order(a) <= order(b))
    );
    assert!(
        log.rows
            .iter()
            .eq(read_log(dir).expect("the log was readable before").rows.iter())
    );
}

/// A row as text that is equal for equal rows: all NaNs are equal, and the order of columns does not matter.
fn shown(row: Row<'_>) -> String {
    let mut record = row.to_record();
    record.metrics.sort_keys();
    format!("{record:?}")
}

fn sorted_rows(log: &Log) -> Vec<String> {
    let mut rows: Vec<String> = log.rows.iter().map(shown).collect();
    rows.sort();
    rows
}

/// Scores are finite or missing; a missing score comes with a reason.
fn check_scores(log: &Log) {
    let experts: Vec<SteLog> = SteLog::new(log.clone()).into_iter().collect();
    let mut choices = vec![Options::default(); 3];
    choices[1].variant_mode = VariantMode::Agnostic;
    choices[1].smoothing_method = SmoothingMethod::Hanning;
    choices[1].window_length = Some(3);
    choices[1].clamp_outliers = true;
    choices[1].transfer_method = TransferMethod::Both;
    choices[1].maintenance_method = MaintenanceMethod::Both;
    choices[1].ste_averaging_method = SteAveragingMethod::Time;
    choices[2].normalization_method = NormalizationMethod::Off;
    choices[2].aggregation_method = AggregationMethod::Median;
    choices[2].smooth_eval_data = true;
    for mut options in choices {
        for column in log.logger_info.metrics_columns() {
            options.perf_measure.clone_from(column);
            match score(log, &experts, &options) {
                Ok(metrics) => {
                    let numbers = without_quoted(&format!("{metrics:?}"));
                    assert!(!numbers.contains("NaN") && !numbers.contains("inf,"), "{numbers}");
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
}

/// The text with its quoted parts removed.
fn without_quoted(text: &str) -> String {
    let mut found = String::new();
    let (mut quoted, mut escaped) = (false, false);
    for c in text.chars() {
        match c {
            _ if escaped => escaped = false,
            '\\' if quoted => escaped = true,
            '"' => quoted = !quoted,
            _ if !quoted => found.push(c),
            _ => {}
        }
    }
    found
}

/// A log whose rows follow the writer's rules can be written, and reads back the same.
fn check_writing(dir: &Path, log: &Log) {
    let info = LoggerInfo::new(log.logger_info.metrics_columns()).expect("the columns come from a valid log");
    let mut writer = LogWriter::create(dir, &info, &log.scenario_info).expect("the folder is new");
    for row in log.rows.iter() {
        if writer.write(&row.to_record()).is_err() {
            return;
        }
    }
    writer.finish().expect("the log can be written");
    if log.rows.is_empty() {
        return;
    }
    let copy = read_log(dir).expect("a written log can be read");
    assert_eq!(sorted_rows(&copy), sorted_rows(log));
    for problem in validate_log(dir).problems {
        assert_eq!(
            problem.code(),
            "metrics/not-completed",
            "a written log is valid: {problem}"
        );
    }
    LogWriter::resume(dir).expect("a written log can be resumed");
}

/// A resumed log can be read, and keeps everything that could be read before.
fn check_resuming(dir: &Path, log: Option<&Log>) {
    if LogWriter::resume(dir).is_err() {
        return;
    }
    match read_log(dir) {
        Ok(after) => assert!(log.is_none_or(|log| log.rows == after.rows)),
        Err(error) => assert!(
            error.code() == "metrics/no-data-files"
                || error.code() == "metrics/json"
                || error.code() == "metrics/block-order",
            "a repaired log can be read: {error}"
        ),
    }
}
