//! All integration tests of this crate, in one program, so that it is linked only once.

mod browser;
mod lifetimes;
mod page;
mod reference;
#[path = "../../tests/reference_data.rs"]
mod reference_data;
#[path = "../../tests/tier.rs"]
mod tier;
