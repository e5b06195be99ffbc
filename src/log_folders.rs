//! Finds logs: the given folders themselves, or all logs below them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf, absolute};

use driftworld_files::FileError;

use crate::contents::{Contents, OtherContents, has_info};
use crate::documents;
use crate::{Failure, argument};
use driftworld_text::ShownPath;
use serde_json::Value;

/// Maximum depth of the search below a folder that is not a log itself.
const MAX_LEVELS: usize = 4;

/// Maximum number of logs in one search.
const MOST_LOGS: usize = 10_000;

/// Maximum size, in bytes, of a description that is read for names alone.
const MAX_INFO_BYTES: u64 = 64 << 20;

/// Maximum number of folders searched for logs.
const MAX_FOLDERS: usize = 200_000;

/// The state of a search for logs. A link below the starting folder is followed only if it leads directly to a log: a link to
/// `/` would make it search the whole machine, and a link to a parent folder would make it loop.
#[derive(Default)]
struct Search {
    found: Vec<PathBuf>,
    /// Folders whose entries were read.
    read: usize,
}

/// The given logs, or with `is_recursive` all logs in and below the folders.
pub(crate) fn found(arguments: &[PathBuf], is_recursive: bool) -> Result<Vec<PathBuf>, Failure> {
    if is_recursive {
        below(arguments)
    } else {
        named(arguments)
    }
}

/// The description of a log's run; null if it cannot be read.
pub(crate) fn scenario_info(log: &Path) -> Value {
    let text = driftworld_files::text(&log.join("scenario_info.json"), MAX_INFO_BYTES).unwrap_or_default();
    serde_json::from_str(&text).unwrap_or_default()
}

/// All logs in or below the arguments, in order and without duplicates; those below a folder are sorted by name.
pub(crate) fn below(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for argument in arguments {
        let mut logs = search(argument)?;
        if logs.is_empty() {
            return Err(Failure::input(format!(
                "{}: found no log, expected a folder with logger_info.json, or such folders up to {MAX_LEVELS} \
                 levels below; `driftworld run … -o DIR` writes one",
                argument.shown()
            )));
        }
        found.append(&mut logs);
        check_count(argument, found.len())?;
    }
    Ok(without_duplicates(found))
}

/// The arguments, which must all be logs, in order and without duplicates. A folder with logs below it is refused with advice.
pub(crate) fn named(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    if let Some(folder) = arguments.iter().find(|folder| !is_log(folder)) {
        let below = search(folder)?;
        let path = folder.shown();
        return Err(Failure::input(match below.first() {
            Some(first) => format!(
                "{path}: found a folder of {} logs such as {}, expected one log; name one, or use all with {}",
                below.len(),
                first.shown(),
                argument("recursive")
            ),
            None => format!(
                "{path}: found no log, expected a folder with logger_info.json and \
                 WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv; `driftworld run … -o DIR` writes one"
            ),
        }));
    }
    Ok(without_duplicates(arguments.to_vec()))
}

/// A name for each of several logs: its folder's name, with as many parent folders as needed to distinguish it, such as `a/log`
/// and `b/log`.
pub(crate) fn names(logs: &[PathBuf]) -> Vec<String> {
    let paths: Vec<Vec<String>> = logs.iter().map(|log| folders_to(log)).collect();
    let end = |path: &[String], length: usize| path[path.len().saturating_sub(length)..].join("/");
    let mut names = vec![String::new(); logs.len()];
    let mut ambiguous: Vec<usize> = (0..logs.len()).collect();
    for length in 1.. {
        let mut by_name: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for log in ambiguous {
            by_name.entry(end(&paths[log], length)).or_default().push(log);
        }
        ambiguous = Vec::new();
        for (name, logs) in by_name {
            for &log in &logs {
                names[log].clone_from(&name);
                if logs.len() > 1 && length < paths[log].len() {
                    ambiguous.push(log);
                }
            }
        }
        if ambiguous.is_empty() {
            break;
        }
    }
    names
}

/// The folder names from the root to a log, as given unless the path contains `..`.
fn folders_to(log: &Path) -> Vec<String> {
    let mut path = absolute(log).unwrap_or_else(|_| log.to_owned());
    if path.components().any(|part| part == Component::ParentDir) {
        path = path.canonicalize().unwrap_or(path);
    }
    path.components()
        .filter_map(|part| match part {
            Component::Normal(name) => Some(name.to_string_lossy().into_owned()),
            _ => None,
        })
        .collect()
}

