//! What programs ask of an error: its stable code, and the line that it is about. What it says is in `mod.rs`.

use super::MetricsError;

impl MetricsError {
    /// The line of the file that is meant, from 1; `None` where the error is of no line.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Json { line, .. } => Some(*line as u64),
            Self::RaggedRow { line, .. }
            | Self::Cell { line, .. }
            | Self::TornLastLine { line, .. }
            | Self::CarriageReturns { line, .. }
            | Self::OpenQuote { line, .. }
            | Self::NotUtf8 { line, .. }
            | Self::BlockOrder { line, .. }
            | Self::NumberFalls { line, .. }
            | Self::NotCompleted { line, .. }
            | Self::RowAfterComplete { line, .. } => Some(*line),
            _ => None,
        }
    }

    /// A stable code for programs, such as `metrics/ragged-row`.
    pub fn code(&self) -> &'static str {
        self.into()
    }
}
