//! Which doors keys are spent on that are gone once they have opened one: a bounded search, for such a step cannot be taken
//! back. All else a plan does can be done at any time, and is found in rounds in `plan.rs`.

use std::collections::{BTreeSet, VecDeque};

use super::plan::{Plan, Way};
use super::wishes::Wish;

/// The most choices of doors that are looked at; of more, the best among these is taken. Those that spend fewer keys come first.
const MOST_CHOICES: usize = 1000;

/// What a plan is good for, the more weighty first: whether it comes to a success, what it is paid, how much of what ends the
/// episode well it can do.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Worth {
    succeeds: bool,
    pay: f64,
    num_endings: usize,
    /// How many zones it comes to that are worth being in.
    num_zones: usize,
}

impl Plan<'_> {
    /// The plan with those keys spent, of all that can be, that are worth most; of equals the fewest.
    pub(super) fn with_keys_spent(self, wishes: &[Vec<Wish>; 3]) -> Self {
        let mut next = self.spendings();
        if next.is_empty() {
            return self;
        }
        let mut worth = self.worth(wishes);
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
                let of_other = other.worth(wishes);
                if of_other > worth {
                    (worth, best) = (of_other, other.clone());
                }
                waiting.push_back(other);
            }
        }
        best
    }

    /// The doors that only a key opens that is gone then.
    fn spendings(&self) -> Vec<Way> {
        let mut ways = self.ways_through();
        ways.retain(|way| way.spends.is_some());
        ways
    }

    /// The doors that keys were spent on, and these keys: each rising.
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

    fn worth(&self, [paying, others, held]: &[Vec<Wish>; 3]) -> Worth {
        let spent = self.spent();
        let can_be = |wish: &&Wish| self.first(**wish).is_some();
        // A thing that ends the episode well must not be spent before.
        let can_end = |wish: &&Wish| can_be(wish) && !spent[1].contains(&wish.object());
        let endings = || others.iter().chain(held);
        let is_one_of_many = |wish: &&Wish| matches!(wish, Wish::Bring { .. });
        let is_delivered =
            endings().any(|wish| is_one_of_many(&wish)) && endings().filter(is_one_of_many).all(|wish| can_end(&wish));
        let pay = |wish: &Wish| {
            let index = wish.object() as usize;
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
                    .filter(|wish| !is_one_of_many(wish))
                    .any(|wish| can_end(&wish)),
            // What is touched for a success may pay nothing.
            pay: paying.iter().filter(can_be).map(|wish| 1e-6 + pay(wish)).sum(),
            num_endings: endings().filter(can_end).count(),
            num_zones: zones().count(),
        }
    }
}
