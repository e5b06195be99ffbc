//! Refuses to overwrite files of a log and the command's own inputs, so that a typo does not destroy data.

use std::path::{Path, PathBuf};

use driftworld_curriculum::RECORDINGS_FILE;
use driftworld_text::ShownPath;

use crate::contents::Contents;
use crate::{Failure, documents, tasks};

/// The files of a log.
const LOG_FILES: [&str; 4] = [
    "data-log.tsv",
    "logger_info.json",
    "scenario_info.json",
    RECORDINGS_FILE,
];

/// The failure for an existing file; `advice` suggests an alternative.
pub(crate) fn exists(path: &Path, advice: &str) -> Failure {
    Failure::in_file(path, format!("found a file, expected none; {advice}"))
}

/// Refuses a path inside a log that is, or would be read as, one of the log's files.
pub(crate) fn refuse_log_files(target: &Path) -> Result<(), Failure> {
    let name = target.file_name().unwrap_or_default();
    if !LOG_FILES.iter().any(|log_file| name == *log_file) {
        return Ok(());
    }
    let Ok(folder) = documents::folder_of(target).canonicalize() else {
        return Ok(());
    };
    let is_log = |folder: &&Path| Contents::of_folder(folder) == Some(Contents::Log);
    match folder.ancestors().find(is_log) {
        None => Ok(()),
        Some(log) => {
            let found = format!("found a file of the log {}, expected another file", log.shown());
            Err(Failure::in_file(target, found + "; the log would be overwritten"))
        }
    }
}

/// Refuses the same file for two outputs; `targets` are the options and the files that they name.
pub(crate) fn refuse_same(targets: &[(&str, PathBuf)]) -> Result<(), Failure> {
    // Resolve the folder, because the file may not exist yet.
    let resolved = |path: &Path| {
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        absolute
            .canonicalize()
            .unwrap_or_else(|_| match (absolute.parent(), absolute.file_name()) {
                (Some(folder), Some(name)) => folder.canonicalize().unwrap_or_else(|_| folder.to_owned()).join(name),
                _ => absolute,
            })
    };
    let files = targets.iter().filter(|(_, path)| !path.starts_with("/dev"));
    let mut known: Vec<(&str, PathBuf)> = Vec::new();
    for (option, path) in files {
        let own = resolved(path);
        if let Some((other, _)) = known.iter().find(|(_, other)| *other == own) {
            return Err(Failure::usage(format!(
                "--{option}: found {}, the file of --{other}, expected another file; one would overwrite the other",
                path.shown()
            )));
        }
        known.push((option, own));
    }
    Ok(())
}

/// Refuses a file that the command reads: `names` are paths, with or without a variant appended.
pub(crate) fn refuse_inputs<'a>(target: &Path, names: impl IntoIterator<Item = &'a str>) -> Result<(), Failure> {
    let Ok(canonical) = target.canonicalize() else {
        return Ok(());
    };
    let is_target = |path: &str| Path::new(path).canonicalize().is_ok_and(|path| path == canonical);
    let is_read = |name: &str| is_target(name) || is_target(tasks::split(name).0);
    if canonical.is_file() && names.into_iter().any(is_read) {
        let found = "found the input file, expected another file to write; the input would be overwritten";
        return Err(Failure::in_file(target, found));
    }
    Ok(())
}
