//! From variants in an order to learning and evaluation blocks. What the order is, is `similarity`'s; running it is in `run/`.

mod choice;
mod drifting;
mod evaluation;
mod form;
mod hypothesis;
mod picked;
mod probe;
mod steps;
mod walk;

use std::collections::BTreeMap;
use std::path::Path;

use driftworld_spec::{
    Block, BlockKind, MAX_EXPERIENCES, Phase, Regime, Scenario, ScenarioComplexity, ScenarioDifficulty, ScenarioForm,
    TaskLabel,
};

pub use choice::Choice;
pub use drifting::Drifting;
pub use evaluation::Evaluate;
pub use form::MAX_BLOCKS;
pub use hypothesis::{Control, Hypothesis, arrange, control};
pub use picked::{Picked, distances};
pub use probe::{MAX_PROBED, probe, probe_named};
pub use steps::{MAX_STEPS, Steps, steps};

use crate::CurriculumError;

/// The largest seed of a design: two others are derived from it.
pub const MAX_SEED: u64 = 1 << 52;

/// The index of the first world before deployment: far from those that the lifetime itself learns from.
const BEFORE_DEPLOYMENT: u64 = 1 << 40;

/// How blocks are made of variants.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The scenario's name.
    pub name: String,
    /// Experiences of each learning block; default 20.
    pub learn: u32,
    /// Experiences of each variant in each evaluation block; default 5.
    pub evaluate: u32,
    /// When the agent is evaluated; default every time.
    pub evaluation: Evaluate,
    /// How learning blocks are arranged; by default the variants follow each other, and begin anew when there are more blocks.
    pub form: Option<ScenarioForm>,
    /// How many learning blocks, at most [`MAX_BLOCKS`]; by default as many as the form has of itself.
    pub blocks: Option<u32>,
    /// The number of the lifetime, which decides the order of the permuted form; default 0.
    pub lifetime: u64,
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
            learn: 20,
            evaluate: 5,
            evaluation: Evaluate::Every,
            form: None,
            blocks: None,
            lifetime: 0,
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
/// Learning draws from seed `2 × seed`, evaluation from `2 × seed + 1`, so no world is in both. Every evaluation of a variant
/// draws the same worlds, so that before and after are told apart by the agent alone; a variant that is learned again goes on
/// with worlds it has not had, so that two designs of the same variants and counts have the same worlds in any order.
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

fn arranged(variants: &[Choice], options: &Design, control: Option<&[usize]>) -> Result<Scenario, CurriculumError> {
    check(variants, options)?;
    let (path, lessons) = lessons(variants, options, control)?;
    let num_lessons = lessons.len() as u32;
    let places = options.evaluation.places(num_lessons)?;
    let mut blocks = Vec::new();
    if options.pre_deployment > 0 {
        // From the far end of the indices, so that no world of it is learned again.
        let first = variants[path[0]].regime(options.pre_deployment, options.seed * 2, BEFORE_DEPLOYMENT);
        blocks.push(Block {
            phase: Phase::PreDeployment,
            ..Block::new(BlockKind::Learning, vec![first])
        });
    }
    let evaluation = || {
        let frozen = |choice: &Choice| choice.regime(options.evaluate, options.seed * 2 + 1, 0);
        Block::new(BlockKind::Evaluation, variants.iter().map(frozen).collect())
    };
    for (place, regimes) in (0..).zip(lessons) {
        if places.contains(&place) {
            blocks.push(evaluation());
        }
        blocks.push(Block::new(BlockKind::Learning, regimes));
    }
    if places.contains(&num_lessons) {
        blocks.push(evaluation());
    }
    Ok(Scenario {
        form: options.form,
        complexity: options.complexity,
        difficulty: options.difficulty,
        task_label: options.task_label,
        ..Scenario::new(&options.name, blocks)
    })
}

/// A scenario for each variant in which it alone is learned, as often and as long as `options` say: single-task experts, with
/// which a lifelong learner is compared. They are named `NAME-VARIANT`, or `NAME-TASK-VARIANT` if there are several tasks, and draw the worlds that
/// the lifelong learner does.
///
/// # Errors
/// As [`design`]; [`CurriculumError::SameName`] if two would have the same name.
pub fn experts(variants: &[Choice], options: &Design) -> Result<Vec<Scenario>, CurriculumError> {
    check(variants, options)?;
    let several_tasks = variants.iter().any(|choice| choice.task != variants[0].task);
    let mut named: BTreeMap<String, String> = BTreeMap::new();
    let expert = |choice: &Choice| {
        let variant = plain(choice.name());
        // A task may be the path of its file.
        let task = Path::new(&choice.task).file_stem().and_then(|stem| stem.to_str());
        let name = match task.filter(|_| several_tasks) {
            Some(task) => format!("{}-{}-{variant}", options.name, plain(task)),
            None => format!("{}-{variant}", options.name),
        };
        if let Some(other) = named.insert(name.clone(), choice.id()) {
            return Err(CurriculumError::SameName {
                a: other,
                b: choice.id(),
                name,
            });
        }
        let options = Design {
            name,
            form: Some(ScenarioForm::Expert),
            drifting: None,
            ..options.clone()
        };
        design(std::slice::from_ref(choice), &options)
    };
    variants.iter().map(expert).collect()
}

/// Text as a scenario's name may have it.
fn plain(text: &str) -> String {
    let allowed = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
    text.chars().map(|c| if allowed(c) { c } else { '-' }).collect()
}

fn check(variants: &[Choice], options: &Design) -> Result<(), CurriculumError> {
    if variants.is_empty() {
        return Err(CurriculumError::NoVariants);
    }
    let before = options.pre_deployment.max(1);
    for (kind, found) in [
        ("learning", options.learn),
        ("evaluation", options.evaluate),
        ("pre-deployment", before),
    ] {
        if !(1..=MAX_EXPERIENCES).contains(&found) {
            return Err(CurriculumError::BadCount {
                kind,
                found,
                limit: MAX_EXPERIENCES,
            });
        }
    }
    if options.seed > MAX_SEED {
        return Err(CurriculumError::BadSeed {
            found: options.seed,
            limit: MAX_SEED,
        });
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
) -> Result<(Vec<usize>, Vec<Vec<Regime>>), CurriculumError> {
    let streams = (options.seed, options.lifetime);
    let own = |path: &[usize]| match control {
        Some(order) => form::reordered(options.form, path, order, variants.len()),
        None => Ok(path.to_vec()),
    };
    let Some(drifting) = options.drifting else {
        let path = form::sequence(options.form, variants.len(), options.blocks, streams)?;
        let mut taken = vec![0; variants.len()];
        let lesson = |variant: &usize| {
            let regime = variants[*variant].regime(options.learn, options.seed * 2, taken[*variant]);
            taken[*variant] += u64::from(options.learn);
            vec![regime]
        };
        let lessons = own(&path)?.iter().map(lesson).collect();
        return Ok((path, lessons));
    };
    // The form says which variants the drift leads through; how many blocks it is shared out among is said by `blocks`.
    let path = form::sequence(options.form, variants.len(), None, streams)?;
    if path.len() < 2 {
        return Err(CurriculumError::NoWay);
    }
    let num_blocks = options.blocks.unwrap_or(path.len() as u32 - 1);
    if !(1..=MAX_BLOCKS).contains(&num_blocks) {
        return Err(CurriculumError::BadBlocks {
            found: num_blocks,
            limit: MAX_BLOCKS,
        });
    }
    let lessons = drifting::lessons(variants, &own(&path)?, u64::from(num_blocks), options, drifting)?;
    Ok((path, lessons))
}

#[cfg(test)]
mod tests;
