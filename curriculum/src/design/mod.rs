//! Arranges ordered variants into learning and evaluation blocks.

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
pub(crate) mod wanted;

use std::collections::BTreeSet;

use driftworld_spec::{
    Block, BlockKind, BlockMix, MAX_EXPERIENCES, Phase, Regime, Scenario, ScenarioComplexity, ScenarioDifficulty,
    ScenarioForm, TaskLabel,
};

pub use choice::Choice;
pub use drifting::Drifting;
pub use evaluation::Evaluate;
pub use experts::{experts, experts_of};
pub use hypothesis::{Control, arrange, control};
pub use picked::{Picked, distances};
pub use probe::{probe, probe_named};
pub use steps::steps;
pub use streams::Split;
pub use wanted::{MAX_BLOCKS, MAX_PROBED, MAX_SEED, MAX_STEPS, Steps};

use crate::CurriculumError;
use streams::Streams;

/// Default number of experiences in a learning block.
///
/// PPO on 64 × 64 colour images (`examples/python/ppo_find_objects.py`) reached four fifths of the planner's reward in
/// `find_objects#blue` after 115,000 and 137,000 decisions, which are 1,900 and 2,300 episodes.
pub const LEARN: u32 = 2500;

/// Options for arranging variants into blocks.
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
    /// The arrangement of learning blocks; by default the variants follow each other, and repeat if there are more blocks.
    pub form: Option<ScenarioForm>,
    /// Number of learning blocks, at most [`MAX_BLOCKS`]; by default the form's own.
    pub blocks: Option<u32>,
    /// The number of the lifetime, which determines its worlds, and the order in the permuted form; default 0.
    pub lifetime: u64,
    /// All lifetimes are evaluated in the worlds of lifetime 0; by default each in its own.
    pub fixed_evaluation: bool,
    /// The split of the evaluation worlds; default test.
    pub split: Split,
    /// All variants are learned in worlds with the same numbers, so that variants of one task share layouts; default false.
    pub paired_learning: bool,
    /// Variants that are evaluated but never learned; default none.
    pub held_out: Vec<Choice>,
    /// Learning blocks drift from each variant to the next; by default each block stays with its variant.
    pub drifting: Option<Drifting>,
    /// Experiences of the first variant before deployment; default 0, which adds no such block.
    pub pre_deployment: u32,
    /// Whether the learner gets a task label; default no.
    pub task_label: TaskLabel,
    /// Complexity of the scenario, for its logs; default none.
    pub complexity: Option<ScenarioComplexity>,
    /// Difficulty of its tasks, for its logs; default none.
    pub difficulty: Option<ScenarioDifficulty>,
    /// The seed from which all seeds of the scenario derive, at most [`MAX_SEED`]; default 0.
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

/// Learning blocks of the variants in the given order, with evaluation blocks of all variants, learned or not, between them.
///
/// Learning, validation and test use different seeds, so they have no world in common; the same holds for different lifetimes.
/// Every evaluation of a variant uses the same worlds, so differences between evaluations are due to the agent alone. Each
/// variant is learned in its own worlds, each used once, so two designs of the same variants and counts have the same worlds in
/// any order.
///
/// # Errors
/// [`CurriculumError`] without variants, for counts outside 1..=10,000,000, for a seed above [`MAX_SEED`], for a form that does
/// not fit the variants or blocks, for an evaluation after a block that does not exist, and for a drift between tasks.
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
    build(variants, options, None)
}

/// A control for the design of the same variants and options: the same learning blocks in a different order, after the same
/// pre-deployment block, between the same evaluations.
///
/// `order` is the control's order of the variants, by their indices in `variants`. Every variant is learned as often as in the
/// design itself: if the blocks do not make a whole number of rounds, variants learned an extra time in the design are
/// learned an extra time here, before the first round, or after the last if one of them would otherwise occur twice in
/// a row or the control would equal the design. The reversed order gives the design backwards. Two variants that alternate
/// over an odd number of blocks have only one order.
///
/// # Errors
/// Those of [`design`]; [`CurriculumError::BadForm`] for the permuted form, which draws its own order, and for an `order`
/// that is not a permutation of the variants.
pub fn design_control(variants: &[Choice], order: &[usize], options: &Design) -> Result<Scenario, CurriculumError> {
    build(variants, options, Some(order))
}

