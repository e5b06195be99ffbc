//! The rows of one log or several as one table, the form in which other programs take them, and that table as text.
//!
//! Not here: the table as Parquet or Arrow, which the facade writes from its columns.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::{self, Write};

use driftworld_text::Cells;

use super::columns::delimited;
use super::custom_column::{CustomColumn, number_text};
use super::dictionary_column::{DictionaryColumn, Keys};
use super::log_column::LogColumn;
use super::record::ExpStatus;
use super::rows::Row;
use super::table::{MAX_CELLS, MAX_RECORDS};
use super::text_column::TextColumn;
use super::timestamp::Timestamp;
use super::{Log, spaced_json};
use crate::MetricsError;

/// Columns of the table that no log has.
const ADDED: [&str; 2] = ["run_id", "regime_num"];

/// Which rows of a log come into a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KeptRows {
    /// Those that close an experience, as l2logger keeps them.
    #[default]
    Complete,
    /// All of them.
    All,
}

/// What stands between the cells of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delimiter {
    /// TSV.
    Tab,
    /// CSV.
    Comma,
}

/// Rows of logs as one table, log after log, each in the order in which it is scored.
///
/// Corresponds to `python -m l2logger.aggregate`: `block_num`, `regime_num`, `exp_num`, the other standard columns, then the log's
/// own in alphabetical order; task names in lower case; `regime_num` counts stretches of one block, subtype and task from 0. Unlike
/// there, `block_subtype` of a log of format 1.0 stands in its place and not last, task parameters are written alike (one space
/// behind `:` and `,`, `{}` for none), whole numbers of metrics have a `.0`, and several logs make one table, with the log's name in
/// the first column, `run_id`.
///
/// At most [`MAX_RECORDS`] rows and [`MAX_CELLS`] cells of logs' own columns, over all logs.
#[derive(Debug, Clone, Default)]
pub struct LogTable {
    kept: KeptRows,
    num_logs: usize,
    run_ids: DictionaryColumn,
    block_nums: Vec<u64>,
    regime_nums: Vec<u64>,
    exp_nums: Vec<u64>,
    workers: DictionaryColumn,
    block_types: DictionaryColumn,
    block_subtypes: DictionaryColumn,
    task_names: DictionaryColumn,
    task_params: DictionaryColumn,
    exp_statuses: DictionaryColumn,
    timestamps: Vec<Timestamp>,
    custom: BTreeMap<String, CustomColumn>,
}

impl LogTable {
    /// A table without rows.
    pub fn new(kept: KeptRows) -> Self {
        Self {
            kept,
            ..Self::default()
        }
    }

    /// Adds the rows of a log. Read it with [`read_log_with_texts`](crate::read_log_with_texts) to have its columns of words, too.
    /// A column that is missing in some logs has no values there; one of numbers in some logs and words in others becomes one of
    /// words.
    ///
    /// # Errors
    /// [`MetricsError::TableColumn`] where the log has a column `run_id` or `regime_num` of its own, [`MetricsError::TooLarge`]
    /// where the table would pass its limits. The table is as before then.
    pub fn add(&mut self, log: &Log) -> Result<(), MetricsError> {
        let kept: Vec<Row<'_>> = (log.rows.iter())
            .filter(|row| self.kept == KeptRows::All || row.exp_status() == ExpStatus::Complete)
            .collect();
        self.check(log, kept.len())?;
        let before = self.len();
        self.num_logs += 1;
        let run = self.run_ids.key(&log.run_id);
        let mut workers = Keys::new(log.rows.workers());
        let mut tasks = Keys::new(log.rows.task_names());
        let mut params = Keys::new(log.rows.task_params());
        for row in &kept {
            let index = row.index();
            self.run_ids.push_key(run);
            self.block_nums.push(row.block_num());
            self.exp_nums.push(row.exp_num());
            workers.push(&mut self.workers, index, String::clone);
            self.block_types.push(row.block_type().name());
            self.block_subtypes.push(row.block_subtype().name());
            tasks.push(&mut self.task_names, index, |name| name.to_lowercase());
            params.push(&mut self.task_params, index, |params| spaced_json(params));
            self.exp_statuses.push(row.exp_status().name());
            self.timestamps.push(row.timestamp());
            self.push_regime(before);
        }
        self.add_own(log, &kept, before);
        Ok(())
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.block_nums.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.block_nums.is_empty()
    }

