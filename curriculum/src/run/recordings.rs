//! [`Recordings`]: the actions of each episode, in a file beside the rows of its block.
//!
//! A recording is written before the row of its experience, so every row of a recorded log has one, no matter when the run is
//! stopped.

use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};

use driftworld_env::{EnvError, EpisodeOrigin, Recording, RecordingLines, RecordingMark, RecordingReader};
use driftworld_metrics::BlockType;

use crate::CurriculumError;

/// Name of the files, each beside a `data-log.tsv`.
pub const RECORDINGS_FILE: &str = "actions.jsonl";

/// Maximum size of a file that is read, in bytes.
pub const MAX_RECORDINGS_BYTES: u64 = 1 << 32;

/// Maximum number of files open at a time, one per worker of a block.
const MAX_OPEN: usize = 64;

/// The recordings of a log being written.
#[derive(Debug)]
pub struct Recordings {
    folder: PathBuf,
    /// The files of the current block.
    open: Vec<OpenFile>,
}

#[derive(Debug)]
struct OpenFile {
    /// The folder of its block, relative to the log's folder.
    subdir: PathBuf,
    path: PathBuf,
    file: File,
    length: u64,
    lines: RecordingLines,
    /// Lower bound on the number of the next experience.
    next: u64,
}

impl Recordings {
    /// Recordings of the log in this existing folder.
    pub fn new(folder: &Path) -> Self {
        Self {
            // The process may change its working directory.
            folder: std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned()),
            open: Vec::new(),
        }
    }

    /// Whether a log has recordings, so that it keeps recording when resumed.
    ///
    /// # Errors
    /// [`CurriculumError::Recordings`] if its folder cannot be listed.
    pub fn exist(folder: &Path) -> Result<bool, CurriculumError> {
        let list = |folder: &Path| match fs::read_dir(folder) {
            Ok(entries) => Ok(entries.flatten().map(|entry| entry.path()).collect::<Vec<_>>()),
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(Vec::new()),
            Err(error) => Err(failed(folder, "list this folder")(error)),
        };
        for worker in list(folder)? {
            if (list(&worker)?.iter()).any(|block| block.join(RECORDINGS_FILE).is_file()) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Writes the recording of the experience that is logged next. `worker` and `block` identify its row's file.
    ///
    /// Removes recordings that an earlier run left after the previous row.
    ///
    /// # Errors
    /// [`CurriculumError::Recordings`] if the disk fails; [`CurriculumError::Recording`] if the existing file does not hold
    /// recordings; [`CurriculumError::RecordingsLost`] if the file was removed or changed since the last recording.
    pub fn append(
        &mut self,
        worker: &str,
        block: (u64, BlockType),
        recording: &Recording,
    ) -> Result<(), CurriculumError> {
        let name = format!("{}-{}", block.0, block.1);
        let subdir = Path::new(worker).join(&name);
        let experience = recording.origin.experience;
        if self.open.first().is_some_and(|open| !open.subdir.ends_with(&name)) || self.open.len() == MAX_OPEN {
            self.sync()?;
        }
        // If a row was refused, its recording is in the file already and its number occurs again: reopening removes it.
        self.open
            .retain(|open| open.subdir != subdir || open.next <= experience);
        let known = self.open.iter().position(|open| open.subdir == subdir);
        let index = known.unwrap_or(self.open.len());
        if known.is_none() {
            self.open.push(self.open_file(subdir, experience)?);
        }
        let open = &mut self.open[index];
        let found = fs::metadata(&open.path).ok().map(|found| found.len());
        if found != Some(open.length) {
            return Err(CurriculumError::RecordingsLost {
                path: open.path.clone(),
                found: found.map_or_else(|| "no file".to_owned(), |bytes| format!("{bytes} bytes")),
                expected: open.length,
            });
        }
        let lines = open.lines.lines(recording);
        if let Err(error) = open.file.write_all(lines.as_bytes()) {
            // If even this fails, resuming the log removes the torn line.
            let _ = open.file.set_len(open.length);
            return Err(failed(&open.path, "append to this file")(error));
        }
        open.length += lines.len() as u64;
        open.next = experience + 1;
        Ok(())
    }

    /// Syncs the open files to disk, and closes them.
    ///
    /// # Errors
    /// [`CurriculumError::Recordings`] if the disk fails.
    pub fn sync(&mut self) -> Result<(), CurriculumError> {
        for open in self.open.drain(..) {
            open.file.sync_all().map_err(failed(&open.path, "write this file"))?;
        }
        Ok(())
    }

    /// Opens the file of a block, in which this experience comes next.
    fn open_file(&self, subdir: PathBuf, experience: u64) -> Result<OpenFile, CurriculumError> {
        let mut folder = self.folder.clone();
        for part in &subdir {
            folder.push(part);
            match fs::create_dir(&folder) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                    return Err(failed(&folder, "make this folder")(error));
                }
                _ => {}
            }
        }
        let path = folder.join(RECORDINGS_FILE);
        let (kept, lines) = valid_prefix(&path, experience)?;
        let open = OpenOptions::new().append(true).create(true).open(&path);
        let mut file = open.map_err(failed(&path, "open this file"))?;
        file.set_len(kept).map_err(failed(&path, "truncate this file"))?;
        let mut length = kept;
        if kept == 0 {
            let header = RecordingLines::header();
            file.write_all(header.as_bytes())
                .map_err(failed(&path, "append to this file"))?;
            length = header.len() as u64;
        }
        Ok(OpenFile {
            subdir,
            path,
            file,
            length,
            lines,
            next: experience,
        })
    }
}

