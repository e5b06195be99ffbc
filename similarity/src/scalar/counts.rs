//! Difference between counts per kind.

use std::collections::BTreeMap;

/// Share of things without a counterpart: Σ |aₖ − bₖ| / Σ max(aₖ, bₖ) over all kinds k; 0 if there is nothing.
///
/// A metric (Ruzicka's, the weighted form of Jaccard's), in `0..=1`, no unit. For a single kind, the difference as a share of
/// the larger count. Missing kinds count as 0. Time proportional to the number of kinds.
///
/// Source: Ruzicka 1958; the triangle inequality as for Jaccard, Kosub 2019.
///
/// # Example
/// ```
/// use driftworld_similarity::scalar::counts_distance;
/// use std::collections::BTreeMap;
/// let (a, b) = (BTreeMap::from([("tree", 4), ("rock", 1)]), BTreeMap::from([("tree", 3)]));
/// assert_eq!(counts_distance(&a, &b), 0.4);
/// ```
pub fn counts_distance<K: Ord>(a: &BTreeMap<K, usize>, b: &BTreeMap<K, usize>) -> f64 {
    let of = |counts: &BTreeMap<K, usize>, kind: &K| counts.get(kind).copied().unwrap_or(0);
    let only_b = b.iter().filter(|(kind, _)| !a.contains_key(kind));
    let pairs = a.iter().map(|(kind, &count)| (count, of(b, kind)));
    let (mut difference, mut total) = (0.0, 0.0);
    for (mine, theirs) in pairs.chain(only_b.map(|(_, &count)| (0, count))) {
        difference += mine.abs_diff(theirs) as f64;
        total += mine.max(theirs) as f64;
    }
    if total == 0.0 { 0.0 } else { difference / total }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn counts() -> impl Strategy<Value = BTreeMap<u8, usize>> {
        prop::collection::btree_map(0u8..4, 0usize..6, 0..4)
    }

    #[test]
    fn empty_counts_are_0_apart_and_1_from_any_other() {
        let (none, some) = (BTreeMap::from([(1, 0)]), BTreeMap::from([(1, 2)]));
        assert_eq!(counts_distance(&none, &BTreeMap::new()), 0.0);
        assert_eq!(counts_distance(&some, &BTreeMap::new()), 1.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn counts_distance_is_a_metric(a in counts(), b in counts(), c in counts()) {
            let d = counts_distance;
            prop_assert_eq!(d(&a, &a), 0.0);
            prop_assert_eq!(d(&a, &b), d(&b, &a));
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            prop_assert!((0.0..=1.0).contains(&d(&a, &b)));
        }
    }
}
