//! Logs of single-task experts kept in a data folder, `DATA/TASK/RUN/`: each a copy of the log as it is.
//!
//! Not here: reading them, see `read_ste_log`; what they are compared with, see `score`.

use std::fs;
use std::path::{Path, PathBuf};

use driftworld_atomic_files::ScratchFolder;

use super::{data_files, folder_name, log_folder, logger_info, scenario_info};
use crate::MetricsError;
use crate::choice::choice;
use crate::lifetime::read_ste_log;

/// What folders are called while they are filled or taken away. What a killed process leaves begins so, and is never read.
const TEMPORARY: &str = ".storing-";

choice! {
    /// What becomes of the runs of the same task that are stored already.
    SteStoreMode, "STE store mode" {
        /// They are removed: the task's expert is this run.
        Overwrite = "w",
        /// They stay: the task's expert is the mean over all runs.
        Append = "a",
    }
}

/// A log that was stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredRun {
    /// The trained task, lower-case.
    pub task_name: String,
    /// Where its log is now. A name that was taken has a number behind it, as `run-2`.
    pub dir: PathBuf,
}

/// The stored runs of one task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredTask {
    /// The trained task, lower-case, with its variant.
    pub task_name: String,
    /// Directories of its logs, by name with numbers compared as numbers.
    pub runs: Vec<PathBuf>,
}

/// Copies an expert's log into a data folder, which is made if need be. The run appears there whole or not at all, and other runs
/// are removed only once it has.
///
/// Characters of names that not every file system takes are written as `%` and two digits; no name leads out of the folder.
///
/// # Errors
/// Those of [`read_ste_log`]; [`MetricsError::InUse`] while a writer of ours is at work on the log;
/// [`MetricsError::TooLarge`] for a task whose name makes no folder's name; [`MetricsError::BadOption`] for a data folder inside
/// the log, which would become a part of it; [`MetricsError::Io`].
///
/// # Example
/// ```
/// # use driftworld_metrics::*;
/// # fn main() -> Result<(), MetricsError> {
/// # let base = tempfile::tempdir().unwrap();
/// # let (log, data) = (base.path().join("expert"), base.path().join("data"));
/// # let mut writer = LogWriter::create(&log, &LoggerInfo::new(["reward"])?, &ScenarioInfo::default())?;
/// # let when = Timestamp::from_unix_micros(0)?;
/// # writer.write(&Record::new(0, 0, BlockType::Train, "Find_Red", when).with_metric("reward", 1.0))?;
/// # writer.finish()?;
/// let stored = store_ste(&data, &log, SteStoreMode::Append)?;
/// assert_eq!(stored.dir, data.join("find_red").join("expert"));
/// assert_eq!(find_ste(&data)?[0].task_name, "find_red");
/// # Ok(())
/// # }
/// ```
pub fn store_ste(
    data_folder: impl AsRef<Path>,
    log_dir: impl AsRef<Path>,
    mode: SteStoreMode,
) -> Result<StoredRun, MetricsError> {
    let (data_folder, log_dir) = (data_folder.as_ref(), log_dir.as_ref());
    let files = data_files::find(log_dir)?;
    check_outside(data_folder, log_dir)?;
    let lock = log_folder::lock_for_reading(log_dir)?;
    let expert = read_ste_log(log_dir)?;
    let task_name = expert.task_name().to_owned();
    let task_dir = data_folder.join(folder_name::encoded(data_folder, &task_name)?);
    let run = folder_name::encoded(data_folder, &expert.log().run_id)?;
    drop(expert);

    fs::create_dir_all(&task_dir).map_err(MetricsError::io(&task_dir, "make this directory"))?;
    own_directory(&task_dir)?;
    let temporary = temporary(data_folder)?;
    let new = temporary.path().join("new");
    copy(log_dir, &files, &new)?;
    drop(lock);

    if mode == SteStoreMode::Overwrite && is_run(&task_dir.join(&run)) {
        take_away(&task_dir.join(&run), &temporary)?;
    }
    let dir = give_name(&new, &task_dir, &run)?;
    if mode == SteStoreMode::Overwrite {
        for other in runs_of(&task_dir)?.into_iter().filter(|other| *other != dir) {
            take_away(&other, &temporary)?;
        }
    }
    remove(temporary)?;
    Ok(StoredRun { task_name, dir })
}

