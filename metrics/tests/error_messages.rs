//! Every error with its code and its message, as a snapshot; fails if one is missing.

use std::io;
use std::path::PathBuf;

use driftworld_metrics::{LogLine, MetricsError};
use strum::VariantNames;

fn path() -> PathBuf {
    PathBuf::from("run/w/0-train/data-log.tsv")
}

fn at(line: u64) -> LogLine {
    LogLine { path: path(), line }
}

/// One error of each variant, in declaration order.
#[expect(clippy::too_many_lines, reason = "a flat table")]
fn all() -> Vec<MetricsError> {
    use MetricsError as E;
    let text = str::to_owned;
    vec![
        E::Io {
            path: path(),
            doing: "open this file",
            source: io::Error::other("no permission"),
        },
        E::LogExists("run".into()),
        E::InUse("run".into()),
        E::FolderLost {
            path: "run".into(),
            found: "no directory",
            rows: 12,
            bytes: 3456,
        },
        E::FileLost {
            path: path(),
            found: "3 rows in 900 bytes".to_owned(),
            rows: 12,
            bytes: 3456,
        },
        E::InfoFileChanged {
            path: path(),
            found: 3,
            expected: 210,
        },
        E::NotADirectory {
            path: "run".into(),
            found: "nothing",
        },
        E::NoDataFiles("run".into()),
        E::MissingFile {
            path: "run/logger_info.json".into(),
            expected: "a JSON object",
        },
        E::NotAFile {
            path: path(),
            found: "a named pipe",
        },
        E::Json {
            path: "i.json".into(),
            line: 1,
            column: 2,
            wrong: text("not valid JSON: EOF"),
        },
        E::LoggerInfo {
            field: "metrics_columns",
            found: text("[]"),
            expected: "a name",
        },
        E::TooLarge {
            path: path(),
            what: "bytes",
            found: 9,
            limit: 8,
        },
        E::EmptyFile(path()),
        E::NoHeader {
            path: path(),
            found: text("0 0 worker-default"),
        },
        E::NoTabs {
            path: path(),
            found: text("\"block_num,exp_num\""),
        },
        E::MissingColumn {
            path: path(),
            column: text("reward"),
            found: text("block_num, exp_num"),
        },
        E::RepeatedColumn {
            path: path(),
            column: text("reward"),
        },
        E::OtherColumns {
            path: path(),
            found: text("a, b"),
            expected: text("a, c"),
        },
        E::RaggedRow {
            at: at(3),
            found: 2,
            expected: 9,
        },
        E::Cell {
            at: at(3),
            column: text("reward"),
            found: text("\"x\""),
            expected: text("a number"),
        },
        E::TornLastLine(at(3)),
        E::CarriageReturns(at(1)),
        E::OpenQuote(at(7)),
        E::NotUtf8(at(3)),
        E::BlockOrder {
            at: at(3),
            found: 0,
            expected: 1,
        },
        E::NumberFalls {
            at: at(7),
            column: "exp_num",
            found: 2,
            expected: 3,
        },
        E::ColumnsDiffer {
            path: path(),
            found: text("a, b"),
            expected: text("a, c"),
            first: "run/v/0-train/data-log.tsv".into(),
        },
        E::NotCompleted {
            at: at(7),
            exp_num: 2,
            worker: text("w"),
        },
        E::RowAfterComplete {
            at: at(7),
            exp_num: 2,
            worker: text("w"),
        },
        E::Record {
            exp_num: 4,
            field: text("reward"),
            found: text("inf"),
            expected: text("a finite number"),
        },
        E::Timestamp(text("\"now\"")),
        E::UnknownWord {
            what: "transfer",
            found: text("sum"),
            expected: text("ratio, contrast, both"),
        },
        E::TableColumn {
            run_id: text("run"),
            column: text("regime_num"),
        },
        E::UnknownColumn {
            run_id: text("run"),
            column: text("score"),
            available: text("reward"),
        },
        E::NoUsableRows {
            run_id: text("run"),
            column: text("reward"),
        },
        E::NotSingleTask {
            run_id: text("run"),
            found: text("a_1, b_1"),
        },
        E::NoSteData {
            path: "data".into(),
            found: "nothing",
        },
        E::StePickle("data/taskinfo/a_1.pickle".into()),
        E::TooManyRegimes {
            run_id: text("run"),
            limit: 10_000,
        },
        E::PerformanceOutOfRange {
            run_id: text("run"),
            task: text("a_1"),
            found: 1e200,
            after: "as logged",
        },
        E::Metric {
            metric: text("energy"),
            run_id: text("run"),
            source: "found no column energy, expected one".into(),
        },
        E::Scores {
            place: text("the table"),
            found: text("more than 10000 runs"),
            expected: text("at most 10000"),
        },
        E::BadOption {
            option: "window_length",
            found: text("0"),
            expected: text("1 to 10000 experiences"),
        },
    ]
}

#[test]
fn every_error_has_its_message_and_its_code() {
    let listed: Vec<&str> = all().iter().map(MetricsError::code).collect();
    assert_eq!(listed, MetricsError::VARIANTS, "one entry per variant, in order");
    let line = |error: &MetricsError| format!("{}: {error}", error.code());
    insta::assert_snapshot!(all().iter().map(line).collect::<Vec<_>>().join("\n"));
}
