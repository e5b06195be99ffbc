//! [`MetricProperties`]: which laws a measure keeps, so that a method that needs them can refuse one that does not.

use serde::{Deserialize, Serialize};

/// Which laws a measure of how far things are apart keeps.
///
/// # Example
/// ```
/// use driftworld_similarity::MetricProperties;
/// assert!(MetricProperties::Metric.is_metric());
/// assert!(!MetricProperties::Distance.is_metric());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MetricProperties {
    /// 0 for equals, as far there as back, and no detour is shorter than the straight way.
    Metric,
    /// As a metric, but unlike things may be 0 apart.
    Pseudometric,
    /// 0 for equals and as far there as back; a detour may be shorter.
    #[default]
    Distance,
    /// 0 for equals only; there may be farther than back.
    Divergence,
}

impl MetricProperties {
    /// Whether it is a metric: 0 for equals only, and no detour is shorter.
    pub fn is_metric(self) -> bool {
        self == Self::Metric
    }

    /// Whether the triangle inequality holds: no detour is shorter than the straight way.
    pub fn keeps_triangles(self) -> bool {
        matches!(self, Self::Metric | Self::Pseudometric)
    }
}
