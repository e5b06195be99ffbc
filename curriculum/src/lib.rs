//! Curricula: turns ordered variants into learning and evaluation blocks, runs an agent through them and writes the log.
//!
//! [`probe`] and [`steps`] find variants for a hypothesis, [`arrange`] orders them, [`design`] builds a
//! [`Scenario`](driftworld_spec::Scenario) from them, [`run`] runs it, and [`audit`] checks its scores with simulated
//! agents of known behaviour. The caller passes in folders and the clock.

mod audit;
mod design;
mod error;
mod hash;
mod run;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;
mod transfer;

pub use audit::{AuditOptions, AuditRow, audit};
pub use design::{
    Choice, Control, Design, Drifting, Evaluate, LEARN, MAX_BLOCKS, MAX_PROBED, MAX_SEED, MAX_STEPS, Picked, Split,
    Steps, arrange, control, design, design_control, distances, experts, experts_of, probe, probe_named, steps,
};
pub use error::CurriculumError;
pub use run::{
    COLUMNS, ENDED_BY, ENDING, Experience, ExperienceSpec, Failed, Finished, FoundWorld, Journal, LeftOut,
    MAX_RECORDINGS_BYTES, MOST_STEPS, Plan, Progress, RECORDINGS_FILE, REPEATED_EVALUATIONS, Recordings,
    RecordingsFile, RegimeSummary, Repeats, Rollout, RunContext, Sources, Summary, Trial, Tried, Undrawable, log_name,
    relearn, run, run_rollout, same_log_name, try_expert, try_worlds,
};
pub use transfer::{
    DirectionReport, PairTransfer, TransferOptions, TransferReport, log_name_of_label, transfer_report,
};
