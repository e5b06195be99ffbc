//! `driftworld curriculum`: learning and evaluation blocks of variants in the order of their distances. The design is the
//! library's; what is said of it is in `tables.rs`.

mod tables;

use std::path::{Path, PathBuf};

use crate::curriculum::{Design, Drifting, Evaluate};
use crate::design::{
    self, DEFAULT_STEPS, DEFAULT_TOLERANCE, DesignOrder, DesignRequest, Designed, MAX_LIFETIMES, MAX_TRIED,
};
use crate::spec::{
    DriftSchedule, DriftSwitch, Element, Scenario, ScenarioComplexity, ScenarioDifficulty, ScenarioForm, TaskLabel,
    sound_name,
};
use clap::{Args, ValueEnum};
use driftworld_text::ShownPath;

use super::assets::LibraryChoice;
use super::order::OrderArgs;
use super::{Failure, output, overwrite};
pub(crate) use tables::{blocks, choices};

/// Design learning and evaluation blocks from variants and their distances.
///
/// By default the variants named are learned one after the other, from the one that is named first, in the order that --method finds; of
/// one task named whole, whichever variant is best comes first. --order named keeps the order in which they are named. --probe takes, and
/// where the task declares too few makes, variants that differ in one element of the decision process only, and prints the proof; of several
/// variants named, each must be such a one. --step-distance makes a sequence of even steps; --form arranges the blocks as lifelong learning
/// knows them.
///
/// A few worlds of everything are drawn before a scenario is written, and every variant on the way of a drift is looked at: what could not be
/// run is refused.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld curriculum find_objects --start find_objects#blue -o scenario.json
  driftworld curriculum find_objects --probe reward --order gradual --controls controls -o reward.json --plot reward.png
  driftworld curriculum find_objects#blue --probe observation --step-distance 0.1 --steps 5 -o steps.json
  driftworld curriculum find_objects#blue find_objects#dusk --form alternating --blocks 6 --drift cosine -o drift.json
  driftworld curriculum find_objects --form expert -o experts
  driftworld run scenario.json --agent random --logs log")]
pub(crate) struct Curriculum {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required = true, value_name = "TASK")]
    tasks: Vec<String>,
    #[command(flatten)]
    ordering: OrderArgs,
    /// Probe one element: variants that differ from the start in it and in nothing else. state, action, transition, reward or
    /// observation.
    #[arg(long, value_parser = design::element, value_name = "ELEMENT")]
    probe: Option<Element>,
    /// How many variants the probe takes; all that are declared, and at least 4, if not said.
    #[arg(long, requires = "probe", conflicts_with = "step_distance", value_name = "N")]
    variants: Option<usize>,
    /// The order of the variants, from --start on.
    #[arg(long, value_enum, conflicts_with_all = ["method", "step_distance", "end"])]
    order: Option<Order>,
    /// Make a sequence of variants of which each is this far from the one before: in the probed element, or in all.
    #[arg(long, value_name = "DISTANCE", conflicts_with_all = ["method", "end"])]
    step_distance: Option<f64>,
    /// How far off each step may be.
    #[arg(long, requires = "step_distance", default_value_t = DEFAULT_TOLERANCE)]
    tolerance: f64,
    /// How many steps: one fewer than variants.
    #[arg(long, requires = "step_distance", default_value_t = DEFAULT_STEPS, value_name = "N")]
    steps: u32,
    /// How learning blocks are arranged; the variants one after the other, beginning anew when there are more blocks, if not said.
    #[arg(long, value_enum)]
    form: Option<Form>,
    /// How many learning blocks; as many as the form has of itself if not said.
    #[arg(long, value_name = "N")]
    blocks: Option<u32>,
    /// Write so many lifetimes of the permuted form, each in an order of its own, into the folder --output.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_LIFETIMES))]
    lifetimes: Option<u64>,
    /// Learning blocks drift from each variant to the next: linear, cosine, step:N or sawtooth:N. With --blocks the whole way is
    /// shared out among so many blocks, across their borders.
    #[arg(long, value_parser = design::schedule, value_name = "SCHEDULE")]
    drift: Option<DriftSchedule>,
    /// Values with nothing in between switch by chance, more likely as the drift goes on, not at a point.
    #[arg(long, requires = "drift")]
    mix: bool,
    /// The scenario's name.
    #[arg(long, default_value = "curriculum", value_parser = name)]
    name: String,
    /// Experiences of each learning block.
    #[arg(long, default_value_t = 20, value_name = "N")]
    learn: u32,
    /// Experiences of the first variant in a block before deployment.
    #[arg(long, default_value_t = 0, value_name = "N")]
    pre_deployment: u32,
    /// Experiences of each variant in each evaluation block.
    #[arg(long, visible_alias = "evaluate-with", default_value_t = 5, value_name = "N")]
    eval_episodes: u32,
    /// When the agent is evaluated, frozen, in all variants, seen and to come.
    #[arg(long, value_enum, default_value_t = When::Every)]
    evaluate: When,
    /// Evaluate after so many learning blocks each instead; 0 is before the first.
    #[arg(long, value_delimiter = ',', value_name = "N,…", conflicts_with = "evaluate")]
    evaluate_after: Option<Vec<u32>>,
    /// Whether the learner is told which task it is in.
    #[arg(long, value_enum, default_value_t = Label::None)]
    task_label: Label,
    /// How complex the scenario is, in l2logger's words, for its logs.
    #[arg(long, value_enum)]
    complexity: Option<Complexity>,
    /// How hard its tasks are, in l2logger's words, for its logs.
    #[arg(long, value_enum)]
    difficulty: Option<Difficulty>,
    /// What all worlds of the scenario follow from; evaluation and learning never share one.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Draw so many worlds of each regime first, and refuse to write what cannot be drawn; 0 writes it unseen.
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(MAX_TRIED)))]
    worlds: u32,
    #[command(flatten)]
    libraries: LibraryChoice,
    /// Write the controls into this folder: the same variants, worlds and counts in reversed, random and contrasting order,
    /// after the same block before deployment.
    #[arg(long, value_name = "DIR", conflicts_with = "lifetimes")]
    controls: Option<PathBuf>,
    /// Draw the blocks over the experiences into this PNG file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// The scenario file, or - for standard output; a folder where there are several scenarios.
    #[arg(short, long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
}

