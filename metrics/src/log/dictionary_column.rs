//! [`DictionaryColumn`]: words that repeat, as Arrow's dictionaries have them.
//!
//! Not here: words that need not repeat, see `text_column`; those of one log, see `shared_column`.

use indexmap::IndexSet;

use super::shared_column::SharedColumn;

/// A column of words that repeat: each once, and for each row the position of its own.
#[derive(Debug, Clone, Default)]
pub struct DictionaryColumn {
    values: IndexSet<String>,
    keys: Vec<u32>,
}

impl DictionaryColumn {
    /// The words, in the order of their first rows.
    pub fn values(&self) -> impl ExactSizeIterator<Item = &str> {
        self.values.iter().map(String::as_str)
    }

    /// For each row, the position of its word among the values.
    pub fn keys(&self) -> &[u32] {
        &self.keys
    }

    /// The word of a row.
    pub(super) fn get(&self, row: usize) -> &str {
        &self.values[self.keys[row] as usize]
    }

    /// The position of a word among the values, which it joins if it is new.
    pub(super) fn key(&mut self, word: &str) -> u32 {
        // There are no more words than rows, which a u32 counts.
        self.values
            .get_index_of(word)
            .unwrap_or_else(|| self.values.insert_full(word.to_owned()).0) as u32
    }

    pub(super) fn push(&mut self, word: &str) {
        let key = self.key(word);
        self.keys.push(key);
    }

    /// Adds a row whose word is at this position.
    pub(super) fn push_key(&mut self, key: u32) {
        self.keys.push(key);
    }
}

/// The positions in the table's words that a log's shared values have; found once for each.
pub(super) struct Keys<'a, T> {
    column: &'a SharedColumn<T>,
    keys: Vec<Option<u32>>,
}

impl<'a, T> Keys<'a, T> {
    pub(super) fn new(column: &'a SharedColumn<T>) -> Self {
        Self {
            column,
            keys: vec![None; column.values().len()],
        }
    }

    pub(super) fn push(&mut self, words: &mut DictionaryColumn, row: usize, text: impl Fn(&T) -> String) {
        let id = self.column.ids()[row] as usize;
        let key = *self.keys[id].get_or_insert_with(|| words.key(&text(&self.column.values()[id])));
        words.push_key(key);
    }
}
