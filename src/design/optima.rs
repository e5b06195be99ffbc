//! [`PairOptimum`]: of a probe of the reward, from which variant to which what is best changes. Experts are exchanged by
//! `behavior`.

use driftworld_spec::Element;

use super::{Chosen, DesignRequest, Evidence};
use crate::Failure;
use crate::elements::Optimum;

/// More variants than these are compared with their neighbours only.
const MOST_WITH_ALL: usize = 8;

/// In how many pairs of worlds experts are exchanged.
const WORLDS: u64 = 16;

/// Whether two variants ask for other behaviour.
#[derive(Clone, Debug, PartialEq)]
pub struct PairOptimum {
    /// The variant that is met first.
    pub a: String,
    /// The other.
    pub b: String,
    /// What the expert of `a` loses in worlds of `b`, and the reverse.
    pub optimum: Optimum,
}

impl DesignRequest {
    /// Whether what is best changes from variant to variant of a probe of the reward: of each pair, or of neighbours in the
    /// order where there are more than eight variants. Empty of other designs, and where no worlds are to be drawn.
    ///
    /// # Errors
    /// [`Failure`] where a world cannot be drawn.
    pub fn optima(&self, chosen: &Chosen) -> Result<Vec<PairOptimum>, Failure> {
        let Some(Evidence::Probe { picked, element }) = &chosen.evidence else {
            return Ok(Vec::new());
        };
        if *element != Element::R || self.worlds == 0 {
            return Ok(Vec::new());
        }
        let (catalogue, order) = (self.catalogue()?, &chosen.order);
        let mut found = Vec::new();
        for place in 1..order.len() {
            let first = if order.len() > MOST_WITH_ALL { place - 1 } else { 0 };
            for other in first..place {
                let [a, b] = [&picked[order[other]], &picked[order[place]]];
                found.push(PairOptimum {
                    a: a.choice.id(),
                    b: b.choice.id(),
                    optimum: Optimum::tried(&a.variant, &b.variant, self.design.seed, WORLDS, &catalogue)?,
                });
            }
        }
        Ok(found)
    }
}
