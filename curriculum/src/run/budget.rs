//! [`Budget`]: ends regimes after a number of decisions. Their number of experiences is then known only once they have run.

use super::plan::Plan;

/// Decides which experiences of a block are run, from the lengths of those before them.
///
/// In a regime with a budget, an experience begins only while the regime's decisions so far are below it. With several
/// environments (the plan's lanes), each begins the next experience as soon as it is free; experiences in progress run to their
/// end.
#[derive(Debug, Default)]
pub(super) struct Budget {
    block: usize,
    /// Start and end of each environment's last experience, in steps since the start of the block, and its regime.
    lanes: Vec<(u64, u64, usize)>,
    /// Decisions in all experiences of each regime of the block, by the regime's index in the plan.
    sums: Vec<(usize, u64)>,
}

impl Budget {
    /// Counts a finished experience.
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

    /// The first experience at or after `number` that the budgets allow.
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

    /// Decisions made in a regime by the time an environment becomes free.
    fn decisions(&self, plan: &Plan, regime: usize) -> u64 {
        let sum = self.sums.iter().find(|sum| sum.0 == regime).map_or(0, |sum| sum.1);
        let free = self.lanes.iter().map(|lane| lane.1).min().unwrap_or(0);
        let now = if self.lanes.len() < plan.lanes { 0 } else { free };
        let of_regime = self.lanes.iter().filter(|lane| lane.2 == regime);
        sum - of_regime.map(|lane| lane.1 - now.max(lane.0)).sum::<u64>()
    }

    /// Starts a new block, in which all environments are free.
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
