//! From variants in an order to learning and evaluation blocks. What the order is, is `similarity`'s; running it is in `run/`.

mod balanced;
mod choice;
mod drifting;
mod evaluation;
mod experts;
mod form;
mod hypothesis;
mod picked;
mod probe;
mod steps;
mod streams;
mod walk;

use std::collections::BTreeSet;

use driftworld_spec::{
    Block, BlockKind, BlockMix, MAX_EXPERIENCES, Phase, Regime, Scenario, ScenarioComplexity, ScenarioDifficulty,
    ScenarioForm, TaskLabel,
};

pub use choice::Choice;
pub use drifting::Drifting;
pub use evaluation::Evaluate;
pub use experts::{experts, experts_of};
pub use form::MAX_BLOCKS;
pub use hypothesis::{Control, arrange, control};
pub use picked::{Picked, distances};
pub use probe::{MAX_PROBED, probe, probe_named};
pub use steps::{MAX_STEPS, Steps, steps};
pub use streams::Split;

use crate::CurriculumError;
use streams::Streams;

/// The largest seed of a design.
pub const MAX_SEED: u64 = 1 << 52;

/// Experiences of a learning block where nobody says.
///
/// PPO on 64 × 64 colour pictures (`examples/python/ppo_find_objects.py`) earned four fifths of the planner's reward in
/// `find_objects#blue` after 115,000 and 137,000 decisions, which are 1,900 and 2,300 episodes.
pub const LEARN: u32 = 2500;

/// How blocks are made of variants.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The scenario's name.
    pub name: String,
    /// Experiences of each learning block; default [`LEARN`].
    pub learn: u32,
    /// Experiences of each variant in each evaluation block; default 50.
    pub evaluate: u32,
    /// When the agent is evaluated; default every time.
    pub evaluation: Evaluate,
    /// How learning blocks are arranged; by default the variants follow each other, and begin anew when there are more blocks.
    pub form: Option<ScenarioForm>,
    /// How many learning blocks, at most [`MAX_BLOCKS`]; by default as many as the form has of itself.
    pub blocks: Option<u32>,
    /// The number of the lifetime, which decides its worlds, and the order of the permuted form; default 0.
    pub lifetime: u64,
    /// All lifetimes are evaluated in the worlds of lifetime 0; default each in its own.
    pub fixed_evaluation: bool,
    /// Which worlds it is evaluated in; default those for what is reported.
    pub split: Split,
    /// Variants are learned in worlds of the same numbers, so that variants of one task share layouts; default not.
    pub paired_learning: bool,
    /// Variants that are evaluated and never learned; default none.
    pub held_out: Vec<Choice>,
    /// Learning blocks drift from each variant to the next; by default each block keeps to its variant.
    pub drifting: Option<Drifting>,
    /// Experiences of the first variant before deployment; default 0, which is no such block.
    pub pre_deployment: u32,
    /// Whether the learner is told which task it is in; default not.
    pub task_label: TaskLabel,
    /// How complex the scenario is, for its logs; default nothing.
    pub complexity: Option<ScenarioComplexity>,
    /// How hard its tasks are, for its logs; default nothing.
    pub difficulty: Option<ScenarioDifficulty>,
    /// What all seeds of the scenario follow from, at most [`MAX_SEED`]; default 0.
    pub seed: u64,
}

impl Default for Design {
    fn default() -> Self {
        Self {
            name: "curriculum".to_owned(),
            learn: LEARN,
            evaluate: 50,
            evaluation: Evaluate::Every,
            form: None,
            blocks: None,
            lifetime: 0,
            fixed_evaluation: false,
            split: Split::default(),
            paired_learning: false,
            held_out: Vec::new(),
            drifting: None,
            pre_deployment: 0,
            task_label: TaskLabel::None,
            complexity: None,
            difficulty: None,
            seed: 0,
        }
    }
}

/// Learning blocks of the variants in the order given, and evaluation blocks of all of them, seen and to come, between.
///
/// Learning, validation and test draw from seeds of their own, so no world is in two of them, and so does each lifetime. Every
/// evaluation of a variant draws the same worlds, so that before and after differ by the agent alone. Each variant is learned in
/// worlds of its own, behind those that it had, so that two designs of the same variants and counts have the same worlds in any
/// order.
///
/// # Errors
/// [`CurriculumError`] without variants, for counts out of 1..=10,000,000, for a seed above [`MAX_SEED`], for a form that the
/// variants or blocks do not fit, for an evaluation after a block that there is not, for a drift between tasks.
///
/// # Example
/// ```
/// use driftworld_curriculum::{Choice, Design, design};
/// let choice = |variant: &str| Choice::new("find_objects", variant);
/// let scenario = design(&[choice("blue"), choice("red")], &Design::default())?;
/// assert_eq!(scenario.blocks.len(), 5, "evaluate, blue, evaluate, red, evaluate");
/// # Ok::<(), driftworld_curriculum::CurriculumError>(())
/// ```
pub fn design(variants: &[Choice], options: &Design) -> Result<Scenario, CurriculumError> {
    arranged(variants, options, None)
}

/// A control of the design of the same variants and options: the same learning blocks in another order, after the same block
/// before deployment, between the same evaluations.
///
/// `order` says in which order the control meets the variants, by their places in `variants`. Every variant is learned as often
/// as in the design itself: where the blocks are no whole number of rounds, those that the design has once more are learned once
/// more here, before the first round, or after the last where one of them would else come twice in a row or the control would
/// be the design itself. The reversed order is the design backwards. Two variants in turn, an odd number of times, have one
/// order only.
///
/// # Errors
/// As [`design`]; [`CurriculumError::BadForm`] for the permuted form, which draws an order of its own, and for an `order` that
/// is none of the variants.
pub fn design_control(variants: &[Choice], order: &[usize], options: &Design) -> Result<Scenario, CurriculumError> {
    arranged(variants, options, Some(order))
}

