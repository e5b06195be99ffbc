//! The dialect of L2Explorer's reset files: its keys, and what is said where it and a [`World`](crate::World) differ.
//! Reading it is in `read.rs`, its objects in `read_objects.rs`, with the leniency for single values in `lenient.rs`
//! and what is assumed in place of entries that say nothing in `mend.rs`. Its scenario files, which name such reset
//! files, are read in `read_scenario.rs`.
//!
//! Every file of the dialect becomes a world, with a [`Warning`](crate::Warning) for whatever is not taken as it stands. A
//! number of a predefined map means the original's regions, which are written into the world.

mod lenient;
mod mend;
mod read;
mod read_objects;
mod read_scenario;

use std::sync::LazyLock;

use serde::Serialize;
use serde_json::{Map, Value as Json};

use crate::world::{AgentParams, EnvironmentParams, Field, Fields, ImageParams, Object, Rules, World, WorldDraft};
use mend::Entry;

/// What the table of fields says of one part of a reset file.
struct Part {
    /// The original's keys, then those that only our worlds have, then those of early files, which the reader turns into others.
    keys: Vec<&'static str>,
    /// What the values of the original's keys must be; lists and parts are read by themselves.
    entries: Vec<(&'static str, Entry)>,
    /// What entries are where nothing is said, by key.
    defaults: Map<String, Json>,
}

impl Part {
    /// The part that is made as a `T`, and whose schema this is; `old` are its keys of early files.
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
    /// Nothing of the rules is known to the original.
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

/// How fast an object of the original moves, in metres per second: its documents do not say. It is what the balls of the
/// built-in `moving_object` do, a fifth of what the agent can.
const ASSUMED_SPEED: f64 = 2.0;

/// Whether black on this class (in lower case) is a choice; on all others it is the default and means the asset's own
/// colours.
fn black_is_chosen(class: &str) -> bool {
    matches!(class, "geometric" | "cube" | "icosphere")
}
