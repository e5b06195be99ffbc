//! `driftworld convert`: a world or a scenario from one dialect to another. All are read and written by the spec.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::documents;
use crate::spec::{Scenario, World};
use clap::{Args, ValueEnum};
use driftworld_text::ShownPath;

use super::draw_maps::draw_maps;
use super::world_choice::WorldChoice;
use super::{Failure, output, overwrite};
use crate::scenarios::{Missing, ScenarioFile};

/// Convert worlds and scenarios from and to other formats.
///
/// Those are L2Explorer's format, for both, and maps of letters, for worlds.
///
/// Warnings on standard error name everything that the other format cannot express. L2Explorer's scenarios use map
/// files only, so the worlds that a scenario draws are written as maps into a folder beside the output.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld convert map.json --l2explorer -o world.json
  driftworld convert find_objects#red --seed 7 --to l2explorer -o reset.json
  driftworld convert scenario_findobjects.json -o scenario.json
  driftworld convert scenario.json --to l2explorer -o original/scenario.json
  driftworld convert level.txt --from dmlab-text -o world.json")]
pub(crate) struct Convert {
    #[command(flatten)]
    choice: WorldChoice,
    /// Read a map of letters: the world is the path of a text file.
    #[arg(long, value_enum, conflicts_with_all = ["seed", "index", "l2explorer", "maps"])]
    from: Option<Letters>,
    /// The format to write.
    #[arg(long, value_enum, default_value_t = Form::World)]
    to: Form,
    /// File to write, or - for standard output.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
}

/// A form of documents.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Driftworld's current format. `ours` for short.
    #[value(alias = "ours")]
    World,
    /// L2Explorer's format.
    L2explorer,
}

/// A map of letters.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Letters {
    /// The entity layer of a text level of DeepMind Lab.
    DmlabText,
    /// A grid of MiniGrid, two characters for each cell, as `env.unwrapped.pprint_grid()` gives it.
    MinigridText,
}

impl Letters {
    /// Reads the world, with warnings to standard error.
    fn world(self, path: &Path) -> Result<World, Failure> {
        let text = documents::text(path)?;
        let name = documents::name_of(path);
        let (world, warnings) = match self {
            Self::DmlabText => World::from_dmlab_text(&name, &text),
            Self::MinigridText => World::from_minigrid_text(&name, &text),
        }?;
        for warning in warnings {
            output::warning(warning.to_string());
        }
        Ok(world)
    }
}

impl Convert {
    pub(crate) fn run(self) -> Result<(), Failure> {
        self.convert()?;
        if self.json && !output::is_stdout(&self.output) {
            return output::json_of_what_was_written();
        }
        Ok(())
    }

    fn convert(&self) -> Result<(), Failure> {
        let path = Path::new(self.choice.name());
        overwrite::refuse_inputs(&self.output, [self.choice.name()])?;
        if self.from.is_none() && ScenarioFile::is_one(path) {
            return self.scenario(&ScenarioFile::read(path, &mut output::warning)?);
        }
        let world = match self.from {
            Some(letters) => letters.world(path)?,
            None => self.choice.world()?,
        };
        if self.to == Form::World {
            return output::write_or_print(&self.output, &world.to_json_pretty());
        }
        let (text, warnings) = world.to_l2explorer();
        for warning in warnings {
            output::warning(warning.to_string());
        }
        output::write_or_print(&self.output, &text)
    }

    /// Warns of the world files that the output names by paths that lead nowhere from its own folder.
    fn warn_of_lost_worlds(&self, scenario: &Scenario) {
        if self.output == Path::new("-") {
            return;
        }
        let folder = self.output.parent().unwrap_or(Path::new(""));
        let worlds = scenario.blocks.iter().flat_map(|block| &block.regimes);
        let worlds: BTreeSet<&str> = worlds.filter_map(|regime| regime.world.as_deref()).collect();
        for world in worlds.into_iter().filter(|world| !folder.join(world).is_file()) {
            output::note(format!(
                "warning: {}: names the world file {world:?}, which is missing; put it at that path from its folder, \
                 or beside it",
                self.output.shown()
            ));
        }
    }

    fn scenario(&self, file: &ScenarioFile) -> Result<(), Failure> {
        self.warn_of_lost_worlds(&file.scenario);
        if self.to == Form::World {
            return output::write_or_print(&self.output, &file.scenario.to_json_pretty());
        }
        let mut scenario = file.scenario.clone();
        let draws = |scenario: &Scenario| {
            let mut regimes = scenario.blocks.iter().flat_map(|block| &block.regimes);
            regimes.any(|regime| regime.world.is_none())
        };
        if draws(&scenario) {
            draw_maps(
                &mut scenario,
                &file.plan(Missing::Refused, &mut output::warning)?,
                &self.output,
            )?;
        }
        let (text, warnings) = scenario.to_l2explorer()?;
        for warning in warnings {
            output::warning(warning.to_string());
        }
        output::write_or_print(&self.output, &text)
    }
}
