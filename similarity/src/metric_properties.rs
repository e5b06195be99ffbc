//! [`MetricProperties`]: the metric properties of a measure, so that methods can refuse measures without the properties they
//! need.

use serde::{Deserialize, Serialize};

/// The metric properties of a measure of distance.
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
    /// Zero only between equals, symmetric, and with the triangle inequality.
    Metric,
    /// Like a metric, but different things may be at distance 0.
    Pseudometric,
    /// Zero between equals and symmetric; the triangle inequality may fail.
    #[default]
    Distance,
    /// Zero only between equals; may be asymmetric.
    Divergence,
}

impl MetricProperties {
    /// Whether it is a metric: zero only between equals, with the triangle inequality.
    pub fn is_metric(self) -> bool {
        self == Self::Metric
    }

    /// Whether the triangle inequality holds.
    pub fn keeps_triangles(self) -> bool {
        matches!(self, Self::Metric | Self::Pseudometric)
    }
}
