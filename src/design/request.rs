//! [`DesignRequest`]: the options for designing a curriculum.

use std::path::PathBuf;

use clap::Args;
use driftworld_curriculum::{Choice, Design, Drifting, Evaluate, LEARN, Split};
use driftworld_env::Catalogue;
use driftworld_spec::{
    By, DriftSchedule, DriftSwitch, Element, Modality, ScenarioComplexity, ScenarioDifficulty, ScenarioForm, TaskLabel,
    Variant,
};
use serde::Deserialize;

use super::words::{self, Mix};
use crate::modality;
use crate::numbers::{self, documented};
use crate::ordering::OrderRequest;
use crate::{Failure, argument, libraries, request, within};

/// Maximum number of lifetimes per design.
pub const MAX_LIFETIMES: u64 = 10_000;

/// Maximum number of worlds per regime that are drawn as a check.
pub const MAX_TRIED: u32 = 1_000_000;

/// When the agent is evaluated.
const EVALUATIONS: [&str; 2] = [
    "every: Before the first learning block and after each",
    "ends: Before the first learning block and after the last",
];

/// Forms: arrangements of learning blocks.
const FORMS: [&str; 7] = [
    "condensed: Each variant once, in one long block",
    "dispersed: Each variant repeatedly, in short blocks (3, or as many as --blocks allows)",
    "permuted: Each variant once, in random order. Each of --lifetimes has a different order",
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

/// The options for designing a curriculum: the arguments of `driftworld curriculum` and of Python's `Curriculum.design`.
#[derive(Args, Clone, Debug, Deserialize)]
#[group(skip)]
#[serde(default, deny_unknown_fields)]
#[expect(clippy::struct_excessive_bools, reason = "each is an option")]
pub struct DesignRequest {
    /// Variants, or tasks, which stand for all their variants.
    #[arg(required = true, value_name = "TASK")]
    pub tasks: Vec<String>,
    /// How the variants are ordered.
    #[command(flatten)]
    #[serde(skip)]
    pub ordering: OrderRequest,
    /// Vary one element only: state, action, transition, reward or observation.
    ///
    /// All variants differ from the start in this element and in nothing else.
    #[arg(long, value_parser = words::element, value_name = "ELEMENT")]
    #[serde(deserialize_with = "words::probe")]
    pub probe: Option<Element>,
    /// Images of the learner for which the probe is designed [default: those of the task's worlds].
    #[arg(long, requires = "probe", value_parser = documented::<Modality>(&modality::NAMES), value_delimiter = ',', value_name = "KIND,…")]
    pub modalities: Option<Vec<Modality>>,
    /// Number of variants in the probe [default: all declared, and at least 4].
    #[arg(long, value_name = "N")]
    pub variants: Option<usize>,
    /// What to compare the variants by: parameters, worlds, rewards, and so on, as for `driftworld distance`.
    ///
    /// The default is what their task declares (parameters if it declares nothing), and worlds for variants of several
    /// tasks. --probe and --step-distance always measure by parameters.
    #[arg(long, value_parser = By::from_name, value_name = "MEASURE")]
    #[serde(deserialize_with = "words::by")]
    pub by: Option<By>,
    /// Create a sequence of variants, each this far from the previous one.
    ///
    /// The distance is measured in the probed element, or else in all.
    #[arg(long, value_name = "DISTANCE")]
    pub step_distance: Option<f64>,
    /// How far each step may be from that distance [default: 0.001].
    #[arg(long)]
    pub tolerance: Option<f64>,
    /// Number of steps, one fewer than variants [default: 4].
    #[arg(long, value_name = "N")]
    pub steps: Option<u32>,
    /// Arrangement of the learning blocks [default: one variant after the other; permuted for several lifetimes].
    ///
    /// If there are more blocks than variants, the sequence starts over.
    #[arg(long, value_parser = documented::<ScenarioForm>(&FORMS))]
    pub form: Option<ScenarioForm>,
    /// Number of learning blocks [default: set by the form].
    #[arg(long, value_name = "N")]
    pub blocks: Option<u32>,
    /// Write this many lifetimes into the folder --output, each with worlds and an order of its own.
    ///
    /// Their orders are the rows of a balanced Latin square (--form permuted): each variant is equally often in each
    /// place and after each other variant. If an order, blocks or a drift is given, all lifetimes use it.
    #[arg(long, value_name = "N")]
    pub lifetimes: Option<u64>,
    /// Evaluate all lifetimes on the same worlds.
    #[arg(long, requires = "lifetimes")]
    pub fixed_evaluation: bool,
    /// Evaluate these variants, or tasks, too, but never learn them.
    #[arg(long, num_args = 1.., value_name = "VARIANT")]
    pub hold_out: Vec<String>,
    /// Drift from each variant to the next: linear, cosine, step:N or sawtooth:N.
    ///
    /// With --blocks, the whole drift is divided among that many blocks.
    #[arg(long, value_parser = words::schedule, value_name = "SCHEDULE")]
    #[serde(deserialize_with = "words::drift")]
    pub drift: Option<DriftSchedule>,
    /// Switch at random, not at a fixed point: each value that cannot be interpolated, or the whole variant with `task`.
    ///
    /// The switch becomes more likely as the drift proceeds. With `task`, each experience is of one of the two
    /// variants, which may belong to different tasks.
    #[arg(long, requires = "drift", num_args = 0..=1, require_equals = true, default_missing_value = "parameter", value_name = "WHAT")]
    #[serde(deserialize_with = "words::mix")]
    pub mix: Option<Mix>,
    /// Name of the scenario.
    #[arg(long, default_value = "curriculum", value_parser = numbers::name)]
    #[serde(deserialize_with = "words::name")]
    pub name: String,
    /// Experiences per learning block.
    ///
    /// By default, as many as a PPO learner took to reach 80 % of the planner's reward in `find_objects`.
    #[arg(long, default_value_t = LEARN, value_name = "N")]
    pub learn: u32,
    /// Experiences of the first variant before deployment.
    #[arg(long, default_value_t = 0, value_name = "N")]
    pub pre_deployment: u32,
    /// Experiences per variant in each evaluation block.
    #[arg(long, visible_alias = "evaluate-with", default_value_t = 50, value_name = "N")]
    pub eval_episodes: u32,
    /// When to evaluate the frozen agent, on all variants.
    #[arg(long, value_parser = documented::<Evaluate>(&EVALUATIONS), default_value = "every")]
    pub evaluate: Evaluate,
    /// Evaluate after these numbers of learning blocks instead. 0 is before the first.
    #[arg(long, value_delimiter = ',', value_name = "N,…", conflicts_with = "evaluate")]
    pub evaluate_after: Option<Vec<u32>>,
    /// Whether the learner gets a task label.
    #[arg(long, value_parser = documented::<TaskLabel>(&LABELS), default_value = "none")]
    pub task_label: TaskLabel,
    /// Complexity of the scenario, as l2logger's logs state it.
    #[arg(long, value_parser = documented::<ScenarioComplexity>(&COMPLEXITIES))]
    pub complexity: Option<ScenarioComplexity>,
    /// Difficulty of its tasks, as l2logger's logs state it.
    #[arg(long, value_parser = documented::<ScenarioDifficulty>(&DIFFICULTIES))]
    pub difficulty: Option<ScenarioDifficulty>,
    /// Seed of all worlds, at most 2^52. Learning and evaluation never share a world.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = numbers::seed)]
    pub seed: u64,
    /// Which worlds to evaluate on: validation to choose hyperparameters, test for what you report.
    #[arg(long, value_parser = documented::<Split>(&SPLITS), default_value = "test")]
    pub split: Split,
    /// Learn the variants of a task in the same layouts, one by one.
    ///
    /// A learner can then use what it remembers of a layout, not of the task. By default, no two variants share a layout.
    #[arg(long)]
    pub paired_learning: bool,
    /// Draw this many worlds of each regime first, and fail if one cannot be drawn.
    ///
    /// 0 writes the scenario unchecked.
    #[arg(long, default_value_t = 5, value_name = "N")]
    pub worlds: u32,
    /// An asset library to search before the built-in assets. Repeatable.
    ///
    /// The last one given is searched first.
    #[arg(long = "assets", value_name = "LIBRARY")]
    #[serde(rename = "assets")]
    pub libraries: Vec<PathBuf>,
    /// The number of the lifetime, which determines its worlds, and the order in the permuted form.
    #[arg(skip)]
    pub lifetime: u64,
    /// Whether to design the reversed, random and contrasting orders of the same variants, too.
    #[arg(skip)]
    pub controls: bool,
    /// Whether to design single-task experts of each lifetime, too.
    #[arg(skip)]
    pub experts: bool,
}

impl Default for DesignRequest {
    fn default() -> Self {
        request::usual()
    }
}

impl DesignRequest {
    /// The request for the default curriculum of these variants or tasks.
    pub fn of<S: Into<String>>(tasks: impl IntoIterator<Item = S>) -> Self {
        Self {
            tasks: tasks.into_iter().map(Into::into).collect(),
            ..Self::default()
        }
    }

    /// The form; by default the permuted one for several lifetimes, unless another option determines the order.
    pub(super) fn form(&self) -> Option<ScenarioForm> {
        let is_drawn =
            self.lifetimes.is_some() && self.blocks.is_none() && self.drift.is_none() && self.order_given().is_none();
        self.form.or(is_drawn.then_some(ScenarioForm::Permuted))
    }

    /// Whether there are several scenarios, each in its own file.
    pub fn is_of_several(&self) -> bool {
        self.form() == Some(ScenarioForm::Expert) || self.lifetimes.is_some()
    }

    /// The blocks, and the variants that are held out.
    pub(super) fn design(&self) -> Result<Design, Failure> {
        let held_out = self.held_out()?;
        let choice = |(task, variant): &(String, Variant)| Choice::new(task, variant.name());
        let after = self.evaluate_after.clone().map(Evaluate::After);
        let switch = match self.mix {
            None => DriftSwitch::AtPoint,
            Some(Mix::Parameter) => DriftSwitch::Mixture,
            Some(Mix::Task) => DriftSwitch::Task,
        };
        Ok(Design {
            name: self.name.clone(),
            learn: self.learn,
            evaluate: self.eval_episodes,
            evaluation: after.unwrap_or_else(|| self.evaluate.clone()),
            form: self.form(),
            blocks: self.blocks,
            lifetime: self.lifetime,
            fixed_evaluation: self.fixed_evaluation,
            split: self.split,
            paired_learning: self.paired_learning,
            held_out: held_out.iter().map(choice).collect(),
            drifting: self.drift.map(|schedule| Drifting { schedule, switch }),
            pre_deployment: self.pre_deployment,
            task_label: self.task_label,
            complexity: self.complexity,
            difficulty: self.difficulty,
            seed: self.seed,
        })
    }

    pub(super) fn catalogue(&self) -> Result<Catalogue, Failure> {
        libraries::catalogue(&self.libraries)
    }

    /// Refuses contradictory options; [`design`](super::design) calls it first.
    ///
    /// # Errors
    /// [`Failure`] if options contradict each other.
    pub fn check(&self) -> Result<(), Failure> {
        let given = [
            ("variants", self.variants.is_some()),
            ("modalities", self.modalities.is_some()),
            ("probe", self.probe.is_some()),
            ("order", self.ordering.purpose().is_some()),
            ("by", self.by.is_some()),
            ("method", self.ordering.own_method().is_some()),
            ("end", self.ordering.end.is_some()),
            ("step_distance", self.step_distance.is_some()),
            ("tolerance", self.tolerance.is_some()),
            ("steps", self.steps.is_some()),
            ("lifetimes", self.lifetimes.is_some()),
            ("controls", self.controls),
            ("mix", self.mix.is_some()),
            ("drift", self.drift.is_some()),
            // By default, every block is evaluated.
            ("evaluate", self.evaluate != Evaluate::Every),
            ("evaluate_after", self.evaluate_after.is_some()),
        ];
        let is_given = |name: &str| given.iter().any(|(known, is_given)| *known == name && *is_given);
        for (one, needed) in [
            ("variants", "probe"),
            ("modalities", "probe"),
            ("tolerance", "step_distance"),
            ("steps", "step_distance"),
            ("mix", "drift"),
        ] {
            if is_given(one) && !is_given(needed) {
                let (one, needed) = (argument(one), argument(needed));
                return Err(Failure::usage(format!("{one}: found without {needed}, expected both")));
            }
        }
        for (one, other) in [
            ("variants", "step_distance"),
            ("order", "method"),
            ("order", "step_distance"),
            ("order", "end"),
            ("by", "probe"),
            ("by", "step_distance"),
            ("step_distance", "method"),
            ("step_distance", "end"),
            ("controls", "lifetimes"),
            ("evaluate_after", "evaluate"),
        ] {
            if is_given(one) && is_given(other) {
                let (one, other) = (argument(one), argument(other));
                return Err(Failure::usage(format!(
                    "{one}: found together with {other}, expected only one of the two"
                )));
            }
        }
        within("lifetimes", self.lifetimes.unwrap_or(1), 1..=MAX_LIFETIMES)?;
        within("worlds", self.worlds.into(), 0..=MAX_TRIED.into())?;
        let [lifetimes, form, controls, drift, experts] =
            ["lifetimes", "form", "controls", "drift", "experts"].map(argument);
        if self.form() == Some(ScenarioForm::Expert) {
            let several = [(self.lifetimes.is_some(), &lifetimes), (self.experts, &experts)];
            if let Some((_, other)) = several.iter().find(|(is_given, _)| *is_given) {
                return Err(Failure::usage(format!(
                    "{other}: found with {form} expert, which has no lifetime, expected the form of a lifetime; leave \
                     {form} out, and {experts} writes the experts of each lifetime"
                )));
            }
        }
        if self.is_of_several() && self.controls {
            return Err(Failure::usage(format!(
                "{controls}: found with several scenarios, expected one; leave out {controls}, or {lifetimes} and \
                 {form} expert"
            )));
        }
        if self.form() == Some(ScenarioForm::Permuted) && self.controls {
            return Err(Failure::usage(format!(
                "{controls}: found with {form} permuted, which has a random order, expected an order that was chosen; \
                 leave one of them out ({lifetimes} of the permuted form control each other)"
            )));
        }
        self.check_permuted()?;
        if self.form() == Some(ScenarioForm::Expert) && self.drift.is_some() {
            return Err(Failure::usage(format!(
                "{drift}: found with {form} expert, which learns one variant alone; leave {drift} out"
            )));
        }
        Ok(())
    }

    /// Refuses an explicit order together with the permuted form, whose order is random.
    fn check_permuted(&self) -> Result<(), Failure> {
        match self
            .order_given()
            .filter(|_| self.form() == Some(ScenarioForm::Permuted))
        {
            None => Ok(()),
            Some(name) => Err(Failure::usage(format!(
                "{}: found with {} permuted, whose order is drawn at random, expected one of the two",
                argument(name),
                argument("form")
            ))),
        }
    }

    /// The name of the first given option that determines the order.
    fn order_given(&self) -> Option<&'static str> {
        // The start of a probe or of steps is the variant that is varied; it does not determine the order.
        let is_varied = self.probe.is_some() || self.step_distance.is_some();
        let ordered = [
            ("order", self.ordering.purpose().is_some()),
            ("method", self.ordering.own_method().is_some()),
            ("end", self.ordering.end.is_some()),
            ("target_step", self.ordering.target_step.is_some()),
            ("start", self.ordering.start.is_some() && !is_varied),
        ];
        ordered.iter().find(|(_, is_given)| *is_given).map(|(name, _)| *name)
    }
}
