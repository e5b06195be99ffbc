//! [`CustomColumn`]: a column that logs name, beside the standard ones.
//!
//! Not here: the standard columns, see `columns`.

use super::text_column::TextColumn;

/// A column that the logs name.
#[derive(Debug, Clone)]
pub(super) enum CustomColumn {
    Numbers(Vec<f64>),
    Texts(TextColumn),
}

impl CustomColumn {
    /// The column as texts, which it becomes if it is none yet.
    pub(super) fn as_texts(&mut self) -> &mut TextColumn {
        if let Self::Numbers(numbers) = self {
            let mut texts = TextColumn::default();
            for number in numbers {
                texts.push(&number_text(*number));
            }
            *self = Self::Texts(texts);
        }
        match self {
            Self::Texts(texts) => texts,
            Self::Numbers(_) => unreachable!("it was made texts just now"),
        }
    }
}

/// The shortest text that reads back as the same number; none where there is none.
pub(super) fn number_text(number: f64) -> String {
    if number.is_nan() {
        String::new()
    } else {
        format!("{number:?}")
    }
}
