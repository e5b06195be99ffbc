//! [`Sequence`]: the order in which objects must be collected, and which one is due.

use driftworld_spec::Object;

/// The objects of a sequence in order, and the position of the first one that has not been collected.
#[derive(Clone, Debug, Default)]
pub(super) struct Sequence {
    /// Order number and object, in ascending order.
    entries: Vec<(u32, u32)>,
    /// Index of the first entry that has not been collected.
    next: usize,
}

impl Sequence {
    /// The sequence of a world at its start.
    pub(super) fn of(objects: &[Object]) -> Self {
        let ordered = objects.iter().zip(0..);
        let mut entries: Vec<(u32, u32)> = ordered
            .filter_map(|(object, index)| object.order.map(|order| (order, index)))
            .collect();
        entries.sort_unstable();
        Self { entries, next: 0 }
    }

    /// Adds an uncollected object, if it has an order number.
    pub(super) fn add(&mut self, index: usize, order: Option<u32>) {
        let Some(order) = order else { return };
        let own = (order, index as u32);
        let index = self.entries.partition_point(|other| *other < own);
        self.entries.insert(index, own);
        self.next = self.next.min(index);
    }

    /// Updates the sequence after objects were collected. Objects never become uncollected.
    pub(super) fn advance(&mut self, is_collected: impl Fn(usize) -> bool) {
        let is_done = |(_, index): &(u32, u32)| is_collected(*index as usize);
        while self.entries.get(self.next).is_some_and(is_done) {
            self.next += 1;
        }
    }

    /// Whether all objects with a lower order number have been collected.
    pub(super) fn is_due(&self, order: Option<u32>) -> bool {
        let first = self.entries.get(self.next);
        order.is_none_or(|own| first.is_none_or(|(first, _)| own <= *first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// Compares with the definition: every object with a lower order number has been collected.
        #[test]
        fn object_is_due_once_all_lower_numbers_are_collected(
            orders in prop::collection::vec(prop::option::of(1u32..6), 1..12),
            spawned in prop::collection::vec((0usize..30, prop::option::of(1u32..6)), 0..6),
            collected in prop::collection::vec(0usize..18, 0..30),
        ) {
            let object = |order: &Option<u32>| {
                let mut object = Object::new("coin", [0.0; 2]);
                object.order = *order;
                object
            };
            let mut objects: Vec<Object> = orders.iter().map(object).collect();
            let mut is_collected = vec![false; objects.len()];
            let mut sequence = Sequence::of(&objects);
            for (moment, index) in collected.into_iter().enumerate() {
                for (_, order) in spawned.iter().filter(|(at, _)| *at == moment) {
                    objects.push(object(order));
                    is_collected.push(false);
                    sequence.add(objects.len() - 1, *order);
                }
                if let Some(own) = is_collected.get_mut(index) {
                    *own = true;
                }
                sequence.advance(|index| is_collected[index]);
                for own in &objects {
                    let lower = |other: &Object| other.order.zip(own.order).is_some_and(|(other, own)| other < own);
                    let expected = objects.iter().zip(&is_collected).all(|(other, is_done)| !lower(other) || *is_done);
                    prop_assert_eq!(sequence.is_due(own.order), expected);
                }
            }
        }
    }
}
