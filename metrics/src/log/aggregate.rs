//! Exports the rows of one or several logs as one text table for other programs.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::io::{self, Write};

use driftworld_text::Cells;
use serde::Deserialize;

use super::columns::{STANDARD_COLUMNS, delimited};
use super::record::ExpStatus;
use super::rows::Row;
use super::table::{MAX_CELLS, MAX_RECORDS};
use super::{Log, spaced_json};
use crate::MetricsError;

/// Columns that the table adds.
const ADDED: [&str; 2] = ["run_id", "regime_num"];

/// The rows of a log that a table includes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KeptRows {
    /// Rows that close an experience, as in l2logger.
    #[default]
    Complete,
    /// All rows.
    All,
}

/// The separator between the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub enum Delimiter {
    /// TSV.
    #[serde(rename = "tsv")]
    Tab,
    /// CSV.
    #[serde(rename = "csv")]
    Comma,
}

/// Rows of logs as one table, log after log, each in scoring order.
///
/// Corresponds to `python -m l2logger.aggregate`: the columns are `block_num`, `regime_num`, `exp_num`, the other standard columns,
/// then the log's own in alphabetical order. Task names are in lower case, and `regime_num` counts stretches of one block, type,
/// subtype and task from 0. Unlike l2logger, it puts the `block_subtype` of a log of format 1.0 in its usual position rather
/// than last, writes task parameters uniformly (one space after `:` and `,`, `{}` for none), writes whole numbers in metrics with `.0`,
/// and combines several logs in one table, with the log's name in the first column, `run_id`.
///
/// All logs together may have at most [`MAX_RECORDS`] rows, and at most [`MAX_CELLS`] cells in their own columns.
#[derive(Debug, Clone, Default)]
pub struct LogTable {
    kept: KeptRows,
    logs: Vec<Log>,
    num_rows: usize,
    own: BTreeSet<String>,
}

impl LogTable {
    /// A table without rows.
    pub fn new(kept: KeptRows) -> Self {
        Self {
            kept,
            ..Self::default()
        }
    }

    /// Adds the rows of a log. Read it with [`read_log_with_texts`](crate::read_log_with_texts) to include its text columns. A
    /// column that is missing in some logs has empty cells there.
    ///
    /// # Errors
    /// [`MetricsError::TableColumn`] if the log has a column `run_id` or `regime_num` of its own, [`MetricsError::TooLarge`] if
    /// the table would exceed its limits. The table is then unchanged.
    pub fn add(&mut self, log: Log) -> Result<(), MetricsError> {
        let num_rows = rows(&log, self.kept).count();
        self.check(&log, num_rows)?;
        self.num_rows += num_rows;
        self.own.extend(own_columns(&log).map(str::to_owned));
        self.logs.push(log);
        Ok(())
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.num_rows
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.num_rows == 0
    }

    /// Writes the table as text with a header line. Lines end with `\n`, cells are quoted if necessary, and text that looks like a
    /// formula is guarded unless raw cells are requested.
    ///
    /// # Errors
    /// I/O errors of the writer.
    pub fn write(&self, mut out: impl Write, delimiter: Delimiter, cells: Cells) -> io::Result<()> {
        let delimiter = match delimiter {
            Delimiter::Tab => b'\t',
            Delimiter::Comma => b',',
        };
        let mut write = |mut line: Vec<String>| {
            for cell in &mut line {
                if let Cow::Owned(guarded) = cells.cell(cell) {
                    *cell = guarded;
                }
            }
            out.write_all(&delimited(delimiter, &line))
        };
        let has_run_id = self.logs.len() > 1;
        let [run_id, regime_num] = ADDED;
        let [block_num, others @ ..] = STANDARD_COLUMNS;
        let names = has_run_id.then_some(run_id).into_iter();
        let names = names.chain([block_num, regime_num]).chain(others);
        write(
            names
                .chain(self.own.iter().map(String::as_str))
                .map(str::to_owned)
                .collect(),
        )?;
        for log in &self.logs {
            let params: Vec<String> = log
                .rows
                .task_params()
                .values()
                .iter()
                .map(|it| spaced_json(it))
                .collect();
            let mut regime_num = 0;
            let mut last = None;
            for row in rows(log, self.kept) {
                let task = row.task_name().to_lowercase();
                let regime = (row.block_num(), row.block_type(), row.block_subtype(), task.clone());
                regime_num += u64::from(last.as_ref().is_some_and(|last| *last != regime));
                last = Some(regime);
                let standard = [
                    row.block_num().to_string(),
                    regime_num.to_string(),
                    row.exp_num().to_string(),
                    row.worker_id().to_owned(),
                    row.block_type().name().to_owned(),
                    row.block_subtype().name().to_owned(),
                    task,
                    params[log.rows.task_params().ids()[row.index()] as usize].clone(),
                    row.exp_status().name().to_owned(),
                    row.timestamp().to_string(),
                ];
                let run_id = has_run_id.then(|| log.run_id.clone());
                let own = self.own.iter().map(|name| own_cell(row, name));
                write(run_id.into_iter().chain(standard).chain(own).collect())?;
            }
        }
        out.flush()
    }

