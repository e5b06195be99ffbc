//! [`Distance`]: the weighted sum of its parts.

use driftworld_spec::Element;
use serde::Serialize;

use super::weights::{Weights, position};
use crate::distribution::Method;

/// One comparison in a distance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// The parameter or world property that was compared.
    pub name: String,
    /// The element of the decision process that the part counts for.
    pub element: Element,
    /// The measure, and its normalisation.
    pub measure: &'static str,
    /// For distributions: the method by which the number was found. Single values have none.
    #[serde(rename = "how", skip_serializing_if = "Option::is_none")]
    pub method: Option<Method>,
    /// The measure's raw number, in its own unit.
    pub raw: f64,
    /// The normalised number, at least 0; the measure defines its unit.
    pub normalised: f64,
    /// Weight: the part counts `weight` times.
    pub weight: f64,
    /// Its share of the whole distance, in 0..=1; the shares of all parts add up to 1, or are all 0 if the distance is 0.
    pub share: f64,
}

/// The distance between two variants or two worlds.
///
/// Parts are added, not averaged: each element's distance is the weighted sum of its parts, and the whole is the sum over
/// everything that was compared, each with the weight of its element; a parameter that counts for several elements counts once
/// in the whole, with the largest of their weights. So parts that are equal in both change no number, however many there are. All
/// are at least 0 and may be above 1; for variants, 1 is one parameter moved over its whole declared range. A weighted sum of
/// metrics is a metric.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Distance {
    /// All elements together.
    pub total: f64,
    /// State, action, transition, reward, observation; `None` where nothing could differ. As JSON an object with their names.
    #[serde(serialize_with = "by_name")]
    pub elements: [Option<f64>; 5],
    /// The parts.
    pub parts: Vec<Part>,
}

impl Part {
    /// A part of weight 1 whose number needs no normalisation.
    pub fn of(name: &str, element: Element, measure: &'static str, value: f64) -> Self {
        Self {
            name: name.to_owned(),
            element,
            measure,
            method: None,
            raw: value,
            normalised: value,
            weight: 1.0,
            share: 0.0,
        }
    }
}

impl Distance {
    /// A distance that belongs to no single element, such as one between reachable areas or abilities. It has no parts.
    pub fn whole(total: f64) -> Self {
        Self {
            total,
            elements: [None; 5],
            parts: Vec::new(),
        }
    }

    /// Adds up parts; parts with the same name must be adjacent, with the same number for each of their elements.
    pub fn new(mut parts: Vec<Part>, weights: &Weights) -> Self {
        let elements = Element::ALL.map(|element| {
            let own = || parts.iter().filter(|part| part.element == element && part.weight > 0.0);
            let sum = own().map(|part| part.normalised * part.weight).sum();
            own().next().is_some().then_some(sum)
        });
        let mut total = 0.0;
        for group in parts.chunk_by_mut(|a, b| a.name == b.name) {
            let largest = group.iter().map(|part| weights.of(part.element)).fold(0.0, f64::max);
            let counts = largest * group[0].normalised * group[0].weight;
            let num_elements = group.iter().filter(|part| weights.of(part.element) > 0.0).count();
            for part in group.iter_mut().filter(|part| weights.of(part.element) > 0.0) {
                part.share = counts / num_elements as f64;
            }
            total += counts;
        }
        for part in &mut parts {
            part.share = if total > 0.0 { part.share / total } else { 0.0 };
        }
        Self { total, elements, parts }
    }

    /// Divides every total and every part's weight by `whole`, which must be above 0.
    #[must_use]
    pub fn in_shares_of(mut self, whole: f64) -> Self {
        self.total /= whole;
        for element in self.elements.iter_mut().flatten() {
            *element /= whole;
        }
        for part in &mut self.parts {
            part.weight /= whole;
        }
        self
    }

    /// The distance in one element (for a fine element, in its coarse one); `None` if nothing could differ.
    pub fn element(&self, element: Element) -> Option<f64> {
        self.elements[position(element)]
    }

    /// The distance in one element, 0 if nothing in it could differ; without an element, the total.
    pub fn within(&self, element: Option<Element>) -> f64 {
        element.map_or(self.total, |element| self.element(element).unwrap_or(0.0))
    }

    /// The elements with a distance above 0.
    pub fn differs_in(&self) -> Vec<Element> {
        let differs = |element: &Element| self.element(*element).is_some_and(|distance| distance > 0.0);
        Element::ALL.into_iter().filter(differs).collect()
    }
}

/// Serialises the elements under their names, in order.
fn by_name<S: serde::Serializer>(elements: &[Option<f64>; 5], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(Element::ALL.iter().map(|element| element.name()).zip(elements))
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

    /// Weight 1 for one element and 0 for all others.
    fn only(element: Element) -> Weights {
        Weights(Element::ALL.map(|other| f64::from(u8::from(other == element))))
    }

    #[test]
    fn parts_add_up_to_elements_and_total() {
        let mut parts = vec![
            part(Element::R, 1.0, 1.0),
            part(Element::R, 0.0, 3.0),
            part(Element::O, 0.5, 2.0),
            part(Element::T, 0.7, 0.0),
        ];
        for (part, name) in parts.iter_mut().zip(["a", "b", "c", "d"]) {
            name.clone_into(&mut part.name);
        }
        let weights = Weights::default().with(Element::O, 3.0).unwrap();
        let distance = Distance::new(parts, &weights);
        assert_eq!(distance.elements, [None, None, None, Some(1.0), Some(1.0)]);
        assert_eq!(distance.total, 4.0);
        assert_eq!(distance.differs_in(), [Element::R, Element::O]);
        let shares: Vec<f64> = distance.parts.iter().map(|part| part.share).collect();
        assert_eq!(shares, [0.25, 0.0, 0.75, 0.0]);
    }

    #[test]
    fn part_of_two_elements_counts_once_in_the_total() {
        let parts = vec![part(Element::S, 0.5, 1.0), part(Element::O, 0.5, 1.0)];
        let distance = Distance::new(parts.clone(), &Weights::default());
        assert_eq!((distance.total, distance.element(Element::S)), (0.5, Some(0.5)));
        assert_eq!(Distance::new(parts, &only(Element::O)).total, 0.5);
    }

    #[test]
    fn single_element_can_be_weighted_alone() {
        let parts = vec![part(Element::R, 1.0, 1.0), part(Element::O, 0.5, 1.0)];
        assert_eq!(Distance::new(parts.clone(), &only(Element::S)).total, 0.0);
        assert!(Weights::default().with(Element::R, f64::NAN).is_err());
        assert!(Weights::default().with(Element::R, -1.0).is_err());
    }
}