/// Most regimes of a design. A document has no room for more: each has five values or more.
const MAX_REGIMES: usize = 400_000;

fn arranged(variants: &[Choice], options: &Design, control: Option<&[usize]>) -> Result<Scenario, CurriculumError> {
    check(variants, options)?;
    let streams = Streams::new(variants, options);
    let (path, lessons) = lessons(variants, options, control, &streams)?;
    let places = options.evaluation.places(lessons.len() as u32)?;
    let evaluated = variants.iter().chain(&options.held_out);
    let evaluation: Vec<Regime> = evaluated.map(|choice| streams.evaluation(choice)).collect();
    let regimes = lessons.iter().map(Vec::len).sum::<usize>() + places.len() * evaluation.len();
    if regimes > MAX_REGIMES {
        return Err(CurriculumError::bad_form(
            "chosen",
            variants.len(),
            options.blocks,
            format!("a scenario of at most {MAX_REGIMES} regimes, not {regimes}: fewer variants, or fewer evaluations"),
        ));
    }
    let before = before_deployment(&variants[path[0]], options, &streams);
    Ok(scenario(options, before, lessons, &places, evaluation))
}

/// The block before deployment, where there is one.
fn before_deployment(first: &Choice, options: &Design, streams: &Streams) -> Option<Block> {
    (options.pre_deployment > 0).then(|| Block {
        phase: Phase::PreDeployment,
        ..Block::new(BlockKind::Learning, vec![streams.before_deployment(first)])
    })
}

/// Blocks in their order: what is learned, and an evaluation after so many learning blocks each.
fn scenario(
    options: &Design,
    before: Option<Block>,
    lessons: Vec<Vec<Regime>>,
    places: &BTreeSet<u32>,
    evaluation: Vec<Regime>,
) -> Scenario {
    let mut blocks: Vec<Block> = before.into_iter().collect();
    let last = lessons.len() as u32;
    for (place, regimes) in (0..).zip(lessons) {
        if places.contains(&place) {
            blocks.push(Block::new(BlockKind::Evaluation, evaluation.clone()));
        }
        blocks.push(Block {
            mix: if options.form == Some(ScenarioForm::Joint) {
                BlockMix::Shuffled
            } else {
                BlockMix::InOrder
            },
            ..Block::new(BlockKind::Learning, regimes)
        });
    }
    if places.contains(&last) {
        blocks.push(Block::new(BlockKind::Evaluation, evaluation));
    }
    Scenario {
        form: options.form,
        complexity: options.complexity,
        difficulty: options.difficulty,
        task_label: options.task_label,
        ..Scenario::new(&options.name, blocks)
    }
}

fn check(variants: &[Choice], options: &Design) -> Result<(), CurriculumError> {
    if variants.is_empty() {
        return Err(CurriculumError::NoVariants);
    }
    if options.form == Some(ScenarioForm::Joint) && options.drifting.is_some() {
        return Err(CurriculumError::bad_form(
            "joint",
            variants.len(),
            options.blocks,
            "no drift: all variants are learned at once",
        ));
    }
    if let Some(both) = options.held_out.iter().find(|choice| variants.contains(choice)) {
        return Err(CurriculumError::HeldOut(both.id()));
    }
    let before = options.pre_deployment.max(1);
    for (kind, found) in [
        ("learning", options.learn),
        ("evaluation", options.evaluate),
        ("pre-deployment", before),
    ] {
        if !(1..=MAX_EXPERIENCES).contains(&found) {
            return Err(CurriculumError::BadCount { kind, found });
        }
    }
    if options.seed > MAX_SEED {
        return Err(CurriculumError::BadSeed(options.seed));
    }
    Ok(())
}

/// The variants of the learning blocks in their order, and the regimes of each block.
///
/// In a control the variants are still those of the design itself, whose first is learned before deployment.
fn lessons(
    variants: &[Choice],
    options: &Design,
    control: Option<&[usize]>,
    streams: &Streams,
) -> Result<(Vec<usize>, Vec<Vec<Regime>>), CurriculumError> {
    let drawn = (options.seed, options.lifetime);
    let own = |path: &[usize]| match control {
        Some(order) => form::reordered(options.form, path, order, variants.len()),
        None => Ok(path.to_vec()),
    };
    let Some(drifting) = options.drifting else {
        let path = form::sequence(options.form, variants.len(), options.blocks, drawn)?;
        let mut taken = vec![0; variants.len()];
        let lesson = |variant: &usize| {
            let regime = streams.learning(&variants[*variant], options.learn, taken[*variant]);
            taken[*variant] += u64::from(options.learn);
            vec![regime]
        };
        let mut lessons: Vec<Vec<Regime>> = own(&path)?.iter().map(lesson).collect();
        if options.form == Some(ScenarioForm::Joint) {
            lessons = vec![lessons.into_iter().flatten().collect()];
        }
        return Ok((path, lessons));
    };
    // The form says which variants the drift leads through; how many blocks it is shared out among is said by `blocks`.
    let path = form::sequence(options.form, variants.len(), None, drawn)?;
    if path.len() < 2 {
        return Err(CurriculumError::NoWay);
    }
    let num_blocks = options.blocks.unwrap_or(path.len() as u32 - 1);
    if !(1..=MAX_BLOCKS).contains(&num_blocks) {
        return Err(CurriculumError::BadBlocks(num_blocks));
    }
    let lessons = drifting::lessons(
        variants,
        &own(&path)?,
        u64::from(num_blocks),
        (options.learn, streams),
        drifting,
    )?;
    Ok((path, lessons))
}

#[cfg(test)]
mod tests;
