//! [`FileError`]: why a file cannot be opened or read.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use driftworld_text::ShownPath;

/// Errors raised when opening or reading a file. Each message gives the path, what was found, what was expected, and what to do.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "files/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum FileError {
    /// The file does not exist, or the system refuses to read it.
    #[error("{}: cannot be read: {source}", path.shown())]
    Unreadable {
        /// The file's path.
        path: PathBuf,
        /// The system's error.
        source: std::io::Error,
    },
    /// The path is not a regular file.
    #[error("{}: found {found}, expected a regular file; {}", path.shown(), advice(found))]
    NotAFile {
        /// The file's path.
        path: PathBuf,
        /// What the path is instead: "a folder", "a named pipe", "a link that leads nowhere" and so on.
        found: &'static str,
    },
    /// The file is too large.
    #[error("{}: found {found} bytes, expected at most {limit}; name a smaller file, or split it", path.shown())]
    TooLarge {
        /// The file's path.
        path: PathBuf,
        /// The file's size in bytes, or a lower bound on it.
        found: u64,
        /// Maximum number of bytes allowed.
        limit: u64,
    },
    /// The file is not UTF-8 text.
    #[error("{}: byte {at} (line {line}) is not UTF-8, expected UTF-8 text; save it as UTF-8", path.shown())]
    NotText {
        /// The file's path.
        path: PathBuf,
        /// Offset of the first invalid byte, from 0.
        at: usize,
        /// Line of that byte, from 1.
        line: usize,
    },
}

impl FileError {
    /// The path, if the file does not exist.
    pub fn missing(&self) -> Option<&Path> {
        match self {
            Self::Unreadable { path, source } if source.kind() == ErrorKind::NotFound => Some(path),
            _ => None,
        }
    }

    /// The message without the path, for callers that have already named the file.
    pub fn without_path(&self) -> String {
        let path = match self {
            Self::Unreadable { path, .. }
            | Self::NotAFile { path, .. }
            | Self::TooLarge { path, .. }
            | Self::NotText { path, .. } => path.shown(),
        };
        let message = self.to_string();
        let alone = message.strip_prefix(&format!("{path}: ")).unwrap_or(&message);
        alone.strip_prefix("cannot be read: ").unwrap_or(alone).to_owned()
    }

    /// Stable code of this kind of error.
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

/// Advice for a path that is not a regular file.
fn advice(found: &str) -> &'static str {
    match found {
        "a folder" => "name a file in it",
        "a link that leads nowhere" => "fix the link, or name a file",
        _ => "save its content in a file, and name that file",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every variant with its message.
    #[test]
    fn messages_state_found_expected_and_advice() {
        let path = || PathBuf::from("a.json");
        let check = |error: FileError, code: &str, expected: &str| {
            assert_eq!((error.code(), error.to_string().as_str()), (code, expected));
            let alone = error.without_path();
            assert!(expected.ends_with(&alone) && !alone.contains("a.json"), "{alone}");
        };
        check(
            FileError::Unreadable {
                path: path(),
                source: ErrorKind::PermissionDenied.into(),
            },
            "files/unreadable",
            "a.json: cannot be read: permission denied",
        );
        let not_a_file = |found| FileError::NotAFile { path: path(), found };
        check(
            not_a_file("a folder"),
            "files/not-a-file",
            "a.json: found a folder, expected a regular file; name a file in it",
        );
        check(
            not_a_file("a named pipe"),
            "files/not-a-file",
            "a.json: found a named pipe, expected a regular file; save its content in a file, and name that file",
        );
        check(
            not_a_file("a link that leads nowhere"),
            "files/not-a-file",
            "a.json: found a link that leads nowhere, expected a regular file; fix the link, or name a file",
        );
        check(
            FileError::TooLarge {
                path: path(),
                found: 70,
                limit: 64,
            },
            "files/too-large",
            "a.json: found 70 bytes, expected at most 64; name a smaller file, or split it",
        );
        check(
            FileError::NotText {
                path: path(),
                at: 7,
                line: 2,
            },
            "files/not-text",
            "a.json: byte 7 (line 2) is not UTF-8, expected UTF-8 text; save it as UTF-8",
        );
    }
}
