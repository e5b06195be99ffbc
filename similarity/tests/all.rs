//! All integration tests of this crate in one program, so that only one is linked.

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
