//! Decides by a bounded search on which doors to spend single-use keys, since spending a key cannot be undone. `plan.rs`
//! handles everything that costs no key.

use std::collections::{BTreeSet, VecDeque};

use super::goals::Goal;
use super::plan::{DoorStep, Plan};

/// Maximum number of door choices to compare, starting with those that spend the fewest keys. If there are more, the best of
/// these wins.
const MAX_CHOICES: usize = 1000;

/// The worth of a plan; fields are compared in order.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Worth {
    /// Whether it reaches a success.
    succeeds: bool,
    /// Sum of the expected rewards that it can reach.
    pay: f64,
    /// How many goals that lead to a success it can reach.
    num_endings: usize,
    /// How many rewarding zones it can reach.
    num_zones: usize,
}

impl Plan<'_> {
    /// Spends keys on the doors that make the plan worth most; ties go to the choice with the fewest keys.
    pub(super) fn with_keys_spent(self, goals: &[Vec<Goal>; 3]) -> Self {
        let mut next = self.doors_for_single_use_keys();
        if next.is_empty() {
            return self;
        }
        let mut worth = self.worth(goals);
        let mut best = self.clone();
        let mut queue = VecDeque::from([self]);
        let mut seen = BTreeSet::new();
        while let Some(plan) = queue.pop_front() {
            next.clear();
            next.extend(plan.doors_for_single_use_keys());
            for step in &next {
                let mut other = plan.clone();
                other.add_door(*step);
                other.open_free_doors();
                if !seen.insert(other.spent()) {
                    continue;
                }
                if seen.len() > MAX_CHOICES {
                    return best;
                }
                let of_other = other.worth(goals);
                if of_other > worth {
                    (worth, best) = (of_other, other.clone());
                }
                queue.push_back(other);
            }
        }
        best
    }

    /// The doors that only a single-use key opens.
    fn doors_for_single_use_keys(&self) -> Vec<DoorStep> {
        let mut steps = self.openable_doors();
        steps.retain(|step| step.spends.is_some());
        steps
    }

    /// The doors that keys were spent on, and those keys, each sorted.
    fn spent(&self) -> [Vec<u32>; 2] {
        let steps = || self.steps.iter().filter(|step| step.spends.is_some());
        let mut spent: [Vec<u32>; 2] = [
            steps().map(|step| step.door).collect(),
            steps().filter_map(|step| step.spends).collect(),
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
        let is_delivery = |goal: &&Goal| matches!(goal, Goal::Bring { .. });
        let is_delivered =
            endings().any(|goal| is_delivery(&goal)) && endings().filter(is_delivery).all(|goal| can_end(&goal));
        let pay = |goal: &Goal| {
            let index = goal.object() as usize;
            self.sim.objects()[index].reward.max(0.0) * self.sim.world.objects[index].reward_probability
        };
        let zones = || {
            let wanted = self.sim.world.environment_params.zones.iter().enumerate();
            let wanted = wanted.filter(|(_, zone)| zone.is_wanted());
            wanted.filter(|(index, zone)| self.subgoal_to_enter(*index, zone).is_some())
        };
        let ends_in_zone = || zones().any(|(_, zone)| zone.ends.is_some());
        Worth {
            succeeds: is_delivered
                || ends_in_zone()
                || endings().filter(|goal| !is_delivery(goal)).any(|goal| can_end(&goal)),
            // The constant counts goals that pay nothing themselves, such as objects touched only for a success.
            pay: paying.iter().filter(is_possible).map(|goal| 1e-6 + pay(goal)).sum(),
            num_endings: endings().filter(can_end).count(),
            num_zones: zones().count(),
        }
    }
}
