//! Opens every file that a user or a log names: regular files only, read up to a size limit. Also opens files for appending with
//! the same care.
//!
//! Reading a named pipe could block forever, a device may never end, and a file may be larger than memory. So the kind is checked
//! before and after opening, the length before reading, and reading stops at the limit.

mod error;
mod kind;

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Read};
use std::path::Path;

pub use error::FileError;
pub use kind::LOST_LINK;

/// A regular file, open for reading.
#[derive(Debug)]
pub struct Opened {
    /// The file, at its start.
    pub file: File,
    /// Its length in bytes when it was opened; 0 for files whose content the system generates on reading.
    pub length: u64,
}

/// Opens a regular file of at most `limit` bytes; follows links.
///
/// # Errors
/// [`FileError::Unreadable`] if the file does not exist or the system refuses to open it; [`FileError::NotAFile`] for a folder, a
/// device, a named pipe, a socket or a broken link; [`FileError::TooLarge`] for a file longer than `limit`.
pub fn open(path: &Path, limit: u64) -> Result<Opened, FileError> {
    check(path)?;
    let file = open_without_blocking(path).map_err(unreadable(path))?;
    // Another file may have replaced it since the first check.
    let found = file.metadata().map_err(unreadable(path))?;
    kind::check(path, found.file_type())?;
    let length = found.len();
    check_length(path, length, limit)?;
    Ok(Opened { file, length })
}

fn unreadable(path: &Path) -> impl FnOnce(std::io::Error) -> FileError {
    move |source| FileError::Unreadable {
        path: path.to_owned(),
        source,
    }
}

fn check_length(path: &Path, found: u64, limit: u64) -> Result<(), FileError> {
    if found <= limit {
        return Ok(());
    }
    Err(FileError::TooLarge {
        path: path.to_owned(),
        found,
        limit,
    })
}

/// Checks that a path is a regular file without opening it; follows links.
///
/// # Errors
/// [`FileError::Unreadable`] if the path does not exist or cannot be inspected; [`FileError::NotAFile`] if it is not a regular file.
pub fn check(path: &Path) -> Result<(), FileError> {
    let found = fs::metadata(path).map_err(|source| match source.kind() {
        ErrorKind::NotFound if path.is_symlink() => kind::error(path, LOST_LINK),
        _ => unreadable(path)(source),
    })?;
    kind::check(path, found.file_type())
}

/// Reads a regular file of at most `limit` bytes.
///
/// # Errors
/// The errors of [`open`]; [`FileError::TooLarge`] also if the file grows beyond the limit while it is read.
///
/// # Example
/// ```
/// # let folder = tempfile::tempdir()?;
/// # let path = folder.path().join("a.txt");
/// std::fs::write(&path, "four")?;
/// assert_eq!(driftworld_files::read(&path, 4)?, b"four");
/// assert!(driftworld_files::read(&path, 3).is_err());
/// assert!(driftworld_files::read(folder.path(), 3).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    let Opened { file, length } = open(path, limit)?;
    let mut bytes = Vec::new();
    // One byte more than the length, so that detecting the end of the file needs no reallocation.
    let capacity = usize::try_from(length).unwrap_or(usize::MAX).saturating_add(1);
    bytes
        .try_reserve_exact(capacity)
        .map_err(|_| unreadable(path)(ErrorKind::OutOfMemory.into()))?;
    file.take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(unreadable(path))?;
    check_length(path, bytes.len() as u64, limit)?;
    Ok(bytes)
}

/// Reads a UTF-8 text file of at most `limit` bytes, and drops the byte order mark that some editors write.
///
/// # Errors
/// The errors of [`read`]; [`FileError::NotText`] with the position of the first byte that is not UTF-8.
pub fn text(path: &Path, limit: u64) -> Result<String, FileError> {
    let mut text = String::from_utf8(read(path, limit)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..at]);
        FileError::NotText {
            path: path.to_owned(),
            at,
            line: 1 + before.matches('\n').count(),
        }
    })?;
    if text.starts_with('\u{feff}') {
        text.drain(..'\u{feff}'.len_utf8());
    }
    Ok(text)
}

/// Opens a file for appending; creates it if necessary. A named pipe without a reader is refused. If a pipe's reader is slow,
/// writing fails instead of blocking.
///
/// # Errors
/// The system's error.
pub fn append(path: &Path) -> std::io::Result<File> {
    let mut options = OpenOptions::new();
    options.append(true).create(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY);
    }
    options.open(path)
}

