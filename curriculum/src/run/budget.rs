//! [`Budget`]: regimes that end after so many decisions. How many experiences these have is known once they are run.

use super::plan::Plan;

/// Which experiences of a block are run, from how long those before them took.
///
/// An experience of a regime with a budget begins if fewer decisions than that were made in the regime until then. Where several
/// environments run (the plan's lanes), each begins the next experience as soon as it is free; what is under way is run to its end.
#[derive(Debug, Default)]
pub(super) struct Budget {
    block: usize,
    /// When each environment begins and ends its last experience, in steps from the start of the block, and the regime of it.
    lanes: Vec<(u64, u64, usize)>,
    /// Decisions in all experiences of each regime of the block, by their indices in the plan.
    sums: Vec<(usize, u64)>,
}

impl Budget {
    /// Takes an experience into account that is over.
    pub(super) fn count(&mut self, plan: &Plan, number: u64, steps: u64) {
        let regime = plan.regime_of(number);
        if !plan.has_budgets(plan.regimes[regime].block) {
            return;
        }
        self.enter(plan, regime);
        if self.lanes.len() < plan.lanes {
            self.lanes.push((0, steps, regime));
        } else if let Some(lane) = self.lanes.iter_mut().min_by_key(|lane| lane.1) {
            *lane = (lane.1, lane.1 + steps, regime);
        }
        match self.sums.iter_mut().find(|sum| sum.0 == regime) {
            Some(sum) => sum.1 += steps,
            None => self.sums.push((regime, steps)),
        }
    }

    /// The first experience from `number` on that is run.
    pub(super) fn next(&mut self, plan: &Plan, mut number: u64) -> u64 {
        while number < plan.num_experiences() {
            let regime = plan.regime_of(number);
            let Some(budget) = plan.regimes[regime].steps else {
                break;
            };
            self.enter(plan, regime);
            if self.decisions(plan, regime) < u64::from(budget) {
                break;
            }
            number = plan.after(number);
        }
        number
    }

    /// Decisions made in a regime until an environment is free.
    fn decisions(&self, plan: &Plan, regime: usize) -> u64 {
        let sum = self.sums.iter().find(|sum| sum.0 == regime).map_or(0, |sum| sum.1);
        let free = self.lanes.iter().map(|lane| lane.1).min().unwrap_or(0);
        let now = if self.lanes.len() < plan.lanes { 0 } else { free };
        let of_regime = self.lanes.iter().filter(|lane| lane.2 == regime);
        sum - of_regime.map(|lane| lane.1 - now.max(lane.0)).sum::<u64>()
    }

    /// In a new block all environments are free.
    fn enter(&mut self, plan: &Plan, regime: usize) {
        let block = plan.regimes[regime].block;
        if self.block != block {
            *self = Self {
                block,
                ..Self::default()
            };
        }
    }
}
