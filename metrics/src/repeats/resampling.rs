//! [`Resampling`]: the unit that a resample draws.

use crate::choice::choice;

choice! {
    /// The unit of resampling.
    Resampling, "resampling" {
        /// Whole runs with all their scores (default). Keeps the correlation between the scores of one lifetime; the same as
        /// `Strata` if there is only one stratum. If runs lack scores, a stratum without any drawn score is left out of that
        /// resample.
        Runs = "runs",
        /// The scores of each stratum, independently, as in rliable. Treats the scores of one run in different strata as
        /// independent; if they are not, intervals are much too narrow.
        Strata = "strata",
    }
}
