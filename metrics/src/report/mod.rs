//! Results: the values, the files they are saved in, and the table a newcomer reads.
//!
//! Not here: computing them (`score`), and printing or drawing them (the command's).

mod files;
mod headline;
mod lifetime_metrics;
mod regime_table;
mod repeats;
mod rounding;
mod values;

pub use files::{SavedFiles, Settings};
pub use headline::{Direction, Headline, SummaryRow};
pub use lifetime_metrics::LifetimeMetrics;
pub use regime_table::RegimeMetrics;
pub use repeats::{ComparedMetric, RepeatedMetric, compare_agents, over_repeats};
pub use values::{PairValues, Value, Values};
