//! Finds the data files of a log directory.

use std::collections::BTreeSet;
use std::fs::{self, FileType};
use std::path::{Path, PathBuf};

use super::regular_file;
use crate::MetricsError;

/// Maximum number of entries (files and directories together) in a log directory.
pub const MAX_LOG_FILES: usize = 200_000;

/// Maximum depth of the search; the format needs two levels.
const MAX_DEPTH: usize = 8;

/// Name of every data file.
pub(super) const FILE_NAME: &str = "data-log.tsv";

/// Maximum depth of links to directories, enough for those of workers and blocks. Anything deeper behind a link is skipped, so
/// circular links cannot loop forever.
const MAX_LINK_DEPTH: usize = 2;

/// All data files under a log directory, sorted by path with numbers compared as numbers. A file reached by several paths
/// through links is listed once.
pub(super) fn find(dir: &Path) -> Result<Vec<PathBuf>, MetricsError> {
    if !dir.is_dir() {
        let found = if dir.exists() { "a file" } else { "nothing" };
        return Err(MetricsError::NotADirectory {
            path: dir.to_owned(),
            found,
        });
    }
    let mut search = Search {
        folders: vec![Folder {
            path: dir.to_owned(),
            depth: 0,
            is_linked: false,
        }],
        files: Vec::new(),
    };
    let mut seen = 0;
    while let Some(current) = search.folders.pop() {
        let list = |error| MetricsError::io(&current.path, "list this directory")(error);
        for entry in fs::read_dir(&current.path).map_err(list)? {
            let entry = entry.map_err(list)?;
            seen += 1;
            if seen > MAX_LOG_FILES {
                let (found, limit) = (seen as u64, MAX_LOG_FILES as u64);
                return Err(MetricsError::too_large(dir, "files or more", found, limit));
            }
            let kind = entry.file_type().map_err(list)?;
            search.add_entry(&current, entry.path(), kind)?;
        }
    }
    search.files.sort_by_cached_key(|(path, _)| path_key(path));
    Ok(without_duplicates(search.files))
}

struct Search {
    folders: Vec<Folder>,
    /// The data files found, each with whether it was reached through a link.
    files: Vec<(PathBuf, bool)>,
}

struct Folder {
    path: PathBuf,
    /// Depth below the log's directory.
    depth: usize,
    /// Whether it was reached through a link.
    is_linked: bool,
}

impl Search {
    /// Handles an entry of a folder: a data file, or a folder to search later.
    fn add_entry(&mut self, folder: &Folder, path: PathBuf, kind: FileType) -> Result<(), MetricsError> {
        let is_linked = folder.is_linked || kind.is_symlink();
        let depth = folder.depth + 1;
        if path.file_name().is_some_and(|name| name == FILE_NAME) {
            regular_file::check(&path)?;
            self.files.push((path, is_linked));
        } else if is_linked && depth <= MAX_LINK_DEPTH {
            match fs::metadata(&path) {
                // Only the data file of a block matters; the folder itself may be large.
                Ok(found) if found.is_dir() && depth == MAX_LINK_DEPTH => {
                    let file = path.join(FILE_NAME);
                    regular_file::check(&file)?;
                    if file.exists() {
                        self.files.push((file, true));
                    }
                }
                Ok(found) if found.is_dir() => self.folders.push(Folder { path, depth, is_linked }),
                // Broken links with an extension are ignored, because they led to files, not to workers or blocks.
                Err(_) if path.extension().is_none() && !is_hidden(&path) => {
                    return Err(regular_file::lost_link(&path));
                }
                _ => {}
            }
        } else if kind.is_dir() && !is_linked && depth <= MAX_DEPTH {
            self.folders.push(Folder { path, depth, is_linked });
        }
        Ok(())
    }
}

