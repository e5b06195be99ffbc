//! Manages the data folder of single-task experts on disk: copies logs into it, and names, lists and removes runs.

use std::fs;
use std::path::{Path, PathBuf};

use driftworld_atomic_files::ScratchFolder;

use super::{data_files, logger_info, scenario_info};
use crate::MetricsError;

/// Prefix of folders that are being filled or removed. Killed processes leave such folders behind; they are never read.
pub(super) const TEMPORARY: &str = ".storing-";

/// Refuses a data folder inside a log's directory, because everything in there is read as part of the log.
pub(super) fn check_outside(data_folder: &Path, log_dir: &Path) -> Result<(), MetricsError> {
    let absolute = std::path::absolute(data_folder).map_err(MetricsError::io(data_folder, "find this directory"))?;
    let log = (log_dir.canonicalize()).map_err(MetricsError::io(log_dir, "find this directory"))?;
    // The folder may not exist yet, but one of its ancestors does.
    let existing = absolute.ancestors().find_map(|ancestor| ancestor.canonicalize().ok());
    if existing.is_some_and(|existing| existing.starts_with(&log)) {
        return Err(MetricsError::bad_option(
            "STE data folder",
            data_folder.display().to_string(),
            "a folder outside the log to be stored",
        ));
    }
    Ok(())
}

/// Copies the info files and data files of a log.
pub(super) fn copy(log_dir: &Path, data_files: &[PathBuf], to: &Path) -> Result<(), MetricsError> {
    let info = [logger_info::FILE_NAME, scenario_info::FILE_NAME].map(|name| log_dir.join(name));
    for file in info.iter().filter(|file| file.exists()).chain(data_files) {
        let inside = file.strip_prefix(log_dir).expect("the files were found inside the log");
        let target = to.join(inside);
        let parent = target.parent().unwrap_or(to);
        fs::create_dir_all(parent).map_err(MetricsError::io(parent, "make this directory"))?;
        // Not `fs::copy`, which would keep the mode and ignore the umask. Opened directly,
        // not through driftworld-files: these are the log's own files, just found.
        let copied = fs::File::open(file).and_then(|mut from| {
            let mut to = fs::File::create(&target)?;
            std::io::copy(&mut from, &mut to)?;
            to.sync_all()
        });
        copied.map_err(MetricsError::io(&target, "copy into this file"))?;
    }
    Ok(())
}

/// Renames a finished run to its final name; if the name is taken, appends the first free number.
pub(super) fn give_name(new: &Path, task_dir: &Path, run: &str) -> Result<PathBuf, MetricsError> {
    let names = std::iter::once(run.to_owned()).chain((2..).map(|number: u32| format!("{run}-{number}")));
    for dir in names.map(|name| task_dir.join(name)) {
        if fs::symlink_metadata(&dir).is_ok() {
            continue;
        }
        match fs::rename(new, &dir) {
            Ok(()) => return Ok(dir),
            // Another process took the name in the meantime.
            Err(_) if fs::symlink_metadata(&dir).is_ok() => {}
            Err(error) => return Err(MetricsError::io(&dir, "put the log here")(error)),
        }
    }
    unreachable!("there are more numbers than directories")
}

/// Moves a run into the temporary directory, so that both are removed together.
pub(super) fn move_aside(run: &Path, temporary: &ScratchFolder) -> Result<(), MetricsError> {
    // Keeps the run's path within the data folder, so that no two runs get the same target.
    let names = [run.parent().and_then(Path::file_name), run.file_name()];
    let target_dir: PathBuf = std::iter::once(temporary.path())
        .chain([Path::new("old")])
        .chain(names.into_iter().flatten().map(Path::new))
        .collect();
    let target_parent = target_dir.parent().unwrap_or(temporary.path());
    fs::create_dir_all(target_parent).map_err(MetricsError::io(target_parent, "make this directory"))?;
    fs::rename(run, &target_dir).map_err(MetricsError::io(run, "move this directory aside"))
}

pub(super) fn is_run(dir: &Path) -> bool {
    dir.join(logger_info::FILE_NAME).is_file()
}

pub(super) fn runs_of(task_dir: &Path) -> Result<Vec<PathBuf>, MetricsError> {
    Ok(directories(task_dir)?.into_iter().filter(|dir| is_run(dir)).collect())
}

/// The directories in a directory, sorted by name, except links and hidden ones.
pub(super) fn directories(dir: &Path) -> Result<Vec<PathBuf>, MetricsError> {
    let list = |error| MetricsError::io(dir, "list this directory")(error);
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).map_err(list)? {
        let entry = entry.map_err(list)?;
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        if !hidden && entry.file_type().map_err(list)?.is_dir() {
            found.push(entry.path());
        }
    }
    found.sort_by_cached_key(|path| data_files::path_key(path));
    Ok(found)
}

/// Refuses a link in place of a task's directory, because it could lead out of the data folder.
pub(super) fn own_directory(dir: &Path) -> Result<(), MetricsError> {
    let kind = fs::symlink_metadata(dir).map_err(MetricsError::io(dir, "inspect this directory"))?;
    if kind.is_dir() {
        return Ok(());
    }
    let error = std::io::Error::other("it is a link, which may lead elsewhere; remove it");
    Err(MetricsError::io(dir, "store logs here")(error))
}

pub(super) fn refuse_pickles(data_folder: &Path) -> Result<(), MetricsError> {
    for folder in [data_folder.to_owned(), data_folder.join("taskinfo")] {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        if let Some(path) = paths
            .filter(|path| path.extension().is_some_and(|end| end == "pickle"))
            .min()
        {
            return Err(MetricsError::StePickle(path));
        }
    }
    Ok(())
}
