//! What programs ask of an error: its stable code, and the line that it is about. What it says is in `mod.rs`.

use super::MetricsError;

impl MetricsError {
    /// The line of the file that is meant, from 1; `None` where the error is of no line.
    pub fn line(&self) -> Option<u64> {
        match self {
            Self::Json { line, .. } => Some(*line as u64),
            Self::TornLastLine(at)
            | Self::CarriageReturns(at)
            | Self::OpenQuote(at)
            | Self::NotUtf8(at)
            | Self::RaggedRow { at, .. }
            | Self::Cell { at, .. }
            | Self::BlockOrder { at, .. }
            | Self::NumberFalls { at, .. }
            | Self::NotCompleted { at, .. }
            | Self::RowAfterComplete { at, .. } => Some(at.line),
            _ => None,
        }
    }

    /// A stable code for programs, such as `metrics/ragged-row`.
    pub fn code(&self) -> &'static str {
        self.into()
    }
}
