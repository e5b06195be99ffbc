//! A distance with its parts: what was compared, how, and what it weighs. Which parts there are is said by `variant.rs` and `world.rs`.

use driftworld_spec::{Element, TaskSpec};
use serde::Serialize;

use crate::SimilarityError;
use crate::distribution::Method;

/// The most that an element can weigh: what a task spec may say, too.
pub const MAX_WEIGHT: f64 = 1e6;

/// What the elements of the decision process weigh in the whole. Each 1 by default.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights([f64; 5]);

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

    /// The same weights but for one element.
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

    /// Weight 1 for one element and 0 for all others: the distance in that element alone.
    pub fn only(element: Element) -> Self {
        Self(Element::ALL.map(|other| f64::from(u8::from(other == element))))
    }

    /// What an element weighs.
    pub fn of(&self, element: Element) -> f64 {
        self.0[position(element)]
    }

    /// The weighted mean of the elements that are there; 0 if none that counts is.
    pub(super) fn mean(&self, elements: &[Option<f64>; 5]) -> f64 {
        let mut sum = 0.0;
        let mut whole = 0.0;
        for (weight, distance) in self.0.iter().zip(elements) {
            if let Some(distance) = distance {
                sum += weight * distance;
                whole += weight;
            }
        }
        if whole > 0.0 { sum / whole } else { 0.0 }
    }
}

/// One comparison that a distance is made of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// What was compared: a parameter, or a property of worlds.
    pub name: String,
    /// The element of the decision process that it counts for.
    pub element: Element,
    /// The measure, and what its number is divided by.
    pub measure: &'static str,
    /// For distributions: how the number was found. Values are compared as they are.
    #[serde(rename = "how", skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
    /// The measure's own number, in its own units.
    pub raw: f64,
    /// The number that counts, in 0..=1.
    pub normalised: f64,
    /// What it weighs among the parts of its element.
    pub weight: f64,
    /// Which share of the whole distance is its doing, in 0..=1; the shares of all parts add up to 1, or are 0 where the whole is.
    pub share: f64,
}

/// How far apart two variants or two worlds are.
///
/// A Gower mix: each element's distance is the weighted mean of its parts, the whole is the weighted mean of the elements
/// that have parts. All in 0..=1. A weighted mean of metrics with fixed weights is a metric again.
///
/// Source: Gower 1971, "A general coefficient of similarity and some of its properties".
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Distance {
    /// All elements together.
    pub total: f64,
    /// State, action, transition, reward, observation; `None` where nothing could differ. As JSON an object with their names.
    #[serde(serialize_with = "by_name")]
    pub elements: [Option<f64>; 5],
    /// What it is made of.
    pub parts: Vec<Part>,
}

impl Distance {
    pub(crate) fn new(mut parts: Vec<Part>, weights: &Weights) -> Self {
        let weight_of = |parts: &[Part], element| -> f64 {
            let own = parts.iter().filter(|part| part.element == element);
            own.map(|part| part.weight).sum()
        };
        let elements = Element::ALL.map(|element| {
            let weight = weight_of(&parts, element);
            let own = parts.iter().filter(|part| part.element == element);
            (weight > 0.0).then(|| own.map(|part| part.normalised * part.weight).sum::<f64>() / weight)
        });
        let total = weights.mean(&elements);
        let all: f64 = Element::ALL
            .iter()
            .zip(&elements)
            .map(|(element, distance)| weights.of(*element) * distance.map_or(0.0, |_| 1.0))
            .sum();
        if total > 0.0 {
            let of_element = Element::ALL.map(|element| weight_of(&parts, element));
            for part in &mut parts {
                let own = of_element[position(part.element)];
                if own > 0.0 {
                    let counts = part.normalised * part.weight / own * weights.of(part.element) / all;
                    part.share = counts / total;
                }
            }
        }
        Self { total, elements, parts }
    }

    /// The distance in one element; `None` where nothing could differ.
    pub fn element(&self, element: Element) -> Option<f64> {
        self.elements[position(element)]
    }

    /// The elements in which there is any distance.
    pub fn differs_in(&self) -> Vec<Element> {
        let differs = |element: &Element| self.element(*element).is_some_and(|distance| distance > 0.0);
        Element::ALL.into_iter().filter(differs).collect()
    }
}

/// The elements under their names, in order.
fn by_name<S: serde::Serializer>(elements: &[Option<f64>; 5], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(Element::ALL.iter().map(|element| element.name()).zip(elements))
}

pub(super) fn position(element: Element) -> usize {
    Element::ALL
        .iter()
        .position(|other| *other == element)
        .expect("ALL holds every element")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(element: Element, normalised: f64, weight: f64) -> Part {
        Part {
            name: "p".to_owned(),
            element,
            measure: "same or not",
            method: None,
            raw: normalised,
            normalised,
            weight,
            share: 0.0,
        }
    }

    #[test]
    fn parts_make_elements_and_elements_the_whole() {
        let parts = vec![
            part(Element::R, 1.0, 1.0),
            part(Element::R, 0.0, 3.0),
            part(Element::O, 0.5, 2.0),
            part(Element::T, 0.7, 0.0),
        ];
        let weights = Weights::default().with(Element::O, 3.0).unwrap();
        let distance = Distance::new(parts, &weights);
        assert_eq!(distance.elements, [None, None, None, Some(0.25), Some(0.5)]);
        assert_eq!(distance.total, (0.25 + 3.0 * 0.5) / 4.0);
        assert_eq!(distance.differs_in(), [Element::R, Element::O]);
        let shares: Vec<f64> = distance.parts.iter().map(|part| part.share).collect();
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!((shares[1], shares[3]), (0.0, 0.0));
        assert!((shares[0] - 0.25 / 1.75).abs() < 1e-12);
    }

    #[test]
    fn one_element_can_be_taken_alone() {
        let parts = vec![part(Element::R, 1.0, 1.0), part(Element::O, 0.5, 1.0)];
        assert_eq!(Distance::new(parts.clone(), &Weights::only(Element::O)).total, 0.5);
        assert_eq!(Distance::new(parts, &Weights::only(Element::S)).total, 0.0);
        assert!(Weights::default().with(Element::R, f64::NAN).is_err());
        assert!(Weights::default().with(Element::R, -1.0).is_err());
    }
}
