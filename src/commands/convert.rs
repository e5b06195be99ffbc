//! `driftworld convert`: converts worlds and scenarios of L2Explorer, and worlds of variants, into our format.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::spec::Scenario;
use clap::Args;
use driftworld_text::ShownPath;

use super::output;
use crate::scenarios::ScenarioFile;
use crate::worlds::WorldRequest;
use crate::{Failure, overwrite};

/// Convert worlds and scenarios of L2Explorer.
///
/// Warnings on standard error name everything that is changed or left out. For a variant, one of its worlds is drawn.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld convert map.json --l2explorer -o world.json
  driftworld convert scenario_findobjects.json -o scenario.json
  driftworld convert find_objects#red --seed 7 -o world.json")]
pub(crate) struct Convert {
    #[command(flatten)]
    choice: WorldRequest,
    /// File to write, or - for standard output.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

impl Convert {
    pub(crate) fn run(self) -> Result<(), Failure> {
        self.convert()?;
        output::json_of_what_was_written(self.json && !output::is_stdout(&self.output))
    }

    fn convert(&self) -> Result<(), Failure> {
        let path = Path::new(&self.choice.world);
        overwrite::refuse_inputs(&self.output, [self.choice.world.as_str()])?;
        if ScenarioFile::is_one(path) {
            let scenario = ScenarioFile::read(path, &mut output::warning)?.scenario;
            self.warn_of_lost_worlds(&scenario);
            return output::write_or_print(&self.output, &scenario.to_json_pretty());
        }
        output::write_or_print(
            &self.output,
            &self.choice.world(&|text| output::warning(text))?.to_json_pretty(),
        )
    }

    /// Warns about world files whose relative paths do not resolve from the output's folder.
    fn warn_of_lost_worlds(&self, scenario: &Scenario) {
        if self.output == Path::new("-") {
            return;
        }
        let folder = self.output.parent().unwrap_or(Path::new(""));
        let worlds = scenario.blocks.iter().flat_map(|block| &block.regimes);
        let worlds: BTreeSet<&str> = worlds.filter_map(|regime| regime.world.as_deref()).collect();
        for world in worlds.into_iter().filter(|world| !folder.join(world).is_file()) {
            output::note(format!(
                "warning: {}: names the world file {world:?}, which is missing; put it at that path relative \
                 to the scenario, or beside the scenario",
                self.output.shown()
            ));
        }
    }
}