/// The number of bytes with recordings of experiences before this one, and the state to append after them.
fn valid_prefix(path: &Path, experience: u64) -> Result<(u64, RecordingLines), CurriculumError> {
    // Opened directly, not through driftworld-files: it is our own file, and may have any length.
    let file = match File::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok((0, RecordingLines::default())),
        Err(error) => return Err(failed(path, "read this file")(error)),
    };
    let length = file.metadata().map_err(failed(path, "read this file's size"))?.len();
    let recording_error = |source| recording_error(path, source);
    let reader = match RecordingReader::new(BufReader::new(file)) {
        Ok(reader) => reader,
        // The run was stopped while it wrote the first line.
        Err(_) if length < RecordingLines::header().len() as u64 => return Ok((0, RecordingLines::default())),
        Err(error) => return Err(recording_error(error)),
    };
    let (length, lines, _) = reader.into_lines_before(experience).map_err(recording_error)?;
    Ok((length, lines))
}

/// A file of recordings with random access to episodes.
#[derive(Debug)]
pub struct RecordingsFile<R = BufReader<File>> {
    path: PathBuf,
    reader: RecordingReader<R>,
    episodes: Vec<EpisodeOrigin>,
    /// The start of each episode.
    positions: BTreeMap<u64, RecordingMark>,
    damage: Option<EnvError>,
}

impl RecordingsFile {
    /// Opens a file and indexes its episodes without decoding them; `None` without a file.
    ///
    /// # Errors
    /// [`CurriculumError::Recording`] for any other kind of file; [`CurriculumError::UnreadableRecordings`] if it cannot be read.
    pub fn open(path: &Path) -> Result<Option<Self>, CurriculumError> {
        match driftworld_files::open(path, MAX_RECORDINGS_BYTES) {
            Ok(opened) => Self::new(path, BufReader::new(opened.file)).map(Some),
            Err(error) if error.missing().is_some() => Ok(None),
            Err(source) => Err(CurriculumError::UnreadableRecordings(source)),
        }
    }

    /// Like [`RecordingsFile::open`], for the file beside the rows of a block.
    ///
    /// # Errors
    /// Those of [`RecordingsFile::open`].
    pub fn of_block(log: &Path, worker: &str, block: (u64, BlockType)) -> Result<Option<Self>, CurriculumError> {
        let folder = log.join(worker).join(format!("{}-{}", block.0, block.1));
        Self::open(&folder.join(RECORDINGS_FILE))
    }
}