    fn check(&self, log: &Log, num_rows: usize) -> Result<(), MetricsError> {
        if let Some(column) = own_columns(log).find(|name| ADDED.contains(name)) {
            return Err(MetricsError::TableColumn {
                run_id: log.run_id.clone(),
                column: column.to_owned(),
            });
        }
        let rows = (self.num_rows + num_rows) as u64;
        let new = own_columns(log).filter(|name| !self.own.contains(*name)).count();
        let cells = rows * (self.own.len() + new) as u64;
        for (what, found, limit) in [("rows", rows, MAX_RECORDS as u64), ("cells", cells, MAX_CELLS)] {
            if found > limit {
                return Err(MetricsError::too_large(
                    format!("table of logs up to {}", log.run_id),
                    what,
                    found,
                    limit,
                ));
            }
        }
        Ok(())
    }
}

fn rows(log: &Log, kept: KeptRows) -> impl Iterator<Item = Row<'_>> {
    let is_kept = move |row: &Row| kept == KeptRows::All || row.exp_status() == ExpStatus::Complete;
    log.rows.iter().filter(is_kept)
}

/// The columns of a log other than the standard ones.
fn own_columns(log: &Log) -> impl Iterator<Item = &str> {
    log.rows.metric_names().chain(log.rows.text_names())
}

