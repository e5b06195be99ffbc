//! The JSON of a lifetime with what the reference's file has no field for.
//!
//! Not here: the reference's fields, see `lifetime_metrics`.

use indexmap::IndexMap;
use serde::Serialize;

use super::{EvaluationCurve, ExpertFit, LifetimeMetrics, NullBand, Reached, SummaryRow, Values};

/// A lifetime as JSON: the fields of [`LifetimeMetrics`], then `readings`, the row of each metric that has a value in the
/// table of the lifetime, `null`, the null band of each metric that has one, `contrasts`, those of transfer between tasks
/// where only ratios were asked for, `reached`, what each task came to, `curves`, what each evaluation curve
/// says, and with experts `experts`, whether they are like for like.
#[derive(Debug, Clone, Serialize)]
pub struct WholeLifetime<'a> {
    #[serde(flatten)]
    metrics: &'a LifetimeMetrics,
    readings: IndexMap<String, SummaryRow>,
    null: &'a IndexMap<String, NullBand>,
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    contrasts: &'a IndexMap<String, Values>,
    reached: &'a IndexMap<String, Reached>,
    curves: &'a IndexMap<String, EvaluationCurve>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    cautions: &'a [String],
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    experts: &'a IndexMap<String, Vec<ExpertFit>>,
}

impl LifetimeMetrics {
    /// This lifetime to be serialised with its readings and null bands, what its tasks reached and their curves, which the saved
    /// file leaves out.
    pub fn whole(&self) -> WholeLifetime<'_> {
        WholeLifetime {
            metrics: self,
            readings: (self.summary().into_iter())
                .filter(|row| row.value.is_some())
                .map(|row| (row.name.to_string(), row))
                .collect(),
            null: &self.null_bands,
            contrasts: &self.contrasts,
            reached: &self.reached,
            curves: &self.curves,
            cautions: &self.cautions,
            experts: &self.expert_fits,
        }
    }
}
