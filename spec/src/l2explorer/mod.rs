//! The dialect of L2Explorer's reset files: its keys, and what is said where it and a [`World`](crate::World) differ.
//! Reading it is in `read.rs`, with the leniency for single values in `lenient.rs` and what is assumed in place of entries that
//! say nothing in `mend.rs`; writing it is in `write.rs`.
//! Its scenario files, which name such reset files, are in `scenario.rs`.
//!
//! The dialect is the smaller language: every file of it becomes a world, but a world may hold more than a file can.
//! Both directions hand back a [`Warning`](crate::Warning) for whatever did not pass as it stood. A number of a
//! predefined map means the original's regions there, and our own here.

mod lenient;
mod mend;
mod read;
mod scenario;
mod write;

use crate::world::MotionModel;

/// The keys of one part of a reset file, as we write them.
struct Keys {
    /// Those of the original, in the order in which they are written.
    original: &'static [&'static str],
    /// Those that only our worlds have. The reader takes them, the writer leaves them out.
    ours: &'static [&'static str],
    /// Those of early files, which the reader turns into others.
    old: &'static [&'static str],
}

impl Keys {
    fn all(&self) -> impl Iterator<Item = &'static str> {
        self.original.iter().chain(self.ours).chain(self.old).copied()
    }
}

const WORLD: Keys = Keys {
    original: &[
        "game_mode",
        "max_steps",
        "environment_params",
        "agent_params",
        "image_params",
        "objects",
    ],
    ours: &["version", "seed", "max_seconds", "rules", "progress"],
    old: &[],
};

const ENVIRONMENT: Keys = Keys {
    original: &["bounding_wall_color", "light_intensity", "predefined_map", "map_size"],
    ours: &[
        "map_regions",
        "wall_height",
        "walls",
        "sun_direction",
        "light_color",
        "ambient_light",
        "sky_color",
        "ground_color",
        "fog_distance",
    ],
    old: &[],
};

const AGENT: Keys = Keys {
    original: &[
        "action_model",
        "agent_height",
        "agent_width",
        "max_linear_speed",
        "max_angular_speed",
        "observation_size",
        "coordinates",
        "heading",
    ],
    ours: &[
        "observation_width",
        "supersampling",
        "time_step",
        "field_of_view",
        "frame_skip",
        "modalities",
        "state_features",
        "actions",
        "interact",
    ],
    old: &["pickup_range"],
};

const IMAGE: Keys = Keys {
    original: &["zoom", "yaw_subdivisions", "vertical_subdivisions"],
    ours: &[],
    old: &[],
};

/// Nothing of the rules is known to the original.
const RULES: Keys = Keys {
    original: &[],
    ours: &[
        "step_reward",
        "reward_per_second",
        "order_penalty",
        "shaping",
        "success",
        "failure",
    ],
    old: &[],
};

const OBJECT: Keys = Keys {
    original: &[
        "class",
        "model",
        "coordinates",
        "color",
        "motion_model",
        "reward",
        "reward_stimulus",
        "reward_once_stimulus",
        "destroy_stimulus",
        "range_stimulus_distance",
        "unique_name",
    ],
    ours: &[
        "heading",
        "scale",
        "solid",
        "pushable",
        "reward_probability",
        "speed",
        "turn_rate",
        "sight_range",
        "waypoints",
        "order",
        "respawn",
        "seed",
        "tag",
    ],
    old: &["collectible", "reward_on", "interaction_distance"],
};

/// How fast an object of the original moves, in metres per second: its documents do not say. It is what the balls of the
/// built-in `moving_object` do, a fifth of what the agent can.
const ASSUMED_SPEED: f64 = 2.0;

/// Whether an object of the original moves by itself; a patrol is ours, and is written as what stands still.
fn moves(model: MotionModel) -> bool {
    !matches!(model, MotionModel::Stationary | MotionModel::Patrol)
}

/// Whether black on this class (in lower case) is a choice; on all others it is the default and means the asset's own
/// colours.
fn black_is_chosen(class: &str) -> bool {
    matches!(class, "geometric" | "cube" | "icosphere")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn check(part: &str, keys: &Keys) {
        let schema = crate::schema::world().json();
        let properties = match part {
            "World" => &schema["properties"],
            part => &schema["$defs"][part]["properties"],
        };
        let fields: BTreeSet<&str> = properties
            .as_object()
            .expect("every part has fields")
            .keys()
            .map(String::as_str)
            .filter(|key| *key != "$schema")
            .collect();
        let known: BTreeSet<&str> = keys.original.iter().chain(keys.ours).copied().collect();
        assert_eq!(known, fields, "{part}");
        assert_eq!(known.len(), keys.original.len() + keys.ours.len(), "{part}");
    }

    #[test]
    fn every_field_of_a_world_is_either_the_originals_or_ours() {
        check("World", &WORLD);
        check("EnvironmentParams", &ENVIRONMENT);
        check("AgentParams", &AGENT);
        check("ImageParams", &IMAGE);
        check("Rules", &RULES);
        check("Object", &OBJECT);
    }
}