    /// All columns with their names, in order.
    pub fn columns(&self) -> Vec<(&str, LogColumn<'_>)> {
        let run_ids = (self.num_logs > 1).then_some(("run_id", LogColumn::Dictionary(&self.run_ids)));
        let standard = [
            ("block_num", LogColumn::Integers(&self.block_nums)),
            ("regime_num", LogColumn::Integers(&self.regime_nums)),
            ("exp_num", LogColumn::Integers(&self.exp_nums)),
            ("worker_id", LogColumn::Dictionary(&self.workers)),
            ("block_type", LogColumn::Dictionary(&self.block_types)),
            ("block_subtype", LogColumn::Dictionary(&self.block_subtypes)),
            ("task_name", LogColumn::Dictionary(&self.task_names)),
            ("task_params", LogColumn::Dictionary(&self.task_params)),
            ("exp_status", LogColumn::Dictionary(&self.exp_statuses)),
            ("timestamp", LogColumn::Times(&self.timestamps)),
        ];
        let custom = self.custom.iter().map(|(name, column)| match column {
            CustomColumn::Numbers(numbers) => (name.as_str(), LogColumn::Numbers(numbers)),
            CustomColumn::Texts(texts) => (name.as_str(), LogColumn::Texts(texts)),
        });
        run_ids.into_iter().chain(standard).chain(custom).collect()
    }

