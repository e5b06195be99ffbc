//! Every error with its exact message and code; fails when one is missing.
//!
//! Not here: what leads to them, see `broken_logs` and `log_round_trip`.

use std::io;
use std::path::PathBuf;

use driftworld_metrics::MetricsError;
use strum::VariantNames;

fn path() -> PathBuf {
    PathBuf::from("run/w/0-train/data-log.tsv")
}

/// One of each, in the order of their declaration.
#[expect(clippy::too_many_lines, reason = "a flat table")]
fn all() -> Vec<(MetricsError, &'static str, &'static str)> {
    use MetricsError as E;
    let text = str::to_owned;
    let mut errors = vec![
        (
            E::Io {
                path: path(),
                doing: "open this file",
                source: io::Error::other("no permission"),
            },
            "metrics/io",
            "run/w/0-train/data-log.tsv: cannot open this file: no permission",
        ),
        (
            E::LogExists { path: "run".into() },
            "metrics/log-exists",
            "run: found a directory that is not empty, expected a new or an empty one; choose another name, or \
             continue its log with LogWriter::resume",
        ),
        (
            E::InUse { path: "run".into() },
            "metrics/in-use",
            "run: found a log that another run is writing, expected one not in use; wait for that run, or choose \
             another name",
        ),
        (
            E::FolderLost {
                path: "run".into(),
                found: "no directory",
                rows: 12,
                bytes: 3456,
            },
            "metrics/folder-lost",
            "run: found no directory, expected the directory of this log: it was removed, renamed or replaced during the run, and with it 12 rows in 3456 bytes; put it back and continue the log, or start a new one",
        ),
        (
            E::FileLost {
                path: path(),
                found: "3 rows in 900 bytes".to_owned(),
                rows: 12,
                bytes: 3456,
            },
            "metrics/file-lost",
            "run/w/0-train/data-log.tsv: found 3 rows in 900 bytes, expected the 12 rows in 3456 bytes that were \
             written: it was truncated, removed or replaced during the run; put it back and continue the log, or \
             start a new one; a log that lacks only its last rows can be continued as it is",
        ),
        (
            E::InfoFileChanged {
                path: path(),
                found: 3,
                expected: 210,
            },
            "metrics/info-file-changed",
            "run/w/0-train/data-log.tsv: found 3 bytes, expected the 210 bytes that this log was started with; put the file back: without it, the rows cannot be read",
        ),
        (
            E::NotADirectory {
                path: "run".into(),
                found: "nothing",
            },
            "metrics/not-a-directory",
            "run: found nothing, expected the directory of a log, which holds logger_info.json",
        ),
        (
            E::NoDataFiles { path: "run".into() },
            "metrics/no-data-files",
            "run: found no data-log.tsv, expected at least one as WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv; is this the \
             directory of one log, and has its run begun?",
        ),
        (
            E::MissingFile {
                path: "run/logger_info.json".into(),
                expected: "a JSON object",
            },
            "metrics/missing-file",
            "run/logger_info.json: found no such file, expected a JSON object",
        ),
        (
            E::NotAFile {
                path: path(),
                found: "a named pipe",
            },
            "metrics/not-a-file",
            "run/w/0-train/data-log.tsv: found a named pipe, expected a file; put the file in its place, or remove it",
        ),
        (
            E::Json {
                path: "i.json".into(),
                line: 1,
                column: 2,
                found: text("EOF"),
                expected: "a JSON object",
            },
            "metrics/json",
            "i.json:1:2: found EOF, expected a JSON object",
        ),
        (
            E::LoggerInfo {
                field: "metrics_columns",
                found: text("[]"),
                expected: "a name",
            },
            "metrics/logger-info",
            "logger_info.json, metrics_columns: found [], expected a name",
        ),
        (
            E::TooLarge {
                path: path(),
                what: "bytes",
                found: 9,
                limit: 8,
            },
            "metrics/too-large",
            "run/w/0-train/data-log.tsv: found 9 bytes, expected at most 8",
        ),
        (
            E::EmptyFile { path: path() },
            "metrics/empty-file",
            "run/w/0-train/data-log.tsv:1: found an empty file, expected a header line that begins with block_num",
        ),
        (
            E::NoHeader {
                path: path(),
                found: text("0 0 worker-default"),
            },
            "metrics/no-header",
            "run/w/0-train/data-log.tsv:1: found \"0 0 worker-default\", which has none of the standard columns, \
             expected a \
             header line that begins with block_num",
        ),
        (
            E::NoTabs {
                path: path(),
                found: text("\"block_num,exp_num\""),
            },
            "metrics/no-tabs",
            "run/w/0-train/data-log.tsv:1: found the header \"block_num,exp_num\" without a tab, expected a tab \
             between columns",
        ),
        (
            E::MissingColumn {
                path: path(),
                column: text("reward"),
                found: text("block_num, exp_num"),
            },
            "metrics/missing-column",
            "run/w/0-train/data-log.tsv:1: found the columns block_num, exp_num, expected also reward",
        ),
        (
            E::RepeatedColumn {
                path: path(),
                column: text("reward"),
            },
            "metrics/repeated-column",
            "run/w/0-train/data-log.tsv:1: found the column reward twice, expected every column once",
        ),
        (
            E::OtherColumns {
                path: path(),
                found: text("a, b"),
                expected: text("a, c"),
            },
            "metrics/other-columns",
            "run/w/0-train/data-log.tsv:1: found the columns a, b, expected a, c to continue this log; only logs of \
             format 1.1 written by one writer can be continued; start a new one",
        ),
    ];
    errors.extend(of_rows());
    errors.extend(of_order());
    errors.extend(of_scoring());
    errors
}