impl<R: BufRead + Seek> RecordingsFile<R> {
    fn new(path: &Path, reader: R) -> Result<Self, CurriculumError> {
        let mut this = Self {
            reader: RecordingReader::new(reader).map_err(|source| recording_error(path, source))?,
            path: path.to_owned(),
            episodes: Vec::new(),
            positions: BTreeMap::new(),
            damage: None,
        };
        loop {
            match this.reader.next_episode() {
                Ok(Some(episode)) => {
                    this.positions.entry(episode.origin.experience).or_insert(episode.place);
                    this.episodes.push(episode.origin);
                }
                Ok(None) => return Ok(this),
                Err(error) => this.damage = this.damage.or(Some(error)),
            }
        }
    }

    /// The episodes with undamaged lines, in order.
    pub fn episodes(&self) -> &[EpisodeOrigin] {
        &self.episodes
    }

    /// The first damaged line.
    pub fn damage(&self) -> Option<CurriculumError> {
        self.damage.clone().map(|source| recording_error(&self.path, source))
    }

    /// The recording of an episode, by its number; `None` if there is none.
    ///
    /// # Errors
    /// [`CurriculumError::Recording`] if its line, or the line of its world, is damaged; damaged lines of other episodes are
    /// skipped.
    pub fn recording(&mut self, experience: u64) -> Result<Option<Recording>, CurriculumError> {
        let Some(place) = self.positions.get(&experience) else {
            return self.damage().map_or(Ok(None), Err);
        };
        let recording_error = |source| recording_error(&self.path, source);
        self.reader.turn_to(*place).map_err(recording_error)?;
        let episode = self.reader.next_episode().map_err(recording_error)?;
        let read = episode.map(|episode| self.reader.recording(&episode));
        read.transpose().map_err(recording_error)
    }
}

fn recording_error(path: &Path, source: EnvError) -> CurriculumError {
    CurriculumError::Recording {
        path: path.to_owned(),
        source,
    }
}

fn failed(path: &Path, doing: &'static str) -> impl FnOnce(std::io::Error) -> CurriculumError {
    move |source| CurriculumError::Recordings {
        path: path.to_owned(),
        doing,
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_env::{Action, Environment, Recorder};
    use std::io::{Cursor, Read, SeekFrom};

    /// Counts the bytes read.
    struct Counting<'a>(Cursor<Vec<u8>>, &'a std::cell::Cell<usize>);

    impl Read for Counting<'_> {
        fn read(&mut self, into: &mut [u8]) -> std::io::Result<usize> {
            let read = self.0.read(into)?;
            self.1.set(self.1.get() + read);
            Ok(read)
        }
    }

    impl Seek for Counting<'_> {
        fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
            self.0.seek(to)
        }
    }

    #[test]
    fn all_episodes_of_a_file_are_read_in_two_passes() {
        let world = driftworld_spec::World::default();
        let (mut environment, mut recorder) = (Environment::new(world.clone()), Recorder::default());
        recorder.begin(world);
        let action = Action::Continuous([1.0, 0.0, 0.0]);
        environment.step(action).expect("the action is valid");
        recorder.step(action);
        let mut recording = recorder.recording(&environment, None);
        for episodes in [100, 400] {
            let (mut file, mut lines) = (RecordingLines::header(), RecordingLines::default());
            for number in 0..episodes {
                recording.origin.experience = number;
                file += &lines.lines(&recording);
            }
            let (length, read) = (file.len(), std::cell::Cell::new(0));
            let reader = BufReader::new(Counting(Cursor::new(file.into_bytes()), &read));
            let mut file = RecordingsFile::new(Path::new("actions.jsonl"), reader).expect("the file is valid");
            for number in 0..episodes {
                recording.origin.experience = number;
                assert_eq!(
                    file.recording(number).expect("the file is valid").as_ref(),
                    Some(&recording)
                );
            }
            assert!(read.get() <= 2 * length + 8192, "{} of {length} bytes", read.get());
        }
    }
}
