//! A log that is removed, renamed, replaced or truncated while it is being written: the writer reports it and recreates nothing.
#![cfg(unix)]

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};
use std::process::Command;

use driftworld_metrics::{BlockType, LogWriter, LoggerInfo, MetricsError, Record, ScenarioInfo, Timestamp, read_log};
use proptest::prelude::*;

const WORKERS: [&str; 2] = ["anna", "bert"];

/// Row `number` of a log with 4 rows per block, by one worker or by two alternating ones.
fn record(number: u64, workers: usize) -> Record {
    let block_type = if (number / 4).is_multiple_of(2) {
        BlockType::Train
    } else {
        BlockType::Test
    };
    let when = Timestamp::from_unix_micros(1_600_000_000_000_000).unwrap();
    let worker = WORKERS[number as usize % workers];
    let record = Record::new(number / 4, number, block_type, "find_red", when).with_worker(worker);
    record.with_metric("reward", number as f64)
}

fn create(dir: &Path) -> LogWriter {
    LogWriter::create(dir, &LoggerInfo::new(["reward"]).unwrap(), &ScenarioInfo::default()).unwrap()
}

/// The data file of row `number`.
fn file_of(dir: &Path, number: u64, workers: usize) -> PathBuf {
    let record = record(number, workers);
    let block = format!("{}-{}", record.block_num, record.block_type);
    dir.join(record.worker_id).join(block).join("data-log.tsv")
}

/// Damage to a log while it is being written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mishap {
    FolderDeleted,
    FolderRenamed,
    FolderSwapped,
    FolderReplacedByAFile,
    FileTruncated,
    FileEmptied,
    FileDeleted,
    FileReplaced,
    FileGrown,
    WorkerDeleted,
}

use Mishap as M;

const MISHAPS: [Mishap; 10] = [
    M::FolderDeleted,
    M::FolderRenamed,
    M::FolderSwapped,
    M::FolderReplacedByAFile,
    M::FileTruncated,
    M::FileEmptied,
    M::FileDeleted,
    M::FileReplaced,
    M::FileGrown,
    M::WorkerDeleted,
];

impl Mishap {
    /// Applies the damage to a folder or to a file in it.
    fn apply(self, dir: &Path, file: &Path) {
        let aside = dir.with_extension("aside");
        let cut = |length: u64| {
            OpenOptions::new()
                .write(true)
                .open(file)
                .unwrap()
                .set_len(length)
                .unwrap();
        };
        match self {
            M::FolderDeleted => fs::remove_dir_all(dir).unwrap(),
            M::FolderRenamed => fs::rename(dir, aside).unwrap(),
            M::FolderSwapped => {
                fs::rename(dir, aside).unwrap();
                fs::create_dir(dir).unwrap();
            }
            M::FolderReplacedByAFile => {
                fs::rename(dir, aside).unwrap();
                fs::write(dir, "in its place").unwrap();
            }
            M::FileTruncated => cut(fs::metadata(file).unwrap().len() - 7),
            M::FileEmptied => cut(0),
            M::FileDeleted => fs::remove_file(file).unwrap(),
            M::FileReplaced => {
                // The same length, but entirely different contents.
                let other = "x".repeat(fs::metadata(file).unwrap().len() as usize);
                fs::write(file.with_extension("new"), other).unwrap();
                fs::rename(file.with_extension("new"), file).unwrap();
            }
            M::FileGrown => {
                let mut whole = fs::read(file).unwrap();
                whole.extend(b"somebody else's row\n");
                fs::write(file, whole).unwrap();
            }
            M::WorkerDeleted => fs::remove_dir_all(file.parent().unwrap().parent().unwrap()).unwrap(),
        }
    }

    fn is_of_folder(self) -> bool {
        matches!(
            self,
            M::FolderDeleted | M::FolderRenamed | M::FolderSwapped | M::FolderReplacedByAFile
        )
    }
}

/// Everything below a path, with file contents.
fn listed(path: &Path) -> Vec<(PathBuf, Option<Vec<u8>>)> {
    let mut found = Vec::new();
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        let path = entry.path();
        found.push((path.clone(), fs::read(&path).ok()));
        found.extend(listed(&path));
    }
    found.sort();
    found
}

/// Writes these rows and finishes the log.
fn write(mut writer: LogWriter, rows: std::ops::Range<u64>, workers: usize) -> Result<(), MetricsError> {
    for number in rows {
        writer.write(&record(number, workers))?;
    }
    writer.finish()
}

