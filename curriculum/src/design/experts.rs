//! Single-task experts: for each variant of a lifetime a scenario in which it alone is learned, like for like.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use driftworld_generator::Schedule;
use driftworld_spec::{Regime, Scenario, ScenarioForm};

use super::streams::Streams;
use super::{Choice, Design, before_deployment, check, form, lessons, scenario};
use crate::CurriculumError;

/// A scenario for each variant that the lifetime learns, in which it alone is learned: single-task experts, with which a
/// lifelong learner is compared.
///
/// `options` are those of the lifetime. Each expert learns its variant as long as the lifetime does, in the same worlds and in
/// blocks of the same lengths, after the same block before deployment, and is evaluated in its variant where the lifetime is, in
/// the same worlds. So a learner without interference earns in the lifetime what it earns as its own expert. Of a lifetime
/// that drifts, the expert of a variant has one block with as many experiences as are nearer to it than to the other end. The
/// expert form has no lifetime: each variant is learned for `blocks` blocks, 1 where nobody says.
///
/// They are named `NAME-VARIANT`, or `NAME-TASK-VARIANT` if there are several tasks.
///
/// # Errors
/// As [`design`](super::design); [`CurriculumError::SameName`] if two would have the same name.
pub fn experts(variants: &[Choice], options: &Design) -> Result<Vec<Scenario>, CurriculumError> {
    check(variants, options)?;
    let streams = Streams::new(variants, options);
    let (first, budgets) = budgets(variants, options, &streams)?;
    let several_tasks = variants.iter().any(|choice| choice.task != variants[0].task);
    let mut named: BTreeMap<String, String> = BTreeMap::new();
    let mut experts = Vec::new();
    for (choice, budget) in variants.iter().zip(budgets) {
        if budget.lessons.is_empty() {
            continue;
        }
        let name = name(choice, &options.name, several_tasks);
        if let Some(other) = named.insert(name.clone(), choice.id()) {
            return Err(CurriculumError::SameName {
                a: other,
                b: choice.id(),
                name,
            });
        }
        let own = Design {
            name,
            form: Some(ScenarioForm::Expert),
            ..options.clone()
        };
        let before = before_deployment(&variants[first], options, &streams);
        let evaluation = vec![streams.evaluation(choice)];
        experts.push(scenario(&own, before, budget.lessons, &budget.places, evaluation));
    }
    Ok(experts)
}

/// What a lifetime has of one variant.
#[derive(Default)]
struct Budget {
    /// Its learning blocks.
    lessons: Vec<Vec<Regime>>,
    /// After how many of these it is evaluated.
    places: BTreeSet<u32>,
}

/// The variant that the lifetime begins with, and what it has of each.
fn budgets(
    variants: &[Choice],
    options: &Design,
    streams: &Streams,
) -> Result<(usize, Vec<Budget>), CurriculumError> {
    if options.form == Some(ScenarioForm::Expert) {
        return Ok((0, alone(variants, options, streams)?));
    }
    let (path, lessons) = lessons(variants, options, None, streams)?;
    let places = options.evaluation.places(lessons.len() as u32)?;
    if options.drifting.is_some() {
        return Ok((path[0], nearest(variants, &lessons, &places, streams)));
    }
    let mut budgets: Vec<Budget> = variants.iter().map(|_| Budget::default()).collect();
    // After each of the lifetime's blocks, each variant has come so far; evaluated once where it has not moved.
    for place in 0..=lessons.len() {
        if places.contains(&(place as u32)) {
            for budget in &mut budgets {
                budget.places.insert(budget.lessons.len() as u32);
            }
        }
        if let (Some(lesson), Some(variant)) = (lessons.get(place), path.get(place)) {
            budgets[*variant].lessons.push(lesson.clone());
        }
    }
    Ok((path[0], budgets))
}

/// Each variant for so many blocks as the expert form has.
fn alone(variants: &[Choice], options: &Design, streams: &Streams) -> Result<Vec<Budget>, CurriculumError> {
    let path = form::sequence(options.form, 1, options.blocks, (options.seed, options.lifetime))?;
    let places = options.evaluation.places(path.len() as u32)?;
    let budget = |choice: &Choice| Budget {
        lessons: (0..path.len() as u64)
            .map(|block| vec![streams.learning(choice, options.learn, block * u64::from(options.learn))])
            .collect(),
        places: places.clone(),
    };
    Ok(variants.iter().map(budget).collect())
}

/// Of a drift, each variant for as long as the drift is nearer to it than to its other end, in one block.
fn nearest(
    variants: &[Choice],
    lessons: &[Vec<Regime>],
    places: &BTreeSet<u32>,
    streams: &Streams,
) -> Vec<Budget> {
    let mut counts = vec![0_u32; variants.len()];
    for regime in lessons.iter().flatten() {
        let Some(drift) = &regime.drift else { continue };
        let schedule = Schedule::from(drift.schedule);
        let is_near = |experience: &u32| schedule.at(drift.progress(*experience, regime.count)) < 0.5;
        let near = (0..regime.count).filter(is_near).count() as u32;
        let is = |choice: &Choice, variant: &str, name: Option<&str>| {
            choice.task == regime.task && choice.variant == variant && choice.name.as_deref() == name
        };
        for (choice, count) in variants.iter().zip(&mut counts) {
            if is(choice, &regime.variant, regime.name.as_deref()) {
                *count += near;
            }
            if is(choice, &drift.to, drift.name.as_deref()) {
                *count += regime.count - near;
            }
        }
    }
    let budget = |(choice, count): (&Choice, u32)| {
        if count == 0 {
            return Budget::default();
        }
        Budget {
            lessons: vec![vec![streams.learning(choice, count, 0)]],
            places: places.iter().map(|place| u32::from(*place > 0)).collect(),
        }
    };
    variants.iter().zip(counts).map(budget).collect()
}

fn name(choice: &Choice, scenario: &str, several_tasks: bool) -> String {
    let variant = plain(choice.name());
    // A task may be the path of its file.
    let task = Path::new(&choice.task).file_stem().and_then(|stem| stem.to_str());
    match task.filter(|_| several_tasks) {
        Some(task) => format!("{scenario}-{}-{variant}", plain(task)),
        None => format!("{scenario}-{variant}"),
    }
}

/// Text as a scenario's name may have it.
fn plain(text: &str) -> String {
    let allowed = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
    text.chars().map(|c| if allowed(c) { c } else { '-' }).collect()
}
