//! The `driftworld` command as its users meet it, a file per subcommand. What the libraries under it do is tested in their rooms.

#[cfg(feature = "gltf")]
mod assets;
mod closed_pipes;
mod console;
mod curriculum;
mod curriculum_notes;
mod distance_findings;
mod distances;
mod elements;
mod endings;
mod general;
mod half_written;
mod hostile_text;
mod logs;
mod lost_logs;
mod metrics;
mod mix;
mod modes;
mod null_bands;
mod original_scenarios;
mod other_contents;
mod overwrite;
mod pipes;
mod report;
mod run;
mod run_files;
mod scales;
mod several_lifetimes;
mod signals;
mod special_files;
mod terminal;
mod text_maps;
mod transfer_report;
mod undrawable;
mod unity;
