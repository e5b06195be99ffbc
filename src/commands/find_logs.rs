//! Where the logs are: the folders named, or all below them. Reading one is `metrics`'s.

use std::fs;
use std::path::{Path, PathBuf};

use super::Failure;

/// How deep logs are looked for below a folder that is none itself.
const MOST_LEVELS: usize = 4;

/// The most logs that are taken together.
const MOST_LOGS: usize = 10_000;

/// Every log that the arguments name, in order, those below a folder by name.
pub(crate) fn find(arguments: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for argument in arguments {
        let before = found.len();
        collect(argument, MOST_LEVELS, &mut found)?;
        if found.len() == before {
            return Err(Failure::input(format!(
                "{}: found no log, expected a folder with logger_info.json, or folders of such up to {MOST_LEVELS} levels \
                 below; `driftworld run … --logs DIR` writes them",
                argument.display()
            )));
        }
    }
    let mut seen = std::collections::BTreeSet::new();
    found.retain(|log| seen.insert(log.canonicalize().unwrap_or_else(|_| log.clone())));
    Ok(found)
}

/// Whether a folder is a log.
pub(crate) fn is_log(folder: &Path) -> bool {
    folder.join("logger_info.json").is_file()
}

fn collect(folder: &Path, levels: usize, found: &mut Vec<PathBuf>) -> Result<(), Failure> {
    if is_log(folder) {
        if found.len() == MOST_LOGS {
            let path = folder.display();
            return Err(Failure::input(format!(
                "{path}: found more than {MOST_LOGS} logs, expected at most that; name fewer folders"
            )));
        }
        found.push(folder.to_owned());
        return Ok(());
    }
    let unreadable = |error| Failure::input(format!("{}: cannot be read: {error}", folder.display()));
    let mut below = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.is_dir() {
            below.push(path);
        }
    }
    below.sort();
    if levels > 0 {
        for folder in below {
            collect(&folder, levels - 1, found)?;
        }
    }
    Ok(())
}
