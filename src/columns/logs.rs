//! Rows of logs as one Parquet or Arrow file, with types. Which rows and columns there are is `metrics`'s [`LogTable`].
//!
//! Whole numbers are 64-bit integers, words that repeat are dictionaries, time stamps count microseconds without a time zone,
//! metrics are 64-bit floats, and what is missing is null.
//!
//! ```text
//! >>> import pandas
//! >>> pandas.read_feather("log.feather").groupby("task_name")["reward"].mean()
//! ```

use std::io::Write;
use std::ops::Range;
use std::sync::Arc;

use arrow_array::types::Int32Type;
use arrow_array::{
    ArrayRef, DictionaryArray, Float64Array, Int32Array, Int64Array, RecordBatch, StringArray,
    TimestampMicrosecondArray,
};
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef, TimeUnit};
use driftworld_metrics::{LogColumn, LogTable};

use super::sink::Sink;
use super::{ColumnsError, Format};

/// How many rows are written at once.
const ROWS: usize = 65_536;

/// Writes a table of logs and hands back what it was written to. The same table gives the same bytes.
///
/// # Errors
/// [`ColumnsError`] where the file cannot be written, or a block or experience number is beyond 2⁶³ − 1.
pub fn write_log_table<W: Write + Send>(table: &LogTable, writer: W, format: Format) -> Result<W, ColumnsError> {
    let columns = table.columns();
    check_numbers(&columns)?;
    let schema = schema(&columns);
    let mut sink = Sink::new(writer, schema.clone(), format)?;
    // Every batch has the same dictionaries: the Arrow file format allows no others.
    let dictionaries: Vec<Option<Arc<StringArray>>> = columns
        .iter()
        .map(|(_, column)| match column {
            LogColumn::Dictionary(words) => Some(Arc::new(words.values().map(Some).collect())),
            _ => None,
        })
        .collect();
    for first in (0..table.len()).step_by(ROWS) {
        let rows = first..table.len().min(first + ROWS);
        let arrays = columns
            .iter()
            .zip(&dictionaries)
            .map(|((_, column), dictionary)| array(*column, dictionary.as_ref(), rows.clone()));
        let arrays = arrays.collect::<Result<Vec<ArrayRef>, ArrowError>>()?;
        sink.write(&RecordBatch::try_new(schema.clone(), arrays)?)?;
    }
    sink.finish()
}

