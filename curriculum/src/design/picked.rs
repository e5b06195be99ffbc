//! [`Picked`]: a variant that was chosen or made, with its distances. Which ones are picked is said by `probe.rs` and `steps.rs`.

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_similarity::{Distance, DistanceMatrix, VariantMeasure, Weights};
use driftworld_spec::{Element, Variant};

use super::Choice;
use crate::CurriculumError;

/// A distance that no variant has, and that still tells differences of 1e-9 apart.
const BEYOND: f64 = 1e6;

/// A variant for a curriculum.
#[derive(Clone, Debug)]
pub struct Picked {
    /// As a scenario names it.
    pub choice: Choice,
    /// The variant itself.
    pub variant: Variant,
}

impl Picked {
    /// A variant that its task declares. `task` is what scenarios call the task.
    pub fn declared(task: &str, variant: Variant) -> Self {
        Self {
            choice: Choice::new(task, variant.name()),
            variant,
        }
    }

    /// A variant made of a declared one.
    pub(super) fn made(task: &str, from: &Variant, variant: Variant) -> Self {
        Self {
            choice: Choice::made(task, from, &variant),
            variant,
        }
    }

    /// Whether its task does not declare it.
    pub fn is_made(&self) -> bool {
        self.choice.name.is_some()
    }

    /// How far it is from another, element by element.
    ///
    /// # Errors
    /// [`CurriculumError::Similarity`] for variants of different tasks.
    pub fn distance(&self, other: &Self) -> Result<Distance, CurriculumError> {
        Ok(measure_of(&self.variant).between(&self.variant, &other.variant)?)
    }
}

/// Every distance among variants of one task: in an element alone, or in all together if none is named.
///
/// # Errors
/// [`CurriculumError::Similarity`] for variants of different tasks, or too many of them.
pub fn distances(picked: &[Picked], element: Option<Element>) -> Result<DistanceMatrix, CurriculumError> {
    let labels = picked.iter().map(|picked| picked.choice.id()).collect();
    // Without variants the matrix says so before anything is measured.
    let measure = picked.first().map(|first| measure_of(&first.variant));
    DistanceMatrix::measure(labels, |a, b| match &measure {
        Some(measure) => apart(measure, &picked[a].variant, &picked[b].variant, element),
        None => Ok(0.0),
    })
}

/// Compares variants of the same task as this one, at the weights that the task declares: made once for many comparisons.
pub(super) fn measure_of(variant: &Variant) -> VariantMeasure {
    VariantMeasure::new(variant.task(), Weights::of_task(variant.task()))
}

/// How far two variants are apart: in an element, or in all together.
pub(super) fn apart(
    measure: &VariantMeasure,
    a: &Variant,
    b: &Variant,
    element: Option<Element>,
) -> Result<f64, CurriculumError> {
    Ok(in_element(&measure.between(a, b)?, element))
}

/// How far the farthest variant is that the generator finds by moving a subject, in an element or in all together.
pub(super) fn farthest(
    measure: &VariantMeasure,
    anchor: &Variant,
    subject: &Subject,
    element: Option<Element>,
) -> Result<f64, GeneratorError> {
    let distance = |other: &Variant| apart(measure, anchor, other, element).unwrap_or(0.0);
    // Nothing is so far, so this finds the farthest, or the farthest of as many as can be looked at.
    match at_distance(anchor, subject, BEYOND, 0.0, distance) {
        Err(GeneratorError::TooFar { farthest, .. }) => Ok(farthest),
        Err(GeneratorError::NoneBetween { nearest, .. }) => Ok(nearest),
        Err(other) => Err(other),
        Ok(found) => Ok(found.distance),
    }
}

/// A distance in an element, 0 where nothing could differ, or the whole.
pub(super) fn in_element(distance: &Distance, element: Option<Element>) -> f64 {
    match element {
        Some(element) => distance.element(element).unwrap_or(0.0),
        None => distance.total,
    }
}

/// Whether a distance is exactly 0 in every element but one.
pub(super) fn is_alone(distance: &Distance, element: Element) -> bool {
    let others = Element::ALL.into_iter().filter(|other| *other != element);
    others
        .into_iter()
        .all(|other| distance.element(other).is_none_or(|apart| apart == 0.0))
}
