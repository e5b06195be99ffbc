//! [`elements`]: measures which elements of the decision process the variants of a task change, and compares them with the
//! claims of the task's parameters.

mod optimum;
mod outcome;
mod request;

use std::sync::Arc;

use driftworld_env::{Experiment, Findings, MAX_EXPERIMENT_STEPS};
use driftworld_generator::Sampler;
use driftworld_spec::{Element, TaskSpec, Value, Variant, World};

pub use optimum::Optimum;
pub use outcome::{Contradiction, ElementsOutcome, Measured, Unmeasured, VariantElements, Verdict};
pub use request::{DEFAULT_ELEMENTS_WORLDS, ElementsRequest, MAX_ELEMENTS_WORLDS};

use crate::{Failure, libraries, tasks};

/// Maximum number of worlds in which a parameter is tested for having no effect.
const IDLE_WORLDS: u64 = 8;

/// Factor on the number of steps for which a parameter must show no effect before it counts as idle.
const IDLE_PATIENCE: u32 = 4;

/// Measures which elements differ between variants of a task, and reports where its parameters claim something else.
///
/// Each variant is compared with the first that the task declares, or one named variant with another. Worlds are drawn in
/// pairs: world `i` of one variant with world `i` of the other, under one seed.
///
/// # Errors
/// [`Failure`] if a task or variant is missing or invalid, a world cannot be drawn, or the request contradicts itself.
///
/// # Example
/// ```
/// use driftworld::elements::{ElementsRequest, elements};
/// use driftworld::spec::Element;
/// let request = ElementsRequest { worlds: 2, ..ElementsRequest::between("find_objects", "red", "penalty") };
/// let found = elements(&request).unwrap();
/// assert_eq!(found.variants[0].elements(), [Element::R]);
/// assert!(found.is_sound());
/// ```
pub fn elements(request: &ElementsRequest) -> Result<ElementsOutcome, Failure> {
    elements_of(&tasks::task(&request.task)?, request)
}

/// Like [`elements`], for a task that has been read; the name in the request is used in messages.
///
/// # Errors
/// As [`elements`].
pub fn elements_of(task: &Arc<TaskSpec>, request: &ElementsRequest) -> Result<ElementsOutcome, Failure> {
    request.check()?;
    let variants = request.variants_of(task)?;
    let trial = Trial::new(request)?;
    tasks::check_variants(&variants, &trial.experiment.catalogue)?;
    let mut outcome = ElementsOutcome::new(request, task.name());
    trial.compare_all(&variants, &mut outcome, Trial::test_variant)?;
    // Only the full set of variants can show that a parameter never has a declared effect.
    if variants.len() == task.variant_names().len() {
        outcome.note_unmeasured(task);
    }
    Ok(outcome)
}

/// Compares variants of one task with the first of them.
///
/// # Errors
/// [`Failure`] if a world cannot be drawn.
pub(crate) fn elements_among(variants: &[Variant], request: &ElementsRequest) -> Result<ElementsOutcome, Failure> {
    let trial = Trial::new(request)?;
    let mut outcome = ElementsOutcome::new(request, variants.first().map_or("", |first| first.task().name()));
    trial.compare_all(variants, &mut outcome, Trial::compare_variant)?;
    Ok(outcome)
}

/// Compares a variant with a base in worlds of the base.
type Compare = fn(&Trial, &Variant, &[World], &Variant) -> Result<VariantElements, Failure>;

/// Measures variants under the same settings.
struct Trial {
    experiment: Experiment,
    seed: u64,
    num_worlds: u64,
}

impl Trial {
    fn new(request: &ElementsRequest) -> Result<Self, Failure> {
        Ok(Self {
            experiment: Experiment {
                modalities: request.modalities.clone(),
                steps: request.steps,
                seed: request.seed,
                catalogue: libraries::catalogue(&request.libraries)?,
                ..Experiment::default()
            },
            seed: request.seed,
            num_worlds: request.worlds,
        })
    }

