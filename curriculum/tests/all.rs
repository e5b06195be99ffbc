//! All integration tests of this crate in one program, so that only one is linked.

mod audit;
mod lifetime;
mod log_words;
mod stopped;
mod undrawable;
