//! [`OrderArgs`]: the options by which an order is found, for every command that orders. What is done with it is theirs.

use crate::similarity::{DistanceMatrix, Method, OrderOptions, Ordering, SimilarityError, order};
use clap::Args;

use super::Failure;

/// How an order is found; shared with `curriculum`.
#[derive(Args)]
pub(crate) struct OrderArgs {
    /// The method: nearest, exact (up to 15 variants), two-opt, spectral, tree, leaf, contrast, typical-last, farthest-first,
    /// random, bottleneck, target-step or given; exact where possible if none is given, else two-opt.
    #[arg(long)]
    pub(crate) method: Option<Method>,
    /// The variant that comes first; whichever is best if none is given.
    #[arg(long, value_name = "TASK#VARIANT")]
    pub(crate) start: Option<String>,
    /// The variant that comes last; whichever is best if none is given.
    #[arg(long, value_name = "TASK#VARIANT")]
    pub(crate) end: Option<String>,
    /// The step that the method target-step wants between neighbours.
    #[arg(long, value_name = "DISTANCE")]
    pub(crate) target_step: Option<f64>,
}

impl OrderArgs {
    /// The order of a matrix's items, and the method that found it. `seed` is what the method random draws from.
    pub(crate) fn order(&self, matrix: &DistanceMatrix, seed: u64) -> Result<(Method, Ordering), Failure> {
        let method = self.method.unwrap_or_else(|| Method::default_for(matrix.len()));
        let options = self.options(matrix, seed)?;
        let ordering = order(matrix, method, &options).map_err(|error| match error {
            SimilarityError::BadTargetStep { .. } => Failure::usage(format!("{error}; give it with --target-step")),
            other => other.into(),
        })?;
        Ok((method, ordering))
    }

    /// The same, from whichever of some items makes the shortest path, where neither end is asked for.
    pub(crate) fn order_from(
        &self,
        matrix: &DistanceMatrix,
        seed: u64,
        firsts: &[usize],
    ) -> Result<(Method, Ordering), Failure> {
        if self.start.is_some() || firsts.is_empty() || firsts.len() == matrix.len() {
            return self.order(matrix, seed);
        }
        let last = self.options(matrix, seed)?.last;
        let mut best: Option<(Method, Ordering)> = None;
        // What was asked for as the last cannot be the first, too.
        for first in firsts.iter().filter(|first| Some(**first) != last) {
            let from = Self {
                method: self.method,
                start: Some(matrix.labels()[*first].clone()),
                end: self.end.clone(),
                target_step: self.target_step,
            };
            let found = from.order(matrix, seed)?;
            if best.as_ref().is_none_or(|(_, best)| found.1.length < best.length) {
                best = Some(found);
            }
        }
        best.map_or_else(|| self.order(matrix, seed), Ok)
    }

    /// The options that hold for every method.
    pub(crate) fn options(&self, matrix: &DistanceMatrix, seed: u64) -> Result<OrderOptions, Failure> {
        let position = |option: &str, name: &String| {
            let found = matrix.labels().iter().position(|label| label == name);
            found.ok_or_else(|| Failure::input(format!("{option}: found {name:?}, expected one of {}", some(matrix))))
        };
        let first = self.start.as_ref().map(|name| position("--start", name)).transpose()?;
        let last = self.end.as_ref().map(|name| position("--end", name)).transpose()?;
        Ok(OrderOptions {
            first,
            last,
            seed,
            target_step: self.target_step,
        })
    }
}

/// The labels, or as many as a message can hold.
fn some(matrix: &DistanceMatrix) -> String {
    const MOST: usize = 20;
    let shown = &matrix.labels()[..matrix.len().min(MOST)];
    let rest = matrix.len() - shown.len();
    let more = if rest > 0 {
        format!(" and {rest} more")
    } else {
        String::new()
    };
    shown.join(", ") + &more
}
