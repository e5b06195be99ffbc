//! [`RecordingReader`] reads recordings. A damaged line is an error with its number, and does not affect other lines.

use std::collections::BTreeMap;
use std::io::{BufRead, ErrorKind, Read, Seek};

use driftworld_spec::{MAX_BYTES, World};
use driftworld_text::in_plain_words;

use super::lines::{EpisodeLine, HeaderLine, RECORDING_FORMAT, RecordingLines, WorldLine, check_checksum};
use super::packed::inflated;
use super::{Edit, EpisodeOrigin, Recording};
use crate::EnvError;
use crate::sim::EndedBy;

/// Maximum length of a line in bytes.
pub const MAX_RECORDING_LINE: u64 = 1 << 27;

/// Reads the episodes of a file one after another.
#[derive(Debug)]
pub struct RecordingReader<R> {
    reader: R,
    line: u64,
    offset: u64,
    /// Encoded worlds with their line numbers, by hash.
    worlds: BTreeMap<String, (u64, String)>,
    is_truncated: bool,
}

/// A position in a file between two lines.
#[derive(Clone, Copy, Debug)]
pub struct RecordingMark {
    line: u64,
    offset: u64,
}

/// An episode of a file that is not decoded yet; see [`RecordingReader::recording`].
#[derive(Debug)]
pub struct RecordedEpisode {
    /// The episode's identity.
    pub origin: EpisodeOrigin,
    /// Its number of steps, as stated in the file.
    pub steps: u32,
    /// Its reward, as stated in the file.
    pub reward: f64,
    /// Its line in the file, from 1.
    pub line: u64,
    /// The position of that line.
    pub place: RecordingMark,
    stored: EpisodeLine,
}

impl<R: BufRead> RecordingReader<R> {
    /// A reader at the first line.
    ///
    /// # Errors
    /// [`EnvError::Recording`] if the first line is not that of a recordings file of this version.
    pub fn new(reader: R) -> Result<Self, EnvError> {
        let mut this = Self {
            reader,
            line: 0,
            offset: 0,
            worlds: BTreeMap::new(),
            is_truncated: false,
        };
        let expected = "the first line of a recordings file, as written by run --record";
        let Some(line) = this.line()? else {
            return Err(wrong(this.line, "an empty file", expected));
        };
        let header: HeaderLine =
            serde_json::from_slice(&line).map_err(|_| wrong(this.line, "another line", expected))?;
        if header.recording_format != RECORDING_FORMAT {
            let expected = format!("format {RECORDING_FORMAT}; use the version of Driftworld that wrote it");
            return Err(wrong(
                this.line,
                format!(
                    "format {} of driftworld {:.40}",
                    header.recording_format, header.driftworld
                ),
                expected,
            ));
        }
        Ok(this)
    }

    /// The next episode; `None` at the end.
    ///
    /// # Errors
    /// [`EnvError::Recording`] for a line that is damaged or truncated; the next call continues after it.
    pub fn next_episode(&mut self) -> Result<Option<RecordedEpisode>, EnvError> {
        loop {
            let place = self.mark();
            let Some(line) = self.line()? else { return Ok(None) };
            let not_a_line = |this: &Self, error: &serde_json::Error| {
                wrong(this.line, in_plain_words(error), "a line of a world or of an episode")
            };
            if line.starts_with(b"{\"world_hash\":") {
                let world: WorldLine = serde_json::from_slice(&line).map_err(|error| not_a_line(self, &error))?;
                let line = self.line;
                // If a world has several lines, the last one counts: it was written because earlier ones could not be decoded.
                self.worlds.insert(world.world_hash, (line, world.world));
                continue;
            }
            let stored: EpisodeLine = serde_json::from_slice(&line).map_err(|error| not_a_line(self, &error))?;
            return Ok(Some(RecordedEpisode {
                origin: stored.origin.clone(),
                steps: stored.steps,
                reward: stored.reward,
                line: self.line,
                place,
                stored,
            }));
        }
    }

