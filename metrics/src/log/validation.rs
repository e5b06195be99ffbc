//! Reads a log and checks the rules of the format. Stops at the first fault, or lists them all.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::cell::listed;
use super::faults::{Faults, Listed};
use super::logger_info::LoggerInfo;
use super::record::{ExpStatus, is_conventional_task_name};
use super::rows::Rows;
use super::scenario_info::ScenarioInfo;
use super::table::{Table, Texts};
use super::warning::LogWarning;
use super::{columns, data_file, data_files};
use crate::MetricsError;

/// The result of [`validate_log`].
#[derive(Debug)]
#[non_exhaustive]
pub struct Validation {
    /// The faults, file by file, up to [`MAX_LISTED`](crate::MAX_LISTED).
    pub problems: Vec<MetricsError>,
    /// Number of further problems.
    pub more_problems: u64,
    /// The warnings, up to [`MAX_LISTED`](crate::MAX_LISTED).
    pub warnings: Vec<LogWarning>,
    /// Number of further warnings.
    pub more_warnings: u64,
    /// Counts of the rows and files checked.
    pub counts: LogCounts,
}

impl Validation {
    /// Whether there are no problems; warnings do not count.
    pub fn is_valid(&self) -> bool {
        self.problems.is_empty()
    }
}

/// Counts over a log's readable rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct LogCounts {
    /// Data files.
    pub files: usize,
    /// Rows.
    pub rows: usize,
    /// Rows that close an experience.
    pub complete_rows: usize,
    /// Experiences: pairs of number and worker.
    pub experiences: usize,
    /// Distinct block numbers.
    pub blocks: usize,
    /// Workers.
    pub workers: usize,
    /// Distinct task names.
    pub tasks: usize,
}

/// Checks a log by the rules of [`read_log`](crate::read_log), and lists every fault: numbers never decrease within a file;
/// every file has the same columns, those of the log's version; each experience has exactly one complete row, at its end. Warns
/// about departures from convention: task names that are not two words, missing or unknown words in `scenario_info.json`,
/// missing experience numbers, time stamps that run backwards, folders not named after the worker and the block of their rows,
/// an unfinished last experience, and metrics without numbers.
pub fn validate_log(dir: impl AsRef<Path>) -> Validation {
    let dir = dir.as_ref();
    let mut check = Check::new(Faults::List(Listed::default()));
    let fatal_error = check.all(dir, Texts::Leave).err();
    let mut listed = match check.faults {
        Faults::List(found) => found,
        Faults::Stop => Listed::default(),
    };
    if let Some(error) = fatal_error {
        listed.add(error);
    }
    Validation {
        problems: listed.first,
        more_problems: listed.num_more,
        warnings: check.warnings.first,
        more_warnings: check.warnings.num_more,
        counts: check.counts,
    }
}

/// Reads a log, as far as its faults allow, and checks it.
pub(super) struct Check {
    faults: Faults,
    pub(super) warnings: Listed<LogWarning>,
    counts: LogCounts,
}

/// The contents of a log: its two info files, and its rows in order.
pub(super) type Read = (LoggerInfo, ScenarioInfo, Rows);

impl Check {
    pub(super) fn new(faults: Faults) -> Self {
        Self {
            faults,
            warnings: Listed::default(),
            counts: LogCounts::default(),
        }
    }

    /// Reads and checks the whole log. The error is the first fault if reading stops there, otherwise a problem that ends the check.
    pub(super) fn all(&mut self, dir: &Path, texts: Texts) -> Result<Read, MetricsError> {
        let files = data_files::find(dir)?;
        self.counts.files = files.len();
        let scenario_info = self.scenario_info(dir)?;
        let logger_info = LoggerInfo::read(dir)?;
        if files.is_empty() {
            return Err(MetricsError::NoDataFiles(dir.to_owned()));
        }
        let mut table = Table::new(dir, logger_info.metrics_columns(), texts);
        self.read(&mut table, &files, &logger_info)?;
        self.order_in_files(&table)?;
        self.folders(dir, &table);
        self.completions(&table)?;
        self.missing(&table, &scenario_info);
        self.metrics(&table, logger_info.metrics_columns());
        self.count(&table);
        self.sort(&mut table)?;
        Ok((logger_info, scenario_info, table.rows))
    }

    /// Adds a breach of a rule that does not affect scores: validation lists it as a problem, reading as a warning with the same
    /// text.
    fn add_minor_fault(&mut self, fault: MetricsError) -> Result<(), MetricsError> {
        match self.faults {
            Faults::List(_) => self.faults.add(fault),
            Faults::Stop => {
                self.warnings.add(LogWarning::Breach(fault.to_string()));
                Ok(())
            }
        }
    }

    fn scenario_info(&mut self, dir: &Path) -> Result<ScenarioInfo, MetricsError> {
        let mut warnings = Vec::new();
        let info = self.faults.check(ScenarioInfo::read(dir, &mut warnings))?;
        if let (Some(info), Faults::List(_)) = (&info, &self.faults)
            && !warnings.contains(&LogWarning::NoScenarioInfo)
        {
            info.warn_of_missing(&mut warnings);
        }
        for warning in warnings {
            self.warnings.add(warning);
        }
        Ok(info.unwrap_or_default())
    }

