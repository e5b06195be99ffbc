//! `driftworld replay`: replays recorded episodes, compares them with their log, and films them.

use std::path::PathBuf;

use crate::env::Catalogue;
use crate::film::{FilmOptions, expect_film};
use crate::recordings::RecordedEpisodes;
use clap::Args;
use driftworld_text::ShownPath;
use serde_json::json;

use super::assets::LibraryChoice;
use super::film_choice::{self, report_film, summary};
use super::output;
use crate::Failure;

/// Replay recorded episodes, check them, and draw them.
///
/// Reads what `run --record`, `film --record`, `play --record`, Python's `record=True` and `driftworld-unity --record`
/// wrote. An episode is run again from its world and its actions, and must earn exactly the reward in the log, to the
/// last bit. Without --episode, all episodes are checked.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld run scenario.json --agent random --output logs/first --record
  driftworld replay logs/first
  driftworld replay logs/first --episode 17 -o episode.gif
  driftworld replay logs/first --episode 17 -o episode.png --size 320")]
pub(crate) struct Replay {
    /// The folder of a log, or a file of recordings.
    log: PathBuf,
    /// The number of the episode: `exp_num` in the log, from 0.
    #[arg(long, value_name = "N")]
    episode: Option<u64>,
    /// The worker whose episode to replay, if several have one with this number.
    #[arg(long, value_name = "WORKER", requires = "episode")]
    worker: Option<String>,
    /// File to draw the episode into: .gif or .apng for a film, .png for a sheet of key frames.
    #[arg(short, long, value_name = "FILE", requires = "episode")]
    output: Option<PathBuf>,
    #[command(flatten)]
    film: FilmOptions,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Replay {
    pub(crate) fn run(self) -> Result<(), Failure> {
        output::run_to_end_for_exit_code();
        if let Some(path) = &self.output {
            expect_film(path)?;
            self.film.check()?;
        }
        let mut episodes = RecordedEpisodes::open(&self.log)?;
        let catalogue = self.libraries.catalogue()?;
        match self.episode {
            Some(number) => self.one(&mut episodes, number, &catalogue),
            None => self.all(&mut episodes, &catalogue),
        }
    }

    fn one(&self, episodes: &mut RecordedEpisodes, number: u64, catalogue: &Catalogue) -> Result<(), Failure> {
        let worker = self.worker.as_deref();
        let recording = episodes.recording(number, worker)?;
        let recording = recording.ok_or_else(|| episodes.unrecorded(number))?;
        episodes.check(&recording, worker, catalogue)?;
        let written = match &self.output {
            Some(path) => Some((path, film_choice::write(path, &recording, catalogue, &self.film)?)),
            None => None,
        };
        if self.json {
            let origin = serde_json::to_value(&recording.origin)?;
            return output::json(&json!({
                "episode": origin, "steps": recording.actions.len(), "reward": recording.reward,
                "ended_by": recording.ended_by.map(driftworld_env::EndedBy::word), "recorded_by": recording.recorded_by,
                "file": written.as_ref().map(|(path, _)| path), "film": written.as_ref().map(|(_, film)| film),
            }));
        }
        output::line(format!(
            "episode {number}: {}; replays as recorded",
            summary(&recording)
        ))?;
        written.map_or(Ok(()), |(path, film)| report_film(path, &film))
    }

    fn all(&self, episodes: &mut RecordedEpisodes, catalogue: &Catalogue) -> Result<(), Failure> {
        let numbers = episodes.all();
        let bar = output::progress(numbers.len() as u64, "replaying");
        let (mut checked, mut steps, mut unrecorded) = (0_u64, 0_u64, Vec::new());
        let mut failures: Vec<Failure> = episodes.damage().into_iter().map(Failure::from).collect();
        for (number, worker) in numbers {
            let worker = worker.as_deref();
            let outcome = episodes
                .recording(number, worker)
                .and_then(|recording| match recording {
                    Some(recording) => {
                        episodes.check(&recording, worker, catalogue)?;
                        Ok(Some(recording.actions.len()))
                    }
                    None => Ok(None),
                });
            match outcome {
                Ok(Some(count)) => {
                    checked += 1;
                    steps += count as u64;
                }
                Ok(None) => unrecorded.push(number),
                Err(failure) => failures.push(failure),
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        if self.json && failures.is_empty() {
            return output::json(&json!({ "checked": checked, "steps": steps, "not_recorded": unrecorded }));
        }
        if !failures.is_empty() {
            const MAX_LISTED: usize = 10;
            let shown: Vec<&Failure> = failures.iter().take(MAX_LISTED).collect();
            output::note(format!(
                "{checked} episodes replay as recorded, {} do not",
                failures.len()
            ));
            return Err(Failure::of_several(&shown));
        }
        if checked == 0 {
            return Err(episodes.unrecorded(unrecorded.first().copied().unwrap_or(0)));
        }
        let skipped = match unrecorded.len() {
            0 => String::new(),
            count => format!("; {count} were not recorded"),
        };
        output::line(format!(
            "{}: {checked} {} of {steps} steps in all {} as recorded{skipped}",
            self.log.shown(),
            if checked == 1 { "episode" } else { "episodes" },
            if checked == 1 { "replays" } else { "replay" },
        ))
    }
}
