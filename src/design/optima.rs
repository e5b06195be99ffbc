//! [`PairOptimum`]: in a design that probes the reward, whether the optimal behaviour changes between two variants.

use driftworld_spec::Element;

use super::{Chosen, DesignRequest, Evidence};
use crate::Failure;
use crate::elements::Optimum;

/// Maximum number of variants of which all pairs are compared; with more variants, only neighbours are.
const MAX_FOR_ALL_PAIRS: usize = 8;

/// Number of pairs of worlds in which experts are exchanged.
const WORLDS: u64 = 16;

/// Whether two variants call for different behaviour.
#[derive(Clone, Debug, PartialEq)]
pub struct PairOptimum {
    /// The variant that is learned first, such as `find_objects#red`.
    pub a: String,
    /// The other variant.
    pub b: String,
    /// The loss of `a`'s expert in worlds of `b`, and vice versa.
    pub optimum: Optimum,
}

impl DesignRequest {
    /// In a design that probes the reward, whether the optimal behaviour changes between variants: for each pair, or only for
    /// neighbours in the order if there are more than eight variants. Empty for other designs, and if no worlds are to be drawn.
    ///
    /// # Errors
    /// [`Failure`] if a world cannot be drawn.
    pub fn optima(&self, chosen: &Chosen) -> Result<Vec<PairOptimum>, Failure> {
        let Some(Evidence::Probe { picked, element }) = &chosen.evidence else {
            return Ok(Vec::new());
        };
        if *element != Element::R || self.worlds == 0 {
            return Ok(Vec::new());
        }
        let (catalogue, order) = (self.catalogue()?, &chosen.order);
        let mut found = Vec::new();
        for index in 1..order.len() {
            let first = if order.len() > MAX_FOR_ALL_PAIRS { index - 1 } else { 0 };
            for other in first..index {
                let [a, b] = [&picked[order[other]], &picked[order[index]]];
                found.push(PairOptimum {
                    a: a.label(),
                    b: b.label(),
                    optimum: Optimum::measure(&a.variant, &b.variant, self.seed, WORLDS, &catalogue)?,
                });
            }
        }
        Ok(found)
    }
}
