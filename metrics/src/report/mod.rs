//! Results: the values, the files they are saved in, and the table a newcomer reads.
//!
//! Not here: computing them (`score`), and printing or drawing them (the command's).

mod files;
mod lifetime_metrics;
mod regime_table;
mod rounding;
mod summary;
mod task_metrics;

pub use files::{SavedFiles, Settings};
pub use lifetime_metrics::{LifetimeMetrics, LifetimeScores};
pub use regime_table::RegimeMetrics;
pub use summary::{Direction, SummaryRow};
pub use task_metrics::{PairValues, TaskMetrics};
