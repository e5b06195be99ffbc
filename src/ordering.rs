//! [`OrderRequest`]: how to order variants, with the first and last given by name.

use std::str::FromStr;

use clap::Args;
use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, Ordering, SimilarityError, order};
use driftworld_spec::did_you_mean;
use driftworld_text::{WordKind, first_of, removed};
use serde::Deserialize;

use crate::{Failure, argument, request, tasks};

/// Maximum number of labels in a message.
const MAX_LISTED: usize = 20;

/// How an order is found.
#[derive(Args, Clone, Debug, Default, Deserialize)]
#[group(skip)]
#[serde(default, deny_unknown_fields)]
pub struct OrderRequest {
    /// Order of the variants [default: the shortest path; exact for up to 15 variants].
    ///
    /// By purpose: gradual (the shortest path, with the smallest largest step among equals), outward (by growing distance
    /// from the first), abrupt (the longest path), path (the shortest path), farthest (each time the variant farthest from
    /// all before it), named (as given). Or a method: nearest, exact, two-opt, random, target-step, given.
    #[arg(long, value_name = "ORDER")]
    #[serde(deserialize_with = "request::word")]
    pub order: Option<OrderWord>,
    /// The ordering method, given separately from `order`.
    #[arg(skip)]
    #[serde(deserialize_with = "request::word")]
    pub method: Option<Method>,
    /// First variant, such as blue [default: the one named first, or the best one of a whole task].
    #[arg(long, value_name = "VARIANT")]
    pub start: Option<String>,
    /// Last variant [default: whichever is best].
    #[arg(long, value_name = "VARIANT")]
    pub end: Option<String>,
    /// Step between neighbours for the order target-step.
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true)]
    pub target_step: Option<f64>,
}

/// An order of variants by purpose, with its method; `None` for the shortest path, whose method depends on the number of items.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DesignOrder(pub Option<Method>);

impl DesignOrder {
    /// In the given order, whatever the distances.
    pub const NAMED: Self = Self(Some(Method::Given));

    /// The orders, each with its word.
    pub const WORDS: [(&'static str, Self); 6] = [
        // Small steps: the shortest path from the first; of equally short ones, the one whose largest step is smallest.
        ("gradual", Self(Some(Method::Gradual))),
        // By growing distance from the first: the most different ones come last.
        ("outward", Self(Some(Method::Outward))),
        // The longest path from the first: neighbours are as different as possible.
        ("abrupt", Self(Some(Method::Abrupt))),
        // The shortest path from the first: neighbours are as similar as possible.
        ("path", Self(None)),
        // Greedy: the next variant is always the farthest from all before it.
        ("farthest", Self(Some(Method::Farthest))),
        ("named", Self::NAMED),
    ];
}

/// Values of `--order`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OrderWord {
    /// An order by purpose.
    Design(DesignOrder),
    /// A method.
    Method(Method),
}

impl FromStr for OrderWord {
    type Err = String;

    fn from_str(word: &str) -> Result<Self, String> {
        if let Some((_, design)) = DesignOrder::WORDS.iter().find(|(name, _)| *name == word) {
            return Ok(Self::Design(*design));
        }
        word.parse().map(Self::Method).map_err(|_| {
            if let Some(advice) = removed(WordKind::Order, word) {
                return advice;
            }
            let designs = DesignOrder::WORDS.map(|(name, _)| name);
            let methods = Method::ALL.iter().map(|method| method.name());
            let methods: Vec<&str> = methods.filter(|name| !designs.contains(name)).collect();
            let near = did_you_mean(word, designs.iter().chain(&methods).copied());
            format!(
                "expected one of {}, or a method: {}{near}",
                designs.join(", "),
                methods.join(", ")
            )
        })
    }
}

impl OrderRequest {
    /// The requested order by purpose, if any.
    pub(crate) fn purpose(&self) -> Option<DesignOrder> {
        match self.order {
            Some(OrderWord::Design(order)) => Some(order),
            _ => None,
        }
    }