/// The tasks whose experts are stored in a data folder, by name, each with its runs.
///
/// # Errors
/// [`MetricsError::NoSteData`] where there is no such folder, or it is a log; [`MetricsError::StePickle`] where it holds experts
/// as l2metrics stores them; [`MetricsError::Io`].
pub fn find_ste(data_folder: impl AsRef<Path>) -> Result<Vec<StoredTask>, MetricsError> {
    let data_folder = data_folder.as_ref();
    let not_there = |found| MetricsError::NoSteData {
        path: data_folder.to_owned(),
        found,
    };
    match fs::metadata(data_folder) {
        Err(_) => return Err(not_there("nothing")),
        Ok(kind) if !kind.is_dir() => return Err(not_there("a file")),
        Ok(_) if is_run(data_folder) => return Err(not_there("a log")),
        Ok(_) => refuse_pickles(data_folder)?,
    }
    let mut tasks = Vec::new();
    for task_dir in directories(data_folder)? {
        let runs = runs_of(&task_dir)?;
        if !runs.is_empty() {
            let task_name = folder_name::decoded(&task_dir);
            tasks.push(StoredTask { task_name, runs });
        }
    }
    tasks.sort_by(|a, b| a.task_name.cmp(&b.task_name));
    Ok(tasks)
}

/// Removes the stored runs of one task, or of all, and what interrupted storing left; returns the runs that are gone. Anything else
/// in the folder stays.
///
/// # Errors
/// Those of [`find_ste`]; [`MetricsError::UnknownWord`] for a task of which nothing is stored.
pub fn clear_ste(data_folder: impl AsRef<Path>, task: Option<&str>) -> Result<Vec<PathBuf>, MetricsError> {
    let data_folder = data_folder.as_ref();
    let mut tasks = find_ste(data_folder)?;
    if let Some(wanted) = task.map(str::to_lowercase) {
        let names: Vec<&str> = tasks.iter().map(|stored| stored.task_name.as_str()).collect();
        let expected = names.join(", ");
        tasks.retain(|stored| stored.task_name == wanted);
        if tasks.is_empty() {
            return Err(MetricsError::UnknownWord {
                what: "stored task",
                found: wanted,
                expected,
            });
        }
    }
    let temporary = temporary(data_folder)?;
    let mut removed = Vec::new();
    for run in tasks.into_iter().flat_map(|stored| stored.runs) {
        take_away(&run, &temporary)?;
        // Only an empty one goes: what is not ours stays.
        let _ = run.parent().map(fs::remove_dir);
        removed.push(run);
    }
    remove(temporary)?;
    if task.is_none() {
        for left in leftovers(data_folder)? {
            fs::remove_dir_all(&left).map_err(MetricsError::io(&left, "remove this directory"))?;
        }
    }
    Ok(removed)
}

/// Whatever lies in a log's directory is read as a part of it.
fn check_outside(data_folder: &Path, log_dir: &Path) -> Result<(), MetricsError> {
    let place = std::path::absolute(data_folder).map_err(MetricsError::io(data_folder, "find this directory"))?;
    let log = (log_dir.canonicalize()).map_err(MetricsError::io(log_dir, "find this directory"))?;
    // The folder may not be there yet, but what it will lie in is.
    let there = place.ancestors().find_map(|ancestor| ancestor.canonicalize().ok());
    if there.is_some_and(|there| there.starts_with(&log)) {
        return Err(MetricsError::BadOption {
            option: "STE data folder",
            found: data_folder.display().to_string(),
            expected: "a folder outside the log that is stored".to_owned(),
        });
    }
    Ok(())
}

