//! The rows of a log, stored by column, with a view of each row.

use indexmap::IndexMap;

use super::record::{BlockSubtype, BlockType, ExpStatus, Record, TaskParams};
use super::shared_column::{SharedColumn, reorder};
use super::timestamp::Timestamp;

/// The rows of a log, of all its workers, by column. Every column has a value for each row.
///
/// Two tables are equal if they have the same columns and equal rows in the same order; missing numbers (NaN) are equal to each
/// other.
///
/// ```
/// # use driftworld_metrics::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log};
/// # let base = tempfile::tempdir().unwrap();
/// # let dir = base.path().join("log");
/// # let mut writer = LogWriter::create(&dir, &LoggerInfo::new(["reward"])?, &ScenarioInfo::default())?;
/// # for (exp_num, reward) in [(0, 1.0), (1, 3.0)] {
/// #     let record = Record::new(exp_num, exp_num, BlockType::Train, "find_red", Timestamp::from_unix_micros(0)?);
/// #     writer.write(&record.with_metric("reward", reward))?;
/// # }
/// let rows = read_log(&dir)?.rows;
/// assert_eq!(rows.metric("reward"), Some(&[1.0, 3.0][..]), "columns are slices");
/// let late = rows.iter().find(|row| row.block_num() == 1).expect("there are two blocks");
/// assert_eq!((late.task_name(), late.metric("reward")), ("find_red", Some(3.0)));
/// # Ok::<(), driftworld_metrics::MetricsError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Rows {
    pub(super) block_nums: Vec<u64>,
    pub(super) exp_nums: Vec<u64>,
    pub(super) workers: SharedColumn<String>,
    pub(super) block_types: Vec<BlockType>,
    pub(super) block_subtypes: Vec<BlockSubtype>,
    pub(super) task_names: SharedColumn<String>,
    pub(super) task_params: SharedColumn<TaskParams>,
    pub(super) exp_statuses: Vec<ExpStatus>,
    pub(super) timestamps: Vec<Timestamp>,
    pub(super) metrics: IndexMap<String, Vec<f64>>,
    pub(super) texts: IndexMap<String, SharedColumn<String>>,
}

/// The cells of a row in the standard columns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    pub(super) block_num: u64,
    pub(super) exp_num: u64,
    /// Ids of worker, task and parameters in their columns.
    pub(super) shared: [u32; 3],
    pub(super) block_type: BlockType,
    pub(super) block_subtype: BlockSubtype,
    pub(super) exp_status: ExpStatus,
    pub(super) timestamp: Timestamp,
}

impl Rows {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.exp_nums.len()
    }

    /// Whether there are no rows: only headers were written.
    pub fn is_empty(&self) -> bool {
        self.exp_nums.is_empty()
    }

    /// A row by index, from 0; `None` beyond the last.
    pub fn get(&self, index: usize) -> Option<Row<'_>> {
        (index < self.len()).then_some(Row { rows: self, index })
    }

    /// All rows in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Row<'_>> + DoubleEndedIterator + Clone {
        (0..self.len()).map(|index| Row { rows: self, index })
    }

    /// Block number of each row.
    pub fn block_nums(&self) -> &[u64] {
        &self.block_nums
    }

    /// Experience number of each row.
    pub fn exp_nums(&self) -> &[u64] {
        &self.exp_nums
    }

    /// Worker of each row.
    pub fn workers(&self) -> &SharedColumn<String> {
        &self.workers
    }

    /// Learning or evaluation, for each row.
    pub fn block_types(&self) -> &[BlockType] {
        &self.block_types
    }

    /// Awake or asleep, for each row.
    pub fn block_subtypes(&self) -> &[BlockSubtype] {
        &self.block_subtypes
    }

    /// Task of each row, as logged.
    pub fn task_names(&self) -> &SharedColumn<String> {
        &self.task_names
    }

    /// Task parameters of each row.
    pub fn task_params(&self) -> &SharedColumn<TaskParams> {
        &self.task_params
    }

    /// Complete or not, for each row.
    pub fn exp_statuses(&self) -> &[ExpStatus] {
        &self.exp_statuses
    }

    /// Time stamp of each row.
    pub fn timestamps(&self) -> &[Timestamp] {
        &self.timestamps
    }

    /// The numeric columns: those declared in `logger_info.json`, in its order, then undeclared ones that contain only numbers, in
    /// the order of their first occurrence.
    pub fn metric_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.metrics.keys().map(String::as_str)
    }

    /// A numeric column, NaN for missing values; `None` if there is no such column.
    pub fn metric(&self, name: &str) -> Option<&[f64]> {
        self.metrics.get(name).map(Vec::as_slice)
    }

    /// The undeclared text columns; none unless requested, see [`read_log_with_texts`](crate::read_log_with_texts).
    pub fn text_names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.texts.keys().map(String::as_str)
    }

    /// A text column; `None` if there is no such column.
    pub fn text(&self, name: &str) -> Option<&SharedColumn<String>> {
        self.texts.get(name)
    }

    /// A table of records that all have the same metrics, for tests.
    #[cfg(test)]
    pub(crate) fn from_records(records: &[Record]) -> Self {
        let mut rows = Self::default();
        for (row, record) in (0..).zip(records) {
            rows.workers.add(record.worker_id.clone());
            rows.task_names.add(record.task_name.clone());
            rows.task_params.add(record.task_params.clone());
            rows.push(&Cells {
                block_num: record.block_num,
                exp_num: record.exp_num,
                shared: [row; 3],
                block_type: record.block_type,
                block_subtype: record.block_subtype,
                exp_status: record.exp_status,
                timestamp: record.timestamp,
            });
            for (name, number) in &record.metrics {
                rows.metrics.entry(name.clone()).or_default().push(*number);
            }
        }
        rows
    }

    pub(super) fn push(&mut self, cells: &Cells) {
        let [worker, task, params] = cells.shared;
        self.block_nums.push(cells.block_num);
        self.exp_nums.push(cells.exp_num);
        self.workers.push(worker);
        self.block_types.push(cells.block_type);
        self.block_subtypes.push(cells.block_subtype);
        self.task_names.push(task);
        self.task_params.push(params);
        self.exp_statuses.push(cells.exp_status);
        self.timestamps.push(cells.timestamp);
    }

    /// Sorts by experience number, then block number, stably. Returns the old index of each row; `None` if nothing moved.
    pub(super) fn sort(&mut self) -> Option<Vec<u32>> {
        let key = |row: usize| (self.exp_nums[row], self.block_nums[row]);
        if (1..self.len()).all(|row| key(row - 1) <= key(row)) {
            return None;
        }
        // The number of rows is far below the range of a u32.
        let mut order: Vec<u32> = (0..self.len() as u32).collect();
        order.sort_by_key(|&row| key(row as usize));
        reorder(&mut self.block_nums, &order);
        reorder(&mut self.exp_nums, &order);
        self.workers.reorder(&order);
        reorder(&mut self.block_types, &order);
        reorder(&mut self.block_subtypes, &order);
        self.task_names.reorder(&order);
        self.task_params.reorder(&order);
        reorder(&mut self.exp_statuses, &order);
        reorder(&mut self.timestamps, &order);
        for numbers in self.metrics.values_mut() {
            reorder(numbers, &order);
        }
        for texts in self.texts.values_mut() {
            texts.reorder(&order);
        }
        Some(order)
    }
}

impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len()
            && self.metrics.keys().eq(other.metrics.keys())
            && self.texts.keys().eq(other.texts.keys())
            && self.iter().eq(other.iter())
    }
}

/// A view of one row of a log.
#[derive(Clone, Copy)]
pub struct Row<'a> {
    rows: &'a Rows,
    index: usize,
}

impl<'a> Row<'a> {
    /// Position among the rows of the log, from 0.
    pub fn index(self) -> usize {
        self.index
    }

    /// Number of the block.
    pub fn block_num(self) -> u64 {
        self.rows.block_nums[self.index]
    }

    /// Number of the experience.
    pub fn exp_num(self) -> u64 {
        self.rows.exp_nums[self.index]
    }

    /// The worker that gathered the experience.
    pub fn worker_id(self) -> &'a str {
        self.rows.workers.of(self.index)
    }

    /// Learning or evaluation.
    pub fn block_type(self) -> BlockType {
        self.rows.block_types[self.index]
    }

    /// Awake or asleep.
    pub fn block_subtype(self) -> BlockSubtype {
        self.rows.block_subtypes[self.index]
    }

    /// Name of the task, as logged.
    pub fn task_name(self) -> &'a str {
        self.rows.task_names.of(self.index)
    }

    /// Parameters of the task.
    pub fn task_params(self) -> &'a TaskParams {
        self.rows.task_params.of(self.index)
    }

    /// Whether the row closes its experience.
    pub fn exp_status(self) -> ExpStatus {
        self.rows.exp_statuses[self.index]
    }

    /// End of the experience.
    pub fn timestamp(self) -> Timestamp {
        self.rows.timestamps[self.index]
    }

    /// A number of the row, NaN if missing; `None` if there is no such column.
    pub fn metric(self, name: &str) -> Option<f64> {
        Some(self.rows.metrics.get(name)?[self.index])
    }

    /// All numbers of the row with their column names.
    pub fn metrics(self) -> impl ExactSizeIterator<Item = (&'a str, f64)> {
        let columns = self.rows.metrics.iter();
        columns.map(move |(name, numbers)| (name.as_str(), numbers[self.index]))
    }

    /// A text of the row, empty if missing; `None` if there is no such column.
    pub fn text(self, name: &str) -> Option<&'a str> {
        Some(self.rows.texts.get(name)?.of(self.index))
    }

    /// All texts of the row with their column names.
    pub fn texts(self) -> impl ExactSizeIterator<Item = (&'a str, &'a str)> {
        let columns = self.rows.texts.iter();
        columns.map(move |(name, texts)| (name.as_str(), texts.of(self.index).as_str()))
    }

    /// The row as a separate record, ready to be written to another log. Text columns are not copied.
    pub fn to_record(self) -> Record {
        let metrics = self.metrics().map(|(name, number)| (name.to_owned(), number));
        Record {
            block_num: self.block_num(),
            exp_num: self.exp_num(),
            worker_id: self.worker_id().to_owned(),
            block_type: self.block_type(),
            block_subtype: self.block_subtype(),
            task_name: self.task_name().to_owned(),
            task_params: self.task_params().clone(),
            exp_status: self.exp_status(),
            timestamp: self.timestamp(),
            metrics: metrics.collect(),
            texts: IndexMap::new(),
        }
    }
}

impl PartialEq for Row<'_> {
    fn eq(&self, other: &Self) -> bool {
        let cells = |row: &Self| (row.block_num(), row.exp_num(), row.worker_id(), row.task_name());
        let words = |row: &Self| (row.block_type(), row.block_subtype(), row.exp_status(), row.timestamp());
        let same = |a: (&str, f64), b: (&str, f64)| a.0 == b.0 && (a.1 == b.1 || (a.1.is_nan() && b.1.is_nan()));
        cells(self) == cells(other)
            && words(self) == words(other)
            && self.task_params() == other.task_params()
            && self.metrics().len() == other.metrics().len()
            && self.metrics().zip(other.metrics()).all(|(a, b)| same(a, b))
            && self.texts().eq(other.texts())
    }
}

impl std::fmt::Debug for Row<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.to_record().fmt(f)
    }
}