    /// The requested method, if any.
    pub(crate) fn own_method(&self) -> Option<Method> {
        match self.order {
            Some(OrderWord::Method(method)) => Some(method),
            _ => self.method,
        }
    }

    /// The requested method, or else the method for the requested purpose, or else the default.
    fn method(&self, items: usize) -> Method {
        let of_purpose = || self.purpose().and_then(|order| order.0);
        let method = self.own_method().or_else(of_purpose);
        method.unwrap_or_else(|| Method::default_for(items))
    }

    /// The same request, with the first and last variants named as in a matrix.
    pub(crate) fn labelled(&self) -> Self {
        Self {
            start: self.start.as_deref().map(tasks::label_of),
            end: self.end.as_deref().map(tasks::label_of),
            ..self.clone()
        }
    }

    /// The order of a matrix's items, and the method that found it. `seed` is the random method's seed.
    pub(crate) fn order(&self, matrix: &DistanceMatrix, seed: u64) -> Result<(Method, Ordering), Failure> {
        let method = self.method(matrix.len());
        if self.target_step.is_some() && method != Method::TargetStep {
            return Err(Failure::usage(format!(
                "{}: found with the order {}, expected the order {}, the only one that uses it",
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

    /// Like [`Self::order`], but if no start is given, starts at whichever variant of the first of the `named` tasks gives the
    /// shortest path. The matrix has the variants of the names in order, each once.
    pub(crate) fn order_from(
        &self,
        matrix: &DistanceMatrix,
        seed: u64,
        named: &[String],
    ) -> Result<(Method, Ordering), Failure> {
        let method = self.method(matrix.len());
        let of_first = named.first().and_then(|first| tasks::variants(first).ok());
        let starts = of_first.map_or(0, |variants| variants.len());
        if self.start.is_some() || !method.seeks_from_a_first() || starts == 0 || starts >= matrix.len() {
            return self.order(matrix, seed);
        }
        let last = self.options(matrix, seed)?.last;
        let mut best: Option<(Method, Ordering)> = None;
        // The requested last item cannot also be the first.
        for first in (0..starts).filter(|first| Some(*first) != last) {
            let from = Self {
                start: Some(matrix.labels()[first].clone()),
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
                    first_of(matrix.labels(), MAX_LISTED)
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

/// The index of a label, found by the full label, or by the variant's name alone if that is unique.
///
/// # Errors
/// If the label is unknown or ambiguous; returns a remark to insert in the error message.
pub(crate) fn position_of<S: AsRef<str>>(labels: &[S], name: &str) -> Result<usize, &'static str> {
    if let Some(index) = labels.iter().position(|label| label.as_ref() == name) {
        return Ok(index);
    }
    // A task given by its path may also be named without it.
    if name.contains('#') {
        let is_same = |label: &S| bare(label.as_ref()) == bare(name) && tasks::label_of(label.as_ref()) == name;
        return labels.iter().position(is_same).ok_or("");
    }
    let mut found = labels
        .iter()
        .enumerate()
        .filter(|(_, label)| bare(label.as_ref()) == name);
    match (found.next(), found.next()) {
        (Some((index, _)), None) => Ok(index),
        (Some(_), Some(_)) => Err(", which several tasks have"),
        _ => Err(""),
    }
}

/// The name of a variant without its task.
pub(crate) fn bare(label: &str) -> &str {
    label.rsplit_once('#').map_or(label, |(_, variant)| variant)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_word_names_an_order_by_purpose_or_method() {
        assert_eq!(
            "abrupt".parse(),
            Ok(OrderWord::Design(DesignOrder(Some(Method::Abrupt))))
        );
        assert_eq!("two-opt".parse(), Ok(OrderWord::Method(Method::TwoOpt)));
        for method in Method::ALL {
            assert!(method.name().parse::<OrderWord>().is_ok(), "{}", method.name());
        }
        let refused = "gradul".parse::<OrderWord>().expect_err("there is none");
        assert!(refused.ends_with("did you mean \"gradual\"?"), "{refused}");
    }
}
