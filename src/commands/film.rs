//! `driftworld film`: an agent's episode in a world, filmed. What a frame shows is the library's.

use std::path::PathBuf;

use crate::episode_frames::recorded;
use crate::film::expect_film;
use clap::Args;
use driftworld_text::ShownPath;
use serde_json::json;

use super::agent::AgentArg;
use super::assets::LibraryChoice;
use super::film_choice::{FilmChoice, summary, tell};
use super::recording_file::write_recording;
use super::world_choice::WorldChoice;
use super::{Failure, output};

/// Let an agent act in a world, and film it.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld film find_objects#dusk --agent onrails -o dusk.gif
  driftworld film examples/worlds/key_corridor.json -o keys.gif --view both --size 300
  driftworld film moving_object --agent random --agent-seed 7 -o random.apng --record random.jsonl")]
pub(crate) struct Film {
    #[command(flatten)]
    choice: WorldChoice,
    #[arg(long, default_value = "onrails", value_name = "AGENT", help = AgentArg::HELP)]
    agent: AgentArg,
    /// Seed of the agent's random numbers.
    #[arg(long, default_value_t = 0, value_name = "S", allow_negative_numbers = true)]
    agent_seed: u64,
    /// File to write: .gif or .apng for a film, .png for a sheet of the frames that matter.
    #[arg(short, long, default_value = "film.gif", value_name = "FILE")]
    output: PathBuf,
    /// Keep the world and the actions in this file, for `driftworld replay`.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    #[command(flatten)]
    #[expect(clippy::struct_field_names, reason = "what a film is like, as replay has it")]
    film: FilmChoice,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Print what came of it as JSON.
    #[arg(long)]
    json: bool,
}

impl Film {
    pub(crate) fn run(self) -> Result<(), Failure> {
        expect_film(&self.output)?;
        let world = self.choice.world()?;
        let catalogue = self.libraries.catalogue()?;
        let mut agent = self.agent.agent()?.agent;
        let mut recording = recorded(&world, &catalogue, agent.as_mut(), self.agent_seed)?;
        recording.origin = self.choice.origin();
        let film = self.film.write(&self.output, &recording, &catalogue)?;
        if let Some(path) = &self.record {
            write_recording(path, &recording)?;
        }
        if self.json {
            return output::json(&json!({
                "file": self.output, "film": film, "record": self.record, "steps": recording.actions.len(),
                "reward": recording.reward, "ended_by": recording.ended_by.map(driftworld_env::EndedBy::word),
            }));
        }
        output::line(summary(&recording))?;
        tell(&self.output, &film)?;
        self.record
            .as_ref()
            .map_or(Ok(()), |path| output::line(format!("wrote {}", path.shown())))
    }
}
