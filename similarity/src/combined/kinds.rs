//! Distances between kinds of objects, cached per thread: worlds have many objects of few kinds.

use std::cell::RefCell;

use crate::combined::sketch::ObjectFeatures;

/// Number of pairs of kinds in a thread's cache; a power of 2.
const CACHE_SIZE: usize = 2048;

/// Difference in reward that counts as 1.
pub(super) const REWARD_UNIT: f64 = 100.0;

/// Weight of the reward in the cost of a match: just enough to break ties.
const TIE_BREAK: f64 = 1e-9;

/// The distance between two kinds of objects in each part that does not depend on position, heading or size.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct KindDistance {
    /// The kinds; 0 is none.
    of: [u64; 2],
    /// Cost of matching an object of one kind with one of the other.
    pub(super) cost: f64,
    pub(super) motion: f64,
    pub(super) body: f64,
    pub(super) reward: f64,
    pub(super) paid_for: f64,
    pub(super) odds: f64,
    pub(super) color: f64,
    pub(super) model: f64,
}

impl KindDistance {
    /// Measures without the cache. Rewards only break ties between otherwise equally cheap matches.
    pub(super) fn between(a: &ObjectFeatures, b: &ObjectFeatures) -> Self {
        let of = [a.kind, b.kind];
        if a.kind == b.kind {
            return Self { of, ..Self::default() };
        }
        let parts = Self {
            of,
            cost: 0.0,
            motion: a.motion.distance(&b.motion),
            body: a.body.distance(&b.body),
            reward: (a.reward - b.reward).abs(),
            paid_for: a.paid_for.distance(&b.paid_for),
            odds: (a.odds - b.odds).abs(),
            color: a.color_distance(b),
            model: a.model.distance(&b.model),
        };
        let pays = parts.reward / REWARD_UNIT + parts.odds;
        Self {
            cost: parts.motion + parts.body + parts.paid_for + parts.color + parts.model + TIE_BREAK * pays.min(1.0),
            ..parts
        }
    }
}

/// The cache. A kind's number is unique among all sketchers, so entries never become stale.
pub(super) struct Kinds(Vec<KindDistance>);

thread_local! {
    static KINDS: RefCell<Kinds> = const { RefCell::new(Kinds(Vec::new())) };
}

impl Kinds {
    /// Calls `action` with this thread's cache.
    pub(super) fn with<T>(action: impl FnOnce(&mut Self) -> T) -> T {
        KINDS.with_borrow_mut(|kinds| {
            if kinds.0.is_empty() {
                kinds.0.resize(CACHE_SIZE, KindDistance::default());
            }
            action(kinds)
        })
    }

    #[inline]
    pub(super) fn distance(&mut self, a: &ObjectFeatures, b: &ObjectFeatures) -> &KindDistance {
        let slot = a.kind.wrapping_mul(47).wrapping_add(b.kind) as usize % CACHE_SIZE;
        let known = &mut self.0[slot];
        if known.of != [a.kind, b.kind] {
            *known = KindDistance::between(a, b);
        }
        known
    }
}
