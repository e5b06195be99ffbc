//! [`Nature`]: which laws a measure keeps, so that a method that needs them can refuse one that does not.

use serde::{Deserialize, Serialize};

/// Which laws a measure of how far things are apart keeps.
///
/// # Example
/// ```
/// use driftworld_similarity::Nature;
/// assert!(Nature::Metric.is_metric());
/// assert!(!Nature::Distance.is_metric());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Nature {
    /// 0 for equals, as far there as back, and no detour is shorter than the straight way.
    Metric,
    /// 0 for equals and as far there as back; a detour may be shorter.
    #[default]
    Distance,
    /// 0 for equals only; there may be farther than back.
    Divergence,
}

impl Nature {
    /// Whether the triangle inequality holds.
    pub fn is_metric(self) -> bool {
        self == Self::Metric
    }
}
