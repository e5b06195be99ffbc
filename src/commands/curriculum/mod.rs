//! `driftworld curriculum`: arranges variants, ordered by their distances, into learning and evaluation blocks.

mod folders;
mod tables;

use std::path::PathBuf;

use crate::curriculum::{Design, Drifting, Evaluate, LEARN, Split};
use crate::design::{self, DesignRequest, Designed};
use crate::distances::By;
use crate::modality;
use crate::spec::{
    DriftSchedule, DriftSwitch, Element, Modality, Scenario, ScenarioComplexity, ScenarioDifficulty, ScenarioForm,
    TaskLabel,
};
use clap::Args;
use serde_json::json;

use super::assets::LibraryChoice;
use super::order::OrderArgs;
use super::output;
use super::sample::Mix;
use crate::numbers::{self, documented};
use crate::{Failure, overwrite};
use folders::write_into;
use tables::blocks;
pub(crate) use tables::choices;

/// Design a curriculum from variants and their distances.
///
/// A scenario has learning blocks and evaluation blocks.
///
/// By default, the variants lie on the shortest path, and the first one given comes first. Given a whole task, the best first
/// variant is chosen. --order says another order, and --order named keeps the one given.
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
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct Curriculum {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required = true, value_name = "TASK")]
    tasks: Vec<String>,
    #[command(flatten)]
    ordering: OrderArgs,
    /// Vary one element only: state, action, transition, reward or observation.
    ///
    /// All variants differ from the start in this element and in nothing else.
    #[arg(long, value_parser = design::element, value_name = "ELEMENT")]
    probe: Option<Element>,
    /// Images of the learner that the probe is for [default: those of the task's worlds].
    #[arg(long, requires = "probe", value_parser = documented::<Modality>(&modality::NAMES), value_delimiter = ',', value_name = "KIND,…")]
    modalities: Option<Vec<Modality>>,
    /// Number of variants in the probe [default: all declared, and at least 4].
    #[arg(long, value_name = "N")]
    variants: Option<usize>,
    /// What to compare the variants by: parameters, worlds, rewards, and so on, as for `driftworld distance`.
    ///
    /// By default what their task declares, which is parameters where it says nothing; worlds for variants of several
    /// tasks. --probe and --step-distance always measure by parameters.
    #[arg(long, value_parser = By::from_name, value_name = "MEASURE")]
    by: Option<By>,
    /// Create a sequence of variants, each this far from the one before.
    ///
    /// The distance is measured in the probed element, or else in all.
    #[arg(long, value_name = "DISTANCE")]
    step_distance: Option<f64>,
    /// How far each step may be from that distance [default: 0.001].
    #[arg(long)]
    tolerance: Option<f64>,
    /// Number of steps, one fewer than variants [default: 4].
    #[arg(long, value_name = "N")]
    steps: Option<u32>,
    /// Arrangement of the learning blocks [default: one variant after the other; of several lifetimes: permuted].
    ///
    /// If there are more blocks than variants, the sequence starts over.
    #[arg(long, value_parser = documented::<ScenarioForm>(&FORMS))]
    form: Option<ScenarioForm>,
    /// Number of learning blocks [default: set by the form].
    #[arg(long, value_name = "N")]
    blocks: Option<u32>,
    /// Write this many lifetimes into the folder --output, each with worlds and an order of its own.
    ///
    /// Their orders are the rows of a balanced Latin square (--form permuted): each variant is equally often in each
    /// place and after each other variant. With an order, blocks or a drift, all have that one.
    #[arg(long, value_name = "N")]
    lifetimes: Option<u64>,
    /// Evaluate all lifetimes on the same worlds.
    #[arg(long, requires = "lifetimes")]
    fixed_evaluation: bool,
    /// Evaluate these variants, or tasks, too, and never learn them.
    #[arg(long, num_args = 1.., value_name = "VARIANT")]
    hold_out: Vec<String>,
    /// Drift from each variant to the next: linear, cosine, step:N or sawtooth:N.
    ///
    /// With --blocks, the whole drift is divided among that many blocks.
    #[arg(long, value_parser = design::schedule, value_name = "SCHEDULE")]
    drift: Option<DriftSchedule>,
    /// Switch at random, not at a fixed point: each value that cannot be interpolated, or the whole variant with `task`.
    ///
    /// The switch becomes more likely as the drift proceeds. With `task` each experience is of one of the two variants, which may
    /// be of two tasks.
    #[arg(long, requires = "drift", num_args = 0..=1, require_equals = true, default_missing_value = "parameter", value_name = "WHAT")]
    mix: Option<Mix>,
    /// Name of the scenario.
    #[arg(long, default_value = "curriculum", value_parser = numbers::name)]
    name: String,
    /// Experiences per learning block.
    ///
    /// By default, as many as a PPO learner took to reach 80 % of the planner's reward in `find_objects`.
    #[arg(long, default_value_t = LEARN, value_name = "N")]
    learn: u32,
    /// Experiences of the first variant before deployment.
    #[arg(long, default_value_t = 0, value_name = "N")]
    pre_deployment: u32,
    /// Experiences per variant in each evaluation block.
    #[arg(long, visible_alias = "evaluate-with", default_value_t = 50, value_name = "N")]
    eval_episodes: u32,
    /// When to evaluate the frozen agent, on all variants.
    #[arg(long, value_parser = documented::<Evaluate>(&EVALUATIONS), default_value = "every")]
    evaluate: Evaluate,
    /// Evaluate after these numbers of learning blocks instead. 0 is before the first.
    #[arg(long, value_delimiter = ',', value_name = "N,…", conflicts_with = "evaluate")]
    evaluate_after: Option<Vec<u32>>,
    /// Whether the learner gets a task label.
    #[arg(long, value_parser = documented::<TaskLabel>(&LABELS), default_value = "none")]
    task_label: TaskLabel,
    /// Complexity of the scenario, as l2logger's logs state it.
    #[arg(long, value_parser = documented::<ScenarioComplexity>(&COMPLEXITIES))]
    complexity: Option<ScenarioComplexity>,
    /// Difficulty of its tasks, as l2logger's logs state it.
    #[arg(long, value_parser = documented::<ScenarioDifficulty>(&DIFFICULTIES))]
    difficulty: Option<ScenarioDifficulty>,
    /// Seed of all worlds, at most 2^52. Learning and evaluation never share a world.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = numbers::seed)]
    seed: u64,
    /// Which worlds to evaluate on: validation to choose hyperparameters, test for what you report.
    #[arg(long, value_parser = documented::<Split>(&SPLITS), default_value = "test")]
    split: Split,
    /// Learn the variants of a task in the same layouts, one by one.
    ///
    /// A learner can then use what it remembers of a layout, not of the task. By default, no two variants share one.
    #[arg(long)]
    paired_learning: bool,
    /// Draw this many worlds of each regime first, and fail if one cannot be drawn.
    ///
    /// 0 writes the scenario unchecked.
    #[arg(long, default_value_t = 5, value_name = "N")]
    worlds: u32,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Also write control curricula into this folder.
    ///
    /// They have the same variants, worlds and counts in reversed, random and contrasting order, after the same
    /// pre-deployment block.
    #[arg(long, value_name = "DIR")]
    controls: Option<PathBuf>,
    /// Also write single-task experts of each lifetime into this folder.
    ///
    /// Each learns one variant, in the worlds and as long as the lifetime does, and is evaluated where the lifetime is.
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

