//! A log that is removed, renamed, replaced or cut while a run writes it: the run ends with an error that names what is
//! lost, whatever the number of jobs, and makes nothing anew.

use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};
use std::process::Child;
use std::thread;
use std::time::{Duration, Instant};

use super::figures::Figures;
use super::options::Options;
use super::rng::Rng;
use super::signals::send;
use super::subject::{Subject, all_files, difference, end, file_error, num_bytes, start, to_its_end};
use crate::error::XtaskError;

/// How often each mishap happens to each number of jobs.
const TRIES: u64 = 20;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Mishap {
    FolderDeleted,
    FolderRenamed,
    FolderSwapped,
    FileTruncated,
    FileDeleted,
    FileReplaced,
}

const MISHAPS: [Mishap; 6] = [
    Mishap::FolderDeleted,
    Mishap::FolderRenamed,
    Mishap::FolderSwapped,
    Mishap::FileTruncated,
    Mishap::FileDeleted,
    Mishap::FileReplaced,
];

impl Mishap {
    /// Lets it happen; false where the file was not there to have it happen to.
    fn happen(self, log: &Path, file: &Path) -> bool {
        let away = log.with_extension("away");
        let done = match self {
            // Whoever writes into it meanwhile may hinder that.
            Self::FolderDeleted => {
                let removed = (0..100).any(|_| fs::remove_dir_all(log).is_ok());
                return removed;
            }
            Self::FolderRenamed => fs::rename(log, &away),
            Self::FolderSwapped => fs::rename(log, &away).and_then(|()| fs::create_dir(log)),
            // A file that was just made has nothing to lose.
            Self::FileTruncated if fs::metadata(file).is_ok_and(|found| found.len() == 0) => return false,
            Self::FileTruncated => OpenOptions::new()
                .write(true)
                .open(file)
                .and_then(|file| file.set_len(file.metadata()?.len() / 2)),
            Self::FileDeleted => fs::remove_file(file),
            Self::FileReplaced => {
                let other = file.with_extension("other");
                fs::write(&other, "another").and_then(|()| fs::rename(&other, file))
            }
        };
        done.is_ok()
    }
}

pub(super) fn figures(subject: &Subject, options: &Options, rng: &mut Rng) -> Result<Figures, XtaskError> {
    let mut figures = Figures::default();
    for jobs in [1, 2, 4] {
        let (expected, _) = subject.undisturbed(&subject.scenario, "random", jobs)?;
        let total = num_bytes(&expected);
        for mishap in MISHAPS {
            let (mut met, mut tries) = (0, 0);
            let wanted = options.scaled(TRIES);
            while met < wanted && tries < 20 * wanted {
                tries += 1;
                let log = subject.fresh("lost")?;
                subject.fresh("lost.away")?;
                let began = Instant::now();
                let mut child = start(&mut subject.run(&subject.scenario, "random", jobs, &log))?;
                let moment = rng.below(total * 7 / 10);
                let Some(file) = grown(&mut child, &log, moment) else {
                    end(child, began);
                    continue;
                };
                // It stands still meanwhile, and there are rows to come: so it has to notice.
                send("-STOP", child.id());
                let is_due = is_stopped(&child) && num_bytes(&all_files(&log)) < total;
                let happened = is_due && mishap.happen(&log, &file);
                let left = all_files(&log);
                send("-CONT", child.id());
                let ended = end(child, began);
                if !happened {
                    continue;
                }
                met += 1;
                figures.faults += 1;
                let what = format!("{mishap:?} at {moment} bytes, {jobs} jobs");
                if ended.status.code() != Some(1) || !ended.is_orderly() || !ended.said.contains("expected") {
                    figures.failed(format!("{what}: {}", ended.shown()));
                }
                let of_the_folder = matches!(
                    mishap,
                    Mishap::FolderDeleted | Mishap::FolderRenamed | Mishap::FolderSwapped
                );
                if of_the_folder && all_files(&log) != left {
                    figures.failed(format!("{what}: something was written in its place"));
                }
                // What was put aside is put back, or the log is begun anew: both end as they should.
                let away = subject.folder.join("lost.away");
                if away.exists() {
                    super::subject::remove(&log)?;
                    fs::rename(&away, &log).map_err(|source| file_error(&log, source))?;
                } else if !of_the_folder {
                    super::subject::remove(&log)?;
                }
                let last = to_its_end(&mut subject.run(&subject.scenario, "random", jobs, &log))?;
                if !last.is_well() {
                    figures.failed(format!("{what}, gone on with: {}", last.shown()));
                }
                figures.compared(difference(&all_files(&log), &expected), &what);
            }
            if met < wanted {
                figures.failed(format!("{mishap:?} could not be brought about, {jobs} jobs"));
            }
        }
    }
    Ok(figures)
}

/// Waits until a process that was told to stand still does; false if it ended before.
fn is_stopped(child: &Child) -> bool {
    let path = format!("/proc/{}/stat", child.id());
    (0..10_000).any(|_| {
        let stat = fs::read_to_string(&path).unwrap_or_default();
        // Behind the name in brackets.
        let state = stat.rsplit(") ").next().and_then(|rest| rest.chars().next());
        if state != Some('T') {
            thread::sleep(Duration::from_micros(100));
        }
        state == Some('T')
    })
}

/// Waits until a log has so many bytes; the data file that was written last, or nothing if the run ended before.
fn grown(child: &mut Child, log: &Path, bytes: u64) -> Option<PathBuf> {
    loop {
        let files = all_files(log);
        let tables = files.keys().filter(|name| name.ends_with("data-log.tsv"));
        if let Some(last) =
            tables.max_by_key(|name| fs::metadata(log.join(name)).and_then(|found| found.modified()).ok())
            && num_bytes(&files) >= bytes
        {
            return Some(log.join(last));
        }
        if child.try_wait().ok().flatten().is_some() {
            return None;
        }
        thread::sleep(Duration::from_micros(200));
    }
}
