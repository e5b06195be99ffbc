//! [`OrderRequest`]: how variants are ordered, with the ends given by name.

use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, Ordering, SimilarityError, order};
use driftworld_spec::did_you_mean;
use driftworld_text::first_of;

use crate::{Failure, argument, tasks};

/// Maximum number of labels in a message.
const MOST_LISTED: usize = 20;

/// How an order is found.
#[derive(Clone, Debug, Default)]
pub struct OrderRequest {
    /// The method; by default exact if possible, else two-opt.
    pub method: Option<Method>,
    /// The first item; by default the best one.
    pub start: Option<String>,
    /// The last item; by default the best one.
    pub end: Option<String>,
    /// The target length of steps for the method target-step.
    pub target_step: Option<f64>,
}

impl OrderRequest {
    /// The order of a matrix's items, and the method that found it. `seed` is the random method's seed.
    pub(crate) fn order(&self, matrix: &DistanceMatrix, seed: u64) -> Result<(Method, Ordering), Failure> {
        let method = self.method.unwrap_or_else(|| Method::default_for(matrix.len()));
        if self.target_step.is_some() && method != Method::TargetStep {
            return Err(Failure::usage(format!(
                "{}: found with the order {}, expected the order {}, which alone keeps to it",
                argument("target_step"),
                <&str>::from(method),
                <&str>::from(Method::TargetStep)
            )));
        }
        let options = self.options(matrix, seed)?;
        let ordering = order(matrix, method, &options).map_err(|error| match error {
            SimilarityError::BadTargetStep { .. } => {
                Failure::usage(format!("{error}; give it with {}", argument("target_step")))
            }
            other => other.into(),
        })?;
        Ok((method, ordering))
    }

    /// Like [`Self::order`], but if no start is given, starts at whichever of `firsts` gives the shortest path.
    pub(crate) fn order_from(
        &self,
        matrix: &DistanceMatrix,
        seed: u64,
        firsts: &[usize],
    ) -> Result<(Method, Ordering), Failure> {
        let method = self.method.unwrap_or_else(|| Method::default_for(matrix.len()));
        if self.start.is_some() || !method.seeks_from_a_first() || firsts.is_empty() || firsts.len() == matrix.len() {
            return self.order(matrix, seed);
        }
        let last = self.options(matrix, seed)?.last;
        let mut best: Option<(Method, Ordering)> = None;
        // The requested last item cannot also be the first.
        for first in firsts.iter().filter(|first| Some(**first) != last) {
            let from = Self {
                start: Some(matrix.labels()[*first].clone()),
                ..self.clone()
            };
            let found = from.order(matrix, seed)?;
            if best.as_ref().is_none_or(|(_, best)| found.1.length < best.length) {
                best = Some(found);
            }
        }
        best.map_or_else(|| self.order(matrix, seed), Ok)
    }

    /// The options shared by all methods.
    pub(crate) fn options(&self, matrix: &DistanceMatrix, seed: u64) -> Result<OrderOptions, Failure> {
        let position = |option: &str, name: &String| {
            position_of(matrix.labels(), name).map_err(|found| {
                let near = did_you_mean(name, matrix.labels().iter().map(|label| bare(label)));
                Failure::input(format!(
                    "{}: found {name:?}{found}, expected one of {}{near}",
                    argument(option),
                    first_of(matrix.labels(), MOST_LISTED)
                ))
            })
        };
        let first = self.start.as_ref().map(|name| position("start", name)).transpose()?;
        let last = self.end.as_ref().map(|name| position("end", name)).transpose()?;
        Ok(OrderOptions {
            first,
            last,
            seed,
            target_step: self.target_step,
        })
    }
}

/// The index of a label, by the full label or by the variant's name alone if that is unique; otherwise a remark for the error
/// message.
pub(crate) fn position_of<S: AsRef<str>>(labels: &[S], name: &str) -> Result<usize, &'static str> {
    if let Some(place) = labels.iter().position(|label| label.as_ref() == name) {
        return Ok(place);
    }
    // A task given by its path may also be called by its name.
    if name.contains('#') {
        let is_it = |label: &S| bare(label.as_ref()) == bare(name) && tasks::label_of(label.as_ref()) == name;
        return labels.iter().position(is_it).ok_or("");
    }
    let mut found = labels
        .iter()
        .enumerate()
        .filter(|(_, label)| bare(label.as_ref()) == name);
    match (found.next(), found.next()) {
        (Some((place, _)), None) => Ok(place),
        (Some(_), Some(_)) => Err(", which several tasks have"),
        _ => Err(""),
    }
}

/// The name of a variant without its task.
pub(crate) fn bare(label: &str) -> &str {
    label.rsplit_once('#').map_or(label, |(_, variant)| variant)
}
