//! All integration tests of this crate in one program, so that only one is linked.

mod agreement;
mod broken_logs;
mod documentation;
mod drift;
mod error_messages;
mod generators;
mod l2logger_aggregate;
mod like_for_like;
mod log_round_trip;
mod lost_log;
mod metrics_of_ones_own;
mod null_bands;
mod power;
mod properties;
mod reference;
mod reference_lifetimes;
mod reference_ragged;
mod repeats_coverage;
mod repeats_laws;
mod repeats_rliable;
mod repeats_whole_runs;
#[path = "../../tests/tier.rs"]
mod tier;
mod tiny_lifetime;
mod torn_log;
mod validation;
