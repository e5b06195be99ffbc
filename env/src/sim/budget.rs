//! Limits the work of a time step, so that no crowd of bodies can freeze it. The users of a budget (`slide.rs`,
//! `moving_body.rs`, `motion.rs` and `pushing.rs`) define what happens when it is used up.
//!
//! The unit is a query about one corner of one body. Queries are counted, not timed, so that a world runs the same on every
//! machine, alone or in a batch. Counts depend only on the positions of objects, so that a saved world resumes exactly. Worlds
//! with a few thousand bodies that are not crowded use a small part of the budget.

/// Queries for the agent's path in one time step. When they are used up, the path ends.
pub(super) const AGENTS: u64 = 4_000_000;

/// Queries per time step for all objects that move by themselves: a shared amount, plus an amount per object. An object for
/// which too few queries are left stays where it is in this time step.
pub(super) const MOVERS: u64 = 1_000_000;
pub(super) const PER_MOVER: u64 = 100;

/// Queries per time step for all objects that respawn: a shared amount, plus an amount per object. If the budget runs out before
/// an object's turn, the object respawns in a later time step.
pub(super) const RETURNS: u64 = 500_000;
pub(super) const PER_RETURN: u64 = 20;

/// The number of remaining queries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    left: u64,
}

impl Budget {
    pub(super) fn new(count: u64) -> Self {
        Self { left: count }
    }

    /// Takes `count` queries; if there are fewer, returns false and leaves none.
    pub(super) fn take(&mut self, count: usize) -> bool {
        let rest = self.left.checked_sub(count as u64);
        self.left = rest.unwrap_or(0);
        rest.is_some()
    }

    /// The number of remaining queries.
    pub(super) fn left(self) -> u64 {
        self.left
    }
}

/// Queries for a queue whose order never changes. Half of them are reserved for the rear of the queue, starting at a position
/// that changes with every time step, so that no body waits forever behind the same crowd.
#[derive(Clone, Copy, Debug)]
pub(super) struct SharedBudget {
    budget: Budget,
    reserved: u64,
    /// Position from which the reserved half is available.
    from: usize,
}

impl SharedBudget {
    /// A budget of `count` queries for this time step, shared by the `waiting` objects in the queue.
    pub(super) fn new(count: u64, waiting: usize, tick: u64) -> Self {
        /// A prime, so that every position gets its turn, and neighbours do not follow each other.
        const TURN: u64 = 7919;
        let waiting = waiting.max(1) as u64;
        let turn = if waiting.is_multiple_of(TURN) { 1 } else { TURN };
        Self {
            budget: Budget::new(count - count / 2),
            reserved: count / 2,
            from: (tick % waiting * turn % waiting) as usize,
        }
    }

    /// The budget for a position in the queue; positions must be requested in ascending order.
    pub(super) fn at(&mut self, position: usize) -> &mut Budget {
        if position >= self.from {
            self.budget.left += std::mem::take(&mut self.reserved);
        }
        &mut self.budget
    }

    /// The total number of remaining queries.
    #[cfg(test)]
    pub(super) fn left(self) -> u64 {
        self.budget.left + self.reserved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The total is never exceeded, and over several time steps everyone gets some queries.
        #[test]
        fn shared_budget_is_never_exceeded_and_starves_nobody(
            count in 2u64..500,
            wants in prop::collection::vec(1usize..60, 1..40),
        ) {
            let mut served = vec![false; wants.len()];
            for tick in 0..wants.len() as u64 * 20 {
                let mut shared = SharedBudget::new(count, wants.len(), tick);
                let mut taken = 0;
                for (position, want) in wants.iter().enumerate() {
                    if shared.at(position).take(*want) {
                        taken += *want as u64;
                        served[position] = true;
                    }
                }
                prop_assert!(taken + shared.left() <= count);
            }
            let reserved = count / 2;
            for (want, served) in wants.iter().zip(served) {
                prop_assert!(served || *want as u64 > reserved, "{want} of {count}");
            }
        }
    }
}
