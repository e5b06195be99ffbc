//! Reads L2Explorer's files. Reset files are read in `read.rs`, their objects in `read_objects.rs`, single values leniently in
//! `lenient.rs`; `mend.rs` repairs unusable entries; `reader.rs` holds their shared state. Scenario files, which name reset
//! files, are read in `read_scenario.rs`.
//!
//! Every reset file becomes a [`World`](crate::World), with a [`Warning`](crate::Warning) for everything that is not taken
//! literally. The original's regions of a predefined map are written into the world.

mod lenient;
mod mend;
mod read;
mod read_objects;
mod read_scenario;
mod reader;

use std::sync::LazyLock;

use serde::Serialize;
use serde_json::{Map, Value as Json};

use crate::world::{AgentParams, EnvironmentParams, Field, Fields, ImageParams, Object, Rules, World, WorldDraft};
use mend::Entry;

/// The table of fields for one part of a reset file.
struct Part {
    /// The original's keys, then keys that only our worlds have, then keys of early files, which the reader converts.
    keys: Vec<&'static str>,
    /// The required forms of the original's keys; lists and parts are read separately.
    entries: Vec<(&'static str, Entry)>,
    /// Defaults by key.
    defaults: Map<String, Json>,
}

impl Part {
    /// The part that becomes a `T` with this schema; `old` lists its keys in early files.
    fn of<T: Fields + Serialize>(default: &T, schema: &Json, old: &[&'static str]) -> Self {
        let fields = T::ROWS.iter().map(|row| row.field);
        let (original, ours): (Vec<Field>, Vec<Field>) = fields
            .filter(|field| field.key != "$schema")
            .partition(|field| field.is_original);
        let entry = |field: &Field| Some((field.key, Entry::of(&schema["properties"][field.key])?));
        let keys = original.iter().chain(&ours).map(|field| field.key);
        Self {
            keys: keys.chain(old.iter().copied()).collect(),
            entries: original.iter().filter_map(entry).collect(),
            defaults: match serde_json::to_value(default) {
                Ok(Json::Object(map)) => map,
                other => unreachable!("the parts of a world serialise as objects with string keys, not as {other:?}"),
            },
        }
    }
}

/// The parts of a reset file.
struct Parts {
    world: Part,
    environment: Part,
    agent: Part,
    image: Part,
    /// The rules, which the original does not have.
    rules: Part,
    object: Part,
}

static PARTS: LazyLock<Parts> = LazyLock::new(|| {
    let world = World::schema().json();
    let of = |name: &str| &world["$defs"][name];
    let old_of_objects = &["collectible", "reward_on", "interaction_distance"];
    Parts {
        world: Part::of(&WorldDraft::default(), world, &[]),
        environment: Part::of(&EnvironmentParams::default(), of("EnvironmentParams"), &[]),
        agent: Part::of(&AgentParams::default(), of("AgentParams"), &["pickup_range"]),
        image: Part::of(&ImageParams::default(), of("ImageParams"), &[]),
        rules: Part::of(&Rules::default(), of("Rules"), &[]),
        object: Part::of(&Object::default(), of("Object"), old_of_objects),
    }
});

/// Assumed speed of the original's moving objects in metres per second, because its documents do not state it: the speed of the
/// balls in the built-in `moving_object`, a fifth of the agent's.
const ASSUMED_SPEED: f64 = 2.0;

/// Whether black is a deliberate colour for this class (in lower case); for all others it is the default and means the
/// asset's own colours.
fn black_is_chosen(class: &str) -> bool {
    matches!(class, "geometric" | "cube" | "icosphere")
}