/// A cell of a non-standard column: a text, or a number as the shortest string that reads back exactly; empty if missing.
fn own_cell(row: Row, name: &str) -> String {
    match row.metric(name) {
        Some(number) if number.is_nan() => String::new(),
        Some(number) => format!("{number:?}"),
        None => row.text(name).unwrap_or_default().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlockType, LoggerInfo, Record, ScenarioInfo, read_log_with_texts};

    const HEADER: &str = "block_num\texp_num\tworker_id\tblock_type\ttask_name\ttask_params\texp_status\ttimestamp";

    /// Reads a log of format 1.0 with these columns after the standard ones.
    fn log(name: &str, columns: &str, rows: &[&str]) -> Log {
        let base = tempfile::tempdir().unwrap();
        let dir = base.path().join(name);
        std::fs::create_dir_all(dir.join("w/0-train")).unwrap();
        std::fs::write(
            dir.join("logger_info.json"),
            r#"{"metrics_columns": ["reward"], "log_format_version": "1.0"}"#,
        )
        .unwrap();
        let text = format!("{HEADER}\t{columns}\n{}\n", rows.join("\n"));
        std::fs::write(dir.join("w/0-train/data-log.tsv"), text).unwrap();
        read_log_with_texts(&dir).unwrap()
    }

    fn text(table: &LogTable, delimiter: Delimiter) -> String {
        let mut bytes = Vec::new();
        table.write(&mut bytes, delimiter, Cells::Guarded).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    fn rows() -> Log {
        log(
            "one",
            "reward\tdebug",
            &[
                "0\t0\tw\ttrain\tA_x\t{}\tincomplete\t20200101T000000.0\t0.5\thm, \"so\"",
                "0\t0\tw\ttrain\tA_x\t\"{\"\"k\"\":1}\"\tcomplete\t20200101T000001.0\t1\tok",
                "0\t1\tw\ttrain\ta_X\t{}\tcomplete\t20200101T000002.5\tnan\t",
                "1\t2\tw\ttest\ta_x\t{}\tcomplete\t20200101T000003.0\t-2e-7\tok",
            ],
        )
    }

    #[test]
    fn table_matches_l2logger_columns_and_rows() {
        let mut table = LogTable::new(KeptRows::Complete);
        table.add(rows()).unwrap();
        let expected = "block_num\tregime_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\t\
                        debug\treward\n\
                        0\t0\t0\tw\ttrain\twake\ta_x\t\"{\"\"k\"\": 1}\"\tcomplete\t20200101T000001.000000\tok\t1.0\n\
                        0\t0\t1\tw\ttrain\twake\ta_x\t{}\tcomplete\t20200101T000002.500000\t\t\n\
                        1\t1\t2\tw\ttest\twake\ta_x\t{}\tcomplete\t20200101T000003.000000\tok\t-2e-7\n";
        assert_eq!(text(&table, Delimiter::Tab), expected);
    }

    #[test]
    fn all_rows_are_kept_on_request() {
        let mut table = LogTable::new(KeptRows::All);
        table.add(rows()).unwrap();
        assert_eq!(table.len(), 4);
        let csv = text(&table, Delimiter::Comma);
        let first = csv.lines().nth(1).unwrap();
        assert_eq!(
            first,
            "0,0,0,w,train,wake,a_x,{},incomplete,20200101T000000.000000,\"hm, \"\"so\"\"\",0.5"
        );
    }

    #[test]
    fn several_logs_are_labelled_and_missing_columns_filled() {
        let other = log(
            "two",
            "reward\tdebug\tsteps",
            &["7\t9\tv\ttrain\tb_y\t{}\tcomplete\t20200101T000000.0\t3\t12\t4"],
        );
        let mut table = LogTable::new(KeptRows::Complete);
        table.add(rows()).unwrap();
        table.add(other).unwrap();
        table.add(rows()).unwrap();
        let cells: Vec<Vec<String>> = text(&table, Delimiter::Comma)
            .lines()
            .map(|line| line.split(',').map(str::to_owned).collect())
            .collect();
        assert_eq!(cells[0][..3], ["run_id", "block_num", "regime_num"]);
        assert_eq!(cells[0][11..], ["debug", "reward", "steps"]);
        let column = |index: usize| cells[1..].iter().map(|row| row[index].as_str()).collect::<Vec<_>>();
        assert_eq!(column(0), ["one", "one", "one", "two", "one", "one", "one"]);
        assert_eq!(
            column(2),
            ["0", "0", "1", "0", "0", "0", "1"],
            "each log counts its own regimes"
        );
        assert_eq!(column(11), ["ok", "", "ok", "12.0", "ok", "", "ok"]);
        assert_eq!(column(13), ["", "", "", "4.0", "", "", ""]);
    }

    #[test]
    fn column_may_hold_numbers_in_one_log_and_text_in_another() {
        let row = "0\t0\tw\ttrain\ta_x\t{}\tcomplete\t20200101T000000.0\t1";
        let mut table = LogTable::new(KeptRows::Complete);
        for cell in ["2", "two"] {
            table
                .add(log("run", "reward\tnote", &[&format!("{row}\t{cell}")]))
                .unwrap();
        }
        let csv = text(&table, Delimiter::Comma);
        let notes: Vec<&str> = csv.lines().filter_map(|line| line.split(',').nth(11)).collect();
        assert_eq!(notes, ["note", "2.0", "two"]);
    }

    #[test]
    fn reserved_column_is_refused() {
        let row = "0\t0\tw\ttrain\ta_x\t{}\tcomplete\t20200101T000000.0\t1\t1";
        let mut table = LogTable::new(KeptRows::Complete);
        let error = table.add(log("run", "reward\tregime_num", &[row])).unwrap_err();
        assert_eq!(error.code(), "metrics/table-column");
        assert!(table.is_empty());
    }

    #[test]
    fn empty_table_has_only_a_header() {
        assert_eq!(text(&LogTable::default(), Delimiter::Comma).lines().count(), 1);
        let info = LoggerInfo::new(["reward"]).unwrap();
        let base = tempfile::tempdir().unwrap();
        let dir = base.path().join("log");
        let mut writer = crate::LogWriter::create(&dir, &info, &ScenarioInfo::default()).unwrap();
        let stamp = "20200101T000000.0".parse().unwrap();
        let record = Record::new(0, 0, BlockType::Train, "a_b", stamp).with_metric("reward", 1.0);
        let record = Record {
            exp_status: ExpStatus::Incomplete,
            ..record
        };
        writer.write(&record).unwrap();
        writer.finish().unwrap();
        let mut table = LogTable::new(KeptRows::Complete);
        table.add(read_log_with_texts(&dir).unwrap()).unwrap();
        assert!(table.is_empty());
        assert_eq!(text(&table, Delimiter::Tab).split('\t').count(), 11);
    }
}
