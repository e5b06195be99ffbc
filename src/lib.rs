//! Driftworld: typed task specs to worlds, distances between them, curricula, and a first-person environment to run them in.
//!
//! This crate re-exports the workspace's crates and adds what joins them: the built-in tasks, names for tasks, worlds as
//! tables, distances among variants of any tasks, picture distances, and the `driftworld` command. Only the command prints.
//!
//! ```
//! use driftworld::{generator, tasks};
//! let variant = tasks::variant("find_objects#red")?;
//! let world = generator::sample(&variant, 7, 12_345)?;
//! assert_eq!(world.objects.iter().filter(|object| object.tag.as_deref() == Some("targets")).count(), 5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub use driftworld_curriculum as curriculum;
pub use driftworld_env as env;
pub use driftworld_generator as generator;
pub use driftworld_metrics as metrics;
pub use driftworld_report as report;
pub use driftworld_similarity as similarity;
pub use driftworld_spec as spec;

pub mod behavior;
mod checksum;
pub mod clock;
pub mod commands;
mod console;
mod contact_sheet;
pub mod contents;
pub mod design;
pub mod distances;
pub mod documents;
mod dynamics;
pub mod elements;
mod episode_frames;
mod failure;
mod figure_files;
pub mod film;
mod libraries;
pub mod lifetime_report;
mod log_folders;
mod log_names;
mod map_colors;
mod map_drawing;
mod map_legend;
mod map_scale;
mod matrix_file;
mod modality;
mod numbers;
pub mod ordering;
mod output_file;
mod overwrite;
pub mod picture_distance;
pub mod recordings;
mod remarks;
pub mod scales;
pub mod scenarios;
pub mod scoring;
mod sheet_words;
mod style;
mod subject;
mod table;
pub mod tasks;
mod throughput;
#[cfg(test)]
#[path = "../tests/tier.rs"]
mod tier;
mod top_level;
mod trials;
mod value_words;
mod variant_names;
mod views;
mod worlds;
mod wrap;

pub use failure::{Cause, Failure, FailureText, Warn};
pub(crate) use failure::{argument, within};
pub use libraries::MAX_LIBRARY_BYTES;
pub use matrix_file::MAX_MATRIX_BYTES;

/// The Rust code of the page is compiled with the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/rust.md")]
struct RustPage;
