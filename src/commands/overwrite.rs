//! What a command does not write over: files of a log, and what it reads itself. A slip of the keyboard is asked about, and costs nothing.

use std::path::Path;

use driftworld_text::ShownPath;

use crate::contents::Contents;
use crate::tasks;

use super::Failure;

/// The files of which a log is made.
const OF_LOGS: [&str; 3] = ["data-log.tsv", "logger_info.json", "scenario_info.json"];

/// How many folders above its rows a log's own folder is, at most.
const LEVELS: usize = 3;

/// Refuses a file that a log is made of.
pub(crate) fn of_logs(target: &Path) -> Result<(), Failure> {
    let name = target.file_name().unwrap_or_default();
    if !OF_LOGS.iter().any(|of_logs| name == *of_logs) {
        return Ok(());
    }
    let Ok(target_there) = target.canonicalize() else {
        return Ok(());
    };
    let mut above = target_there.ancestors().skip(1).take(LEVELS);
    let log = above.find(|folder| Contents::of_folder(folder) == Some(Contents::Log));
    log.map_or(Ok(()), |log| {
        Err(Failure::input(format!(
            "{}: found a file of the log {}, expected another name; the log would be lost",
            target.shown(),
            log.shown()
        )))
    })
}

/// Refuses a file that the command reads: `names` are paths, with or without a variant behind them.
pub(crate) fn inputs<'a>(target: &Path, names: impl IntoIterator<Item = &'a str>) -> Result<(), Failure> {
    let Ok(there) = target.canonicalize() else {
        return Ok(());
    };
    let is_read = |name: &&str| {
        let paths = [Path::new(*name), Path::new(tasks::split(name).0)];
        paths
            .iter()
            .any(|path| path.canonicalize().is_ok_and(|path| path == there))
    };
    if !there.is_file() || !names.into_iter().any(|name| is_read(&name)) {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{}: found the file that is read, expected another to write to; it would be lost",
        target.shown()
    )))
}