fn of_rows() -> Vec<(MetricsError, &'static str, &'static str)> {
    use MetricsError as E;
    let text = str::to_owned;
    vec![
        (
            E::RaggedRow {
                path: path(),
                line: 3,
                found: 2,
                expected: 9,
            },
            "metrics/ragged-row",
            "run/w/0-train/data-log.tsv:3: found 2 cells, expected 9 as in the header; is a tab or a quote missing?",
        ),
        (
            E::Cell {
                path: path(),
                line: 3,
                column: text("reward"),
                found: text("\"x\""),
                expected: text("a number"),
            },
            "metrics/cell",
            "run/w/0-train/data-log.tsv:3, column reward: found \"x\", expected a number",
        ),
        (
            E::TornLastLine { path: path(), line: 3 },
            "metrics/torn-last-line",
            "run/w/0-train/data-log.tsv:3: found a last line without a line end, expected complete rows; its writer \
             was interrupted: delete that line, or continue the log, which deletes it (`driftworld run … --resume`, \
             LogWriter::resume)",
        ),
        (
            E::CarriageReturns { path: path(), line: 1 },
            "metrics/carriage-returns",
            "run/w/0-train/data-log.tsv:1: found lines that end in a lone carriage return, expected LF or CRLF; save \
             the file with such line ends",
        ),
        (
            E::OpenQuote { path: path(), line: 7 },
            "metrics/open-quote",
            "run/w/0-train/data-log.tsv:7: found a quote that opens a cell and is never closed, expected another at \
             the end of the cell; the rows after it were read as part of the cell",
        ),
        (
            E::NotUtf8 { path: path(), line: 3 },
            "metrics/not-utf8",
            "run/w/0-train/data-log.tsv:3: found bytes that are not UTF-8, expected text",
        ),
        (
            E::BlockOrder {
                path: path(),
                line: 3,
                found: 0,
                expected: 1,
            },
            "metrics/block-order",
            "run/w/0-train/data-log.tsv:3, column block_num: found 0, expected at least 1: in order of exp_num, block \
             numbers never decrease",
        ),
    ]
}

fn of_order() -> Vec<(MetricsError, &'static str, &'static str)> {
    use MetricsError as E;
    let text = str::to_owned;
    vec![
        (
            E::NumberFalls {
                path: path(),
                line: 7,
                column: "exp_num",
                found: 2,
                expected: 3,
            },
            "metrics/number-falls",
            "run/w/0-train/data-log.tsv:7, column exp_num: found 2, expected at least 3 as in the row above: numbers \
             never decrease",
        ),
        (
            E::ColumnsDiffer {
                path: path(),
                found: text("a, b"),
                expected: text("a, c"),
                first: "run/v/0-train/data-log.tsv".into(),
            },
            "metrics/columns-differ",
            "run/w/0-train/data-log.tsv:1: found the columns a, b, expected a, c as in run/v/0-train/data-log.tsv",
        ),
        (
            E::NotCompleted {
                path: path(),
                line: 7,
                exp_num: 2,
                worker: text("w"),
            },
            "metrics/not-completed",
            "run/w/0-train/data-log.tsv:7: found experience 2 of w without a complete row, expected exactly one: \
             it is not scored",
        ),
        (
            E::RowAfterComplete {
                path: path(),
                line: 7,
                exp_num: 2,
                worker: text("w"),
            },
            "metrics/row-after-complete",
            "run/w/0-train/data-log.tsv:7: found another row of experience 2 of w after its complete one, expected \
             the complete row to be the last: give the next experience a new number",
        ),
        (
            E::Record {
                exp_num: 4,
                field: text("reward"),
                found: text("inf"),
                expected: text("a finite number"),
            },
            "metrics/record",
            "record of experience 4, reward: found inf, expected a finite number",
        ),
        (
            E::Timestamp { found: text("\"now\"") },
            "metrics/timestamp",
            "timestamp: found \"now\", expected YYYYMMDDTHHMMSS.ffffff as in 20200913T122640.000000, on an existing \
             day",
        ),
    ]
}

