//! The JSON of a lifetime with what the reference's file has no field for.
//!
//! Not here: the reference's fields, see `lifetime_metrics`.

use indexmap::IndexMap;
use serde::Serialize;

use super::{LifetimeMetrics, NullBand, Reached};

/// A lifetime as JSON: the fields of [`LifetimeMetrics`], then `null`, the null band of each metric that has one, and
/// `reached`, what each task came to.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct WholeLifetime<'a> {
    #[serde(flatten)]
    metrics: &'a LifetimeMetrics,
    null: &'a IndexMap<String, NullBand>,
    reached: &'a IndexMap<String, Reached>,
}

impl LifetimeMetrics {
    /// This lifetime to be serialised with its null bands and what its tasks reached, which the saved file leaves out.
    pub fn whole(&self) -> WholeLifetime<'_> {
        WholeLifetime {
            metrics: self,
            null: &self.null_bands,
            reached: &self.reached,
        }
    }
}
