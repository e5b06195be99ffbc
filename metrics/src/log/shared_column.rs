//! A column with few distinct values over many rows: each value is stored once, and rows refer to it by id.

use std::collections::HashMap;

/// Maximum number of distinct strings remembered. Most logs have few, but a log with more can still be read.
const MAX_REMEMBERED: usize = 65_536;

/// A column that stores each of its values once.
///
/// [`values`](Self::values) may contain a value twice if a log has very many distinct ones: rows with the same id are
/// equal, and rows with different ids usually are not.
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

    /// For each row, the index of its value in [`values`](Self::values).
    pub fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// The value of a row. Panics unless `row` is below the number of rows.
    pub(crate) fn of(&self, row: usize) -> &T {
        &self.values[self.ids[row] as usize]
    }

    /// Adds a value, even if it exists already.
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

/// Reorders a column: row `n` becomes the former row `order[n]`.
pub(super) fn reorder<T: Copy>(column: &mut Vec<T>, order: &[u32]) {
    *column = order.iter().map(|&row| column[row as usize]).collect();
}

/// Finds the id of a string seen before; fastest if it repeats the previous one.
#[derive(Debug, Default)]
pub(super) struct Seen {
    ids: HashMap<String, u32>,
    last: Option<(String, u32)>,
}

impl Seen {
    /// The id of a string's value; `make` creates the value of a new string.
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
            // The number of rows is far below the range of a u32, and each adds at most one value.
            let id = column.values.len() as u32;
            column.values.push(value);
            if self.ids.len() == MAX_REMEMBERED {
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
    fn equal_strings_share_a_value_and_survive_reordering() {
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
