//! [`Journal`]: writes remarks, line by line, to the terminal or a file.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use driftworld_text::printable_lines;

use crate::error::UnityError;

/// The destination of remarks.
#[derive(Debug)]
pub struct Journal {
    file: Option<File>,
}

impl Journal {
    /// Opens a journal that appends to a file, or writes to the terminal.
    ///
    /// # Errors
    /// [`UnityError::Writing`] if the file cannot be opened for writing.
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

    /// Writes one remark, with control and invisible characters escaped. If writing to the file fails, switches to the
    /// terminal.
    pub fn note(&mut self, remark: &str) {
        let remark = printable_lines(remark);
        let written = self
            .file
            .as_mut()
            .map(|file| writeln!(file, "driftworld-unity: {remark}"));
        if !matches!(written, Some(Ok(()))) {
            self.file = None;
            // A closed terminal is no reason to stop.
            let _ = writeln!(std::io::stderr(), "driftworld-unity: {remark}");
        }
    }
}
