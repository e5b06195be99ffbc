//! All integration tests of this crate in one program, so that only one is linked.

#![expect(clippy::unwrap_used, reason = "a test stops at its first surprise")]

mod agreement;
mod broken_logs;
mod documentation;
mod drift;
mod error_messages;
#[path = "../../tests/files_below.rs"]
mod files_below;
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
#[path = "../../tests/reference_data.rs"]
mod reference_data;
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
