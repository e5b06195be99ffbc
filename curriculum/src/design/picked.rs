//! [`Picked`]: a chosen or generated variant; distances between such variants.

use driftworld_generator::{GeneratorError, Subject, at_distance};
use driftworld_similarity::{Distance, DistanceMatrix, VariantMeasure, Weights};
use driftworld_spec::{Element, Variant};

use super::Choice;
use crate::CurriculumError;

/// Greater than any distance between variants, and small enough to resolve differences of 1e-9.
const BEYOND: f64 = 1e6;

/// A variant for a curriculum.
#[derive(Clone, Debug)]
pub struct Picked {
    /// Its name in scenarios.
    pub choice: Choice,
    /// The variant itself.
    pub variant: Variant,
}

impl Picked {
    /// A variant that its task declares. `task` is the task's name in scenarios.
    pub fn declared(task: &str, variant: Variant) -> Self {
        Self {
            choice: Choice::new(task, variant.name()),
            variant,
        }
    }

    /// A variant derived from a declared one.
    pub(super) fn generated(task: &str, from: &Variant, variant: Variant) -> Self {
        Self {
            choice: Choice::made(task, from, &variant),
            variant,
        }
    }

    /// Whether it was generated rather than declared by its task.
    pub fn is_made(&self) -> bool {
        self.choice.name.is_some()
    }

    /// Its name with its task's own, such as `find_objects#red`.
    pub fn label(&self) -> String {
        format!("{}#{}", self.variant.task().name(), self.choice.name())
    }

    /// The distance to another variant, element by element.
    ///
    /// # Errors
    /// [`CurriculumError::Similarity`] for variants of different tasks.
    pub fn distance(&self, other: &Self) -> Result<Distance, CurriculumError> {
        Ok(measure_of(&self.variant).between(&self.variant, &other.variant)?)
    }
}

/// All distances among variants of one task: in one element, or in total if none is named.
///
/// # Errors
/// [`CurriculumError::Similarity`] for variants of different tasks, or too many of them.
pub fn distances(picked: &[Picked], element: Option<Element>) -> Result<DistanceMatrix, CurriculumError> {
    let labels = picked.iter().map(|picked| picked.choice.id()).collect();
    // Without variants, the matrix reports the error before anything is measured.
    let measure = picked.first().map(|first| measure_of(&first.variant));
    DistanceMatrix::measure(labels, |a, b| match &measure {
        Some(measure) => distance_between(measure, &picked[a].variant, &picked[b].variant, element),
        None => Ok(0.0),
    })
}

/// The measure for variants of the same task, with the task's weights; it can be used for many comparisons.
pub(super) fn measure_of(variant: &Variant) -> VariantMeasure {
    VariantMeasure::new(variant.task(), Weights::of_task(variant.task()))
}

/// The distance between two variants: in one element, or in total.
pub(super) fn distance_between(
    measure: &VariantMeasure,
    a: &Variant,
    b: &Variant,
    element: Option<Element>,
) -> Result<f64, CurriculumError> {
    Ok(measure.between(a, b)?.within(element))
}

/// The distance of the farthest variant that the generator finds by changing a subject, in one element or in total.
pub(super) fn farthest(
    measure: &VariantMeasure,
    anchor: &Variant,
    subject: &Subject,
    element: Option<Element>,
) -> Result<f64, GeneratorError> {
    let distance = |other: &Variant| distance_between(measure, anchor, other, element).unwrap_or(0.0);
    // No variant is this far away, so the generator returns the farthest that it finds.
    match at_distance(anchor, subject, BEYOND, 0.0, distance) {
        Err(GeneratorError::TooFar { farthest, .. }) => Ok(farthest),
        Err(GeneratorError::NoneBetween { nearest, .. }) => Ok(nearest),
        Err(other) => Err(other),
        Ok(found) => Ok(found.distance),
    }
}

/// Whether a distance is exactly 0 in every element except this one.
pub(super) fn is_only_in(distance: &Distance, element: Element) -> bool {
    let others = Element::ALL.into_iter().filter(|other| *other != element);
    others
        .into_iter()
        .all(|other| distance.element(other).is_none_or(|own| own == 0.0))
}
