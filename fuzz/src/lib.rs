//! What must hold of everything that Driftworld reads, whatever its bytes are: a law for each kind of document, file
//! and message.
//!
//! `tests/replay.rs` checks the laws on the seeds and on small changes of them; `scripts/fuzz.sh` lets libFuzzer look
//! for bytes that break them. Not here: what a sound document may say, which the tests of each crate say.

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

/// What bytes are handed to, and what must hold then.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The name of its folder of seeds.
    pub name: &'static str,
    /// Panics where the bytes break the law.
    pub law: fn(&[u8]),
}

/// Every target, in the order of the alphabet.
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