fn is_hidden(path: &Path) -> bool {
    path.file_name()
        .is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

/// Keeps one path to each file, preferably one without links.
fn without_duplicates(mut files: Vec<(PathBuf, bool)>) -> Vec<PathBuf> {
    if files.iter().any(|(_, is_linked)| *is_linked) {
        let canonical = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let canonical_paths: Vec<PathBuf> = files.iter().map(|(path, _)| canonical(path)).collect();
        let mut seen_paths: BTreeSet<&Path> = (files.iter().zip(&canonical_paths))
            .filter(|((_, is_linked), _)| !is_linked)
            .map(|(_, canonical)| canonical.as_path())
            .collect();
        let mut canonical_paths = canonical_paths.iter();
        files.retain(|(_, is_linked)| {
            let canonical = canonical_paths.next();
            !is_linked || canonical.is_some_and(|canonical| seen_paths.insert(canonical))
        });
    }
    files.into_iter().map(|(path, _)| path).collect()
}

/// Sort key that puts `2-train` before `10-test`: each part of the path by its leading number first, then by its text.
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
    fn blocks_are_sorted_by_number() {
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
    fn path_that_is_not_a_directory_is_named() {
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

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_circular_links_end() {
        use std::os::unix::fs::symlink;
        let base = tempfile::tempdir().unwrap();
        let dir = base.path().join("log");
        let at = |path: &str| base.path().join(path);
        for block in ["log/w/0-test", "elsewhere/v/0-test", "elsewhere/v/1-test"] {
            fs::create_dir_all(at(block)).unwrap();
            fs::write(at(block).join(FILE_NAME), "").unwrap();
        }
        let found = || {
            let found = find(&dir).map_err(|error| error.to_string().replace(&dir.display().to_string(), "LOG"))?;
            let block = |path: &PathBuf| path.parent().unwrap().strip_prefix(&dir).unwrap().display().to_string();
            Ok::<Vec<String>, String>(found.iter().map(block).collect())
        };
        // A data file, a block and a worker.
        fs::create_dir_all(dir.join("w/1-train")).unwrap();
        symlink(
            at("elsewhere/v/1-test").join(FILE_NAME),
            dir.join("w/1-train").join(FILE_NAME),
        )
        .unwrap();
        assert_eq!(found().unwrap(), ["w/0-test", "w/1-train"]);
        symlink("../../elsewhere/v/0-test", dir.join("w/2-test")).unwrap();
        assert_eq!(found().unwrap(), ["w/0-test", "w/1-train", "w/2-test"]);
        fs::remove_file(dir.join("w/2-test")).unwrap();
        fs::remove_dir_all(dir.join("w/1-train")).unwrap();
        symlink("../elsewhere/v", dir.join("v")).unwrap();
        assert_eq!(found().unwrap(), ["v/0-test", "v/1-test", "w/0-test"]);
        // Links to files already found, circular links, and a broken link with an extension.
        symlink(".", dir.join("circle")).unwrap();
        symlink("..", dir.join("w/circle")).unwrap();
        symlink("v", dir.join("again")).unwrap();
        symlink("w", dir.join("a")).unwrap();
        symlink("nowhere", dir.join("model.bin")).unwrap();
        assert_eq!(found().unwrap(), ["again/0-test", "again/1-test", "w/0-test"]);
        symlink("nowhere", dir.join("u")).unwrap();
        let message = |path: &str, found: &str| {
            format!("LOG/{path}: found {found}, expected a file; put the file in its place, or remove it")
        };
        assert_eq!(found().unwrap_err(), message("u", "a link that leads nowhere"));
        fs::remove_file(dir.join("u")).unwrap();
        fs::remove_file(dir.join("a")).unwrap();
        fs::create_dir_all(dir.join("w/3-test")).unwrap();
        symlink("nowhere", dir.join("w/3-test").join(FILE_NAME)).unwrap();
        assert_eq!(
            found().unwrap_err(),
            message("w/3-test/data-log.tsv", "a link that leads nowhere")
        );
        fs::remove_file(dir.join("w/3-test").join(FILE_NAME)).unwrap();
        fs::create_dir_all(dir.join("w/3-test").join(FILE_NAME)).unwrap();
        assert_eq!(found().unwrap_err(), message("w/3-test/data-log.tsv", "a directory"));
    }
}
