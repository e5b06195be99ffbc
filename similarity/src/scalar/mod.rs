//! Differences of single numbers, choices and counts.

mod choice;
mod circular;
mod cost_table;
mod counts;
mod relative;

pub use choice::choice_mismatch;
pub use circular::circular_difference;
pub use cost_table::{CostTable, MAX_CHOICES};
pub use counts::counts_distance;
pub use relative::relative_difference;
