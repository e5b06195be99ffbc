//! Limits on the size of documents, on the number of objects in a world and on seeds.

/// Maximum number of objects in one world.
pub const MAX_OBJECTS: usize = 100_000;

/// Largest seed of a world or an object, 2⁵³ − 1: the largest integer that every JSON reader represents exactly.
pub const MAX_SEED: u64 = 9_007_199_254_740_991;

/// Maximum size of a document in bytes.
pub const MAX_BYTES: usize = 64 << 20;

/// Maximum number of values in a world, ours or the original's: numbers, strings, lists, objects and so on.
pub const MAX_WORLD_VALUES: usize = 4_000_000;

/// Maximum number of values in a scenario, ours or the original's: enough for 100,000 blocks of four regimes.
pub const MAX_SCENARIO_VALUES: usize = 2_000_000;

/// Maximum number of values in a task spec, a maps file or a single object.
pub const MAX_VALUES: usize = 1_000_000;

pub use driftworld_text::json::{MAX_DEPTH, MAX_KEY_BYTES};

/// Maximum depth of nested lists and objects in a task spec, where values may be any JSON.
pub const MAX_TASK_DEPTH: usize = 48;
