//! Statistics over repeats: aggregates over many lifetimes of one agent, their uncertainty, and comparisons of two agents.
//!
//! The methods follow Agarwal et al. 2021, "Deep Reinforcement Learning at the Edge of the Statistical Precipice", and match
//! the numbers of its package rliable 1.2. A [`ScoreTable`] takes one number of any kind per run and task.

mod aggregate;
mod bootstrap;
mod contest;
mod estimate;
mod improvement;
mod interval;
mod jackknife;
mod permutation;
mod power;
mod resample;
mod resampling;
mod score_table;
mod student;

pub use aggregate::Aggregate;
pub use bootstrap::{BootstrapOptions, MAX_RESAMPLES, MAX_SCORES_DRAWN};
pub use estimate::{Estimate, estimate};
pub use improvement::{Improvement, StratumImprovement, probability_of_improvement};
pub use interval::Interval;
pub use jackknife::FEW_RUNS;
pub use power::{MAX_POWER_LIFETIMES, POWER_LEVEL, POWER_WANTED, lifetimes_for, smallest_effect, welch_power};
pub use resampling::Resampling;
pub use score_table::{MAX_RUNS, MAX_SCORES, MAX_STRATA, ScoreTable};
pub use student::student_reach;
