//! The JSON of a lifetime with what the reference's file has no field for.
//!
//! Not here: the reference's fields, see `lifetime_metrics`.

use indexmap::IndexMap;
use serde::Serialize;

use super::{EvaluationCurve, LifetimeMetrics, NullBand, Reached};

/// A lifetime as JSON: the fields of [`LifetimeMetrics`], then `null`, the null band of each metric that has one,
/// `reached`, what each task came to, and `curves`, what each evaluation curve says.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct WholeLifetime<'a> {
    #[serde(flatten)]
    metrics: &'a LifetimeMetrics,
    null: &'a IndexMap<String, NullBand>,
    reached: &'a IndexMap<String, Reached>,
    curves: &'a IndexMap<String, EvaluationCurve>,
}

impl LifetimeMetrics {
    /// This lifetime to be serialised with its null bands, what its tasks reached and their curves, which the saved file leaves out.
    pub fn whole(&self) -> WholeLifetime<'_> {
        WholeLifetime {
            metrics: self,
            null: &self.null_bands,
            reached: &self.reached,
            curves: &self.curves,
        }
    }
}
