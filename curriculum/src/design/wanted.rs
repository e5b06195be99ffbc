//! Limits of designs, probes and sequences of steps, and the request for a sequence of steps.

use driftworld_spec::Element;

/// Maximum number of learning blocks in a scenario.
pub const MAX_BLOCKS: u32 = 10_000;

/// Maximum number of variants in a probe, because all pairs are compared.
pub const MAX_PROBED: usize = 200;

/// The largest seed of a design.
pub const MAX_SEED: u64 = 1 << 52;

/// Maximum number of steps in a sequence.
pub const MAX_STEPS: u32 = 1000;

/// The sequence to find.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// Distance between neighbours, above 0 and at most 1.
    pub distance: f64,
    /// Allowed deviation from `distance`, at least 0 and below it.
    pub tolerance: f64,
    /// Number of steps, one less than the number of variants; at most [`MAX_STEPS`].
    pub count: u32,
    /// The only element that changes and is measured; `None` for all elements together.
    pub element: Option<Element>,
}
