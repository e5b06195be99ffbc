//! Checks the state of a log directory: it is free, contains the leftovers of an interrupted creation, or contains a log.

use std::fs;
use std::path::Path;

use driftworld_atomic_files::is_unfinished;

use super::logger_info::{self, LoggerInfo};
use super::scenario_info::{self, ScenarioInfo};
use super::warning::LogWarning;
use super::{data_files, json_file};
use crate::MetricsError;

/// Reads the two info files of the log in `dir`; `None` if no log was started.
///
/// No log was started if the directory does not exist, is empty, or contains only the leftovers of a log whose creation was
/// interrupted: [`LogWriter::create`](crate::LogWriter::create) accepts such a directory.
///
/// # Errors
/// [`MetricsError::MissingFile`] and [`MetricsError::Json`] if an info file is missing or torn although the directory contains other
/// files, [`MetricsError::LoggerInfo`] if a field is wrong, [`MetricsError::NotADirectory`] if the path is a file, or
/// [`MetricsError::Io`].
pub fn begun_log(dir: impl AsRef<Path>) -> Result<Option<(LoggerInfo, ScenarioInfo)>, MetricsError> {
    let dir = dir.as_ref();
    if !dir.exists() || (dir.is_dir() && is_free(dir)?) {
        return Ok(None);
    }
    data_files::find(dir)?;
    let logger_info = LoggerInfo::read(dir)?;
    let mut warnings = Vec::new();
    let scenario_info = ScenarioInfo::read(dir, &mut warnings)?;
    if warnings.contains(&LogWarning::NoScenarioInfo) {
        return Err(MetricsError::missing_file(
            dir.join(scenario_info::FILE_NAME),
            "a JSON object",
        ));
    }
    Ok(Some((logger_info, scenario_info)))
}

/// Whether a directory is empty, or contains only the leftovers of an interrupted creation.
///
/// The info files are written before anything else: if both are whole, a log was started.
pub(super) fn is_free(dir: &Path) -> Result<bool, MetricsError> {
    let list = |error| MetricsError::io(dir, "list this directory")(error);
    let names = [scenario_info::FILE_NAME, logger_info::FILE_NAME];
    let mut whole = 0;
    for entry in fs::read_dir(dir).map_err(list)? {
        let entry = entry.map_err(list)?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if is_unfinished(&name) || names.iter().any(|info| older_name(info) == name) {
            continue;
        }
        if !names.contains(&name.as_ref()) || !entry.file_type().map_err(list)?.is_file() {
            return Ok(false);
        }
        whole += usize::from(json_file::read_object(&entry.path(), "a JSON object").is_ok());
    }
    Ok(whole < names.len())
}

/// Temporary name of an incomplete info file in older versions.
fn older_name(info: &str) -> String {
    format!(".{info}.tmp")
}

/// Removes the temporary files of an interrupted creation.
pub(super) fn remove_leftovers(dir: &Path) -> Result<(), MetricsError> {
    driftworld_atomic_files::remove_leftovers(dir);
    for info in [scenario_info::FILE_NAME, logger_info::FILE_NAME] {
        let path = dir.join(older_name(info));
        match fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(MetricsError::io(path, "remove this file")(error));
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LogWriter;

    /// A log directory whose creation stopped after writing these files.
    fn interrupted_creation(files: &[(&str, &str)]) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        for (name, text) in files {
            fs::write(dir.path().join(name), text).unwrap();
        }
        dir
    }

    #[test]
    fn interrupted_creation_is_started_again() {
        let scenario = ("scenario_info.json", "{}");
        let check = |files: &[(&str, &str)]| {
            let dir = interrupted_creation(files);
            assert!(begun_log(dir.path()).unwrap().is_none(), "{files:?}");
            let info = LoggerInfo::new(["reward"]).unwrap();
            LogWriter::create(dir.path(), &info, &ScenarioInfo::default()).unwrap();
            assert_eq!(begun_log(dir.path()).unwrap().unwrap().0, info, "{files:?}");
            assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2, "{files:?}");
        };
        check(&[]);
        check(&[(".scenario_info.json.tmp", "{ \"scen")]);
        check(&[(".scenario_info.json.aB3.driftworld-part", "{ \"scen")]);
        check(&[scenario, (".logger_info.json.aB3.driftworld-part", "{ \"scen")]);
        check(&[scenario]);
        check(&[("scenario_info.json", "{ \"scen")]);
        check(&[scenario, (".logger_info.json.tmp", "")]);
        check(&[scenario, ("logger_info.json", "{ \"metr")]);
    }

    #[cfg(unix)]
    #[test]
    fn second_of_two_simultaneous_writers_is_refused_before_writing() {
        let (dir, info) = (tempfile::tempdir().unwrap(), LoggerInfo::new(["reward"]).unwrap());
        let create = || LogWriter::create(dir.path(), &info, &ScenarioInfo::default());
        let held = fs::File::open(dir.path()).unwrap();
        held.try_lock().unwrap();
        assert_eq!(create().unwrap_err().code(), "metrics/in-use");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0, "nothing was written");
        drop(held);
        let first = create().unwrap();
        assert_eq!(create().unwrap_err().code(), "metrics/in-use");
        assert_eq!(LogWriter::resume(dir.path()).unwrap_err().code(), "metrics/in-use");
        first.finish().unwrap();
        assert_eq!(create().unwrap_err().code(), "metrics/log-exists");
        LogWriter::resume(dir.path()).unwrap();
    }

    #[test]
    fn files_that_are_not_leftovers_of_a_log_are_never_overwritten() {
        let check = |files: &[(&str, &str)], code: &str| {
            let dir = interrupted_creation(files);
            assert_eq!(begun_log(dir.path()).unwrap_err().code(), code);
            let info = LoggerInfo::new(["reward"]).unwrap();
            let error = LogWriter::create(dir.path(), &info, &ScenarioInfo::default()).unwrap_err();
            assert_eq!(error.code(), "metrics/log-exists");
        };
        check(&[("notes.txt", "mine")], "metrics/missing-file");
        check(
            &[("scenario_info.json", "{}"), ("notes.txt", "mine")],
            "metrics/missing-file",
        );
        let torn = [("logger_info.json", "{ \"met"), ("data-log.tsv", "block_num\n")];
        check(&torn, "metrics/json");
    }
}
