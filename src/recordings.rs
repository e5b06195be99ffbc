//! Finds recorded episodes by their numbers, in a log or in a file of recordings.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use driftworld_curriculum::{CurriculumError, RECORDINGS_FILE, RecordingsFile};
use driftworld_env::{Catalogue, EpisodeOrigin, Recording, Replay};
use driftworld_metrics::{BlockType, read_log_with_texts};
use driftworld_text::{ShownPath, printable};

use crate::Failure;
use crate::contents::{Contents, OtherContents};

/// A source of recorded episodes.
pub struct RecordedEpisodes {
    path: PathBuf,
    /// The rows of a log by their numbers; `None` for a file of recordings.
    rows: Option<BTreeMap<u64, Vec<LoggedRow>>>,
    /// Whether the log was written by one of our runs.
    is_ours: bool,
    /// The file read last, with its block.
    file: Option<(Block, Option<RecordingsFile>)>,
}

/// A worker and its block.
type Block = (String, u64, BlockType);

/// An episode's row in a log.
#[derive(Clone, Debug, PartialEq)]
struct LoggedRow {
    block: Block,
    reward: Option<f64>,
    steps: Option<f64>,
}

impl RecordedEpisodes {
    /// Opens a log's folder, or a file of recordings.
    ///
    /// # Errors
    /// [`Failure`] if the path is neither, or cannot be read.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let mut episodes = Self {
            path: path.to_owned(),
            rows: None,
            is_ours: false,
            file: None,
        };
        if !path.is_dir() {
            let file = RecordingsFile::open(path)?;
            let missing = || Failure::in_file(path, "found no such file, expected a log or recordings");
            episodes.file = Some(((String::new(), 0, BlockType::Train), Some(file.ok_or_else(missing)?)));
            return Ok(episodes);
        }
        if let Some(other) = OtherContents::check(path, Contents::of_folder(path), &[Contents::Log]) {
            return Err(other.into());
        }
        let log = read_log_with_texts(path)?;
        // In other programs' logs, columns with these names may have a different meaning, such as a scaled reward.
        episodes.is_ours = log.scenario_info.extra.contains_key("made_from");
        let rows: &mut BTreeMap<u64, Vec<LoggedRow>> = episodes.rows.get_or_insert_default();
        for row in log.rows.iter() {
            let of_number = rows.entry(row.exp_num()).or_default();
            // Only the worker's last row for this number counts: it completes the episode.
            of_number.retain(|other| other.block.0 != row.worker_id());
            of_number.push(LoggedRow {
                block: (row.worker_id().to_owned(), row.block_num(), row.block_type()),
                reward: row.metric("reward"),
                steps: row.metric("episode_step_count"),
            });
        }
        Ok(episodes)
    }

    /// The numbers of all episodes, each with its worker if they come from a log. They are ordered by block, so that each file
    /// is read once.
    pub fn all(&self) -> Vec<(u64, Option<String>)> {
        let Some(rows) = &self.rows else {
            let numbers: BTreeSet<u64> = self.episodes_in_file().map(|origin| origin.experience).collect();
            return numbers.into_iter().map(|number| (number, None)).collect();
        };
        let mut keys: Vec<(&Block, u64)> = (rows.iter())
            .flat_map(|(number, rows)| rows.iter().map(|row| (&row.block, *number)))
            .collect();
        keys.sort_by_key(|((worker, block, kind), number)| (*block, kind.name(), worker, *number));
        keys.into_iter()
            .map(|((worker, ..), number)| (number, Some(worker.clone())))
            .collect()
    }

    /// The first damaged line of a file of recordings.
    pub fn damage(&self) -> Option<CurriculumError> {
        let (_, file) = self.file.as_ref().filter(|_| self.rows.is_none())?;
        file.as_ref()?.damage()
    }

    /// The recording of an episode; `None` if a log has its row but no recording. If several workers have an episode with this
    /// number, `worker` selects one.
    ///
    /// # Errors
    /// [`Failure`] if there is no such episode, or its recording is damaged.
    pub fn recording(&mut self, number: u64, worker: Option<&str>) -> Result<Option<Recording>, Failure> {
        if self.rows.is_some() {
            let block = self.row(number, worker)?.block.clone();
            if self.file.as_ref().is_none_or(|(open, _)| *open != block) {
                let file = RecordingsFile::of_block(&self.path, &block.0, (block.1, block.2))?;
                self.file = Some((block, file));
            }
        }
        let Some((_, Some(file))) = &mut self.file else {
            return Ok(None);
        };
        match file.recording(number)? {
            None if self.rows.is_none() => Err(self.missing(number)),
            recording => Ok(recording),
        }
    }

    /// Replays an episode, and compares the result with its recording and, in a log, with its row.
    ///
    /// # Errors
    /// A [`Failure`] that states the difference.
    pub fn check(&self, recording: &Recording, worker: Option<&str>, catalogue: &Catalogue) -> Result<(), Failure> {
        let mut replay = Replay::new(recording, catalogue);
        while replay.step()?.is_some() {}
        replay.check()?;
        self.check_row(recording, worker)
    }

    /// Compares a recording with its row in the log, if one of our runs wrote it.
    ///
    /// # Errors
    /// A [`Failure`] that states the difference.
    pub fn check_row(&self, recording: &Recording, worker: Option<&str>) -> Result<(), Failure> {
        if !self.is_ours {
            return Ok(());
        }
        let number = recording.origin.experience;
        let row = self.row(number, worker)?;
        let differs = |what: &str, found: f64, expected: f64| {
            Err(Failure::input(format!(
                "{}: experience {number}, {what}: found {found} in its recording, expected {expected} as in its row: the log or the \
                 recording was changed",
                self.path.shown()
            )))
        };
        match (row.reward, row.steps) {
            (Some(logged), _) if logged.to_bits() != recording.reward.to_bits() => {
                differs("reward", recording.reward, logged)
            }
            (_, Some(logged)) if logged != recording.actions.len() as f64 => {
                differs("steps", recording.actions.len() as f64, logged)
            }
            _ => Ok(()),
        }
    }

    fn row(&self, number: u64, worker: Option<&str>) -> Result<&LoggedRow, Failure> {
        let of_number = self.rows.as_ref().and_then(|rows| rows.get(&number));
        let of_number = of_number.ok_or_else(|| self.missing(number))?;
        let workers = || -> Vec<&str> { of_number.iter().map(|row| row.block.0.as_str()).collect() };
        let path = self.path.shown();
        match (&of_number[..], worker) {
            ([row], None) => Ok(row),
            (_, None) => Err(Failure::input(format!(
                "{path}: found episode {number} of each of the workers {}, expected one; choose it with {}",
                workers().join(", "),
                crate::argument("worker")
            ))),
            (rows, Some(worker)) => rows.iter().find(|row| row.block.0 == worker).ok_or_else(|| {
                Failure::input(format!(
                    "{path}: found no episode {number} of the worker {}, expected one of {}",
                    printable(worker),
                    workers().join(", ")
                ))
            }),
        }
    }

    /// The episodes of a file.
    fn episodes_in_file(&self) -> impl Iterator<Item = &EpisodeOrigin> {
        let file = self.file.iter().filter_map(|(_, file)| file.as_ref());
        file.flat_map(RecordingsFile::episodes)
    }

    fn missing(&self, number: u64) -> Failure {
        let numbers: BTreeSet<u64> = self.all().into_iter().map(|(number, _)| number).collect();
        let available = match (numbers.first(), numbers.last()) {
            (Some(first), Some(last)) if first == last => format!("episode {first}"),
            (Some(first), Some(last)) => format!("one of episodes {first} to {last}"),
            _ => "a file with episodes".to_owned(),
        };
        Failure::in_file(&self.path, format!("found no episode {number}, expected {available}"))
    }

    /// The error for an episode of a log that was not recorded, with advice.
    pub fn unrecorded(&self, number: u64) -> Failure {
        Failure::input(format!(
            "{}: found no recording of episode {number} (an {RECORDINGS_FILE} beside its rows), expected one; run with {}",
            self.path.shown(),
            crate::argument("record")
        ))
    }
}
