//! How far apart kinds of objects are, remembered from pair to pair: worlds have many objects of few kinds.

use std::cell::RefCell;

use crate::combined::sketch::ObjectFeatures;

/// How many pairs of kinds a thread remembers; a power of 2.
const REMEMBERED: usize = 2048;

/// How much what objects pay counts when they are matched.
const TIE_BREAK: f64 = 1e-9;

/// How far apart two kinds of objects are, in each part that places, headings and sizes do not decide.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct KindsApart {
    /// The kinds; 0 is none.
    of: [u64; 2],
    /// What it costs to match objects of the two.
    pub(super) cost: f64,
    pub(super) motion: f64,
    pub(super) body: f64,
    pub(super) reward: f64,
    pub(super) paid_for: f64,
    pub(super) odds: f64,
    pub(super) color: f64,
    pub(super) model: f64,
}

impl KindsApart {
    /// Measured anew. What kinds pay only decides between matches that are equally cheap else.
    pub(super) fn between(a: &ObjectFeatures, b: &ObjectFeatures) -> Self {
        let of = [a.kind, b.kind];
        if a.kind == b.kind {
            return Self { of, ..Self::default() };
        }
        let apart = Self {
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
        let pays = apart.reward / super::matching::UNIT_OF_REWARD + apart.odds;
        Self {
            cost: apart.motion + apart.body + apart.paid_for + apart.color + apart.model + TIE_BREAK * pays.min(1.0),
            ..apart
        }
    }
}

/// What pairs of kinds came to. The number of a kind is its own among all sketchers, so nothing here goes out of date.
pub(super) struct Kinds(Vec<KindsApart>);

thread_local! {
    static KINDS: RefCell<Kinds> = const { RefCell::new(Kinds(Vec::new())) };
}

impl Kinds {
    /// Hands over what this thread remembers.
    pub(super) fn with<T>(look: impl FnOnce(&mut Self) -> T) -> T {
        KINDS.with_borrow_mut(|kinds| {
            if kinds.0.is_empty() {
                kinds.0.resize(REMEMBERED, KindsApart::default());
            }
            look(kinds)
        })
    }

    #[inline]
    pub(super) fn apart(&mut self, a: &ObjectFeatures, b: &ObjectFeatures) -> &KindsApart {
        let place = a.kind.wrapping_mul(47).wrapping_add(b.kind) as usize % REMEMBERED;
        let known = &mut self.0[place];
        if known.of != [a.kind, b.kind] {
            *known = KindsApart::between(a, b);
        }
        known
    }
}
