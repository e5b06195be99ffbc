//! All integration tests of this crate in one program, so that only one is linked.

mod audit;
#[path = "../../tests/files_below.rs"]
mod files_below;
mod lifetime;
mod living;
mod log_words;
mod stopped;
mod undrawable;