/// Copies what makes up a log.
fn copy(log_dir: &Path, data_files: &[PathBuf], to: &Path) -> Result<(), MetricsError> {
    let info = [logger_info::FILE_NAME, scenario_info::FILE_NAME].map(|name| log_dir.join(name));
    for file in info.iter().filter(|file| file.exists()).chain(data_files) {
        let inside = file.strip_prefix(log_dir).expect("the files were found inside the log");
        let target = to.join(inside);
        let parent = target.parent().unwrap_or(to);
        fs::create_dir_all(parent).map_err(MetricsError::io(parent, "make this directory"))?;
        // Not the system's copy: that takes the mode along, whatever the umask says.
        // What was just found, not by driftworld-files: it is a file of the log.
        let copied = fs::File::open(file).and_then(|mut from| {
            let mut to = fs::File::create(&target)?;
            std::io::copy(&mut from, &mut to)?;
            to.sync_all()
        });
        copied.map_err(MetricsError::io(&target, "copy into this file"))?;
    }
    Ok(())
}

/// Puts a finished run under its name, or with the first number behind it that is free.
fn give_name(new: &Path, task_dir: &Path, run: &str) -> Result<PathBuf, MetricsError> {
    let names = std::iter::once(run.to_owned()).chain((2..).map(|number: u32| format!("{run}-{number}")));
    for dir in names.map(|name| task_dir.join(name)) {
        if fs::symlink_metadata(&dir).is_ok() {
            continue;
        }
        match fs::rename(new, &dir) {
            Ok(()) => return Ok(dir),
            // Someone else took the name meanwhile.
            Err(_) if fs::symlink_metadata(&dir).is_ok() => {}
            Err(error) => return Err(MetricsError::io(&dir, "put the log here")(error)),
        }
    }
    unreachable!("there are more numbers than directories")
}

/// Moves a run where it is no longer found, to be removed with the temporary directory.
fn take_away(run: &Path, temporary: &ScratchFolder) -> Result<(), MetricsError> {
    // As in the data folder: no two of them have one name.
    let names = [run.parent().and_then(Path::file_name), run.file_name()];
    let grave: PathBuf = std::iter::once(temporary.path())
        .chain([Path::new("old")])
        .chain(names.into_iter().flatten().map(Path::new))
        .collect();
    let above = grave.parent().unwrap_or(temporary.path());
    fs::create_dir_all(above).map_err(MetricsError::io(above, "make this directory"))?;
    fs::rename(run, &grave).map_err(MetricsError::io(run, "take away this directory"))
}

fn temporary(data_folder: &Path) -> Result<ScratchFolder, MetricsError> {
    ScratchFolder::new(TEMPORARY, data_folder).map_err(MetricsError::io(data_folder, "make a directory here"))
}

fn remove(temporary: ScratchFolder) -> Result<(), MetricsError> {
    let path = temporary.path().to_owned();
    temporary
        .close()
        .map_err(MetricsError::io(path, "remove this directory"))
}

fn leftovers(data_folder: &Path) -> Result<Vec<PathBuf>, MetricsError> {
    let list = |error| MetricsError::io(data_folder, "list this directory")(error);
    let mut left = Vec::new();
    for entry in fs::read_dir(data_folder).map_err(list)? {
        let entry = entry.map_err(list)?;
        if entry.file_name().to_string_lossy().starts_with(TEMPORARY) && entry.path().is_dir() {
            left.push(entry.path());
        }
    }
    Ok(left)
}

fn is_run(dir: &Path) -> bool {
    dir.join(logger_info::FILE_NAME).is_file()
}

fn runs_of(task_dir: &Path) -> Result<Vec<PathBuf>, MetricsError> {
    Ok(directories(task_dir)?.into_iter().filter(|dir| is_run(dir)).collect())
}