    /// Decodes an episode.
    ///
    /// # Errors
    /// [`EnvError::Recording`] if its actions or its worlds cannot be read.
    pub fn recording(&self, episode: &RecordedEpisode) -> Result<Recording, EnvError> {
        let stored = &episode.stored;
        let at_episode = |(found, expected): (String, String)| wrong(episode.line, found, expected);
        let world = self.world(episode.line, &stored.world_hash)?;
        check_metadata(stored, &world).map_err(at_episode)?;
        let actions = stored.actions.unpack(stored.steps).map_err(at_episode)?;
        let ended_by = stored.ended_by.as_deref().map(|word| {
            let parsed = word.parse::<EndedBy>();
            parsed.map_err(|_| wrong(episode.line, format!("ended_by {word:.40}"), "a known cause"))
        });
        let edits = stored.edits.iter().map(|(step, hash)| {
            Ok(Edit {
                step: *step,
                world: self.world(episode.line, hash)?,
            })
        });
        Ok(Recording {
            origin: episode.origin.clone(),
            recorded_by: stored.driftworld.clone(),
            world,
            edits: edits.collect::<Result<_, _>>()?,
            actions,
            reward: stored.reward,
            ended_by: ended_by.transpose()?,
        })
    }

    /// Seeks to a marked position after the file has been read to its end. Does not seek if the reader is already there.
    ///
    /// # Errors
    /// [`EnvError::Recording`] if seeking fails.
    pub fn turn_to(&mut self, place: RecordingMark) -> Result<(), EnvError>
    where
        R: Seek,
    {
        let by = place.offset.cast_signed() - self.offset.cast_signed();
        let result = self.reader.seek_relative(by);
        result.map_err(|error| wrong(self.line, error.to_string(), "a readable file"))?;
        (self.line, self.offset) = (place.line, place.offset);
        Ok(())
    }

    /// The reader's current position.
    pub fn mark(&self) -> RecordingMark {
        RecordingMark {
            line: self.line,
            offset: self.offset,
        }
    }

    /// Finds the end of the episodes before this experience: the first episode of this or a later experience, or an incomplete
    /// last line. Returns the number of bytes before that point, a writer that continues there, and the index of the next
    /// experience (0 if there are no episodes before).
    ///
    /// # Errors
    /// [`EnvError::Recording`] for a damaged line before that point.
    pub fn into_lines_before(mut self, experience: u64) -> Result<(u64, RecordingLines, u64), EnvError> {
        let mut next = 0;
        let end = loop {
            let before = self.mark();
            match self.next_episode() {
                Ok(Some(episode)) if episode.origin.experience < experience => next = episode.origin.experience + 1,
                Ok(Some(_)) => break before,
                Ok(None) => break self.mark(),
                Err(_) if self.is_truncated => break before,
                Err(error) => return Err(error),
            }
        };
        let (length, lines) = self.into_lines_at(end);
        Ok((length, lines, next))
    }

    /// The number of bytes before a position, and a writer that continues there. The writer writes worlds again if their lines
    /// cannot be decoded, for example because they are of a different version.
    fn into_lines_at(self, place: RecordingMark) -> (u64, RecordingLines) {
        let before = self.worlds.iter().filter(|(_, (line, _))| *line <= place.line);
        let decodable = before.filter(|(hash, _)| self.world(place.line, hash).is_ok());
        let decodable = decodable.map(|(hash, _)| hash.clone());
        (place.offset, RecordingLines::with_worlds(decodable))
    }

    fn world(&self, line: u64, hash: &str) -> Result<World, EnvError> {
        let missing = || {
            let found = format!("world {hash:.16}, which has no line before it");
            wrong(line, found, "that line: it is damaged or missing")
        };
        let (line, packed) = self.worlds.get(hash).ok_or_else(missing)?;
        let at_world = |(found, expected): (String, String)| wrong(*line, found, expected);
        let bytes = inflated(packed, MAX_BYTES as u64).map_err(at_world)?;
        let text = String::from_utf8(bytes).map_err(|_| wrong(*line, "bytes that are not UTF-8", "a world"))?;
        let world = World::from_json("world", &text)
            .map_err(|error| wrong(*line, error.to_string(), "a world of this version"))?;
        let found = world.hash();
        if found != hash {
            let expected = format!("{hash:.64}: the world means something else in this version");
            return Err(wrong(*line, format!("the hash {found}"), expected));
        }
        Ok(world)
    }

