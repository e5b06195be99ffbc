//! Opens every file that a user or a log names: regular files only, and never more of one than a limit. What stands in
//! a file is its reader's affair; nothing is written here, but a file is opened for additions in the same careful way.
//!
//! A pipe would be waited for without an end, a device may never end, and a file may be larger than the memory. So a
//! path is looked at before it is opened, the opened file once more, its length before it is read, and no more is read
//! than the limit allows.

mod error;
mod kind;

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Read};
use std::path::Path;

pub use error::FileError;
pub use kind::LOST_LINK;

/// A regular file that is open for reading.
#[derive(Debug)]
pub struct Opened {
    /// The file, at its start.
    pub file: File,
    /// Its length in bytes when it was opened; 0 for files that the system makes while they are read.
    pub length: u64,
}

/// Opens a regular file of at most `limit` bytes; links are followed.
///
/// # Errors
/// [`FileError::Unreadable`], also where there is nothing; [`FileError::NotAFile`] for a folder, a device, a named
/// pipe, a socket and a link that leads nowhere; [`FileError::TooLarge`].
pub fn open(path: &Path, limit: u64) -> Result<Opened, FileError> {
    check(path)?;
    let file = without_waiting(path).map_err(unreadable(path))?;
    // Another file may have taken its place meanwhile.
    let found = file.metadata().map_err(unreadable(path))?;
    kind::check(path, found.file_type())?;
    let length = found.len();
    within(path, length, limit)?;
    Ok(Opened { file, length })
}

fn unreadable(path: &Path) -> impl FnOnce(std::io::Error) -> FileError {
    move |source| FileError::Unreadable {
        path: path.to_owned(),
        source,
    }
}

fn within(path: &Path, found: u64, limit: u64) -> Result<(), FileError> {
    if found <= limit {
        return Ok(());
    }
    Err(FileError::TooLarge {
        path: path.to_owned(),
        found,
        limit,
    })
}

/// Looks whether a regular file is there, and opens nothing; links are followed.
///
/// # Errors
/// [`FileError::Unreadable`], also where there is nothing; [`FileError::NotAFile`].
pub fn check(path: &Path) -> Result<(), FileError> {
    let found = fs::metadata(path).map_err(|source| match source.kind() {
        ErrorKind::NotFound if path.is_symlink() => kind::error(path, LOST_LINK),
        _ => unreadable(path)(source),
    })?;
    kind::check(path, found.file_type())
}

/// The bytes of a regular file of at most `limit` bytes.
///
/// # Errors
/// As [`open`]; [`FileError::TooLarge`] also for a file that grows beyond the limit while it is read.
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
    // One more, so that the end is seen without making room again.
    let room = usize::try_from(length).unwrap_or(usize::MAX).saturating_add(1);
    bytes
        .try_reserve_exact(room)
        .map_err(|_| unreadable(path)(ErrorKind::OutOfMemory.into()))?;
    file.take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(unreadable(path))?;
    within(path, bytes.len() as u64, limit)?;
    Ok(bytes)
}

/// The text of a regular file of at most `limit` bytes, without the byte order mark that some editors put in front.
///
/// # Errors
/// As [`read`]; [`FileError::NotText`] with the place of the first byte that is no UTF-8.
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

/// Opens a file for additions, made if need be. A named pipe that nobody reads is refused, and one whose reader is slow
/// is not waited for: what it does not take is an error of the writing.
///
/// # Errors
/// What the system says.
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

/// Opens for reading. A pipe that has just taken the file's place is not waited for, and no terminal is taken over.
#[cfg(unix)]
fn without_waiting(path: &Path) -> std::io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    OpenOptions::new()
        .read(true)
        .custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY)
        .open(path)
}

#[cfg(not(unix))]
fn without_waiting(path: &Path) -> std::io::Result<File> {
    OpenOptions::new().read(true).open(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a temporary folder can be made")
    }

    #[test]
    fn a_file_is_read_up_to_the_limit_and_not_beyond() {
        let folder = folder();
        let path = folder.path().join("file");
        fs::write(&path, [7; 1000]).expect("it can be written");
        assert_eq!(read(&path, 1000).expect("it fits"), [7; 1000]);
        assert_eq!(open(&path, u64::MAX).expect("it fits").length, 1000);
        let error = read(&path, 999).expect_err("it is too large");
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
    fn the_place_of_what_is_no_text_is_told_and_a_byte_order_mark_is_not() {
        let folder = folder();
        let path = folder.path().join("file");
        let with = |bytes: &[u8]| {
            fs::write(&path, bytes).expect("it can be written");
            text(&path, 100)
        };
        assert_eq!(with("\u{feff}\u{feff}ä".as_bytes()).expect("it is text"), "\u{feff}ä");
        let error = with(b"a\nb\n\xff\xfe").expect_err("it is no text");
        assert!(matches!(error, FileError::NotText { at: 4, line: 3, .. }), "{error}");
    }

    #[test]
    fn where_there_is_nothing_the_system_says_so() {
        let folder = folder();
        let error = read(&folder.path().join("absent"), 9).expect_err("there is nothing");
        assert_eq!(error.missing(), Some(folder.path().join("absent").as_path()));
    }

    #[test]
    #[cfg(unix)]
    fn what_is_no_regular_file_is_refused_before_it_is_opened() {
        use std::os::unix::{fs::symlink, net::UnixListener};
        let folder = folder();
        let at = |name: &str| folder.path().join(name);
        let found = |path: &Path| match read(path, 9) {
            Err(FileError::NotAFile { found, .. }) => Some(found),
            Err(other) => panic!("{other}"),
            Ok(_) => None,
        };
        fs::write(at("file"), "").expect("it can be written");
        symlink("file", at("link")).expect("a link can be made");
        symlink("nowhere", at("lost")).expect("a link can be made");
        symlink("/dev/zero", at("zeros")).expect("a link can be made");
        symlink("turn", at("turn")).expect("a link can be made");
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
        let error = read(&at("turn"), 9).expect_err("it leads to itself");
        assert!(matches!(error, FileError::Unreadable { .. }), "{error}");
    }

    /// What takes the place of a file between the two looks at it.
    #[test]
    #[cfg(unix)]
    fn a_pipe_that_nobody_writes_to_is_opened_without_waiting() {
        let folder = folder();
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.expect("every unix has mkfifo").success());
        let opened = without_waiting(&pipe).expect("it can be opened");
        let kind = opened.metadata().expect("it can be looked at").file_type();
        assert!(kind::check(&pipe, kind).is_err());
        drop(opened);
        assert!(append(&pipe).is_err(), "nobody reads it");
    }

    /// Files that the system makes while they are read say that they are empty.
    #[test]
    #[cfg(target_os = "linux")]
    fn a_file_without_a_length_is_read_up_to_the_limit() {
        let path = Path::new("/proc/self/status");
        assert!(!read(path, 1 << 20).expect("it is short").is_empty());
        assert!(matches!(read(path, 10), Err(FileError::TooLarge { found: 11, .. })));
    }
}