#[expect(clippy::too_many_lines, reason = "a flat table")]
fn of_scoring() -> Vec<(MetricsError, &'static str, &'static str)> {
    use MetricsError as E;
    let text = str::to_owned;
    vec![
        (
            E::UnknownWord {
                what: "transfer",
                found: text("sum"),
                expected: text("ratio, contrast, both"),
            },
            "metrics/unknown-word",
            "transfer: found \"sum\", expected one of ratio, contrast, both",
        ),
        (
            E::TableColumn {
                run_id: text("run"),
                column: text("regime_num"),
            },
            "metrics/table-column",
            "log run: found a column regime_num of its own, expected another name: a table of logs has a column of \
             that name; \
             rename it in the log's files and in logger_info.json",
        ),
        (
            E::UnknownColumn {
                run_id: text("run"),
                column: text("score"),
                available: text("reward"),
            },
            "metrics/unknown-column",
            "log run: found no metrics column \"score\", expected one of reward",
        ),
        (
            E::NoUsableRows {
                run_id: text("run"),
                column: text("reward"),
            },
            "metrics/no-usable-rows",
            "log run: found no complete row with a number in column \"reward\", expected at least one",
        ),
        (
            E::NotSingleTask {
                run_id: text("run"),
                found: text("a_1, b_1"),
            },
            "metrics/not-single-task",
            "single-task expert log run: found a_1, b_1, expected exactly one trained task; take one log for \
             each task, or compare with an agent that ran the same blocks by --against, with floors and ceilings by --scales",
        ),
        (
            E::NoSteData {
                path: "data".into(),
                found: "nothing",
            },
            "metrics/no-ste-data",
            "data: found nothing, expected a folder of single-task experts as TASK/RUN/logger_info.json; store an \
             expert's log \
             there first",
        ),
        (
            E::StePickle {
                path: "data/taskinfo/a_1.pickle".into(),
            },
            "metrics/ste-pickle",
            "data/taskinfo/a_1.pickle: found a pickle of l2metrics, expected folders of logs: reading a pickle can \
             run code; store the original logs instead, and remove the pickle from this folder",
        ),
        (
            E::TooManyRegimes {
                run_id: text("run"),
                limit: 10_000,
            },
            "metrics/too-many-regimes",
            "log run: found more than 10000 regimes, expected at most that; do tasks alternate row by row?",
        ),
        (
            E::PerformanceOutOfRange {
                run_id: text("run"),
                task: text("a_1"),
                found: 1e200,
                after: "as logged",
            },
            "metrics/performance-out-of-range",
            "log run, task a_1: found a performance of 1e200 as logged, expected less than 1e100 in magnitude",
        ),
        (
            E::Metric {
                metric: text("energy"),
                run_id: text("run"),
                source: "found no column energy, expected one".into(),
            },
            "metrics/metric",
            "metric energy, log run: found no column energy, expected one",
        ),
        (
            E::Scores {
                place: text("the table"),
                found: text("more than 10000 runs"),
                expected: text("at most 10000"),
            },
            "metrics/scores",
            "scores, the table: found more than 10000 runs, expected at most 10000",
        ),
        (
            E::BadOption {
                option: "window_length",
                found: text("0"),
                expected: text("1 to 10000 experiences"),
            },
            "metrics/bad-option",
            "option window_length: found 0, expected 1 to 10000 experiences",
        ),
    ]
}

#[test]
fn every_error_has_its_message_and_its_code() {
    let listed: Vec<&str> = all().into_iter().map(|(_, code, _)| code).collect();
    assert_eq!(listed, MetricsError::VARIANTS, "one entry per variant, in order");
    for (error, code, message) in all() {
        assert_eq!(error.to_string(), message);
        assert_eq!(error.code(), code);
    }
}
