//! Fuzz targets, one per kind of document, file and message that Driftworld reads. Each checks properties that must
//! hold for any input bytes.
//!
//! `tests/replay.rs` runs the checks on the seeds and on small changes to them; `scripts/fuzz.sh` lets libFuzzer search for bytes
//! that make a check fail.

mod agent_script;
mod edited;
mod episode;
mod gltf;
mod library;
mod log;
mod maps;
mod matrix;
mod network;
mod protocol;
mod recording;
mod refusal;
mod scenario;
mod settings;
mod task;
mod world;

/// A fuzz target: a check, and the folder with its seed inputs.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Name of the folder with its seed inputs.
    pub name: &'static str,
    /// The check; panics if a property does not hold for the bytes.
    pub law: fn(&[u8]),
}

/// All targets in alphabetical order.
pub const TARGETS: [Target; 14] = [
    target("agent_script", agent_script::check),
    target("episode", episode::check),
    target("gltf", gltf::check),
    target("library", library::check),
    target("log", log::check),
    target("maps", maps::check),
    target("matrix", matrix::check),
    target("network", network::check),
    target("protocol", protocol::check),
    target("recording", recording::check),
    target("scenario", scenario::check),
    target("settings", settings::check),
    target("task", task::check),
    target("world", world::check),
];

const fn target(name: &'static str, law: fn(&[u8])) -> Target {
    Target { name, law }
}
