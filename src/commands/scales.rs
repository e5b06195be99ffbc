//! `driftworld scales`: measures floors and ceilings of variants.

use std::path::PathBuf;

use clap::Args;

use crate::scales::{AgentLevel, BestAgent, ScalesFile, ScalesRequest, num_variants, scales};
use crate::table::table;
use crate::tasks::built_in_names;

use super::output;
use crate::Failure;

/// Measure the floor and the ceiling of each variant.
///
/// The floor is the reward of agents that know nothing, the ceiling that of an agent that knows the map.
///
/// Three agents run in the same worlds: one that acts at random, one that stands still, one that knows the map. The
/// better of the first two is the floor of a variant, the third its ceiling. `driftworld metrics --scales FILE` scales
/// performance by them: 0 at the floor, 1 at the ceiling.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld scales find_objects#red find_objects#blue
  driftworld scales --worlds 50 --seed 77 -o scales.json
  driftworld scales find_objects#blue find_objects#turned --unlabelled
  driftworld metrics LOG --scales scales.json")]
pub(crate) struct Scales {
    #[command(flatten)]
    request: ScalesRequest,
    /// JSON file to write.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Scales {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let mut request = self.request;
        if request.tasks.is_empty() {
            request.tasks = built_in_names().into_iter().map(str::to_owned).collect();
        }
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

/// A row per variant of each set of variants that look alike; `None` unless requested.
fn unlabelled(found: &ScalesFile) -> Option<String> {
    let mut rows = Vec::new();
    for set in &found.unlabelled {
        for (place, name) in set.among.iter().enumerate() {
            let level = |best: &BestAgent| in_words(best.levels.get(name));
            let agent = |best: &BestAgent| if place == 0 { best.agent.clone() } else { String::new() };
            let scale = found.scales.get(name);
            rows.push([
                scale.map_or_else(|| name.clone(), |scale| scale.variant.clone()),
                scale.map_or_else(String::new, |scale| format!("{:.1}", scale.ceiling)),
                level(&set.finds_out),
                agent(&set.finds_out),
                level(&set.fixed),
                agent(&set.fixed),
            ]);
        }
    }
    let headings = ["look alike", "ceiling", "finds out", "", "does the same in all", ""];
    let what = "Best mean reward over variants that look alike, among agents that are not told which one they are in.";
    (!rows.is_empty()).then(|| format!("{}\n{what}", table(headings, rows, &[1, 2, 4])))
}

fn in_words(level: Option<&AgentLevel>) -> String {
    level.map_or_else(String::new, |level| {
        format!("{:.1} ± {:.1}", level.mean, level.standard_error)
    })
}

fn shown(found: &ScalesFile) -> String {
    let rows = found.scales.values().map(|scale| {
        let level = |agent: &str| in_words(scale.agents.get(agent));
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
    let unlabelled = unlabelled(found).map_or_else(String::new, |shown| format!("\n\n{shown}"));
    format!(
        "{}\nReward of an episode, ± the standard error over {} worlds of seed {}.{unlabelled}",
        table(headings, rows, &[1, 2, 3, 4, 5]),
        found.worlds,
        found.seed
    )
}
