//! [`BlockFile`]: appends rows to a data file, and detects if the file was truncated, removed or replaced in the meantime.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use super::identity::Identity;
use super::log_folder::LogFolder;
use crate::MetricsError;

/// The expected state of a data file, as known to its writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Written {
    pub(super) rows: u64,
    /// Bytes of whole lines, including the header.
    pub(super) bytes: u64,
    /// `None` before it was first opened.
    identity: Option<Identity>,
    /// `None` if it could not be read.
    digest: Option<Digest>,
}

impl Written {
    /// The state of an earlier writer's file, with this number of rows and bytes.
    pub(super) fn found(path: &Path, rows: u64, bytes: u64) -> Result<Self, MetricsError> {
        let found = fs::metadata(path).map_err(MetricsError::io(path, "inspect this file"))?;
        Ok(Self {
            rows,
            bytes,
            identity: Some(Identity::of(&found)),
            digest: Digest::of(path),
        })
    }

    const NEW_FILE: Self = Self {
        rows: 0,
        bytes: 0,
        identity: None,
        digest: Some(Digest::NEW),
    };

    /// Fails if the file at this path is missing, is a different file, or differs in length.
    ///
    /// Some file systems change the id of a file while no process has it open, so a file with a different id counts as the same if
    /// its bytes are equal.
    pub(super) fn check(&self, folder: &LogFolder, inside: &Path) -> Result<(), MetricsError> {
        let path = folder.absolute(inside);
        let found = match fs::metadata(&path) {
            // A link may lead to a file that stores nothing, such as a pipe.
            Ok(found) if !found.is_file() && !found.is_dir() => return Ok(()),
            Ok(found) if found.is_dir() => "a directory".to_owned(),
            Ok(found) if found.len() != self.bytes => rows_and_bytes(&path, found.len()),
            Ok(found) => {
                let is_known = self.identity.is_none_or(|known| known == Identity::of(&found));
                let is_equal = || self.digest.is_none_or(|digest| Digest::of(&path) == Some(digest));
                if is_known || is_equal() {
                    return Ok(());
                }
                "another file".to_owned()
            }
            Err(error) if error.kind() == ErrorKind::NotFound => "no file".to_owned(),
            Err(error) => return Err(MetricsError::io(folder.shown_inside(inside), "find this file")(error)),
        };
        Err(self.lost_error(folder, inside, found))
    }

    fn lost_error(&self, folder: &LogFolder, inside: &Path, found: String) -> MetricsError {
        MetricsError::FileLost {
            path: folder.shown_inside(inside),
            found,
            rows: self.rows,
            bytes: self.bytes,
        }
    }
}

/// Describes the rows and bytes of a file.
fn rows_and_bytes(path: &Path, bytes: u64) -> String {
    let rows = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .flexible(true)
        .from_path(path)
        .map(|file| file.into_byte_records().take_while(Result::is_ok).count());
    match rows {
        Ok(rows) => format!("{} in {bytes} bytes", driftworld_text::counted(rows, "row")),
        Err(_) => format!("{bytes} bytes"),
    }
}

/// An open data file, with its expected state.
#[derive(Debug)]
pub(super) struct BlockFile {
    /// Its path inside the log's directory.
    pub(super) inside: PathBuf,
    pub(super) written: Written,
    place: PathBuf,
    file: File,
}

impl BlockFile {
    /// Opens a data file for appending, and writes its header if it is new. `before` is the state in which this log's writers left
    /// the file; `None` for a new one.
    pub(super) fn open(
        folder: &LogFolder,
        inside: PathBuf,
        before: Option<Written>,
        header: &[u8],
    ) -> Result<Self, MetricsError> {
        if let Some(before) = &before {
            before.check(folder, &inside)?;
        } else if let Some(parent) = inside.parent() {
            folder.make(parent)?;
        }
        let path = folder.absolute(&inside);
        let io = |doing| MetricsError::io(folder.shown_inside(&inside), doing);
        let file = OpenOptions::new().append(true).create(before.is_none()).open(&path);
        let file = file.map_err(io("open this file"))?;
        let found = file.metadata().map_err(io("read this file's size"))?;
        let mut written = before.unwrap_or(Written::NEW_FILE);
        if found.len() != written.bytes && found.is_file() {
            return Err(written.lost_error(folder, &inside, rows_and_bytes(&path, found.len())));
        }
        written.identity = Some(Identity::of(&found));
        let mut opened = Self {
            inside,
            written,
            place: path,
            file,
        };
        if found.len() == 0 {
            opened.append(folder, header)?;
        }
        Ok(opened)
    }

    /// Whether the opened file is still the one at its path, and has the expected length. This takes one system call, which also
    /// detects a lost directory; [`Written::check`] identifies the fault.
    pub(super) fn is_unchanged(&self) -> bool {
        fs::metadata(&self.place).is_ok_and(|found| {
            found.is_file() && found.len() == self.written.bytes && self.written.identity == Some(Identity::of(&found))
        })
    }

    /// Adds a row.
    pub(super) fn add_row(&mut self, folder: &LogFolder, row: &[u8]) -> Result<(), MetricsError> {
        self.append(folder, row)?;
        self.written.rows += 1;
        Ok(())
    }

    /// Syncs the file to disk.
    pub(super) fn sync(&self, folder: &LogFolder) -> Result<(), MetricsError> {
        // A file that is not regular, such as a linked pipe, has nothing to sync.
        match self.file.sync_all() {
            Err(error) if error.kind() != ErrorKind::InvalidInput => Err(MetricsError::io(
                folder.shown_inside(&self.inside),
                "write this file",
            )(error)),
            _ => Ok(()),
        }
    }

    /// Appends one line in one call; undoes a partial write.
    fn append(&mut self, folder: &LogFolder, line: &[u8]) -> Result<(), MetricsError> {
        if let Err(source) = self.file.write_all(line) {
            // If even this fails, the torn line stays, and the reader reports it.
            let _ = self.file.set_len(self.written.bytes);
            let shown = folder.shown_inside(&self.inside);
            return Err(MetricsError::io(shown, "append a line to this file")(source));
        }
        self.written.bytes += line.len() as u64;
        if let Some(digest) = &mut self.written.digest {
            digest.take(line);
        }
        Ok(())
    }
}

/// A CRC-32 of a file's bytes, which does not protect against deliberate forgery.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Digest(u32);

impl Digest {
    const NEW: Self = Self(0);

    fn take(&mut self, bytes: &[u8]) {
        let mut hasher = crc32fast::Hasher::new_with_initial(self.0);
        hasher.update(bytes);
        self.0 = hasher.finalize();
    }

    /// The digest of a file; `None` if it cannot be read.
    fn of(path: &Path) -> Option<Self> {
        // Opened directly, not through driftworld-files: it is our own file, just written.
        let (mut file, mut piece, mut digest) = (File::open(path).ok()?, vec![0; 1 << 16], Self::NEW);
        loop {
            match file.read(&mut piece).ok()? {
                0 => return Some(digest),
                num => digest.take(&piece[..num]),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digest_does_not_depend_on_chunk_boundaries() {
        let digest = |pieces: &[&str]| {
            let mut digest = Digest::NEW;
            for piece in pieces {
                digest.take(piece.as_bytes());
            }
            digest
        };
        // The check value in the CRC catalogue.
        assert_eq!(digest(&["123456789"]), Digest(0xcbf4_3926));
        assert_eq!(digest(&["", "1234", "", "56789"]), Digest(0xcbf4_3926));
        assert_ne!(digest(&["123456788"]), Digest(0xcbf4_3926));
    }
}