/// Opens for reading without blocking, even if a named pipe has just replaced the file, and without making a terminal the
/// controlling terminal.
#[cfg(unix)]
fn open_without_blocking(path: &Path) -> std::io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    OpenOptions::new()
        .read(true)
        .custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY)
        .open(path)
}

#[cfg(not(unix))]
fn open_without_blocking(path: &Path) -> std::io::Result<File> {
    OpenOptions::new().read(true).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a temporary folder can be created")
    }

    #[test]
    fn read_stops_at_the_limit() {
        let folder = folder();
        let path = folder.path().join("file");
        fs::write(&path, [7; 1000]).expect("the file can be written");
        assert_eq!(read(&path, 1000).expect("the file is within the limit"), [7; 1000]);
        assert_eq!(
            open(&path, u64::MAX).expect("the file is within the limit").length,
            1000
        );
        let error = read(&path, 999).expect_err("the file is too large");
        assert!(
            matches!(
                error,
                FileError::TooLarge {
                    found: 1000,
                    limit: 999,
                    ..
                }
            ),
            "{error}"
        );
    }

    #[test]
    fn text_reports_position_of_invalid_utf8_and_drops_bom() {
        let folder = folder();
        let path = folder.path().join("file");
        let with = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("the file can be written");
            text(&path, 100)
        };
        assert_eq!(
            with("\u{feff}\u{feff}ä".as_bytes()).expect("the bytes are UTF-8"),
            "\u{feff}ä"
        );
        let error = with(b"a\nb\n\xff\xfe").expect_err("the bytes are not UTF-8");
        assert!(matches!(error, FileError::NotText { at: 4, line: 3, .. }), "{error}");
    }

    #[test]
    fn missing_file_gives_system_error() {
        let folder = folder();
        let error = read(&folder.path().join("absent"), 9).expect_err("the file does not exist");
        assert_eq!(error.missing(), Some(folder.path().join("absent").as_path()));
    }

    #[test]
    #[cfg(unix)]
    fn non_regular_files_are_refused_before_opening() {
        use std::os::unix::{fs::symlink, net::UnixListener};
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        let found = |path: &Path| match read(path, 9) {
            Err(FileError::NotAFile { found, .. }) => Some(found),
            Err(other) => panic!("{other}"),
            Ok(_) => None,
        };
        fs::write(at("file"), "").expect("the file can be written");
        symlink("file", at("link")).expect("links can be created");
        symlink("nowhere", at("lost")).expect("links can be created");
        symlink("/dev/zero", at("zeros")).expect("links can be created");
        symlink("turn", at("turn")).expect("links can be created");
        let _socket = UnixListener::bind(at("socket")).expect("a socket can be bound");
        let made = std::process::Command::new("mkfifo").arg(at("pipe")).status();
        assert!(made.expect("every unix has mkfifo").success());
        assert_eq!(found(&at("file")), None);
        assert_eq!(found(&at("link")), None);
        assert_eq!(found(folder.path()), Some("a folder"));
        assert_eq!(found(&at("lost")), Some("a link that leads nowhere"));
        assert_eq!(found(&at("socket")), Some("a socket"));
        assert_eq!(found(&at("pipe")), Some("a named pipe"));
        assert_eq!(found(&at("zeros")), Some("a device"));
        assert_eq!(found(Path::new("/dev/null")), Some("a device"));
        let error = read(&at("turn"), 9).expect_err("the link points to itself");
        assert!(matches!(error, FileError::Unreadable { .. }), "{error}");
    }

    /// A pipe may replace the file between the two checks.
    #[test]
    #[cfg(unix)]
    fn opening_a_pipe_without_a_writer_does_not_block() {
        let folder = folder();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.expect("every unix has mkfifo").success());
        let opened = open_without_blocking(&pipe).expect("the pipe can be opened");
        let kind = opened.metadata().expect("metadata can be read").file_type();
        assert!(kind::check(&pipe, kind).is_err());
        drop(opened);
        assert!(append(&pipe).is_err(), "the pipe has no reader");
    }

    /// Files whose content the system generates on reading report length 0.
    #[test]
    #[cfg(target_os = "linux")]
    fn file_with_reported_length_0_is_read_up_to_the_limit() {
        let path = Path::new("/proc/self/status");
        assert!(!read(path, 1 << 20).expect("the file is short").is_empty());
        assert!(matches!(read(path, 10), Err(FileError::TooLarge { found: 11, .. })));
    }
}
