//! All integration tests of this crate, as one program: it is linked once.

mod audit;
mod lifetime;
mod log_words;
mod stopped;
mod undrawable;
