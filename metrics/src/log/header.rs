//! Parses the header of a data file, and checks the cells of each row against their columns.

use std::path::Path;

use csv::StringRecord;

use super::cell::{Cell, cut, listed, shown};
use super::columns::{STANDARD_COLUMNS, SUBTYPE_COLUMN};
use super::data_file::MAX_CELL_BYTES;
use super::faults::Faults;
use super::record::{BlockSubtype, BlockType, ExpStatus};
use super::rows::Cells;
use super::table::{MAX_COLUMNS, Table};
use crate::{LogLine, MetricsError};

/// The columns of one file, by index.
pub(super) struct Header<'a> {
    path: &'a Path,
    pub(super) names: Vec<String>,
    standard: [usize; STANDARD_COLUMNS.len()],
    /// Index of `block_subtype`, which logs of format 1.0 lack.
    subtype: Option<usize>,
    /// Indices of the declared metrics columns, which must contain numbers.
    metrics: Vec<usize>,
    /// Indices of undeclared columns, each with its index in the table.
    others: Vec<(usize, usize)>,
}

impl<'a> Header<'a> {
    pub(super) fn new(
        path: &'a Path,
        row: &StringRecord,
        metrics_columns: &[String],
        table: &mut Table<'_>,
        faults: &mut Faults,
    ) -> Result<Self, MetricsError> {
        if row.len() > MAX_COLUMNS {
            let (found, limit) = (row.len() as u64, MAX_COLUMNS as u64);
            return Err(MetricsError::too_large(path, "columns", found, limit));
        }
        let names: Vec<String> = row.iter().map(str::to_owned).collect();
        if names.len() == 1 && names[0].contains([',', ';', ' ']) {
            return Err(MetricsError::NoTabs {
                path: path.to_owned(),
                found: shown(&names[0]),
            });
        }
        let index_of = |column: &str| names.iter().position(|name| name == column);
        if STANDARD_COLUMNS.iter().all(|column| index_of(column).is_none()) {
            return Err(MetricsError::NoHeader {
                path: path.to_owned(),
                found: cut(&names.join(" ")),
            });
        }
        let required = (STANDARD_COLUMNS.into_iter().filter(|column| *column != SUBTYPE_COLUMN))
            .chain(metrics_columns.iter().map(String::as_str));
        let missing_columns = required.filter(|column| index_of(column).is_none());
        let missing = missing_columns.map(|column| MetricsError::MissingColumn {
            path: path.to_owned(),
            column: column.to_owned(),
            found: listed(&names),
        });
        let repeated = (0..names.len()).find(|&index| names[..index].contains(&names[index]));
        let repeated = repeated.map(|index| MetricsError::RepeatedColumn {
            path: path.to_owned(),
            column: cut(&names[index]),
        });
        let mut header_faults: Vec<MetricsError> = repeated.into_iter().chain(missing).collect();
        if let Some(last) = header_faults.pop() {
            for fault in header_faults {
                faults.add(fault)?;
            }
            return Err(last);
        }
        // Every required column exists.
        let metrics: Vec<usize> = metrics_columns.iter().filter_map(|column| index_of(column)).collect();
        let is_other = |index: &usize| !metrics.contains(index) && !STANDARD_COLUMNS.contains(&names[*index].as_str());
        let others: Vec<usize> = (0..names.len()).filter(is_other).collect();
        let numbers = table.begin_columns(others.iter().map(|&index| names[index].as_str()))?;
        Ok(Self {
            path,
            subtype: index_of(SUBTYPE_COLUMN),
            standard: STANDARD_COLUMNS.map(|column| index_of(column).unwrap_or_default()),
            others: others.into_iter().zip(numbers).collect(),
            metrics,
            names,
        })
    }

    /// Adds a row to the table, unless it has a fault.
    pub(super) fn add(
        &self,
        row: &StringRecord,
        line: u64,
        table: &mut Table<'_>,
        faults: &mut Faults,
    ) -> Result<(), MetricsError> {
        if row.len() != self.names.len() {
            let (found, expected) = (row.len(), self.names.len());
            let path = self.path.to_owned();
            let at = LogLine { path, line };
            return faults.add(MetricsError::RaggedRow { at, found, expected });
        }
        let cell = |index: usize| self.cell(row, line, index);
        if row.as_slice().len() > MAX_CELL_BYTES
            && let Some(index) = (0..row.len()).find(|index| row[*index].len() > MAX_CELL_BYTES)
        {
            return faults.add(cell(index).error(format!("at most {MAX_CELL_BYTES} bytes; is a quote unclosed?")));
        }
        let cells = self.standard_cells(cell, table, faults)?;
        let mut numbers = table.take_buffer();
        for &index in &self.metrics {
            if let Some(number) = faults.check(cell(index).number())? {
                numbers.push(number);
            }
        }
        match cells {
            Some(cells) if numbers.len() == self.metrics.len() => {
                let others = self.others.iter().map(|&(index, number)| (number, &row[index]));
                table.push(line, &cells, numbers, others)
            }
            _ => Ok(()),
        }
    }

    /// A cell of a row that is as long as the header.
    fn cell<'r>(&'r self, row: &'r StringRecord, line: u64, index: usize) -> Cell<'r> {
        Cell {
            path: self.path,
            line,
            column: &self.names[index],
            text: &row[index],
        }
    }

    /// The cells of the standard columns; `None` if one of them is invalid.
    fn standard_cells<'r>(
        &self,
        cell: impl Fn(usize) -> Cell<'r>,
        table: &mut Table<'_>,
        faults: &mut Faults,
    ) -> Result<Option<Cells>, MetricsError> {
        let [
            block_num,
            exp_num,
            worker_id,
            block_type,
            _,
            task_name,
            task_params,
            exp_status,
            timestamp,
        ] = self.standard.map(&cell);
        let block_num = faults.check(block_num.whole_number())?;
        let exp_num = faults.check(exp_num.whole_number())?;
        let worker = (table.workers).id(&mut table.rows.workers, worker_id.text, |_| worker_id.worker());
        let worker = faults.check(worker)?;
        let block_type = faults.check(block_type.word(BlockType::expected))?;
        let block_subtype = match self.subtype {
            Some(index) => cell(index).word(BlockSubtype::expected),
            None => Ok(BlockSubtype::Wake),
        };
        let block_subtype = faults.check(block_subtype)?;
        let task = (table.task_names).id(&mut table.rows.task_names, task_name.text, |text| Ok(text.to_owned()));
        let task = faults.check(task)?;
        let params = (table.task_params).id(&mut table.rows.task_params, task_params.text, |_| task_params.params());
        let params = faults.check(params)?;
        let exp_status = faults.check(exp_status.word(ExpStatus::expected))?;
        let timestamp = faults.check(timestamp.timestamp())?;
        let cells = || {
            Some(Cells {
                block_num: block_num?,
                exp_num: exp_num?,
                shared: [worker?, task?, params?],
                block_type: block_type?,
                block_subtype: block_subtype?,
                exp_status: exp_status?,
                timestamp: timestamp?,
            })
        };
        Ok(cells())
    }
}