    /// Compares every other variant with the first.
    fn compare_all(
        &self,
        variants: &[Variant],
        outcome: &mut ElementsOutcome,
        compare: Compare,
    ) -> Result<(), Failure> {
        let Some((base, others)) = variants.split_first() else {
            return Ok(());
        };
        base.name().clone_into(&mut outcome.base);
        let worlds = self.worlds(base, self.num_worlds)?;
        for other in others {
            outcome.variants.push(compare(self, base, &worlds, other)?);
        }
        Ok(())
    }

    fn worlds(&self, variant: &Variant, count: u64) -> Result<Vec<World>, Failure> {
        let sampler = Sampler::new(variant, self.seed);
        Ok((0..count).map(|index| sampler.world(index)).collect::<Result<_, _>>()?)
    }

    fn compare(&self, base: &[World], other: &Variant) -> Result<Findings, Failure> {
        let worlds = self.worlds(other, base.len() as u64)?;
        let pairs: Vec<_> = base.iter().cloned().zip(worlds).collect();
        Ok(self.experiment.compare(&pairs)?)
    }

    fn compare_variant(&self, base: &Variant, worlds: &[World], other: &Variant) -> Result<VariantElements, Failure> {
        let found = self.compare(worlds, other)?;
        Ok(VariantElements::new(base, other, &changed(base, other), found))
    }

    fn test_variant(&self, base: &Variant, worlds: &[World], other: &Variant) -> Result<VariantElements, Failure> {
        let mut outcome = self.compare_variant(base, worlds, other)?;
        outcome.idle = self.idle(base, other, &outcome)?;
        let changes_reward = outcome.declared.contains(&Element::R) || outcome.elements().contains(&Element::R);
        if changes_reward {
            outcome.optimum = Some(Optimum::measure(
                base,
                other,
                self.seed,
                self.num_worlds,
                &self.experiment.catalogue,
            )?);
        }
        outcome.judge();
        Ok(outcome)
    }

    /// The idle parameters: resetting them to the base's values changes nothing.
    fn idle(&self, base: &Variant, other: &Variant, outcome: &VariantElements) -> Result<Vec<String>, Failure> {
        let names = &outcome.parameters;
        let is_alike = outcome.measured.is_empty();
        if names.is_empty() || (names.len() < 2 && !is_alike) {
            return Ok(Vec::new());
        }
        let worlds = self.worlds(other, self.num_worlds.min(IDLE_WORLDS))?;
        let patient = Self {
            experiment: Experiment {
                steps: self
                    .experiment
                    .steps
                    .saturating_mul(IDLE_PATIENCE)
                    .min(MAX_EXPERIMENT_STEPS),
                ..self.experiment.clone()
            },
            ..*self
        };
        let mut idle: Vec<String> = Vec::new();
        // Reset the parameters one by one, from the last: of two equivalent ones, only one counts as idle.
        for name in names.iter().rev() {
            let reset = idle.iter().chain([name]);
            let values: Vec<_> = reset
                .filter_map(|name| Some((name.clone(), base.value(name)?.clone())))
                .collect();
            // Do not test combinations that the task forbids or that cannot be drawn, such as a start within a wall.
            let Ok(without) = other.with("without", values) else {
                continue;
            };
            if self.worlds(&without, worlds.len() as u64).is_err() {
                continue;
            }
            let is_same = |trial: &Self| Ok::<_, Failure>(trial.compare(&worlds, &without)?.differences.is_empty());
            if (is_alike || is_same(self)?) && is_same(&patient)? {
                idle.push(name.clone());
            }
        }
        idle.reverse();
        Ok(idle)
    }
}

/// The parameters in which two variants of a task differ, with the elements that they claim to affect.
fn changed(a: &Variant, b: &Variant) -> Vec<(String, Vec<Element>)> {
    // Parameters that the task does not read in a variant count with their defaults.
    let (a, b) = (a.as_read(), b.as_read());
    let differs = |(name, value): &(&String, &Value)| a.value(name) != Some(*value);
    let declared = |name: &String| {
        a.task()
            .parameters()
            .get(name)
            .map(|parameter| parameter.affects.clone())
    };
    let changed = b.values().iter().filter(differs);
    changed
        .map(|(name, _)| (name.clone(), declared(name).unwrap_or_default()))
        .collect()
}

#[cfg(test)]
mod tests;
