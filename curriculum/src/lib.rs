//! Curricula: variants in an order made into learning and evaluation blocks, and lived by an agent into a log.
//!
//! [`design`] makes a [`Scenario`](driftworld_spec::Scenario), [`run`] lives it. The order of variants comes from distances
//! measured elsewhere; files and the clock are handed in.

mod design;
mod error;
mod run;

pub use design::{Choice, Design, Evaluate, MAX_SEED, design};
pub use error::CurriculumError;
pub use run::{
    COLUMNS, FoundWorld, Journal, Plan, Progress, RegimeSummary, Sources, Summary, Surroundings, log_name, run,
};
