//! All integration tests of this crate in one binary, to link once. `allocation` is separate because it counts the memory of
//! the whole process.

mod actions;
mod batch;
mod batch_modalities;
mod channel;
mod contacts;
mod continuation;
mod crowds;
mod door_orders;
mod editing;
mod energy;
mod errands;
mod expert_of_paths;
mod expert_of_puzzles;
mod expert_of_what_remains;
mod expert_of_zones;
mod finite;
mod fixtures;
mod hostile;
mod import;
mod layouts;
mod looks;
mod maps;
mod models;
mod motion;
mod natural;
mod parity;
mod pictures;
mod pushing;
#[path = "../../tests/reference_data.rs"]
mod reference_data;
mod rng;
mod sarsa;
mod show_carried;
mod signs;
mod simulation;
mod state;
mod things;
mod things_laws;
#[path = "../../tests/tier.rs"]
mod tier;
mod walks;
mod walls;
mod zones;
mod zones_seen;