/// Maximum number of regimes in a design. A document cannot hold more: each has at least five values.
const MAX_REGIMES: usize = 400_000;

fn build(variants: &[Choice], options: &Design, control: Option<&[usize]>) -> Result<Scenario, CurriculumError> {
    check(variants, options)?;
    let streams = Streams::new(variants, options);
    let (path, lessons) = lessons(variants, options, control, &streams)?;
    let positions = options.evaluation.positions(lessons.len() as u32)?;
    let evaluated = variants.iter().chain(&options.held_out);
    let evaluation: Vec<Regime> = evaluated.map(|choice| streams.evaluation(choice)).collect();
    let regimes = lessons.iter().map(Vec::len).sum::<usize>() + positions.len() * evaluation.len();
    if regimes > MAX_REGIMES {
        return Err(CurriculumError::bad_form(
            "chosen",
            variants.len(),
            options.blocks,
            format!("a scenario of at most {MAX_REGIMES} regimes, not {regimes}; use fewer variants or evaluations"),
        ));
    }
    let before = before_deployment(&variants[path[0]], options, &streams);
    Ok(scenario(options, before, lessons, &positions, evaluation))
}

/// The block before deployment, if there is one.
fn before_deployment(first: &Choice, options: &Design, streams: &Streams) -> Option<Block> {
    (options.pre_deployment > 0).then(|| Block {
        phase: Phase::PreDeployment,
        ..Block::new(BlockKind::Learning, vec![streams.before_deployment(first)])
    })
}

/// The blocks in order: learning blocks, and evaluations after the given numbers of them.
fn scenario(
    options: &Design,
    before: Option<Block>,
    lessons: Vec<Vec<Regime>>,
    positions: &BTreeSet<u32>,
    evaluation: Vec<Regime>,
) -> Scenario {
    let mut blocks: Vec<Block> = before.into_iter().collect();
    let last = lessons.len() as u32;
    for (position, regimes) in (0..).zip(lessons) {
        if positions.contains(&position) {
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
    if positions.contains(&last) {
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

/// The variants of the learning blocks in order, and the regimes of each block.
///
/// For a control, the variants are in the order of the design itself: its first is learned before deployment.
fn lessons(
    variants: &[Choice],
    options: &Design,
    control: Option<&[usize]>,
    streams: &Streams,
) -> Result<(Vec<usize>, Vec<Vec<Regime>>), CurriculumError> {
    let seeds = (options.seed, options.lifetime);
    let reorder = |path: &[usize]| match control {
        Some(order) => form::reordered(options.form, path, order, variants.len()),
        None => Ok(path.to_vec()),
    };
    let Some(drifting) = options.drifting else {
        let path = form::sequence(options.form, variants.len(), options.blocks, seeds)?;
        let mut num_learned = vec![0; variants.len()];
        let lesson = |variant: &usize| {
            let regime = streams.learning(&variants[*variant], options.learn, num_learned[*variant]);
            num_learned[*variant] += u64::from(options.learn);
            vec![regime]
        };
        let mut lessons: Vec<Vec<Regime>> = reorder(&path)?.iter().map(lesson).collect();
        if options.form == Some(ScenarioForm::Joint) {
            lessons = vec![lessons.into_iter().flatten().collect()];
        }
        return Ok((path, lessons));
    };
    // The form determines the variants along the drift; `blocks` is the number of blocks into which the drift is divided.
    let path = form::sequence(options.form, variants.len(), None, seeds)?;
    if path.len() < 2 {
        return Err(CurriculumError::NoWay);
    }
    let num_blocks = options.blocks.unwrap_or(path.len() as u32 - 1);
    if !(1..=MAX_BLOCKS).contains(&num_blocks) {
        return Err(CurriculumError::BadBlocks(num_blocks));
    }
    let lessons = drifting::lessons(
        variants,
        &reorder(&path)?,
        u64::from(num_blocks),
        (options.learn, streams),
        drifting,
    )?;
    Ok((path, lessons))
}

#[cfg(test)]
mod tests;
