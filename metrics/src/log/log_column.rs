//! [`LogColumn`]: a column of a table of logs, whatever stands in it.
//!
//! Not here: which columns a table has, see `aggregate`.

use super::dictionary_column::DictionaryColumn;
use super::text_column::TextColumn;
use super::timestamp::Timestamp;

/// A column of a [`LogTable`](crate::LogTable).
#[derive(Debug, Clone, Copy)]
pub enum LogColumn<'a> {
    /// Whole numbers.
    Integers(&'a [u64]),
    /// Words that repeat.
    Dictionary(&'a DictionaryColumn),
    /// Time stamps.
    Times(&'a [Timestamp]),
    /// Numbers, NaN where there is none.
    Numbers(&'a [f64]),
    /// Texts, empty where there is none.
    Texts(&'a TextColumn),
}

impl LogColumn<'_> {
    /// Appends the cell of a row.
    pub(super) fn write(&self, row: usize, cell: &mut String) {
        use std::fmt::Write as _;
        let written = match self {
            Self::Integers(numbers) => write!(cell, "{}", numbers[row]),
            Self::Dictionary(words) => cell.write_str(words.get(row)),
            Self::Times(stamps) => write!(cell, "{}", stamps[row]),
            Self::Numbers(numbers) if numbers[row].is_nan() => Ok(()),
            Self::Numbers(numbers) => write!(cell, "{:?}", numbers[row]),
            Self::Texts(texts) => cell.write_str(texts.get(row).unwrap_or_default()),
        };
        written.expect("memory takes every text");
    }
}