    /// Writes the table as text with a header line; lines end with `\n`, cells are quoted where they must be, and texts
    /// are guarded against being taken for formulas unless they are wanted as they are.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&self, mut out: impl Write, delimiter: Delimiter, cells: Cells) -> io::Result<()> {
        let delimiter = match delimiter {
            Delimiter::Tab => b'\t',
            Delimiter::Comma => b',',
        };
        let columns = self.columns();
        out.write_all(&delimited(
            delimiter,
            columns.iter().map(|(name, _)| cells.cell(name).into_owned()),
        ))?;
        let mut line = vec![String::new(); columns.len()];
        for row in 0..self.len() {
            for (cell, (_, column)) in line.iter_mut().zip(&columns) {
                cell.clear();
                column.write(row, cell);
                if let Cow::Owned(guarded) = cells.cell(cell) {
                    *cell = guarded;
                }
            }
            out.write_all(&delimited(delimiter, &line))?;
        }
        out.flush()
    }

    fn check(&self, log: &Log, num_rows: usize) -> Result<(), MetricsError> {
        let names = || log.rows.metric_names().chain(log.rows.text_names());
        if let Some(column) = names().find(|name| ADDED.contains(name)) {
            return Err(MetricsError::TableColumn {
                run_id: log.run_id.clone(),
                column: column.to_owned(),
            });
        }
        let rows = (self.len() + num_rows) as u64;
        let new = names().filter(|name| !self.custom.contains_key(*name)).count();
        let cells = rows * (self.custom.len() + new) as u64;
        for (what, found, limit) in [("rows", rows, MAX_RECORDS as u64), ("cells", cells, MAX_CELLS)] {
            if found > limit {
                return Err(MetricsError::TooLarge {
                    path: format!("table of logs up to {}", log.run_id).into(),
                    what,
                    found,
                    limit,
                });
            }
        }
        Ok(())
    }

    /// Numbers the regime of the row whose other cells were just added; the log's first row is at `first`.
    fn push_regime(&mut self, first: usize) {
        let row = self.regime_nums.len();
        let regime = |row: usize| {
            let words = [&self.block_types, &self.block_subtypes, &self.task_names].map(|words| words.keys()[row]);
            (self.block_nums[row], words)
        };
        let regime_num = match row.checked_sub(1).filter(|before| *before >= first) {
            None => 0,
            Some(before) => self.regime_nums[before] + u64::from(regime(before) != regime(row)),
        };
        self.regime_nums.push(regime_num);
    }

    /// Adds the columns that the log names; the table had `before` rows.
    fn add_own(&mut self, log: &Log, kept: &[Row<'_>], before: usize) {
        for name in log.rows.metric_names() {
            let numbers = log.rows.metric(name).unwrap_or_default();
            match self
                .custom
                .entry(name.to_owned())
                .or_insert_with(|| CustomColumn::Numbers(Vec::new()))
            {
                CustomColumn::Numbers(column) => {
                    column.resize(before, f64::NAN);
                    column.extend(kept.iter().map(|row| numbers[row.index()]));
                }
                CustomColumn::Texts(column) => {
                    column.pad(before);
                    for row in kept {
                        column.push(&number_text(numbers[row.index()]));
                    }
                }
            }
        }
        for name in log.rows.text_names() {
            let column = self
                .custom
                .entry(name.to_owned())
                .or_insert_with(|| CustomColumn::Texts(TextColumn::default()));
            let column = column.as_texts();
            column.pad(before);
            for row in kept {
                column.push(row.text(name).unwrap_or_default());
            }
        }
        let num_rows = self.block_nums.len();
        for column in self.custom.values_mut() {
            match column {
                CustomColumn::Numbers(column) => column.resize(num_rows, f64::NAN),
                CustomColumn::Texts(column) => column.pad(num_rows),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlockType, LoggerInfo, Record, ScenarioInfo, read_log_with_texts};

    const HEADER: &str = "block_num\texp_num\tworker_id\tblock_type\ttask_name\ttask_params\texp_status\ttimestamp";

    /// Reads a log of format 1.0 with these columns behind the standard ones.
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
    fn a_table_has_the_columns_and_rows_of_l2logger() {
        let mut table = LogTable::new(KeptRows::Complete);
        table.add(&rows()).unwrap();
        let expected = "block_num\tregime_num\texp_num\tworker_id\tblock_type\tblock_subtype\ttask_name\ttask_params\texp_status\ttimestamp\t\
                        debug\treward\n\
                        0\t0\t0\tw\ttrain\twake\ta_x\t\"{\"\"k\"\": 1}\"\tcomplete\t20200101T000001.000000\tok\t1.0\n\
                        0\t0\t1\tw\ttrain\twake\ta_x\t{}\tcomplete\t20200101T000002.500000\t\t\n\
                        1\t1\t2\tw\ttest\twake\ta_x\t{}\tcomplete\t20200101T000003.000000\tok\t-2e-7\n";
        assert_eq!(text(&table, Delimiter::Tab), expected);
    }

    #[test]
    fn all_rows_are_kept_where_they_are_wanted() {
        let mut table = LogTable::new(KeptRows::All);
        table.add(&rows()).unwrap();
        assert_eq!(table.len(), 4);
        let csv = text(&table, Delimiter::Comma);
        let first = csv.lines().nth(1).unwrap();
        assert_eq!(
            first,
            "0,0,0,w,train,wake,a_x,{},incomplete,20200101T000000.000000,\"hm, \"\"so\"\"\",0.5"
        );
    }

    #[test]
    fn several_logs_say_which_row_is_whose_and_fill_up_what_others_lack() {
        let other = log(
            "two",
            "reward\tdebug\tsteps",
            &["7\t9\tv\ttrain\tb_y\t{}\tcomplete\t20200101T000000.0\t3\t12\t4"],
        );
        let mut table = LogTable::new(KeptRows::Complete);
        table.add(&rows()).unwrap();
        table.add(&other).unwrap();
        table.add(&rows()).unwrap();
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
    fn a_column_of_numbers_becomes_words_where_a_later_log_has_words() {
        let row = "0\t0\tw\ttrain\ta_x\t{}\tcomplete\t20200101T000000.0\t1";
        let mut table = LogTable::new(KeptRows::Complete);
        for cell in ["2", "two"] {
            table
                .add(&log("run", "reward\tnote", &[&format!("{row}\t{cell}")]))
                .unwrap();
        }
        let (name, column) = table.columns()[11];
        assert_eq!(name, "note");
        let LogColumn::Texts(texts) = column else {
            panic!("{column:?}")
        };
        assert_eq!((texts.get(0), texts.get(1)), (Some("2.0"), Some("two")));
    }

    #[test]
    fn a_column_that_the_table_adds_itself_is_refused() {
        let row = "0\t0\tw\ttrain\ta_x\t{}\tcomplete\t20200101T000000.0\t1\t1";
        let mut table = LogTable::new(KeptRows::Complete);
        let error = table.add(&log("run", "reward\tregime_num", &[row])).unwrap_err();
        assert_eq!(error.code(), "metrics/table-column");
        assert!(table.is_empty());
    }

    #[test]
    fn no_log_is_a_table_without_rows() {
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
        table.add(&read_log_with_texts(&dir).unwrap()).unwrap();
        assert!(table.is_empty());
        assert_eq!(table.columns().len(), 11);
    }
}
