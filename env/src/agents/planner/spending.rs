//! Decides which doors to spend single-use keys on, by a bounded search, since spending a key cannot be undone. Everything else
//! can be done at any time; `plan.rs` finds it in rounds.

use std::collections::{BTreeSet, VecDeque};

use super::goals::Goal;
use super::plan::{Plan, Way};

/// Maximum number of door choices to compare, starting with those that spend the fewest keys; if there are more, the best of
/// these wins.
const MOST_CHOICES: usize = 1000;

/// The worth of a plan, most important first: whether it reaches a success, how much it earns, how many successful endings it
/// can reach.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Worth {
    succeeds: bool,
    pay: f64,
    num_endings: usize,
    /// How many rewarding zones it can reach.
    num_zones: usize,
}

impl Plan<'_> {
    /// Spends keys on the choice of doors that makes the plan worth most; ties go to the choice with the fewest keys.
    pub(super) fn with_keys_spent(self, goals: &[Vec<Goal>; 3]) -> Self {
        let mut next = self.spendings();
        if next.is_empty() {
            return self;
        }
        let mut worth = self.worth(goals);
        let mut best = self.clone();
        let mut waiting = VecDeque::from([self]);
        let mut seen = BTreeSet::new();
        while let Some(plan) = waiting.pop_front() {
            next.clear();
            next.extend(plan.spendings());
            for way in &next {
                let mut other = plan.clone();
                other.take(*way);
                other.open_what_is_free();
                if !seen.insert(other.spent()) {
                    continue;
                }
                if seen.len() > MOST_CHOICES {
                    return best;
                }
                let of_other = other.worth(goals);
                if of_other > worth {
                    (worth, best) = (of_other, other.clone());
                }
                waiting.push_back(other);
            }
        }
        best
    }

    /// The doors that only a single-use key opens.
    fn spendings(&self) -> Vec<Way> {
        let mut ways = self.ways_through();
        ways.retain(|way| way.spends.is_some());
        ways
    }

    /// The doors that keys were spent on, and those keys, each sorted.
    fn spent(&self) -> [Vec<u32>; 2] {
        let ways = || self.ways.iter().filter(|way| way.spends.is_some());
        let mut spent: [Vec<u32>; 2] = [
            ways().map(|way| way.door).collect(),
            ways().filter_map(|way| way.spends).collect(),
        ];
        for list in &mut spent {
            list.sort_unstable();
        }
        spent
    }

    fn worth(&self, [paying, others, held]: &[Vec<Goal>; 3]) -> Worth {
        let spent = self.spent();
        let is_possible = |goal: &&Goal| self.first(**goal).is_some();
        // A thing needed for success must not be spent first.
        let can_end = |goal: &&Goal| is_possible(goal) && !spent[1].contains(&goal.object());
        let endings = || others.iter().chain(held);
        let is_one_of_many = |goal: &&Goal| matches!(goal, Goal::Bring { .. });
        let is_delivered =
            endings().any(|goal| is_one_of_many(&goal)) && endings().filter(is_one_of_many).all(|goal| can_end(&goal));
        let pay = |goal: &Goal| {
            let index = goal.object() as usize;
            self.sim.objects()[index].reward.max(0.0) * self.sim.world.objects[index].reward_probability
        };
        let zones = || {
            let wanted = self.sim.world.environment_params.zones.iter().enumerate();
            let wanted = wanted.filter(|(_, zone)| zone.is_wanted());
            wanted.filter(|(index, zone)| self.zone_entered(*index, zone).is_some())
        };
        let ends_in_zone = || zones().any(|(_, zone)| zone.ends.is_some());
        Worth {
            succeeds: is_delivered
                || ends_in_zone()
                || endings()
                    .filter(|goal| !is_one_of_many(goal))
                    .any(|goal| can_end(&goal)),
            // The constant counts goals that pay nothing themselves, such as objects touched only for a success.
            pay: paying.iter().filter(is_possible).map(|goal| 1e-6 + pay(goal)).sum(),
            num_endings: endings().filter(can_end).count(),
            num_zones: zones().count(),
        }
    }
}