/// Refuses numbers that a signed integer does not hold, before anything is written.
fn check_numbers(columns: &[(&str, LogColumn<'_>)]) -> Result<(), ColumnsError> {
    for (name, column) in columns {
        let LogColumn::Integers(numbers) = column else { continue };
        if let Some(&found) = numbers.iter().find(|number| i64::try_from(**number).is_err()) {
            let column = (*name).to_owned();
            return Err(ColumnsError::Number { column, found });
        }
    }
    Ok(())
}

fn schema(columns: &[(&str, LogColumn<'_>)]) -> SchemaRef {
    let field = |(name, column): &(&str, LogColumn<'_>)| {
        let (kind, nullable) = match column {
            LogColumn::Integers(_) => (DataType::Int64, false),
            LogColumn::Dictionary(_) => {
                let (keys, words) = (Box::new(DataType::Int32), Box::new(DataType::Utf8));
                (DataType::Dictionary(keys, words), false)
            }
            LogColumn::Times(_) => (DataType::Timestamp(TimeUnit::Microsecond, None), false),
            LogColumn::Numbers(_) => (DataType::Float64, true),
            LogColumn::Texts(_) => (DataType::Utf8, true),
        };
        Field::new(*name, kind, nullable)
    };
    let metadata = [("driftworld.log_columns".to_owned(), "1".to_owned())];
    let fields: Vec<Field> = columns.iter().map(field).collect();
    Arc::new(Schema::new_with_metadata(fields, metadata))
}

fn array(
    column: LogColumn<'_>,
    dictionary: Option<&Arc<StringArray>>,
    rows: Range<usize>,
) -> Result<ArrayRef, ArrowError> {
    Ok(match column {
        LogColumn::Integers(numbers) => {
            // They were checked to be small enough.
            let signed = numbers[rows].iter().map(|&number| number as i64);
            Arc::new(Int64Array::from_iter_values(signed))
        }
        LogColumn::Dictionary(words) => {
            // A dictionary has at most as many words as there are rows, of which there are fewer than 2³¹.
            let keys = words.keys()[rows].iter().map(|&key| key as i32);
            let values = dictionary
                .cloned()
                .unwrap_or_else(|| Arc::new(words.values().map(Some).collect()));
            Arc::new(DictionaryArray::<Int32Type>::try_new(
                Int32Array::from_iter_values(keys),
                values,
            )?)
        }
        LogColumn::Times(stamps) => {
            let micros = stamps[rows].iter().map(|stamp| stamp.unix_micros());
            Arc::new(TimestampMicrosecondArray::from_iter_values(micros))
        }
        LogColumn::Numbers(numbers) => {
            let present = numbers[rows].iter().map(|&number| (!number.is_nan()).then_some(number));
            Arc::new(present.collect::<Float64Array>())
        }
        LogColumn::Texts(texts) => {
            let present = rows.map(|row| texts.get(row).filter(|text| !text.is_empty()));
            Arc::new(present.collect::<StringArray>())
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::worlds::read_back;
    use arrow_array::Array;
    use arrow_array::cast::AsArray;
    use arrow_array::types::{Float64Type, Int64Type, TimestampMicrosecondType};
    use driftworld_metrics::{
        BlockType, KeptRows, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log_with_texts,
    };

    /// A log of so many experiences, alternately of two tasks, and every third without its reward.
    fn table(num_rows: u64) -> LogTable {
        let base = tempfile::tempdir().unwrap();
        let dir = base.path().join("run");
        let info = LoggerInfo::new(["reward"]).unwrap();
        let mut writer = LogWriter::create(&dir, &info, &ScenarioInfo::default()).unwrap();
        for exp_num in 0..num_rows {
            let task = if exp_num.is_multiple_of(2) { "a_b" } else { "c_d" };
            let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + exp_num as i64).unwrap();
            let reward = if exp_num.is_multiple_of(3) {
                f64::NAN
            } else {
                exp_num as f64 / 2.0
            };
            let record = Record::new(7, exp_num, BlockType::Test, task, when).with_metric("reward", reward);
            writer.write(&record).unwrap();
        }
        writer.finish().unwrap();
        let mut table = LogTable::new(KeptRows::Complete);
        table.add(&read_log_with_texts(&dir).unwrap()).unwrap();
        table
    }

    #[test]
    fn every_cell_comes_back_with_its_type_over_several_batches() {
        let num_rows = ROWS as u64 + 100;
        let table = table(num_rows);
        for format in [Format::Parquet, Format::Arrow] {
            let mut row = 0_u64;
            for batch in read_back(write_log_table(&table, Vec::new(), format).unwrap(), format) {
                let column = |name: &str| batch.column_by_name(name).unwrap();
                let tasks = column("task_name").as_dictionary::<Int32Type>().clone();
                let tasks = tasks.downcast_dict::<StringArray>().unwrap();
                let times = column("timestamp").as_primitive::<TimestampMicrosecondType>();
                let rewards = column("reward").as_primitive::<Float64Type>();
                for index in 0..batch.num_rows() {
                    assert_eq!(column("exp_num").as_primitive::<Int64Type>().value(index), row as i64);
                    assert_eq!(
                        tasks.values().value(tasks.keys().value(index) as usize),
                        if row.is_multiple_of(2) { "a_b" } else { "c_d" }
                    );
                    assert_eq!(times.value(index), 1_600_000_000_000_000 + row as i64);
                    assert_eq!(rewards.is_null(index), row.is_multiple_of(3));
                    assert!(rewards.is_null(index) || rewards.value(index) == row as f64 / 2.0);
                    row += 1;
                }
            }
            assert_eq!(row, num_rows, "{format:?}");
        }
    }

    #[test]
    fn numbers_beyond_those_of_the_columns_are_refused() {
        let write = |exp_num: u64| {
            let base = tempfile::tempdir().unwrap();
            let dir = base.path().join("run");
            let info = LoggerInfo::new(["reward"]).unwrap();
            let mut writer = LogWriter::create(&dir, &info, &ScenarioInfo::default()).unwrap();
            let when = Timestamp::from_unix_micros(0).unwrap();
            let record = Record::new(0, exp_num, BlockType::Test, "a_b", when).with_metric("reward", 1.0);
            writer.write(&record).unwrap();
            writer.finish().unwrap();
            let mut table = LogTable::new(KeptRows::Complete);
            table.add(&read_log_with_texts(&dir).unwrap()).unwrap();
            write_log_table(&table, Vec::new(), Format::Parquet).map_err(|error| error.to_string())
        };
        let largest = i64::MAX as u64;
        assert!(write(largest).is_ok());
        let message = "column exp_num: found 9223372036854775808, expected at most 9223372036854775807 in Parquet and Arrow; write \
                       it as .tsv or .csv";
        assert_eq!(write(largest + 1).unwrap_err(), message);
    }

    #[test]
    fn a_table_without_rows_still_has_its_columns() {
        for format in [Format::Parquet, Format::Arrow] {
            let empty = LogTable::default();
            let bytes = write_log_table(&empty, Vec::new(), format).unwrap();
            assert_eq!(
                read_back(bytes, format)
                    .iter()
                    .map(RecordBatch::num_rows)
                    .sum::<usize>(),
                0
            );
            let again = write_log_table(&table(10), Vec::new(), format).unwrap();
            assert_eq!(
                again,
                write_log_table(&table(10), Vec::new(), format).unwrap(),
                "same rows, same bytes"
            );
        }
    }
}