/// When the agent is evaluated.
const EVALUATIONS: [&str; 2] = [
    "every: Before the first learning block and after each",
    "ends: Before the first learning block and after the last",
];

/// Forms: arrangements of learning blocks.
const FORMS: [&str; 7] = [
    "condensed: Each variant once, in one long block",
    "dispersed: Each variant repeatedly, in short blocks (3, or as many as --blocks allows)",
    "permuted: Each variant once, in random order. Each of --lifetimes has another order",
    "alternating: Two variants in turn, 3 times each unless --blocks is given",
    "expert: Single-task experts: one scenario per variant, which learns it alone",
    "joint: All variants in one block, shuffled: joint training, an upper bound for lifelong learners",
    "custom: One variant after the other, starting over if there are more blocks",
];

/// Whether the learner gets a task label.
const LABELS: [&str; 3] = [
    "none: No label",
    "info: Beside the observation, as info",
    "observation: As part of the observation",
];

/// Complexities of a scenario and difficulties of its tasks, in l2logger's words.
const COMPLEXITIES: [&str; 3] = ["1-low", "2-intermediate", "3-high"];
const DIFFICULTIES: [&str; 3] = ["1-easy", "2-medium", "3-hard"];

/// What the evaluation worlds are used for.
const SPLITS: [&str; 2] = [
    "validation: For choosing hyperparameters and agents",
    "test: For what you report",
];

