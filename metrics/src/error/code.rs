//! The stable code of an error, for programs, and the line of the file that the error concerns.

use super::MetricsError;

impl MetricsError {
    /// The line of the file, from 1; `None` if the error does not concern a line.
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
