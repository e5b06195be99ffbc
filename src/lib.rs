//! Driftworld samples worlds from typed task specs, measures distances between them, designs curricula, and runs agents in a
//! first-person environment.
//!
//! This crate re-exports the workspace's crates and adds what connects them: the built-in tasks, names for tasks, worlds as
//! tables, distances among variants of any tasks, picture distances, and the `driftworld` command. Only the command prints.
//!
//! ```
//! use driftworld::{generator, tasks};
//! let variant = tasks::variant("find_objects#red")?;
//! let world = generator::sample(&variant, 7, 12_345)?;
//! assert_eq!(world.objects.iter().filter(|object| object.tag.as_deref() == Some("targets")).count(), 5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![cfg_attr(
    target_family = "wasm",
    expect(dead_code, reason = "some code is used only by the command, which is left out there")
)]

pub use driftworld_curriculum as curriculum;
pub use driftworld_env as env;
pub use driftworld_generator as generator;
pub use driftworld_metrics as metrics;
#[cfg(not(target_family = "wasm"))]
pub use driftworld_report as report;
pub use driftworld_similarity as similarity;
pub use driftworld_spec as spec;

// The workbench in a browser (`studio/wasm/`) needs the modules without `cfg`: it has no files, terminal or figures.
mod behavior;
#[cfg(not(target_family = "wasm"))]
mod checksum;
#[cfg(not(target_family = "wasm"))]
pub mod clock;
#[cfg(not(target_family = "wasm"))]
pub mod commands;
#[cfg(not(target_family = "wasm"))]
mod console;
#[cfg(not(target_family = "wasm"))]
mod contact_sheet;
pub mod contents;
#[cfg(not(target_family = "wasm"))]
pub mod design;
pub mod distances;
pub mod documents;
mod dynamics;
pub mod elements;
#[cfg(not(target_family = "wasm"))]
mod episode_frames;
mod failure;
#[cfg(not(target_family = "wasm"))]
mod figure_files;
#[cfg(not(target_family = "wasm"))]
pub mod film;
mod libraries;
#[cfg(not(target_family = "wasm"))]
pub mod lifetime_report;
#[cfg(not(target_family = "wasm"))]
mod log_folders;
#[cfg(not(target_family = "wasm"))]
mod log_names;
#[cfg(not(target_family = "wasm"))]
mod map_colors;
#[cfg(not(target_family = "wasm"))]
mod map_drawing;
#[cfg(not(target_family = "wasm"))]
mod map_legend;
#[cfg(not(target_family = "wasm"))]
mod map_scale;
#[cfg(not(target_family = "wasm"))]
mod matrix_file;
pub mod modality;
mod numbers;
#[cfg(not(target_family = "wasm"))]
pub mod ordering;
#[cfg(not(target_family = "wasm"))]
mod output_file;
#[cfg(not(target_family = "wasm"))]
mod overwrite;
mod picture_distance;
#[cfg(not(target_family = "wasm"))]
pub mod recordings;
#[cfg(not(target_family = "wasm"))]
mod remarks;
#[cfg(not(target_family = "wasm"))]
pub mod request;
#[cfg(not(target_family = "wasm"))]
pub mod scales;
#[cfg(not(target_family = "wasm"))]
pub mod scenarios;
#[cfg(not(target_family = "wasm"))]
pub mod scoring;
#[cfg(not(target_family = "wasm"))]
mod sheet_words;
#[cfg(not(target_family = "wasm"))]
mod style;
#[cfg(not(target_family = "wasm"))]
mod subject;
#[cfg(not(target_family = "wasm"))]
mod table;
pub mod tasks;
#[cfg(not(target_family = "wasm"))]
mod throughput;
#[cfg(test)]
#[path = "../tests/tier.rs"]
mod tier;
mod top_level;
#[cfg(not(target_family = "wasm"))]
mod trials;
#[cfg(not(target_family = "wasm"))]
mod value_words;
#[cfg(not(target_family = "wasm"))]
mod variant_names;
#[cfg(not(target_family = "wasm"))]
mod views;
#[cfg(not(target_family = "wasm"))]
mod worlds;
#[cfg(not(target_family = "wasm"))]
mod wrap;

#[cfg(not(target_family = "wasm"))]
pub(crate) use failure::argument;
pub(crate) use failure::within;
pub use failure::{Cause, Failure, Warn};
pub use libraries::MAX_LIBRARY_BYTES;
#[cfg(not(target_family = "wasm"))]
pub use matrix_file::MAX_MATRIX_BYTES;

/// Compiles the Rust code of `docs/rust.md` with the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/rust.md")]
struct RustPage;
