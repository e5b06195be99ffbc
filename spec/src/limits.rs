//! How large documents may be, and how many objects a world may hold. Other limits stand beside what they bound.

/// The most objects that one world may hold.
pub const MAX_OBJECTS: usize = 100_000;

/// The longest text that is read, in bytes.
pub const MAX_BYTES: usize = 64 << 20;

/// The most values of a world, ours or the original's: numbers, texts, lists, objects and the like.
pub const MAX_WORLD_VALUES: usize = 4_000_000;

/// The most values of a scenario, ours or the original's: what 100,000 blocks of four regimes have.
pub const MAX_SCENARIO_VALUES: usize = 2_000_000;

/// The most values of a task spec, a maps file or an object alone.
pub const MAX_VALUES: usize = 1_000_000;

pub use driftworld_text::json::{MAX_DEPTH, MAX_KEY_BYTES};

/// How deep lists and objects may stand in each other in a task spec, whose values may be any JSON.
pub const MAX_TASK_DEPTH: usize = 48;
