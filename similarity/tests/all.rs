//! All integration tests of this crate, as one program: it is linked once.

mod assignment;
mod color;
mod correlation;
mod distributions;
mod draws;
mod mdp;
mod occupancy;
mod ospa;
mod picture;
mod reward;
#[path = "../../tests/tier.rs"]
mod tier;
mod transport;
