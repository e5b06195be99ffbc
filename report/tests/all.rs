//! All integration tests of this crate, as one program: it is linked once.

mod browser;
mod lifetimes;
mod page;
mod reference;
#[path = "../../tests/reference_data.rs"]
mod reference_data;
#[path = "../../tests/tier.rs"]
mod tier;
