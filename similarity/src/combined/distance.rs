//! A distance with its parts: what was compared, how, and what it weighs. Which parts there are is said by `variant.rs` and `world.rs`.

use driftworld_spec::Element;
use serde::Serialize;

use crate::SimilarityError;

/// What the elements of the decision process weigh in the whole. Each 1 by default.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights([f64; 5]);

impl Default for Weights {
    fn default() -> Self {
        Self([1.0; 5])
    }
}

impl Weights {
    /// The same weights but for one element.
    ///
    /// # Errors
    /// [`SimilarityError::BadWeight`] unless the weight is finite and at least 0.
    pub fn with(mut self, element: Element, weight: f64) -> Result<Self, SimilarityError> {
        if !weight.is_finite() || weight < 0.0 {
            return Err(SimilarityError::BadWeight {
                name: element.name().to_owned(),
                found: weight,
            });
        }
        self.0[position(element)] = weight;
        Ok(self)
    }

    /// What an element weighs.
    pub fn of(&self, element: Element) -> f64 {
        self.0[position(element)]
    }
}

/// One comparison that a distance is made of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// What was compared: a parameter, or a property of worlds.
    pub name: String,
    /// The element of the decision process that it counts for.
    pub element: Element,
    /// How it was compared.
    pub measure: &'static str,
    /// The measure's own number, in its own units.
    pub raw: f64,
    /// The number that counts, in 0..=1.
    pub normalised: f64,
    /// What it weighs among the parts of its element.
    pub weight: f64,
}

/// How far apart two variants or two worlds are.
///
/// A Gower mix: each element's distance is the weighted mean of its parts, the whole is the weighted mean of the elements
/// that have parts. All in 0..=1.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Distance {
    /// All elements together.
    pub total: f64,
    /// State, action, transition, reward, observation; `None` where nothing could differ.
    pub elements: [Option<f64>; 5],
    /// What it is made of.
    pub parts: Vec<Part>,
}

impl Distance {
    pub(crate) fn new(parts: Vec<Part>, weights: &Weights) -> Self {
        let elements = Element::ALL.map(|element| {
            let own = || parts.iter().filter(move |part| part.element == element);
            let weight: f64 = own().map(|part| part.weight).sum();
            (weight > 0.0).then(|| own().map(|part| part.normalised * part.weight).sum::<f64>() / weight)
        });
        let present = || {
            Element::ALL
                .into_iter()
                .zip(elements)
                .filter_map(|(element, d)| Some((weights.of(element), d?)))
        };
        let weight: f64 = present().map(|(weight, _)| weight).sum();
        let total = if weight > 0.0 {
            present().map(|(weight, d)| weight * d).sum::<f64>() / weight
        } else {
            0.0
        };
        Self { total, elements, parts }
    }

    /// The distance in one element; `None` where nothing could differ.
    pub fn element(&self, element: Element) -> Option<f64> {
        self.elements[position(element)]
    }
}

fn position(element: Element) -> usize {
    Element::ALL
        .iter()
        .position(|other| *other == element)
        .expect("ALL holds every element")
}