proptest! {
    // Each log syncs to disk many times.
    #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 48), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_mishap_is_an_error_and_nothing_is_recreated(
        mishap in prop::sample::select(&MISHAPS[..]),
        workers in 1..=2_usize,
        resumed in any::<bool>(),
        (written, after) in (1..20_u64, 0..10_u64),
        hit in any::<prop::sample::Index>(),
    ) {
        let base = tempfile::tempdir().unwrap();
        let dir = base.path().join("log");
        let mut writer = create(&dir);
        for number in 0..written {
            if resumed && number == written / 2 {
                writer.finish().unwrap();
                writer = LogWriter::resume(&dir).unwrap();
            }
            writer.write(&record(number, workers)).unwrap();
        }
        let file = file_of(&dir, hit.index(written as usize) as u64, workers);
        mishap.apply(&dir, &file);
        let left = listed(base.path());
        let error = write(writer, written..written + after, workers).unwrap_err();
        let expected = if mishap.is_of_folder() { "metrics/folder-lost" } else { "metrics/file-lost" };
        prop_assert_eq!(error.code(), expected, "{}", error);
        let message = error.to_string();
        prop_assert!(message.starts_with(dir.to_str().unwrap()), "{}", message);
        // Rows may have been written to intact files, but nothing to the damaged ones, and no folder was recreated.
        if mishap.is_of_folder() {
            prop_assert_eq!(listed(base.path()), left);
            prop_assert!(message.contains(&format!("and with it {written} row")), "{}", message);
        } else {
            let of_the_file = |found: &[(PathBuf, Option<Vec<u8>>)]| {
                found.iter().find(|(path, _)| *path == file).cloned()
            };
            prop_assert_eq!(of_the_file(&listed(base.path())), of_the_file(&left));
        }
    }

    #[test]
    fn untouched_or_restored_log_is_whole(
        workers in 1..=2_usize, rows in 1..20_u64, moment in 0..20_u64,
    ) {
        let base = tempfile::tempdir().unwrap();
        let dir = base.path().join("log");
        let mut writer = create(&dir);
        for number in 0..rows {
            if number == moment {
                let away = base.path().join("away");
                fs::rename(&dir, &away).unwrap();
                let error = writer.write(&record(number, workers)).unwrap_err();
                prop_assert_eq!(error.code(), "metrics/folder-lost");
                fs::rename(&away, &dir).unwrap();
            }
            writer.write(&record(number, workers)).unwrap();
        }
        writer.finish().unwrap();
        let records: Vec<Record> = read_log(&dir).unwrap().rows.iter().map(driftworld_metrics::Row::to_record).collect();
        let expected: Vec<Record> = (0..rows).map(|number| record(number, workers)).collect();
        prop_assert_eq!(records, expected);
    }
}

#[test]
fn lost_rows_and_bytes_are_counted() {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("log");
    let mut writer = create(&dir);
    (0..3).for_each(|number| writer.write(&record(number, 1)).unwrap());
    let file = file_of(&dir, 0, 1);
    let whole = fs::read_to_string(&file).unwrap();
    let first = whole.lines().take(2).map(|line| line.len() + 1).sum::<usize>();
    fs::write(&file, &whole[..first]).unwrap();
    let message = writer.finish().unwrap_err().to_string();
    let expected_start = format!(
        "{}: found 1 row in {first} bytes, expected the 3 rows in {} bytes that were written",
        file.display(),
        whole.len()
    );
    assert!(message.starts_with(&expected_start), "{message}");
}

#[test]
fn identical_copy_of_a_finished_file_is_not_a_loss() {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("log");
    let mut writer = create(&dir);
    (0..6).for_each(|number| writer.write(&record(number, 1)).unwrap());
    // The first block is finished; some file systems now give its file a different id.
    let file = file_of(&dir, 0, 1);
    fs::copy(&file, file.with_extension("new")).unwrap();
    fs::rename(file.with_extension("new"), &file).unwrap();
    writer.finish().unwrap();
}

#[test]
fn missing_info_file_is_detected() {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("log");
    let mut writer = create(&dir);
    writer.write(&record(0, 1)).unwrap();
    fs::remove_file(dir.join("logger_info.json")).unwrap();
    let error = writer.finish().unwrap_err();
    assert_eq!(error.code(), "metrics/missing-file");
    assert!(error.to_string().contains("logger_info.json"), "{error}");
}

/// The new folder belongs to another writer, as when a run is restarted after `rm -r`.
#[test]
fn two_writers_never_share_a_folder() {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("log");
    let mut first = create(&dir);
    first.write(&record(0, 1)).unwrap();
    fs::remove_dir_all(&dir).unwrap();
    let mut second = create(&dir);
    second.write(&record(0, 1)).unwrap();
    for number in 1..6 {
        assert_eq!(
            first.write(&record(number, 1)).unwrap_err().code(),
            "metrics/folder-lost"
        );
        second.write(&record(number, 1)).unwrap();
    }
    assert_eq!(first.finish().unwrap_err().code(), "metrics/folder-lost");
    second.finish().unwrap();
    assert_eq!(read_log(&dir).unwrap().rows.len(), 6);
}

/// Folders are kept as absolute paths.
#[test]
fn changing_the_working_directory_does_not_move_the_log() {
    // In a separate process, because all threads share the working directory.
    if std::env::var_os("LOST_LOG_ALONE").is_none() {
        let name = "lost_log::changing_the_working_directory_does_not_move_the_log";
        let mut alone = Command::new(std::env::current_exe().unwrap());
        let output = alone
            .args([name, "--exact"])
            .env("LOST_LOG_ALONE", "1")
            .output()
            .unwrap();
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && printed.contains("1 passed"), "{printed}");
        return;
    }
    let base = tempfile::tempdir().unwrap();
    std::env::set_current_dir(base.path()).unwrap();
    let mut writer = create(Path::new("log"));
    writer.write(&record(0, 1)).unwrap();
    fs::create_dir("elsewhere").unwrap();
    std::env::set_current_dir("elsewhere").unwrap();
    (1..6).for_each(|number| writer.write(&record(number, 1)).unwrap());
    writer.finish().unwrap();
    assert_eq!(read_log(base.path().join("log")).unwrap().rows.len(), 6);
    assert_eq!(fs::read_dir(".").unwrap().count(), 0);
}

#[test]
fn truncated_or_missing_info_file_fails_at_the_end() {
    for name in ["logger_info.json", "scenario_info.json"] {
        for cut in [true, false] {
            let base = tempfile::tempdir().unwrap();
            let dir = base.path().join("log");
            let mut writer = create(&dir);
            writer.write(&record(0, 1)).unwrap();
            if cut {
                fs::write(dir.join(name), "{}").unwrap();
            } else {
                fs::remove_file(dir.join(name)).unwrap();
            }
            let error = writer.finish().unwrap_err();
            let code = if cut {
                "metrics/info-file-changed"
            } else {
                "metrics/missing-file"
            };
            assert_eq!(error.code(), code, "{error}");
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}