/// When the agent is evaluated.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum When {
    /// Before the first learning block and after each.
    Every,
    /// Before the first and after the last.
    Ends,
}

/// The order of the variants.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Order {
    /// By growing distance from the first: the unlike come last.
    Gradual,
    /// The longest path from the first: neighbours as unlike as can be.
    Abrupt,
    /// The shortest path from the first: neighbours as alike as can be.
    Path,
    /// Each time what is farthest from everything met so far.
    Farthest,
    /// As they are named, whatever their distances.
    Named,
}

/// How learning blocks are arranged.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Each variant once, in one long block.
    Condensed,
    /// Each variant again and again, in several short blocks: 3 if --blocks does not say.
    Dispersed,
    /// Each variant once, in an order drawn by chance: another in each of --lifetimes.
    Permuted,
    /// Two variants in turn, 3 times each if --blocks does not say.
    Alternating,
    /// Single-task experts: a scenario for every variant, in which it alone is learned.
    Expert,
    /// One after the other, and anew when there are more blocks.
    Custom,
}

/// How complex a scenario is, in l2logger's words.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Complexity {
    #[value(name = "1-low")]
    Low,
    #[value(name = "2-intermediate")]
    Intermediate,
    #[value(name = "3-high")]
    High,
}

/// How hard its tasks are, in l2logger's words.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Difficulty {
    #[value(name = "1-easy")]
    Easy,
    #[value(name = "2-medium")]
    Medium,
    #[value(name = "3-hard")]
    Hard,
}

/// Whether the learner is told which task it is in.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Label {
    /// It is not.
    None,
    /// Beside its observations.
    Info,
    /// As part of its observations.
    Observation,
}

