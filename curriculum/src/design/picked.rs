//! [`Picked`]: a variant that was chosen or made, with its distances. Which ones are picked is said by `probe.rs` and `steps.rs`.

use driftworld_similarity::{Distance, DistanceMatrix, Weights, variant_distance};
use driftworld_spec::{Element, Variant};

use super::Choice;
use crate::CurriculumError;

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
        distance(&self.variant, &other.variant)
    }
}

/// Every distance among variants of one task: in an element alone, or in all together if none is named.
///
/// # Errors
/// [`CurriculumError::Similarity`] for variants of different tasks, or too many of them.
pub fn distances(picked: &[Picked], element: Option<Element>) -> Result<DistanceMatrix, CurriculumError> {
    let labels = picked.iter().map(|picked| picked.choice.id()).collect();
    DistanceMatrix::measure(labels, |a, b| apart(&picked[a].variant, &picked[b].variant, element))
}

/// How far two variants are apart: in an element, or in all together.
pub(super) fn apart(a: &Variant, b: &Variant, element: Option<Element>) -> Result<f64, CurriculumError> {
    Ok(in_element(&distance(a, b)?, element))
}

pub(super) fn distance(a: &Variant, b: &Variant) -> Result<Distance, CurriculumError> {
    Ok(variant_distance(a, b, &Weights::of_task(a.task()))?)
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
