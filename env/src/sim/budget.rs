//! How much one time step may look at, so that no heap of bodies can freeze it. Who looks is in `slide.rs`,
//! `moving_body.rs`, `motion.rs` and `pushing.rs`; what each does when its budget is used up is said there.
//!
//! A look is a question about one corner of one body. Looks are counted and not timed: a world goes the same way on
//! every machine, alone or in a batch. What is counted depends on where things stand alone, so that a world that was
//! written down goes on to the last bit. Worlds of some thousand bodies that keep apart use a small part.

/// What the agent may look at on its way of one time step; then its way ends where it has come to.
pub(super) const AGENTS: u64 = 4_000_000;

/// What all objects that move by themselves may look at together in one time step, and on top of that for each of them.
/// Those for which too little is left wait.
pub(super) const MOVERS: u64 = 1_000_000;
pub(super) const EACH_MOVER: u64 = 100;

/// What all objects that come back may look at together in one time step, and on top of that for each of them. Those
/// for which nothing is left come back in a later one.
pub(super) const RETURNS: u64 = 500_000;
pub(super) const EACH_RETURN: u64 = 20;

/// Looks that are left.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    left: u64,
}

impl Budget {
    pub(super) fn new(count: u64) -> Self {
        Self { left: count }
    }

    /// Takes so many; false, and none is left, if there are fewer.
    pub(super) fn take(&mut self, count: usize) -> bool {
        let rest = self.left.checked_sub(count as u64);
        self.left = rest.unwrap_or(0);
        rest.is_some()
    }

    /// How many are left.
    pub(super) fn left(self) -> u64 {
        self.left
    }
}

/// Looks for which many wait in a row, always in the same order. Half of them is kept for those from a place on that
/// changes with each time step, so that nobody waits for ever behind the same crowd.
#[derive(Clone, Copy, Debug)]
pub(super) struct SharedBudget {
    budget: Budget,
    kept: u64,
    /// From which place on the kept half is given.
    from: usize,
}

impl SharedBudget {
    /// So many looks for `waiting` in a row, in this time step.
    pub(super) fn new(count: u64, waiting: usize, tick: u64) -> Self {
        /// A prime, so that every place has its turn, and neighbours do not have theirs one after another.
        const TURN: u64 = 7919;
        let waiting = waiting.max(1) as u64;
        let turn = if waiting.is_multiple_of(TURN) { 1 } else { TURN };
        Self {
            budget: Budget::new(count - count / 2),
            kept: count / 2,
            from: (tick % waiting * turn % waiting) as usize,
        }
    }

    /// The budget of the one at a place in the row; places are asked for in rising order.
    pub(super) fn at(&mut self, place: usize) -> &mut Budget {
        if place >= self.from {
            self.budget.left += std::mem::take(&mut self.kept);
        }
        &mut self.budget
    }

    /// How many are left in all.
    #[cfg(test)]
    pub(super) fn left(self) -> u64 {
        self.budget.left + self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// All take what they can: never more than there is, and over the time steps everyone gets some.
        #[test]
        fn nobody_takes_more_than_there_is_and_nobody_waits_for_ever(
            count in 2u64..500,
            wants in prop::collection::vec(1usize..60, 1..40),
        ) {
            let mut served = vec![false; wants.len()];
            for tick in 0..wants.len() as u64 * 20 {
                let mut shared = SharedBudget::new(count, wants.len(), tick);
                let mut taken = 0;
                for (place, want) in wants.iter().enumerate() {
                    if shared.at(place).take(*want) {
                        taken += *want as u64;
                        served[place] = true;
                    }
                }
                prop_assert!(taken + shared.left() <= count);
            }
            let most = count / 2;
            for (want, served) in wants.iter().zip(served) {
                prop_assert!(served || *want as u64 > most, "{want} of {count}");
            }
        }
    }
}
