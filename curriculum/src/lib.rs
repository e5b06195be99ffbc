//! Curricula: variants in an order made into learning and evaluation blocks, and lived by an agent into a log.
//!
//! [`design`] makes a [`Scenario`](driftworld_spec::Scenario), [`run`] lives it. The order of variants comes from distances
//! measured elsewhere; files and the clock are handed in.

mod design;
mod error;
mod run;
mod transfer;

pub use design::{Choice, Design, Evaluate, MAX_SEED, design};
pub use error::CurriculumError;
pub use run::{COLUMNS, Progress, RegimeSummary, Summary, Surroundings, log_name, logger_info, run, scenario_info};
pub use transfer::{DirectionReport, PairTransfer, TransferOptions, TransferReport, transfer_report};