impl Curriculum {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let request = self.request();
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
            overwrite::refuse_inputs(target, self.tasks.iter().map(String::as_str))?;
        }
        let designed = design::design(&request)?;
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
            for scenario in &designed.scenarios {
                output::wrote(&write_into(&self.output, scenario)?, tables::learned(scenario));
            }
        } else {
            self.write_one(&designed)?;
        }
        self.write_experts(&designed)?;
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
                output::line(blocks(scenario, Some((matrix, designed.chosen.by))))?;
            }
        }
        if let Some(path) = &self.plot {
            designed.write_plot(path)?;
            output::wrote(path, "");
        }
        let folder = self.controls.iter();
        for (folder, scenario) in folder.flat_map(|folder| designed.controls.iter().map(move |one| (folder, one))) {
            output::wrote(&write_into(folder, scenario)?, tables::path(scenario, matrix));
        }
        Ok(())
    }

    fn write_experts(&self, designed: &Designed) -> Result<(), Failure> {
        let Some(folder) = &self.experts else { return Ok(()) };
        for scenario in &designed.experts {
            output::wrote(&write_into(folder, scenario)?, tables::learned(scenario));
        }
        Ok(())
    }

    fn request(&self) -> DesignRequest {
        let (ordering, order) = self.ordering.design();
        DesignRequest {
            tasks: self.tasks.clone(),
            ordering,
            by: self.by,
            order,
            probe: self.probe,
            modalities: self.modalities.clone(),
            variants: self.variants,
            step_distance: self.step_distance,
            tolerance: self.tolerance,
            steps: self.steps,
            lifetimes: self.lifetimes,
            hold_out: self.hold_out.clone(),
            experts: self.experts.is_some(),
            controls: self.controls.is_some(),
            worlds: self.worlds,
            libraries: self.libraries.paths().to_vec(),
            design: self.design(),
        }
    }

    fn design(&self) -> Design {
        Design {
            name: self.name.clone(),
            learn: self.learn,
            evaluate: self.eval_episodes,
            evaluation: (self.evaluate_after.clone()).map_or_else(|| self.evaluate.clone(), Evaluate::After),
            form: self.form,
            blocks: self.blocks,
            lifetime: 0,
            fixed_evaluation: self.fixed_evaluation,
            split: self.split,
            paired_learning: self.paired_learning,
            // Held-out variants are named in the request.
            held_out: Vec::new(),
            drifting: self.drift.map(|schedule| Drifting {
                schedule,
                switch: match self.mix {
                    None => DriftSwitch::AtPoint,
                    Some(Mix::Parameter) => DriftSwitch::Mixture,
                    Some(Mix::Task) => DriftSwitch::Task,
                },
            }),
            pre_deployment: self.pre_deployment,
            task_label: self.task_label,
            complexity: self.complexity,
            difficulty: self.difficulty,
            seed: self.seed,
        }
    }
}
