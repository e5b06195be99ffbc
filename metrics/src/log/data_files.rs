//! Finds the data files of a log directory.
//!
//! Not here: reading them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::MetricsError;

/// Most entries (files and directories together) that a log directory may hold.
pub const MAX_LOG_FILES: usize = 200_000;

/// How deep directories are searched; the format needs two levels.
const MAX_DEPTH: usize = 8;

/// Name of every data file.
pub(super) const FILE_NAME: &str = "data-log.tsv";

/// All data files under a log directory, in the order of their paths with numbers compared as numbers. Links are not
/// followed.
pub(super) fn find(dir: &Path) -> Result<Vec<PathBuf>, MetricsError> {
    if !dir.is_dir() {
        let found = if dir.exists() { "a file" } else { "nothing" };
        return Err(MetricsError::NotADirectory {
            path: dir.to_owned(),
            found,
        });
    }
    let (mut files, mut seen) = (Vec::new(), 0);
    let mut to_search = vec![(dir.to_owned(), 0)];
    while let Some((current, depth)) = to_search.pop() {
        let list = |error| MetricsError::io(&current, "list this directory")(error);
        for entry in fs::read_dir(&current).map_err(list)? {
            let entry = entry.map_err(list)?;
            seen += 1;
            if seen > MAX_LOG_FILES {
                let (found, limit) = (seen as u64, MAX_LOG_FILES as u64);
                return Err(MetricsError::TooLarge {
                    path: dir.to_owned(),
                    what: "files or more",
                    found,
                    limit,
                });
            }
            let kind = entry.file_type().map_err(list)?;
            if kind.is_dir() && depth < MAX_DEPTH {
                to_search.push((entry.path(), depth + 1));
            } else if kind.is_file() && entry.file_name() == FILE_NAME {
                files.push(entry.path());
            }
        }
    }
    files.sort_by_cached_key(|path| path_key(path));
    Ok(files)
}

/// Puts `2-train` before `10-test`: each part of the path by its leading number first, then by its text.
pub(super) fn path_key(path: &Path) -> Vec<(u64, String)> {
    let part_key = |part: &std::ffi::OsStr| {
        let text = part.to_string_lossy().into_owned();
        let digits = text.bytes().take_while(u8::is_ascii_digit).count();
        (text[..digits].parse().unwrap_or(u64::MAX), text)
    };
    path.iter().map(part_key).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_come_in_the_order_of_their_numbers() {
        let dir = tempfile::tempdir().unwrap();
        for block in ["w/10-test", "w/2-train", "v/11-test", "w/2-train/deeper"] {
            fs::create_dir_all(dir.path().join(block)).unwrap();
            fs::write(dir.path().join(block).join(FILE_NAME), "").unwrap();
        }
        fs::write(dir.path().join("w/2-train/other.tsv"), "").unwrap();
        let found: Vec<PathBuf> = find(dir.path()).unwrap();
        let expected = ["v/11-test", "w/2-train", "w/2-train/deeper", "w/10-test"];
        let relative: Vec<_> = found
            .iter()
            .map(|path| path.parent().unwrap().strip_prefix(dir.path()).unwrap().to_owned())
            .collect();
        assert_eq!(
            relative.iter().map(|path| path.to_str().unwrap()).collect::<Vec<_>>(),
            expected
        );
    }

    #[test]
    fn a_path_that_is_no_directory_is_named() {
        let dir = tempfile::tempdir().unwrap();
        let check = |path: &Path, found: &str| {
            let expected = "the directory of a log, which holds logger_info.json";
            let message = format!("{}: found {found}, expected {expected}", path.display());
            assert_eq!(find(path).unwrap_err().to_string(), message);
        };
        let file = dir.path().join("file");
        fs::write(&file, "").unwrap();
        check(&file, "a file");
        check(&dir.path().join("absent"), "nothing");
    }
}