impl Curriculum {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let request = self.request();
        request.check()?;
        let to_stdout = self.output.as_os_str() == "-";
        if request.is_of_several() && to_stdout {
            return Err(Failure::usage(
                "several scenarios are written: name a folder with --output",
            ));
        }
        if request.is_of_several() && self.plot.is_some() {
            return Err(Failure::usage(
                "--plot is of one scenario: leave it out, or --lifetimes and --form expert",
            ));
        }
        let targets = [Some(&self.output), self.plot.as_ref()];
        for target in targets.into_iter().flatten() {
            overwrite::refuse_inputs(target, self.tasks.iter().map(String::as_str))?;
        }
        let designed = design::design(&request)?;
        let evidence = designed.chosen.evidence.as_ref();
        // What is printed beside a scenario on standard output would spoil it.
        let say = |text: String| {
            if to_stdout {
                output::note(text);
                return Ok(());
            }
            output::line(text)
        };
        if let Some(evidence) = evidence {
            say(tables::evidence(evidence, &designed.chosen.order)?)?;
        }
        if request.is_of_several() {
            for scenario in &designed.scenarios {
                let path = write_into(&self.output, scenario)?;
                output::line(format!("{}: {}", path.shown(), tables::learned(scenario)))?;
            }
            return Ok(());
        }
        self.write_one(&designed, say)
    }

    /// Writes one scenario, its picture and its controls.
    fn write_one(&self, designed: &Designed, say: impl Fn(String) -> Result<(), Failure>) -> Result<(), Failure> {
        let matrix = &designed.chosen.matrix;
        for scenario in &designed.scenarios {
            output::write_or_print(&self.output, &scenario.to_json_pretty())?;
            if self.output.as_os_str() != "-" {
                output::line(blocks(scenario, Some(matrix)))?;
            }
        }
        if let Some(path) = &self.plot {
            designed.write_plot(path)?;
        }
        let folder = self.controls.iter();
        for (folder, scenario) in folder.flat_map(|folder| designed.controls.iter().map(move |one| (folder, one))) {
            let path = write_into(folder, scenario)?;
            say(format!("{}: {}", path.shown(), tables::path(scenario, matrix)))?;
        }
        Ok(())
    }

    fn request(&self) -> DesignRequest {
        let steps = self.step_distance.is_some();
        DesignRequest {
            tasks: self.tasks.clone(),
            ordering: self.ordering.request(),
            order: self.order.map(|order| match order {
                Order::Gradual => DesignOrder::Gradual,
                Order::Abrupt => DesignOrder::Abrupt,
                Order::Path => DesignOrder::Path,
                Order::Farthest => DesignOrder::Farthest,
                Order::Named => DesignOrder::Named,
            }),
            probe: self.probe,
            variants: self.variants,
            step_distance: self.step_distance,
            tolerance: steps.then_some(self.tolerance),
            steps: steps.then_some(self.steps),
            lifetimes: self.lifetimes,
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
            evaluation: match (&self.evaluate_after, self.evaluate) {
                (Some(places), _) => Evaluate::After(places.clone()),
                (None, When::Every) => Evaluate::Every,
                (None, When::Ends) => Evaluate::Ends,
            },
            form: self.form.map(|form| match form {
                Form::Condensed => ScenarioForm::Condensed,
                Form::Dispersed => ScenarioForm::Dispersed,
                Form::Permuted => ScenarioForm::Permuted,
                Form::Alternating => ScenarioForm::Alternating,
                Form::Expert => ScenarioForm::Expert,
                Form::Custom => ScenarioForm::Custom,
            }),
            blocks: self.blocks,
            lifetime: 0,
            drifting: self.drift.map(|schedule| Drifting {
                schedule,
                switch: if self.mix {
                    DriftSwitch::Mixture
                } else {
                    DriftSwitch::AtPoint
                },
            }),
            pre_deployment: self.pre_deployment,
            task_label: match self.task_label {
                Label::None => TaskLabel::None,
                Label::Info => TaskLabel::Info,
                Label::Observation => TaskLabel::Observation,
            },
            complexity: self.complexity.map(|complexity| match complexity {
                Complexity::Low => ScenarioComplexity::Low,
                Complexity::Intermediate => ScenarioComplexity::Intermediate,
                Complexity::High => ScenarioComplexity::High,
            }),
            difficulty: self.difficulty.map(|difficulty| match difficulty {
                Difficulty::Easy => ScenarioDifficulty::Easy,
                Difficulty::Medium => ScenarioDifficulty::Medium,
                Difficulty::Hard => ScenarioDifficulty::Hard,
            }),
            seed: self.seed,
        }
    }
}

/// Writes a scenario into a folder, in a file named after it.
fn write_into(folder: &Path, scenario: &Scenario) -> Result<PathBuf, Failure> {
    let path = folder.join(format!("{}.json", scenario.name));
    output::write(&path, scenario.to_json_pretty().as_bytes())?;
    Ok(path)
}

/// A name that a scenario may have.
fn name(text: &str) -> Result<String, String> {
    sound_name(text).map(|()| text.to_owned())
}
