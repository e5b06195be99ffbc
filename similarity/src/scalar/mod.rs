//! Differences of single numbers, choices and counts. Distances between distributions of them are in `distribution/`.

mod choice;
mod circular;
mod cost_table;
mod counts;
mod log_ratio;
mod range;
mod relative;

pub use choice::choice_mismatch;
pub use circular::circular_difference;
pub use cost_table::{CostTable, MAX_CHOICES};
pub use counts::counts_distance;
pub use log_ratio::log_ratio;
pub use range::range_difference;
pub use relative::relative_difference;
