//! [`Weights`]: the weight of each element of the decision process in a distance.

use driftworld_spec::{Element, TaskSpec};

use crate::SimilarityError;

/// Maximum weight of an element, also in a task spec.
pub const MAX_WEIGHT: f64 = 1e6;

/// Weights of the elements of the decision process in the whole. Each is 1 by default.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights(pub(super) [f64; 5]);

impl Default for Weights {
    fn default() -> Self {
        Self([1.0; 5])
    }
}

impl Weights {
    /// The weights that a task declares under `element_weights`.
    pub fn of_task(task: &TaskSpec) -> Self {
        Self(task.element_weights().to_array())
    }

    /// These weights, with one element's replaced.
    ///
    /// # Errors
    /// [`SimilarityError::BadWeight`] unless the weight is in `0..=`[`MAX_WEIGHT`].
    pub fn with(mut self, element: Element, weight: f64) -> Result<Self, SimilarityError> {
        if !(0.0..=MAX_WEIGHT).contains(&weight) {
            return Err(SimilarityError::BadWeight {
                name: element.name().to_owned(),
                found: weight,
            });
        }
        self.0[position(element)] = weight;
        Ok(self)
    }

    /// The weight of an element.
    pub fn of(&self, element: Element) -> f64 {
        self.0[position(element)]
    }
}

pub(super) fn position(element: Element) -> usize {
    Element::ALL
        .iter()
        .position(|other| *other == element.coarse())
        .expect("ALL holds every coarse element")
}
