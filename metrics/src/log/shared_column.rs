//! A column of few different values over many rows: each value is kept once, and a row has its number.
//!
//! Not here: which columns there are, see `rows`.

use std::collections::HashMap;

/// So many different texts are remembered; a log has few, and one that does not is read all the same.
const REMEMBERED: usize = 65_536;

/// A column that keeps each of its values once.
///
/// A value may stand in [`values`](Self::values) twice where a log has very many different ones, so that two rows with the
/// same number are equal and two rows with different ones usually are not.
#[derive(Debug, Clone, Default)]
pub struct SharedColumn<T> {
    values: Vec<T>,
    ids: Vec<u32>,
}

impl<T> SharedColumn<T> {
    /// The values, in the order in which they were first read.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// For each row, the position of its value in [`values`](Self::values).
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// The value of a row; `row` counts from 0, below the number of rows.
    pub(crate) fn of(&self, row: usize) -> &T {
        &self.values[self.ids[row] as usize]
    }

    /// Adds a value, whether it is there or not.
    #[cfg(test)]
    pub(super) fn add(&mut self, value: T) {
        self.values.push(value);
    }

    pub(super) fn push(&mut self, id: u32) {
        self.ids.push(id);
    }

    pub(super) fn reorder(&mut self, order: &[u32]) {
        reorder(&mut self.ids, order);
    }
}

/// Puts a column into another order: row `n` becomes what row `order[n]` was.
pub(super) fn reorder<T: Copy>(column: &mut Vec<T>, order: &[u32]) {
    *column = order.iter().map(|&row| column[row as usize]).collect();
}

/// Finds the number of a text that was there before, fastest where it is the text of the row before.
#[derive(Debug, Default)]
pub(super) struct Seen {
    ids: HashMap<String, u32>,
    last: Option<(String, u32)>,
}

impl Seen {
    /// The number of the value that a text stands for; `make` makes the value of a text that is new.
    pub(super) fn id<T, E>(
        &mut self,
        column: &mut SharedColumn<T>,
        text: &str,
        make: impl FnOnce(&str) -> Result<T, E>,
    ) -> Result<u32, E> {
        if let Some((last, id)) = &self.last
            && last == text
        {
            return Ok(*id);
        }
        let id = if let Some(&id) = self.ids.get(text) {
            id
        } else {
            let value = make(text)?;
            // Rows are bounded far below what a u32 counts, and each adds one value at most.
            let id = column.values.len() as u32;
            column.values.push(value);
            if self.ids.len() == REMEMBERED {
                self.ids.clear();
            }
            self.ids.insert(text.to_owned(), id);
            id
        };
        let (last, last_id) = self.last.get_or_insert_default();
        last.clear();
        last.push_str(text);
        *last_id = id;
        Ok(id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_texts_share_one_value_and_rows_keep_theirs_in_any_order() {
        let (mut column, mut seen) = (SharedColumn::default(), Seen::default());
        for text in ["a", "a", "b", "a"] {
            let id = seen.id(&mut column, text, |text| Ok::<_, ()>(text.to_owned())).unwrap();
            column.push(id);
        }
        assert!(seen.id(&mut column, "c", |_| Err(())).is_err());
        assert_eq!((column.values().len(), column.ids()), (2, &[0, 0, 1, 0][..]));
        column.reorder(&[2, 0, 3, 1]);
        assert_eq!((0..4).map(|row| column.of(row).as_str()).collect::<String>(), "baaa");
    }
}