/// The logs in and below a folder, sorted by name.
fn search(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    check_folder(folder)?;
    let mut search = Search::default();
    search.collect(folder, MAX_LEVELS)?;
    Ok(search.found)
}

fn check_folder(argument: &Path) -> Result<(), Failure> {
    let found = match fs::metadata(argument) {
        Ok(kind) if kind.is_dir() => return Ok(()),
        Ok(_) => {
            let shown = documents::text(argument).ok().and_then(|text| Contents::of_text(&text));
            if let Some(other) = OtherContents::check(argument, shown, &[Contents::Log]) {
                return Err(other.into());
            }
            match driftworld_files::check(argument) {
                Err(FileError::NotAFile { found, .. }) => found.to_owned(),
                _ => "a file".to_owned(),
            }
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => "nothing".to_owned(),
        Err(error) => error.to_string(),
    };
    let path = argument.shown();
    Err(Failure::input(format!(
        "{path}: found {found}, expected the folder of a log, which holds logger_info.json"
    )))
}

pub(crate) fn without_duplicates(mut logs: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut seen = std::collections::BTreeSet::new();
    logs.retain(|log| seen.insert(log.canonicalize().unwrap_or_else(|_| log.clone())));
    logs
}

impl Search {
    fn collect(&mut self, folder: &Path, levels: usize) -> Result<(), Failure> {
        if self.is_log(folder)? {
            self.found.push(folder.to_owned());
            return check_count(folder, self.found.len());
        }
        if levels == 0 {
            return Ok(());
        }
        for below in self.entries(folder)? {
            match below {
                (false, below) => self.collect(&below, levels - 1)?,
                (true, link) if has_info(&link) => self.found.push(link),
                (true, _) => {}
            }
        }
        check_count(folder, self.found.len())
    }

    /// Whether a folder is a log, even an incomplete one.
    fn is_log(&mut self, folder: &Path) -> Result<bool, Failure> {
        if has_info(folder) {
            return Ok(true);
        }
        for worker in subfolders(folder) {
            self.count(&worker)?;
            let blocks = subfolders(&worker);
            if blocks.iter().any(|block| block.join("data-log.tsv").is_file()) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn entries(&mut self, folder: &Path) -> Result<Vec<(bool, PathBuf)>, Failure> {
        self.count(folder)?;
        entries(folder).map_err(|error| Failure::in_file(folder, format!("cannot be read: {error}")))
    }

    /// Counts a folder whose entries are read.
    fn count(&mut self, folder: &Path) -> Result<(), Failure> {
        self.read += 1;
        if self.read <= MAX_FOLDERS {
            return Ok(());
        }
        Err(Failure::input(format!(
            "{}: found more than {MAX_FOLDERS} folders in the search for logs, expected at most that; name a folder \
             closer to the logs",
            folder.shown()
        )))
    }
}

fn check_count(path: &Path, logs: usize) -> Result<(), Failure> {
    if logs <= MOST_LOGS {
        return Ok(());
    }
    Err(Failure::in_file(
        path,
        format!("found more than {MOST_LOGS} logs, expected at most that; name fewer folders"),
    ))
}

/// Whether a folder is a log, even an incomplete one.
fn is_log(folder: &Path) -> bool {
    // A folder with too many subfolders to search is not a log.
    has_info(folder) || Search::default().is_log(folder).unwrap_or(false)
}

/// The folders in a folder, then the links, each with whether it is a link; sorted by name.
fn entries(folder: &Path) -> std::io::Result<Vec<(bool, PathBuf)>> {
    let mut below = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let kind = entry.file_type()?;
        if kind.is_dir() || kind.is_symlink() {
            below.push((kind.is_symlink(), entry.path()));
        }
    }
    below.sort();
    Ok(below)
}

/// The folders in a folder, without links to folders.
fn subfolders(folder: &Path) -> Vec<PathBuf> {
    // The search reports a folder that cannot be listed.
    let entries = entries(folder).unwrap_or_default().into_iter();
    let folders = entries.filter(|(is_link, _)| !is_link);
    folders.map(|(_, path)| path).collect()
}

/// Prefixes a message with the log's path unless it already begins with it: some messages name a file below the log, others do
/// not.
pub(crate) fn placed(log: &Path, message: &str) -> String {
    let log = log.shown().to_string();
    if message.starts_with(&log) {
        message.to_owned()
    } else {
        format!("{log}: {message}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_with_the_same_name_are_distinguished_by_parent_folders() {
        let check = |logs: &[&str], expected: &[&str]| {
            let logs: Vec<PathBuf> = logs.iter().map(PathBuf::from).collect();
            assert_eq!(names(&logs), expected, "{logs:?}");
        };
        check(&[], &[]);
        check(&["col/x/log"], &["log"]);
        check(&["col/x/log", "col/y/run/"], &["log", "run"]);
        check(
            &["col/x/log", "other", "col/y/./log", "z/y/log"],
            &["x/log", "other", "col/y/log", "z/y/log"],
        );
        // Some paths are suffixes of others.
        check(
            &["/log", "/deep/log", "/deep/deep/log"],
            &["log", "deep/log", "deep/deep/log"],
        );
        let here = std::env::current_dir().unwrap();
        let name = here.file_name().unwrap().to_str().unwrap();
        check(&[".", "x/log"], &[name, "log"]);
        check(&["src/.."], &[name]);
    }

    #[test]
    fn incomplete_logs_are_found() {
        let base = tempfile::tempdir().unwrap();
        let file = |path: &str| {
            let path = base.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        };
        file("deep/b/logger_info.json");
        file("deep/a/scenario_info.json");
        file("deep/c/worker/0-train/data-log.tsv");
        file("other/notes.txt");
        let root = base.path().to_owned();
        let names = |found: Vec<PathBuf>| {
            let name = |path: &PathBuf| path.strip_prefix(base.path()).unwrap().to_str().unwrap().to_owned();
            found.iter().map(name).collect::<Vec<_>>()
        };
        assert_eq!(
            names(below(std::slice::from_ref(&root)).unwrap()),
            ["deep/a", "deep/b", "deep/c"]
        );
        assert_eq!(
            names(below(&[root.join("deep/b"), root.join("deep")]).unwrap()),
            ["deep/b", "deep/a", "deep/c"]
        );
        assert_eq!(
            names(named(&[root.join("deep/c"), root.join("deep/c")]).unwrap()),
            ["deep/c"]
        );
        let message = named(&[root.join("deep")]).unwrap_err();
        assert!(message.to_string().contains("3 logs such as") && message.for_command().contains("--recursive"));
        assert!(
            named(&[root.join("other")])
                .unwrap_err()
                .to_string()
                .contains("found no log")
        );
        assert!(
            below(&[root.join("other")])
                .unwrap_err()
                .to_string()
                .contains("4 levels")
        );
        assert!(
            named(&[root.join("absent")])
                .unwrap_err()
                .to_string()
                .contains("found nothing")
        );
        assert!(
            below(&[root.join("other/notes.txt")])
                .unwrap_err()
                .to_string()
                .contains("found a file")
        );
    }

    #[cfg(unix)]
    #[test]
    fn search_follows_only_links_to_logs() {
        use std::os::unix::fs::symlink;
        let base = tempfile::tempdir().unwrap();
        let root = base.path().join("logs");
        fs::create_dir_all(root.join("a")).unwrap();
        fs::write(root.join("a/logger_info.json"), "").unwrap();
        fs::create_dir_all(base.path().join("elsewhere/log")).unwrap();
        fs::write(base.path().join("elsewhere/log/logger_info.json"), "").unwrap();
        symlink("/", root.join("machine")).unwrap();
        symlink(&root, root.join("round")).unwrap();
        symlink(base.path().join("elsewhere"), root.join("beside")).unwrap();
        symlink(base.path().join("elsewhere/log"), root.join("best")).unwrap();
        let mut search = Search::default();
        search.collect(&root, MAX_LEVELS).unwrap();
        assert_eq!(search.found, [root.join("a"), root.join("best")]);
        // `a` is a log, and so is not searched.
        assert_eq!(search.read, 2, "reads the root twice: for workers, then for logs");
        // A link given as an argument is searched.
        assert_eq!(below(&[root.join("beside")]).unwrap(), [root.join("beside/log")]);
    }

    #[test]
    fn search_stops_at_the_folder_limit() {
        let base = tempfile::tempdir().unwrap();
        fs::create_dir(base.path().join("a")).unwrap();
        let mut search = Search {
            read: MAX_FOLDERS,
            ..Search::default()
        };
        let error = search.collect(base.path(), MAX_LEVELS).unwrap_err();
        assert!(error.to_string().contains("more than 200000 folders"), "{error}");
    }
}
