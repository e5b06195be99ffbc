//! `driftworld film`: films an agent's episode in a world.

use std::path::PathBuf;

use crate::env::MAX_EXPERT_STEPS;
use crate::episode_frames::record_episode;
use crate::film::{FilmOptions, expect_film};
use crate::worlds::WorldRequest;
use clap::Args;
use driftworld_text::ShownPath;
use serde_json::json;

use super::agent::AgentArg;
use super::assets::LibraryChoice;
use super::film_choice::{self, report_film, summary};
use super::output;
use crate::Failure;

/// Default maximum number of steps of a film in a world without a step limit: 5 minutes at 0.1 s per step.
const MAX_STEPS_WITHOUT_LIMIT: u32 = 3000;

/// Let an agent act in a world, and film it.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld film find_objects#dusk --agent onrails -o dusk.gif
  driftworld film examples/worlds/key_corridor.json -o keys.gif --view both --size 300
  driftworld film moving_object --agent random --agent-seed 7 -o random.apng --record random.jsonl")]
pub(crate) struct Film {
    #[command(flatten)]
    choice: WorldRequest,
    #[arg(long, default_value = "onrails", value_name = "AGENT", help = AgentArg::HELP)]
    agent: AgentArg,
    /// Seed of the agent's random numbers.
    #[arg(long, default_value_t = 0, value_name = "S", allow_negative_numbers = true)]
    agent_seed: u64,
    /// File to write: .gif or .apng for a film, .png for a sheet of key frames.
    #[arg(short, long, default_value = "film.gif", value_name = "FILE")]
    output: PathBuf,
    /// Steps after which the film ends; 3000 if the world has no step limit.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    max_steps: Option<u32>,
    /// Save the world and the actions to this file, for `driftworld replay`. Like the film, it replaces an existing file.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    #[command(flatten)]
    #[expect(clippy::struct_field_names, reason = "the film options, named as in `replay`")]
    film: FilmOptions,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Film {
    pub(crate) fn run(self) -> Result<(), Failure> {
        expect_film(&self.output)?;
        self.film.check()?;
        let world = self.choice.world(&|text| output::warning(text))?;
        let catalogue = self.libraries.catalogue()?;
        let mut agent = self.agent.agent()?.agent;
        let has_limit = world.step_limit().is_some_and(|limit| limit > 0);
        let default_max = if has_limit {
            MAX_EXPERT_STEPS
        } else {
            MAX_STEPS_WITHOUT_LIMIT
        };
        let max_steps = self.max_steps.unwrap_or(default_max);
        let mut recording = record_episode(&world, &catalogue, agent.as_mut(), self.agent_seed, max_steps)?;
        recording.origin = self.choice.origin();
        if self.max_steps.is_none() && !has_limit && recording.actions.len() == max_steps as usize {
            output::warning(format!(
                "the world has no step limit: the film ends after {max_steps} steps; --max-steps sets another limit"
            ));
        }
        let film = film_choice::write(&self.output, &recording, &catalogue, &self.film)?;
        if let Some(path) = &self.record {
            film_choice::record(path, std::slice::from_ref(&recording))?;
        }
        if self.json {
            return output::json(&json!({
                "file": self.output, "film": film, "record": self.record, "steps": recording.actions.len(),
                "reward": recording.reward, "ended_by": recording.ended_by.map(driftworld_env::EndedBy::word),
            }));
        }
        output::line(format!("{} in {}", self.agent.name(), summary(&recording)))?;
        report_film(&self.output, &film)?;
        self.record
            .as_ref()
            .map_or(Ok(()), |path| output::line(format!("wrote {}", path.shown())))
    }
}
