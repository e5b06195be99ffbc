//! `driftworld curriculum`: arranges variants, ordered by their distances, into learning and evaluation blocks.

mod folders;
mod tables;

use std::path::PathBuf;

use crate::design::{self, DesignRequest, Designed};
use crate::spec::Scenario;
use clap::Args;
use serde_json::json;

use super::output;
use crate::{Failure, overwrite};
use folders::write_each;
use tables::blocks;
pub(crate) use tables::choices;

/// Design a curriculum from variants and their distances.
///
/// A scenario has learning blocks and evaluation blocks.
///
/// By default, the variants follow the shortest path, starting with the first one given, or with the best first variant
/// of a whole task. --order selects another order, and --order named keeps the one given.
///
/// --probe selects variants that differ in one element of the decision process only, creates more if too few are
/// declared, and prints the evidence. --step-distance creates a sequence of equal steps. --form arranges the blocks.
///
/// Before a scenario is written, a few worlds of every regime are drawn, and every variant along a drift is checked. A
/// scenario that could not run is not written.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld curriculum find_objects --start blue -o scenario.json
  driftworld curriculum find_objects --probe reward --order gradual --controls controls -o reward.json --plot reward.png
  driftworld curriculum find_objects#blue --probe observation --step-distance 0.1 --steps 5 -o steps.json
  driftworld curriculum find_objects#blue find_objects#dusk --form alternating --blocks 6 --drift cosine -o drift.json
  driftworld curriculum find_objects#blue find_objects#red --lifetimes 5 --experts experts -o lifetimes
  driftworld run scenario.json --agent random -o log")]
pub(crate) struct Curriculum {
    #[command(flatten)]
    request: DesignRequest,
    /// Also write control curricula into this folder.
    ///
    /// They have the same variants, worlds and counts in reversed, random and contrasting order, after the same
    /// pre-deployment block.
    #[arg(long, value_name = "DIR")]
    controls: Option<PathBuf>,
    /// Also write single-task experts of each lifetime into this folder.
    ///
    /// Each learns one variant, in the same worlds and for as long as the lifetime, and is evaluated at the same points.
    #[arg(long, value_name = "DIR")]
    experts: Option<PathBuf>,
    /// Replace the files of an earlier curriculum.
    #[arg(long)]
    force: bool,
    /// Draw the blocks over experiences into this PNG file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Scenario file, or - for standard output. A folder if there are several scenarios.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
    /// Print the variants in their order, and the distances between them, as JSON.
    #[arg(long)]
    json: bool,
}

/// The design as JSON: the variants in order, each with the distance from the one before it, and notes.
fn described(designed: &Designed) -> serde_json::Value {
    let chosen = &designed.chosen;
    let mut before = None;
    let variants = chosen.order.iter().map(|index| {
        let step = before
            .replace(*index)
            .map(|before: usize| chosen.matrix.get(before, *index));
        let choice = &chosen.variants[*index];
        json!({ "task": choice.task, "variant": choice.variant, "values": choice.values, "step": step })
    });
    let names = |scenarios: &[Scenario]| -> Vec<String> { scenarios.iter().map(|one| one.name.clone()).collect() };
    json!({
        "by": chosen.by, "variants": variants.collect::<Vec<_>>(), "notes": designed.notes,
        "scenarios": names(&designed.scenarios), "controls": names(&designed.controls), "experts": names(&designed.experts),
    })
}

impl Curriculum {
    pub(crate) fn run(mut self) -> Result<(), Failure> {
        self.request.controls = self.controls.is_some();
        self.request.experts = self.experts.is_some();
        let request = &self.request;
        request.check()?;
        let to_stdout = output::is_stdout(&self.output);
        if request.is_of_several() {
            folders::refuse_no_folder(&self.output)?;
        }
        for (option, folder) in [("--experts", &self.experts), ("--controls", &self.controls)] {
            folders::refuse_standard_output(option, folder.as_deref())?;
        }
        if request.is_of_several() && self.plot.is_some() {
            return Err(Failure::usage(
                "--plot: found with several scenarios, expected one; leave out --plot, or --lifetimes and --form \
                 expert",
            ));
        }
        let targets = [Some(&self.output), self.plot.as_ref()];
        for target in targets.into_iter().flatten() {
            overwrite::refuse_inputs(target, request.tasks.iter().map(String::as_str))?;
        }
        let designed = design::design(request)?;
        if !self.force {
            let several = request.is_of_several().then_some(&self.output);
            folders::refuse_existing(&[
                (several, &designed.scenarios),
                (self.controls.as_ref(), &designed.controls),
                (self.experts.as_ref(), &designed.experts),
            ])?;
            if !request.is_of_several() && self.output.is_file() {
                let advice = "name another with -o, or replace it with --force";
                return Err(overwrite::exists(&self.output, advice));
            }
        }
        let evidence = designed.chosen.evidence.as_ref();
        // Text on standard output would corrupt a scenario printed there.
        let say = |text: String| {
            if to_stdout || self.json {
                output::note(text);
                return Ok(());
            }
            output::line(text)
        };
        if let Some(evidence) = evidence {
            say(tables::evidence(evidence, &designed.chosen.order)?)?;
        }
        let optima = request.optima(&designed.chosen)?;
        if !optima.is_empty() {
            say(tables::optima(&optima))?;
        }
        for note in &designed.notes {
            output::note(format!("note: {note}"));
        }
        if request.is_of_several() {
            write_each(Some(&self.output), &designed.scenarios, tables::learned)?;
        } else {
            self.write_one(&designed)?;
        }
        write_each(self.experts.as_ref(), &designed.experts, tables::learned)?;
        if self.json && !to_stdout {
            return output::json(&described(&designed));
        }
        Ok(())
    }

    /// Writes one scenario, its picture and its controls.
    fn write_one(&self, designed: &Designed) -> Result<(), Failure> {
        let matrix = &designed.chosen.matrix;
        for scenario in &designed.scenarios {
            output::write_or_print(&self.output, &scenario.to_json_pretty())?;
            if !output::is_stdout(&self.output) && !self.json {
                output::line(blocks(scenario, Some((matrix, &designed.chosen.measure()))))?;
            }
        }
        if let Some(path) = &self.plot {
            designed.write_plot(path)?;
            output::wrote(path, "");
        }
        write_each(self.controls.as_ref(), &designed.controls, |scenario| {
            tables::path(scenario, matrix)
        })
    }
}
