//! Stores exact copies of the logs of single-task experts in a data folder, as `DATA/TASK/RUN/`.

use std::fs;
use std::path::{Path, PathBuf};

use driftworld_atomic_files::ScratchFolder;

use super::ste_folder::{
    TEMPORARY, check_outside, copy, directories, give_name, is_run, move_aside, own_directory, refuse_pickles, runs_of,
};
use super::{data_files, folder_name, log_folder};
use crate::MetricsError;
use crate::choice::choice;
use crate::lifetime::read_ste_log;

choice! {
    /// How to treat stored runs of the same task.
    SteStoreMode, "STE store mode" {
        /// Removes them: this run becomes the task's expert.
        Overwrite = "w",
        /// Keeps them: the task's expert is the mean over all runs.
        Append = "a",
    }
}

/// A stored log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredRun {
    /// The trained task, lower-case.
    pub task_name: String,
    /// The new folder of its log. If the name was taken, a number is appended, as in `run-2`.
    pub dir: PathBuf,
}

/// The stored runs of one task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredTask {
    /// The trained task, lower-case, with its variant.
    pub task_name: String,
    /// Directories of its logs, sorted by name with numbers compared as numbers.
    pub runs: Vec<PathBuf>,
}

/// Copies an expert's log into a data folder, which is created if necessary. The run appears there completely or not at all. In
/// the mode [`Overwrite`](SteStoreMode::Overwrite), a run of the same name is removed just before, and other runs afterwards.
///
/// In folder names, bytes that not every file system accepts are written as `%` and two hexadecimal digits, so that no name leads
/// out of the folder.
///
/// # Errors
/// Those of [`read_ste_log`]; [`MetricsError::InUse`] while one of our writers is using the log; [`MetricsError::TooLarge`] for
/// a task whose name is too long for a folder name; [`MetricsError::BadOption`] for a data folder inside the log, which would
/// become part of it; [`MetricsError::Io`].
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
    let lock = log_folder::lock(log_dir, fs::File::try_lock_shared)?;
    let expert = read_ste_log(log_dir)?;
    let task_name = expert.task_name().to_owned();
    let task_dir = data_folder.join(folder_name::encoded(data_folder, &task_name)?);
    let run = folder_name::encoded(data_folder, &expert.log().run_id)?;
    drop(expert);

    fs::create_dir_all(&task_dir).map_err(MetricsError::io(&task_dir, "make this directory"))?;
    own_directory(&task_dir)?;
    let temporary = ScratchFolder::new(TEMPORARY, data_folder);
    let temporary = temporary.map_err(MetricsError::io(data_folder, "make a directory here"))?;
    let new = temporary.path().join("new");
    copy(log_dir, &files, &new)?;
    drop(lock);

    if mode == SteStoreMode::Overwrite && is_run(&task_dir.join(&run)) {
        move_aside(&task_dir.join(&run), &temporary)?;
    }
    let dir = give_name(&new, &task_dir, &run)?;
    if mode == SteStoreMode::Overwrite {
        for other in runs_of(&task_dir)?.into_iter().filter(|other| *other != dir) {
            move_aside(&other, &temporary)?;
        }
    }
    let path = temporary.path().to_owned();
    temporary
        .close()
        .map_err(MetricsError::io(path, "remove this directory"))?;
    Ok(StoredRun { task_name, dir })
}

/// The tasks whose experts are stored in a data folder, sorted by name, each with its runs.
///
/// # Errors
/// [`MetricsError::NoSteData`] if there is no such folder, or it is a log; [`MetricsError::StePickle`] if it contains experts in
/// l2metrics' own format; [`MetricsError::Io`].
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlockType, LogWriter, LoggerInfo, Record, ScenarioInfo, Timestamp, read_log};

    /// An expert's log with one row, whose reward identifies the run.
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

    /// The stored tasks with the names of their runs.
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
        let names = fs::read_dir(data).unwrap().map(|entry| entry.unwrap().file_name());
        assert_eq!(names.filter(|name| name.to_string_lossy().starts_with('.')).count(), 0);
    }

    #[test]
    fn runs_are_appended_or_replace_others() {
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
        let overwritten = store_ste(&data, &other, SteStoreMode::Overwrite).unwrap();
        check(&data, &[("find_blue", &["blue"]), ("find_red", &["run10"])]);
        let copied = read_log(&overwritten.dir).unwrap();
        let original = read_log(&other).unwrap();
        assert_eq!(copied, original);
    }

    #[test]
    fn names_cannot_escape_the_data_folder() {
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
    fn error_names_the_kind_of_folder_without_experts() {
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
    fn invalid_or_unfinished_logs_are_not_stored() {
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
    fn log_is_not_stored_into_itself() {
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
    fn link_instead_of_a_task_folder_is_refused() {
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
    fn one_log_can_be_stored_several_times_concurrently() {
        let base = tempfile::tempdir().unwrap();
        let (log, data) = (expert(base.path(), "run", "a_1", 1.0), base.path().join("data"));
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| store_ste(&data, &log, SteStoreMode::Append).unwrap());
            }
        });
        assert_eq!(find_ste(&data).unwrap()[0].runs.len(), 8);
        // Storing a log excludes its writers, but not other readers.
        let _reader = log_folder::lock(&log, fs::File::try_lock_shared).unwrap();
        store_ste(&data, &log, SteStoreMode::Append).unwrap();
        #[cfg(unix)]
        assert_eq!(LogWriter::resume(&log).unwrap_err().code(), "metrics/in-use");
    }
}
