//! [`Journal`]: remarks, line by line, on the terminal or in a file. What is remarked is decided elsewhere.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use driftworld_text::printable_lines;

use crate::error::UnityError;

/// Where remarks go.
#[derive(Debug)]
pub struct Journal {
    file: Option<File>,
}

impl Journal {
    /// A journal at the end of a file, or on the terminal.
    ///
    /// # Errors
    /// [`UnityError::Writing`] where the file cannot be opened for writing.
    pub fn open(path: Option<&Path>) -> Result<Self, UnityError> {
        let open = |path: &Path| {
            driftworld_files::append(path).map_err(|source| UnityError::Writing {
                option: "-logFile",
                path: path.to_owned(),
                source,
            })
        };
        Ok(Self {
            file: path.map(open).transpose()?,
        })
    }

    /// Notes one remark, in which characters that a terminal would obey or hide are shown. A file that cannot be
    /// written any more is left for the terminal.
    pub fn note(&mut self, remark: &str) {
        let remark = printable_lines(remark);
        let written = self
            .file
            .as_mut()
            .map(|file| writeln!(file, "driftworld-unity: {remark}"));
        if !matches!(written, Some(Ok(()))) {
            self.file = None;
            // A terminal that is gone is no reason to end.
            let _ = writeln!(std::io::stderr(), "driftworld-unity: {remark}");
        }
    }
}
