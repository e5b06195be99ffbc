//! `--weight reward=2`: weights of the decision process's elements in a distance.

use crate::similarity::{MAX_WEIGHT, SimilarityError, Weights};
use crate::spec::Element;
use clap::Args;

/// The option for weights of elements, shared by the commands that measure distances.
#[derive(Args, Clone, Default)]
pub(crate) struct WeightArgs {
    /// Weight of an element in the total distance, such as reward=2. Repeatable.
    ///
    /// Elements are state, action, transition, reward and observation. The weight overrides the task's own.
    #[arg(long, value_name = "ELEMENT=WEIGHT", value_parser = weight)]
    weight: Vec<(Element, f64)>,
}

impl WeightArgs {
    /// Overrides weights with these.
    pub(crate) fn over(&self, mut weights: Weights) -> Result<Weights, SimilarityError> {
        for (element, weight) in &self.weight {
            weights = weights.with(*element, *weight)?;
        }
        Ok(weights)
    }
}

fn weight(text: &str) -> Result<(Element, f64), String> {
    let expected = || "expected an element, then = and a number from 0 to 1000000, such as reward=2".to_owned();
    let (element, weight) = text.split_once('=').ok_or_else(expected)?;
    let weight: f64 = weight.parse().map_err(|_| expected())?;
    let element = crate::design::element(element)?;
    if (0.0..=MAX_WEIGHT).contains(&weight) {
        Ok((element, weight))
    } else {
        Err(expected())
    }
}