    /// The next line without its line ending, with its checksum verified.
    fn line(&mut self) -> Result<Option<Vec<u8>>, EnvError> {
        let mut line = Vec::new();
        let read = self
            .reader
            .by_ref()
            .take(MAX_RECORDING_LINE)
            .read_until(b'\n', &mut line);
        self.line += 1;
        match read {
            Err(error) if error.kind() != ErrorKind::UnexpectedEof => {
                return Err(wrong(self.line, error.to_string(), "a readable file"));
            }
            _ if line.is_empty() => return Ok(None),
            _ => {}
        }
        self.offset += line.len() as u64;
        if line.pop() != Some(b'\n') {
            self.is_truncated = true;
            let advice = "a line ending: the writer was stopped in this line; earlier lines are intact";
            return Err(wrong(self.line, "the end of the file", advice));
        }
        check_checksum(&line).map_err(|(found, expected)| wrong(self.line, found, expected))?;
        Ok(Some(line))
    }
}

fn wrong(line: u64, found: impl Into<String>, expected: impl Into<String>) -> EnvError {
    EnvError::Recording {
        line,
        found: found.into(),
        expected: expected.into(),
    }
}

/// Checks the line's redundant information against the world, and that its version is not newer than this one.
fn check_metadata(stored: &EpisodeLine, world: &World) -> Result<(), (String, String)> {
    let agent = &world.agent_params;
    let numbers = |version: &str| {
        version
            .split('.')
            .map(|part| part.parse().ok())
            .collect::<Option<Vec<u64>>>()
    };
    let own = env!("CARGO_PKG_VERSION");
    let differs =
        |key: &str, found: &dyn std::fmt::Display, expected: String| Err((format!("{key} {found:.40}"), expected));
    if stored.time_step.to_bits() != agent.time_step.to_bits() {
        return differs(
            "time_step",
            &stored.time_step,
            format!("{} as in its world", agent.time_step),
        );
    }
    if stored.frame_skip != agent.frame_skip.max(1) {
        let expected = format!("{} as in its world", agent.frame_skip.max(1));
        return differs("frame_skip", &stored.frame_skip, expected);
    }
    if numbers(&stored.driftworld).is_none_or(|found| found.len() != 3 || Some(found) > numbers(own)) {
        return differs("driftworld", &stored.driftworld, format!("a version up to {own}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::lines::with_checksum;
    use super::*;
    use crate::recording::packed::deflated;
    use crate::{Action, Environment, Recorder};

    fn recording(experience: u64) -> Recording {
        let world = World::default();
        let (mut environment, mut recorder) = (Environment::new(world.clone()), Recorder::default());
        recorder.begin(world);
        let action = Action::Continuous([1.0, 0.0, 0.0]);
        environment.step(action).unwrap();
        recorder.step(action);
        let mut recording = recorder.recording(&environment, None);
        recording.origin.experience = experience;
        recording
    }

    /// A bug found by the fuzzer: episodes written after such a line could not be read.
    #[test]
    fn undecodable_world_is_written_again() {
        let world = with_checksum(&WorldLine {
            world_hash: World::default().hash(),
            world: deflated(br#"{ "of_another_version": true }"#.iter().copied()),
        });
        let mut file = RecordingLines::header() + &world;
        let reader = RecordingReader::new(file.as_bytes()).expect("the first line is valid");
        let (offset, mut lines, next) = reader.into_lines_before(u64::MAX).expect("no line is damaged");
        assert_eq!((offset, next), (file.len() as u64, 0));
        file += &lines.lines(&recording(0));
        file += &lines.lines(&recording(1));
        assert_eq!(
            file.matches("{\"world_hash\"").count(),
            2,
            "the damaged line and one new line"
        );
        let mut reader = RecordingReader::new(file.as_bytes()).unwrap();
        for number in 0..2 {
            let episode = reader.next_episode().unwrap().unwrap();
            assert_eq!(reader.recording(&episode).unwrap(), recording(number));
        }
    }
}
