//! What can keep the book from being made. What is wrong in a page is a finding, and all of them are reported at once.

use std::path::{Path, PathBuf};

/// Why there is no book, or none that can be trusted.
#[derive(Debug, thiserror::Error)]
pub(crate) enum BookError {
    /// mdBook itself gave up: its configuration, the summary, or a page that cannot be read.
    #[error("mdBook: {0:#}")]
    Builder(mdbook_driver::errors::Error),
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    File { path: PathBuf, source: std::io::Error },
    /// Links that lead nowhere.
    #[error("{}\n{} broken links; correct them, or restore what they led to", findings.join("\n"), findings.len())]
    Links { findings: Vec<String> },
}

/// The error for a file that could not be read or written.
pub(crate) fn file(path: &Path, source: std::io::Error) -> BookError {
    BookError::File {
        path: path.to_owned(),
        source,
    }
}
