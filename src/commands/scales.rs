//! `driftworld scales`: floors and ceilings of variants, measured. How is the library's.

use std::path::PathBuf;

use clap::Args;

use crate::scales::{DEFAULT_SCALES_WORLDS, MAX_SCALES_WORLDS, ScalesFile, ScalesRequest, num_variants, scales};
use crate::table::table;
use crate::tasks::built_in_names;

use super::assets::LibraryChoice;
use super::{Failure, output};

/// Measure what agents that know nothing earn in each variant, and one that knows the map.
///
/// Three agents run in the same worlds: one that acts at random, one that stands still, one that knows the map. The
/// better of the first two is the floor of a variant, the third its ceiling. `driftworld metrics --scales FILE` scales
/// performance by them: 0 at the floor, 1 at the ceiling.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld scales find_objects#red find_objects#blue
  driftworld scales --worlds 50 --seed 77 -o scales.json
  driftworld metrics LOG --scales scales.json")]
pub(crate) struct Scales {
    /// Variants, or tasks, which stand for all their variants [default: the built-in tasks].
    #[arg(value_name = "TASK")]
    tasks: Vec<String>,
    /// Worlds of each variant.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_SCALES_WORLDS,
        value_parser = clap::value_parser!(u64).range(2..=MAX_SCALES_WORLDS))]
    worlds: u64,
    /// Seed of the worlds.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// JSON file to write.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Scales {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let built_in = || built_in_names().into_iter().map(str::to_owned).collect();
        let request = ScalesRequest {
            tasks: if self.tasks.is_empty() { built_in() } else { self.tasks },
            worlds: self.worlds,
            seed: self.seed,
            libraries: self.libraries.paths().to_vec(),
        };
        let bar = output::progress(num_variants(&request)? as u64, "measuring");
        let found = scales(&request, &|| bar.inc(1))?;
        bar.finish_and_clear();
        if let Some(path) = &self.output {
            output::write_or_print(path, &serde_json::to_string_pretty(&found)?)?;
            if output::is_stdout(path) {
                return Ok(());
            }
        }
        if self.json {
            return output::json(&found);
        }
        output::line(shown(&found))
    }
}

fn shown(found: &ScalesFile) -> String {
    let rows = found.scales.values().map(|scale| {
        let level = |agent: &str| {
            let level = scale.agents.get(agent);
            level.map_or_else(String::new, |level| {
                format!("{:.1} ± {:.1}", level.mean, level.standard_error)
            })
        };
        let word = if scale.ceiling > scale.floor {
            ""
        } else {
            "nothing to learn"
        };
        [
            scale.variant.clone(),
            level("random"),
            level("still"),
            level("onrails"),
            format!("{:.1}", scale.floor),
            format!("{:.1}", scale.ceiling),
            word.to_owned(),
        ]
    });
    let headings = ["variant", "random", "still", "onrails", "floor", "ceiling", ""];
    format!(
        "{}\nReward of an episode, ± the standard error over {} worlds of seed {}.",
        table(headings, rows.collect(), &[1, 2, 3, 4, 5]),
        found.worlds,
        found.seed
    )
}
