//! What programs ask of an error: its stable code, and the line that it is about. What it says is in `mod.rs`.

use super::MetricsError;

impl MetricsError {
    /// The line of the file that is meant, from 1; `None` where the error is of no line.
    pub fn line(&self) -> Option<u64> {
        match self {
            // 0 says that the file as a whole is meant.
            Self::Json { line, .. } => Some(*line as u64).filter(|line| *line > 0),
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
        match self {
            Self::Io { .. } => "metrics/io",
            Self::LogExists { .. } => "metrics/log-exists",
            Self::InUse { .. } => "metrics/in-use",
            Self::FolderLost { .. } => "metrics/folder-lost",
            Self::FileLost { .. } => "metrics/file-lost",
            Self::InfoFileChanged { .. } => "metrics/info-file-changed",
            Self::NotADirectory { .. } => "metrics/not-a-directory",
            Self::NoDataFiles { .. } => "metrics/no-data-files",
            Self::MissingFile { .. } => "metrics/missing-file",
            Self::NotAFile { .. } => "metrics/not-a-file",
            Self::Json { .. } => "metrics/json",
            Self::LoggerInfo { .. } => "metrics/logger-info",
            Self::TooLarge { .. } => "metrics/too-large",
            Self::EmptyFile { .. } => "metrics/empty-file",
            Self::NoHeader { .. } => "metrics/no-header",
            Self::NoTabs { .. } => "metrics/no-tabs",
            Self::MissingColumn { .. } => "metrics/missing-column",
            Self::RepeatedColumn { .. } => "metrics/repeated-column",
            Self::OtherColumns { .. } => "metrics/other-columns",
            Self::RaggedRow { .. } => "metrics/ragged-row",
            Self::Cell { .. } => "metrics/cell",
            Self::TornLastLine { .. } => "metrics/torn-last-line",
            Self::CarriageReturns { .. } => "metrics/carriage-returns",
            Self::OpenQuote { .. } => "metrics/open-quote",
            Self::NotUtf8 { .. } => "metrics/not-utf8",
            Self::BlockOrder { .. } => "metrics/block-order",
            Self::NumberFalls { .. } => "metrics/number-falls",
            Self::ColumnsDiffer { .. } => "metrics/columns-differ",
            Self::NotCompleted { .. } => "metrics/not-completed",
            Self::RowAfterComplete { .. } => "metrics/row-after-complete",
            Self::Record { .. } => "metrics/record",
            Self::Timestamp { .. } => "metrics/timestamp",
            Self::UnknownWord { .. } => "metrics/unknown-word",
            Self::TableColumn { .. } => "metrics/table-column",
            Self::UnknownColumn { .. } => "metrics/unknown-column",
            Self::NoUsableRows { .. } => "metrics/no-usable-rows",
            Self::NotSingleTask { .. } => "metrics/not-single-task",
            Self::NoSteData { .. } => "metrics/no-ste-data",
            Self::StePickle { .. } => "metrics/ste-pickle",
            Self::TooManyRegimes { .. } => "metrics/too-many-regimes",
            Self::PerformanceOutOfRange { .. } => "metrics/performance-out-of-range",
            Self::Metric { .. } => "metrics/metric",
            Self::Scores { .. } => "metrics/scores",
            Self::BadOption { .. } => "metrics/bad-option",
        }
    }
}
