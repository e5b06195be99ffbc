//! A column of words that need not repeat: all of them end to end, and where each ends.
//!
//! Not here: words that repeat, see `shared_column`.

/// One text per row.
#[derive(Debug, Clone, Default)]
pub struct TextColumn {
    text: String,
    ends: Vec<usize>,
}

impl TextColumn {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The text of a row, empty where the row's file lacks the column; `None` beyond the last row.
    pub fn get(&self, row: usize) -> Option<&str> {
        let end = *self.ends.get(row)?;
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        Some(&self.text[start..end])
    }

    pub(super) fn push(&mut self, text: &str) {
        self.text.push_str(text);
        self.ends.push(self.text.len());
    }

    /// Adds empty texts until there are so many rows.
    pub(super) fn pad(&mut self, num_rows: usize) {
        self.ends.resize(num_rows, self.text.len());
    }

    pub(super) fn reorder(&mut self, order: &[u32]) {
        let mut ordered = Self {
            text: String::with_capacity(self.text.len()),
            ends: Vec::with_capacity(self.ends.len()),
        };
        for &row in order {
            ordered.push(self.get(row as usize).unwrap_or_default());
        }
        *self = ordered;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_found_by_their_row() {
        let mut column = TextColumn::default();
        column.push("é");
        column.pad(2);
        column.push("two words");
        let texts = |column: &TextColumn| [0, 1, 2].map(|row| column.get(row).unwrap().to_owned());
        assert_eq!(texts(&column), ["é", "", "two words"]);
        assert_eq!(column.get(3), None);
        column.reorder(&[2, 0, 1]);
        assert_eq!(texts(&column), ["two words", "é", ""]);
    }
}