/// The directories in a directory, in the order of their names; links and hidden ones are left out.
fn directories(dir: &Path) -> Result<Vec<PathBuf>, MetricsError> {
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

/// A link in a task's place would lead out of the data folder.
fn own_directory(dir: &Path) -> Result<(), MetricsError> {
    let kind = fs::symlink_metadata(dir).map_err(MetricsError::io(dir, "look at this directory"))?;
    if kind.is_dir() {
        return Ok(());
    }
    let error = std::io::Error::other("it is a link, which may lead elsewhere; remove it");
    Err(MetricsError::io(dir, "store logs here")(error))
}

fn refuse_pickles(data_folder: &Path) -> Result<(), MetricsError> {
    for folder in [data_folder.to_owned(), data_folder.join("taskinfo")] {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        if let Some(path) = paths
            .filter(|path| path.extension().is_some_and(|end| end == "pickle"))
            .min()
        {
            return Err(MetricsError::StePickle { path });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log};

    /// An expert's log with one row, and whose reward tells runs apart.
    fn expert(base: &Path, name: &str, task: &str, reward: f64) -> PathBuf {
        let dir = base.join(name);
        let info = LoggerInfo::new(["reward"]).unwrap();
        let mut writer = LogWriter::create(&dir, &info, &ScenarioInfo::default()).unwrap();
        let when = Timestamp::from_unix_micros(0).unwrap();
        let record = Record::new(0, 0, BlockType::Train, task, when).with_metric("reward", reward);
        writer.write(&record).unwrap();
        writer.finish().unwrap();
        dir
    }

    /// Tasks and names of runs.
    fn stored(data: &Path) -> Vec<(String, Vec<String>)> {
        let name = |run: &PathBuf| run.file_name().unwrap().to_str().unwrap().to_owned();
        let tasks = find_ste(data).unwrap();
        tasks
            .into_iter()
            .map(|task| (task.task_name, task.runs.iter().map(name).collect()))
            .collect()
    }

    fn check(data: &Path, expected: &[(&str, &[&str])]) {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let expected: Vec<_> = expected
            .iter()
            .map(|(task, runs)| ((*task).to_owned(), owned(runs)))
            .collect();
        assert_eq!(stored(data), expected);
        assert!(leftovers(data).unwrap().is_empty());
    }

    #[test]
    fn runs_are_appended_or_take_the_place_of_others() {
        let base = tempfile::tempdir().unwrap();
        let (data, store) = (base.path().join("deep/data"), SteStoreMode::Append);
        let first = expert(base.path(), "run", "Find_Red", 1.0);
        let other = expert(base.path(), "run10", "find_red", 2.0);
        let blue = expert(base.path(), "blue", "find_blue", 3.0);
        for log in [&first, &other, &first, &blue] {
            store_ste(&data, log, store).unwrap();
        }
        check(
            &data,
            &[("find_blue", &["blue"]), ("find_red", &["run", "run-2", "run10"])],
        );
        store_ste(&data, &first, SteStoreMode::Overwrite).unwrap();
        check(&data, &[("find_blue", &["blue"]), ("find_red", &["run"])]);
        let again = store_ste(&data, &other, SteStoreMode::Overwrite).unwrap();
        check(&data, &[("find_blue", &["blue"]), ("find_red", &["run10"])]);
        let copied = read_log(&again.dir).unwrap();
        let original = read_log(&other).unwrap();
        assert_eq!(copied, original);
    }

    #[test]
    fn a_task_or_all_are_removed_and_nothing_else() {
        let base = tempfile::tempdir().unwrap();
        let data = base.path().join("data");
        for task in ["a_1", "b_1", "c_1"] {
            store_ste(&data, expert(base.path(), task, task, 1.0), SteStoreMode::Append).unwrap();
        }
        fs::write(data.join("b_1/notes.txt"), "mine").unwrap();
        fs::create_dir_all(data.join(".storing-killed/new")).unwrap();
        let error = clear_ste(&data, Some("d_1")).unwrap_err().to_string();
        assert_eq!(error, "stored task: found \"d_1\", expected one of a_1, b_1, c_1");
        assert_eq!(clear_ste(&data, Some("A_1")).unwrap(), [data.join("a_1").join("a_1")]);
        assert_eq!(clear_ste(&data, None).unwrap().len(), 2);
        check(&data, &[]);
        let left: Vec<_> = fs::read_dir(&data)
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect();
        assert_eq!(left, ["b_1"], "the folder with a file that is not ours");
    }

    #[test]
    fn no_name_leads_out_of_the_folder() {
        let base = tempfile::tempdir().unwrap();
        let data = base.path().join("data");
        for (number, task) in ["..", "../../escaped", "/etc", "a/b", ".hidden", "é b", "CON:"]
            .iter()
            .enumerate()
        {
            let log = expert(base.path(), &number.to_string(), task, 1.0);
            let run = store_ste(&data, log, SteStoreMode::Append).unwrap();
            assert_eq!(run.dir.parent().unwrap().parent().unwrap(), data);
            assert!(
                stored(&data).iter().any(|(name, _)| *name == task.to_lowercase()),
                "{task}"
            );
        }
        let long = expert(base.path(), "long", &"x".repeat(300), 1.0);
        let error = store_ste(&data, long, SteStoreMode::Append).unwrap_err();
        assert_eq!(error.code(), "metrics/too-large");
    }

    #[test]
    fn folders_that_hold_no_experts_are_told_apart() {
        let base = tempfile::tempdir().unwrap();
        let log = expert(base.path(), "log", "a_1", 1.0);
        let check = |path: &Path, found: &str| {
            let message = find_ste(path).unwrap_err().to_string();
            let expected = format!(
                "{}: found {found}, expected a folder of single-task experts",
                path.display()
            );
            assert!(message.starts_with(&expected), "{message}");
        };
        check(&base.path().join("absent"), "nothing");
        check(&log.join("logger_info.json"), "a file");
        check(&log, "a log");
        fs::create_dir_all(base.path().join("data/taskinfo")).unwrap();
        fs::write(base.path().join("data/taskinfo/a_1.pickle"), "").unwrap();
        let error = find_ste(base.path().join("data")).unwrap_err();
        assert_eq!(error.code(), "metrics/ste-pickle");
    }

    #[test]
    fn what_is_no_experts_log_or_still_being_written_is_not_stored() {
        let base = tempfile::tempdir().unwrap();
        let data = base.path().join("data");
        let error = store_ste(&data, base.path().join("absent"), SteStoreMode::Append).unwrap_err();
        assert_eq!(error.code(), "metrics/not-a-directory");
        assert!(!data.exists());
        let log = expert(base.path(), "log", "a_1", 1.0);
        let mut writer = LogWriter::resume(&log).unwrap();
        if cfg!(unix) {
            let error = store_ste(&data, &log, SteStoreMode::Append).unwrap_err();
            assert_eq!(error.code(), "metrics/in-use");
        }
        let when = Timestamp::from_unix_micros(0).unwrap();
        let second = Record::new(0, 1, BlockType::Train, "b_1", when).with_metric("reward", 1.0);
        writer.write(&second).unwrap();
        writer.finish().unwrap();
        let error = store_ste(&data, &log, SteStoreMode::Append).unwrap_err();
        assert_eq!(error.code(), "metrics/not-single-task");
        assert!(!data.exists());
    }

    #[test]
    fn a_log_is_not_stored_into_itself() {
        let base = tempfile::tempdir().unwrap();
        let log = expert(base.path(), "log", "a_1", 1.0);
        for data in [log.clone(), log.join("data/deep")] {
            let error = store_ste(&data, &log, SteStoreMode::Append).unwrap_err();
            assert_eq!(error.code(), "metrics/bad-option");
        }
        assert!(!log.join("data").exists());
        assert_eq!(read_log(&log).unwrap().rows.len(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_a_tasks_place_is_refused() {
        let base = tempfile::tempdir().unwrap();
        let (data, elsewhere) = (base.path().join("data"), base.path().join("elsewhere"));
        fs::create_dir_all(&data).unwrap();
        fs::create_dir_all(&elsewhere).unwrap();
        std::os::unix::fs::symlink(&elsewhere, data.join("a_1")).unwrap();
        let log = expert(base.path(), "log", "a_1", 1.0);
        assert_eq!(
            store_ste(&data, &log, SteStoreMode::Overwrite).unwrap_err().code(),
            "metrics/io"
        );
        assert_eq!(fs::read_dir(&elsewhere).unwrap().count(), 0);
    }

    #[test]
    fn one_log_can_be_stored_by_several_at_once() {
        let base = tempfile::tempdir().unwrap();
        let (log, data) = (expert(base.path(), "run", "a_1", 1.0), base.path().join("data"));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| store_ste(&data, &log, SteStoreMode::Append).unwrap());
            }
        });
        assert_eq!(find_ste(&data).unwrap()[0].runs.len(), 8);
        // Who reads a log does not keep others from reading, but writers.
        let _reader = log_folder::lock_for_reading(&log).unwrap();
        store_ste(&data, &log, SteStoreMode::Append).unwrap();
        #[cfg(unix)]
        assert_eq!(LogWriter::resume(&log).unwrap_err().code(), "metrics/in-use");
    }
}