    /// Reads every file as far as possible.
    fn read<'d>(
        &mut self,
        table: &mut Table<'d>,
        files: &'d [PathBuf],
        logger_info: &LoggerInfo,
    ) -> Result<(), MetricsError> {
        let mut headers: Vec<(&Path, Vec<String>)> = Vec::new();
        for path in files {
            match data_file::read(path, logger_info.metrics_columns(), table, &mut self.faults) {
                Ok(header) => headers.push((path, header)),
                // The log as a whole is too large, so continuing is pointless.
                Err(error @ MetricsError::TooLarge { .. }) if table.is_full() => return Err(error),
                Err(error) => self.faults.add(error)?,
            }
        }
        self.headers(&headers, logger_info)?;
        table.complete()
    }

    /// Checks that every file has the columns of the first, and those of the log's version.
    fn headers(&mut self, headers: &[(&Path, Vec<String>)], logger_info: &LoggerInfo) -> Result<(), MetricsError> {
        let sorted = |names: &[String]| names.iter().cloned().collect::<BTreeSet<String>>();
        let Some((first, expected)) = headers.first() else {
            return Ok(());
        };
        for (path, names) in &headers[1..] {
            if sorted(names) != sorted(expected) {
                self.add_minor_fault(MetricsError::ColumnsDiffer {
                    path: path.to_path_buf(),
                    found: listed(names),
                    expected: listed(expected),
                    first: first.to_path_buf(),
                })?;
            }
        }
        let has_subtype = expected.iter().any(|name| name == columns::SUBTYPE_COLUMN);
        let version = logger_info.log_format_version();
        if has_subtype == (version == "1.0") {
            self.warnings.add(LogWarning::Version {
                path: first.to_path_buf(),
                version: version.to_owned(),
                has_subtype,
            });
        }
        Ok(())
    }

    /// Checks that numbers never decrease within a file; decreasing time stamps cause one warning per file.
    fn order_in_files(&mut self, table: &Table<'_>) -> Result<(), MetricsError> {
        let rows = &table.rows;
        for (_, mut range) in table.files() {
            let mut is_reported = false;
            let Some(mut before) = range.next() else { continue };
            for row in range {
                for (column, numbers) in [("block_num", rows.block_nums()), ("exp_num", rows.exp_nums())] {
                    if numbers[row] < numbers[before] {
                        self.add_minor_fault(MetricsError::NumberFalls {
                            at: table.line_of(row),
                            column,
                            found: numbers[row],
                            expected: numbers[before],
                        })?;
                    }
                }
                let stamps = rows.timestamps();
                if stamps[row] < stamps[before] && !std::mem::replace(&mut is_reported, true) {
                    self.warnings.add(LogWarning::TimeRunsBack {
                        at: table.line_of(row),
                        found: stamps[row],
                        before: stamps[before],
                    });
                }
                before = row;
            }
        }
        Ok(())
    }

    /// Checks that rows are in the folder of their worker and block; stray rows cause one warning per file.
    fn folders(&mut self, dir: &Path, table: &Table<'_>) {
        let rows = &table.rows;
        for (path, mut range) in table.files() {
            let folder_key = |row: usize| {
                (
                    rows.workers().ids()[row],
                    rows.block_nums()[row],
                    rows.block_types()[row],
                )
            };
            let expected = |row: usize| {
                let worker = rows.workers().of(row);
                format!("{worker}/{}-{}", rows.block_nums()[row], rows.block_types()[row])
            };
            let folder = path.parent().and_then(|folder| folder.strip_prefix(dir).ok());
            let is_in_place = |row: usize| folder == Some(Path::new(&expected(row)));
            let mut last = None;
            let stray = range.find(|&row| {
                // Compares paths only once for consecutive rows of one worker and block.
                last.replace(folder_key(row)) != Some(folder_key(row)) && !is_in_place(row)
            });
            if let Some(row) = stray {
                self.warnings.add(LogWarning::OtherFolder {
                    at: table.line_of(row),
                    expected: expected(row),
                });
            }
        }
    }

    /// Checks that each experience of a worker has exactly one complete row, at its end; the worker's last experience
    /// may have none.
    fn completions(&mut self, table: &Table<'_>) -> Result<(), MetricsError> {
        let rows = &table.rows;
        let key = |row: usize| (rows.workers().ids()[row], rows.exp_nums()[row]);
        let mut by_experience: Vec<u32> = (0..rows.len() as u32).collect();
        by_experience.sort_by_key(|&row| key(row as usize));
        let mut experiences = by_experience
            .chunk_by(|&a, &b| key(a as usize) == key(b as usize))
            .peekable();
        while let Some(experience) = experiences.next() {
            self.counts.experiences += 1;
            // An experience has at least one row.
            let first = experience[0] as usize;
            let is_same_worker = |other: &&[u32]| key(other[0] as usize).0 == key(first).0;
            let is_last = !experiences.peek().is_some_and(is_same_worker);
            let is_complete = |&&row: &&u32| rows.exp_statuses()[row as usize] == ExpStatus::Complete;
            let (exp_num, worker) = (rows.exp_nums()[first], rows.workers().of(first).clone());
            match experience.iter().position(|row| is_complete(&row)) {
                None if is_last => {
                    let at = table.line_of(first);
                    self.warnings.add(LogWarning::Unfinished { at, exp_num });
                }
                None => {
                    let at = table.line_of(first);
                    self.add_minor_fault(MetricsError::NotCompleted { at, exp_num, worker })?;
                }
                Some(end) => {
                    if let Some(&after) = experience.get(end + 1) {
                        let at = table.line_of(after as usize);
                        self.faults
                            .add(MetricsError::RowAfterComplete { at, exp_num, worker })?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Checks that experience numbers increase by one, over all workers, up to the end of our own scenario. Gaps cause one warning
    /// per log, except where a regime with a budget of decisions may leave numbers unused.
    fn missing(&mut self, table: &Table<'_>, scenario: &ScenarioInfo) {
        let numbers = table.rows.exp_nums();
        let (blocks, tasks) = (table.rows.block_nums(), table.rows.task_names().ids());
        let mut rows: Vec<u32> = (0..numbers.len() as u32).collect();
        rows.sort_by_key(|&row| numbers[row as usize]);
        let steps = rows.windows(2).map(|pair| {
            let [before, after] = [pair[0] as usize, pair[1] as usize];
            (before, after, numbers[after] - numbers[before])
        });
        let is_unused = |before: usize, after: usize| {
            let ends = blocks[before] != blocks[after] || tasks[before] != tasks[after];
            scenario.leaves_numbers_unused(blocks[before], ends)
        };
        let mut gaps = steps.filter(|&(before, after, step)| step > 1 && !is_unused(before, after));
        if let Some((before, row, step)) = gaps.next() {
            let missing = gaps.map(|(_, _, step)| step - 1).sum::<u64>() + step - 1;
            let [before, after] = [before, row].map(|row| numbers[row]);
            self.warnings.add(LogWarning::Missing {
                at: table.line_of(row),
                before,
                after,
                missing,
            });
        }
        if let Some(&last) = rows.last() {
            let (block, done) = (blocks[last as usize], numbers[last as usize] + 1);
            if let Some(planned) = scenario.missing_end(block, done) {
                self.warnings.add(LogWarning::EndsEarly { done, planned });
            }
        }
    }

    /// Warns about declared metrics without any number, which cannot be scored. Only for validation: when a log is scored, only the
    /// scored metric matters.
    fn metrics(&mut self, table: &Table<'_>, declared: &[String]) {
        if matches!(self.faults, Faults::Stop) {
            return;
        }
        for name in declared {
            let numbers = table.rows.metric(name).unwrap_or_default();
            if !numbers.is_empty() && numbers.iter().all(|number| number.is_nan()) {
                self.warnings.add(LogWarning::NoNumbers { column: name.clone() });
            }
        }
    }

    fn count(&mut self, table: &Table<'_>) {
        let rows = &table.rows;
        let complete = |status: &&ExpStatus| **status == ExpStatus::Complete;
        self.counts.rows = rows.len();
        self.counts.complete_rows = rows.exp_statuses().iter().filter(complete).count();
        self.counts.blocks = rows.block_nums().iter().collect::<BTreeSet<_>>().len();
        self.counts.workers = rows.workers().values().iter().collect::<BTreeSet<_>>().len();
        // In lower case, as for scoring.
        let tasks = rows.task_names().values().iter().map(|name| name.to_lowercase());
        self.counts.tasks = tasks.collect::<BTreeSet<_>>().len();
    }

    /// Sorts the rows by experience; in that order, block numbers must not decrease.
    fn sort(&mut self, table: &mut Table<'_>) -> Result<(), MetricsError> {
        let order = table.rows.sort();
        let blocks = table.rows.block_nums();
        if let Some(row) = (1..blocks.len()).find(|&row| blocks[row] < blocks[row - 1]) {
            self.faults.add(MetricsError::BlockOrder {
                at: table.line_of(order.map_or(row, |order| order[row] as usize)),
                found: blocks[row],
                expected: blocks[row - 1],
            })?;
        }
        self.task_names(&table.rows);
        Ok(())
    }

    /// Warns once about each unconventional name, in the order of the rows.
    fn task_names(&mut self, rows: &Rows) {
        let names = rows.task_names();
        let mut unreported: Vec<bool> = (names.values().iter())
            .map(|name| !is_conventional_task_name(name))
            .collect();
        if unreported.contains(&true) {
            for &id in names.ids() {
                if std::mem::take(&mut unreported[id as usize]) {
                    let found = names.values()[id as usize].clone();
                    self.warnings.add(LogWarning::TaskName { found });
                }
            }
        }
    }
}
