//! All integration tests of this crate in one program, so that only one is linked.

mod audit;
#[path = "../../tests/files_below.rs"]
mod files_below;
mod lifetime;
mod log_words;
mod run_settings;
mod stopped;
mod undrawable;
