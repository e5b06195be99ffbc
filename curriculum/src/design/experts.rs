//! Single-task experts: for each variant of a lifetime, a comparable scenario that learns only this variant.

use std::collections::BTreeMap;
use std::path::Path;

use driftworld_spec::{Block, BlockKind, BlockMix, Phase, Regime, Scenario, ScenarioForm};

use super::streams::Streams;
use super::{Choice, Design, before_deployment, check, design, form, scenario};
use crate::CurriculumError;

/// A scenario for each variant that the lifetime learns, in which only this variant is learned: single-task experts to compare
/// a lifelong learner with.
///
/// `options` are the lifetime's own; [`experts_of`] describes its experts. The expert form has no lifetime: each variant is
/// learned for `blocks` blocks, by default 1.
///
/// Their names are `NAME-VARIANT`, or `NAME-TASK-VARIANT` if there are several tasks.
///
/// # Errors
/// Those of [`design`](super::design); [`CurriculumError::SameName`] if two would have the same name.
pub fn experts(variants: &[Choice], options: &Design) -> Result<Vec<Scenario>, CurriculumError> {
    if options.form != Some(ScenarioForm::Expert) {
        return experts_of(&design(variants, options)?);
    }
    check(variants, options)?;
    let streams = Streams::new(variants, options);
    let path = form::sequence(options.form, 1, options.blocks, (options.seed, options.lifetime))?;
    let positions = options.evaluation.positions(path.len() as u32)?;
    let expert = |choice: &Choice| {
        let num_learned = (0..path.len() as u64).map(|block| block * u64::from(options.learn));
        let lessons = num_learned.map(|num_learned| vec![streams.learning(choice, options.learn, num_learned)]);
        let before = before_deployment(&variants[0], options, &streams);
        let evaluation = vec![streams.evaluation(choice)];
        (
            choice.clone(),
            scenario(options, before, lessons.collect(), &positions, evaluation),
        )
    };
    with_names(variants.iter().map(expert).collect(), &options.name)
}

/// A scenario for each variant that a scenario learns, in which only this variant is learned.
///
/// Each expert learns its variant for as long as the lifetime does, in the same worlds and in blocks of the same lengths, after
/// the same pre-deployment blocks, and is evaluated on its variant whenever the lifetime is, in the same worlds. A learner
/// without interference therefore earns as much in the lifetime as in the scenarios of its experts. Drifts are replaced: the
/// experiences that are nearer to one end of the drift than to the other become experiences of that end's variant, in worlds
/// with the same numbers. Names are those of [`experts`].
///
/// # Errors
/// [`CurriculumError::SameName`] if two would have the same name.
///
/// # Example
/// ```
/// use driftworld_curriculum::{Choice, Design, design, experts_of};
/// let variants = ["blue", "red"].map(|variant| Choice::new("find_objects", variant));
/// let lifetime = design(&variants, &Design { blocks: Some(4), ..Design::default() })?;
/// let experts = experts_of(&lifetime)?;
/// assert_eq!(experts[1].name, "curriculum-red");
/// assert_eq!(experts[1].blocks.len(), 5, "red twice, evaluated before, between and after");
/// # Ok::<(), driftworld_curriculum::CurriculumError>(())
/// ```
pub fn experts_of(lifetime: &Scenario) -> Result<Vec<Scenario>, CurriculumError> {
    let is_learned = |block: &&Block| block.kind == BlockKind::Learning && block.phase == Phase::Deployment;
    let mut variants: Vec<Choice> = Vec::new();
    for regime in lifetime
        .blocks
        .iter()
        .filter(is_learned)
        .flat_map(|block| &block.regimes)
    {
        for part in parts(regime) {
            let choice = choice(&part);
            if !variants.contains(&choice) {
                variants.push(choice);
            }
        }
    }
    let experts = variants.into_iter().map(|choice| {
        let expert = expert_of(lifetime, &choice);
        (choice, expert)
    });
    with_names(experts.collect(), &lifetime.name)
}

/// The part of a lifetime that concerns one variant.
fn expert_of(lifetime: &Scenario, wanted: &Choice) -> Scenario {
    let mut blocks: Vec<Block> = Vec::new();
    for block in &lifetime.blocks {
        if block.phase == Phase::PreDeployment {
            blocks.push(block.clone());
            continue;
        }
        let regimes = block.regimes.iter().flat_map(parts);
        let own = Block {
            mix: BlockMix::InOrder,
            regimes: regimes.filter(|regime| choice(regime) == *wanted).collect(),
            ..block.clone()
        };
        // Between two of the expert's blocks, the lifetime may be evaluated several times; its expert is evaluated only once.
        let is_repeat = own.kind == BlockKind::Evaluation && blocks.last() == Some(&own);
        if !own.regimes.is_empty() && !is_repeat {
            blocks.push(own);
        }
    }
    Scenario {
        form: Some(ScenarioForm::Expert),
        blocks,
        ..lifetime.clone()
    }
}

/// Splits a regime into stretches of single variants: itself, or the two ends of its drift.
fn parts(regime: &Regime) -> Vec<Regime> {
    let Some(drift) = &regime.drift else {
        return vec![regime.clone()];
    };
    // By its progress, as in logs and metrics, independent of the schedule.
    let is_near = |experience: u32| drift.progress(experience, regime.count) < 0.5;
    let num_near = (0..regime.count).filter(|experience| is_near(*experience)).count() as u32;
    let from = Regime {
        drift: None,
        count: num_near,
        ..regime.clone()
    };
    let to = Regime {
        task: drift.task.clone().unwrap_or_else(|| regime.task.clone()),
        variant: drift.to.clone(),
        values: drift.values.clone(),
        name: drift.name.clone(),
        count: regime.count - num_near,
        first_index: regime.first_index + u64::from(num_near),
        ..from.clone()
    };
    [from, to].into_iter().filter(|part| part.count > 0).collect()
}

/// The variant of a regime without a drift; for a world file, the world's name.
fn choice(regime: &Regime) -> Choice {
    Choice {
        values: regime.values.clone(),
        name: regime.name.clone(),
        ..Choice::new(&regime.task, &regime.variant)
    }
}

fn with_names(experts: Vec<(Choice, Scenario)>, lifetime: &str) -> Result<Vec<Scenario>, CurriculumError> {
    let several_tasks = experts.iter().any(|(choice, _)| choice.task != experts[0].0.task);
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    let mut scenarios = Vec::new();
    for (choice, scenario) in experts {
        let name = name(&choice, lifetime, several_tasks);
        if let Some(other) = names.insert(name.clone(), choice.id()) {
            return Err(CurriculumError::SameName {
                a: other,
                b: choice.id(),
                name,
            });
        }
        scenarios.push(Scenario { name, ..scenario });
    }
    Ok(scenarios)
}

fn name(choice: &Choice, scenario: &str, several_tasks: bool) -> String {
    let variant = name_part(choice.name());
    // A task may be given as a path.
    let task = Path::new(&choice.task).file_stem().and_then(|stem| stem.to_str());
    match task.filter(|_| several_tasks) {
        Some(task) => format!("{scenario}-{}-{variant}", name_part(task)),
        None => format!("{scenario}-{variant}"),
    }
}

/// The text for a scenario's name: characters other than ASCII letters, digits, `_`, `.` and `-` become `-`.
fn name_part(text: &str) -> String {
    let allowed = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
    text.chars().map(|c| if allowed(c) { c } else { '-' }).collect()
}
