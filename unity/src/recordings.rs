//! [`RecordingFile`]: the file to which a session's episodes are appended.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufReader, Seek, Write};
use std::path::{Path, PathBuf};

use driftworld_env::{Recording, RecordingLines, RecordingReader};

use crate::error::UnityError;

/// A recordings file, opened for appending. A client that starts this program repeatedly extends the same file.
#[derive(Debug)]
pub struct RecordingFile {
    path: PathBuf,
    file: File,
    lines: RecordingLines,
    /// Index of the next episode.
    next: u64,
}

impl RecordingFile {
    /// Creates a file, or opens an existing one to continue after its last complete episode.
    ///
    /// # Errors
    /// [`UnityError::Writing`] if it cannot be written or another process is writing it; [`UnityError::Recording`] if it has
    /// other contents or is damaged.
    pub fn open(path: &Path) -> Result<Self, UnityError> {
        let failed = |source: std::io::Error| UnityError::Writing {
            option: "--record",
            path: path.to_owned(),
            source,
        };
        // Not through driftworld-files, because it is read and written; irregular files are refused here.
        let mut options = OpenOptions::new();
        let mut file = options
            .read(true)
            .append(true)
            .create(true)
            .open(path)
            .map_err(failed)?;
        if !file.metadata().map_err(failed)?.is_file() {
            return Err(failed(std::io::Error::other("found no regular file, expected one")));
        }
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(failed(std::io::Error::other(
                    "another driftworld-unity is writing to it; name another file",
                )));
            }
            // If the file system does not support locks, continue without one.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        let length = file.metadata().map_err(failed)?.len();
        let (mut kept_bytes, mut lines, mut next) = (0, RecordingLines::default(), 0);
        // A shorter file contains at most a part of the first line.
        if length >= RecordingLines::header().len() as u64 {
            let damaged = |source| UnityError::Recording {
                path: path.to_owned(),
                source,
            };
            let read = BufReader::new(file.try_clone().map_err(failed)?);
            let reader = RecordingReader::new(read).map_err(damaged)?;
            (kept_bytes, lines, next) = reader.into_lines_before(u64::MAX).map_err(damaged)?;
        }
        file.set_len(kept_bytes).map_err(failed)?;
        file.rewind().map_err(failed)?;
        if kept_bytes == 0 {
            file.write_all(RecordingLines::header().as_bytes()).map_err(failed)?;
        }
        Ok(Self {
            path: path.to_owned(),
            file,
            lines,
            next,
        })
    }

    /// Appends an episode, with the next index.
    ///
    /// # Errors
    /// [`UnityError::Writing`] if it cannot be written.
    pub fn write(&mut self, mut recording: Recording) -> Result<(), UnityError> {
        recording.origin.experience = self.next;
        let lines = self.lines.lines(&recording);
        self.next += 1;
        self.file
            .write_all(lines.as_bytes())
            .map_err(|source| UnityError::Writing {
                option: "--record",
                path: self.path.clone(),
                source,
            })
    }
}
