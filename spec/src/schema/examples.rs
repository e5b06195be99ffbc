//! Examples that editors show beside a schema's definitions. That each is valid is tested in `spec/tests/schemas.rs`.

use serde_json::Value;

/// For each definition its examples, as JSON; a document's own are under its title.
const EXAMPLES: &[(&str, &[&str])] = &[
    (
        "Driftworld world",
        &[
            r#"{ "version": 1, "max_steps": 300, "objects": [{ "class": "tree", "model": "5", "coordinates": [3, 4] }] }"#,
        ],
    ),
    (
        "Driftworld task spec",
        &[r#"{ "version": 2, "name": "light_and_dark",
            "parameters": { "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 } },
            "world": { "max_steps": 100, "environment_params": { "light_intensity": { "param": "light" } } },
            "variants": { "day": {}, "dusk": { "light": 0.3 } } }"#],
    ),
    (
        "Driftworld scenario",
        &[r#"{ "version": 1, "name": "two-colours", "blocks": [
            { "type": "learning", "regimes": [{ "task": "find_objects", "variant": "blue", "count": 100, "seed": 2 }] },
            { "type": "evaluation", "regimes": [{ "task": "find_objects", "variant": "red", "count": 10, "seed": 3 }] } ] }"#],
    ),
    (
        "Driftworld maps file",
        &[
            r#"{ "unit": "metre", "maps": [{ "id": 2, "name": "yard", "excluded_regions": [[[-5, -5], [5, -5], [5, 5], [-5, 5]]] }] }"#,
        ],
    ),
    (
        "Object",
        &[
            r#"{ "class": "geometric", "model": "1", "coordinates": [0, 10], "color": "red", "reward": 100,
            "reward_once_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"] }"#,
        ],
    ),
    (
        "EnvironmentParams",
        &[r#"{ "map_size": [60, 60], "light_intensity": 2.3, "bounding_wall_color": [0.7, 0.7, 0.6] }"#],
    ),
    (
        "AgentParams",
        &[r#"{ "action_model": "byvelocity", "coordinates": [0, 0], "heading": 90, "observation_size": 84 }"#],
    ),
    (
        "ImageParams",
        &[r#"{ "zoom": 2, "yaw_subdivisions": 8, "vertical_subdivisions": 1 }"#],
    ),
    (
        "Rules",
        &[
            r#"{ "step_reward": -0.1, "shaping": { "toward": "goal", "scale": 1 }, "success": ["all_collected"], "failure": [{ "return_at_most": -50 }] }"#,
        ],
    ),
    (
        "Shaping",
        &[
            r#"{ "toward": "goal", "scale": 1 }"#,
            r#"{ "scale": 0.1, "discount": 0.99 }"#,
        ],
    ),
    (
        "Progress",
        &[
            r#"{ "steps": 2, "ticks": 2, "episode_return": 1, "unshaped_return": 1, "velocity": [0, 1], "objects": [{ "collected": true }] }"#,
        ],
    ),
    (
        "LastEvent",
        &[r#"{ "stimulus": "AgentCollide", "reward": 1, "destroyed": false }"#],
    ),
    ("Origin", &[r#"{ "coordinates": [3, 4], "heading": 90, "reward": 1 }"#]),
    (
        "ObjectProgress",
        &[r#"{ "present": false, "collected": true, "returns_at": 99 }"#],
    ),
    (
        "RailsProgress",
        &[r#"{ "target": 0, "goal": [3, 4], "avoided": [1], "patience": 7 }"#],
    ),
    ("Pushable", &[r#"{ "mass": 20, "friction": 0.5 }"#]),
    (
        "EndCondition",
        &[
            r#""all_collected""#,
            r#"{ "touch": "goal" }"#,
            r#"{ "return_at_least": 500 }"#,
        ],
    ),
    (
        "Wall",
        &[r#"{ "polygon": [[0, 0], [8, 0], [8, 1], [0, 1]], "height": 2 }"#],
    ),
    ("Respawn", &[r#"{ "delay": 5, "radius": 10 }"#]),
    (
        "ActionSpace",
        &[
            r#""continuous""#,
            r#""default_discrete""#,
            r#"{ "discrete": [[5, 0, 0], [0, -90, 0], [0, 90, 0]] }"#,
        ],
    ),
    ("Color", &[r#""red""#, "[1, 0.5, 0]"]),
    (
        "Parameter",
        &[
            r#"{ "role": "fixed", "type": "integer", "value": 5 }"#,
            r#"{ "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "blue"], "default": "red" }"#,
            r#"{ "role": "variant", "type": "number", "unit": "m", "affects": ["S"], "range": [2, 40], "default": 20 }"#,
            r#"{ "role": "randomized", "type": "heading", "unit": "deg", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high": 360 } } }"#,
        ],
    ),
    (
        "Compare",
        &[
            r#"{ "weight": 2, "measure": "log_ratio" }"#,
            r#"{ "costs": [[0, 0.2, 1], [0.2, 0, 1], [1, 1, 0]] }"#,
        ],
    ),
    ("ElementWeights", &[r#"{ "R": 2, "O": 0.5 }"#]),
    (
        "ParamRef",
        &[r#"{ "param": "light" }"#, r#"{ "param": "shares", "index": 0 }"#],
    ),
    (
        "Distribution",
        &[
            r#"{ "uniform": { "low": 0, "high": 360 } }"#,
            r#"{ "truncated_normal": { "mean": 2.3, "std": 0.5, "low": 0, "high": 4 } }"#,
            r#"{ "choice": { "values": ["1", "2", "5"], "weights": [2, 1, 1] } }"#,
            r#"{ "gaussian": { "mean": [0, 0], "std": { "param": "spread" } } }"#,
            r#"{ "mixture": { "parts": [{ "disc": { "center": [0, 0], "radius": 5 } }, { "disc": { "center": [20, 0], "radius": 5 } }] } }"#,
        ],
    ),
    (
        "Group",
        &[
            r#"{ "name": "trees", "count": 8, "object": { "class": "tree" }, "placement": { "box": { "low": [-28, -28], "high": [28, 28] } }, "separation": 3 }"#,
            r#"{ "name": "fences", "count": { "poisson": { "mean": 3 } }, "around": "houses", "facing": "middle",
                "object": { "class": "fence" }, "placement": { "annulus": { "center": [0, 0], "inner": 6, "outer": 9 } } }"#,
        ],
    ),
    ("KeepOut", &[r#"{ "walls": 1, "agent": 4, "groups": { "houses": 8 } }"#]),
    (
        "Facing",
        &[r#""random""#, r#"{ "point": [0, 0] }"#, r#"{ "group": "houses" }"#],
    ),
    (
        "VariantSpec",
        &[
            r#"{ "extends": "day", "description": "Red cubes at dusk.", "light": 0.6 }"#,
            r#"{ "grid": { "target_color": ["red", "green"], "light": [0.6, 2.3] } }"#,
            r#"{ "sweep": { "light": { "from": 0.2, "to": 4, "steps": 5 } } }"#,
        ],
    ),
    (
        "Sweep",
        &[r#"{ "from": 0.1, "to": 10, "steps": 5, "spacing": "logarithmic" }"#],
    ),
    (
        "Block",
        &[r#"{ "type": "learning", "regimes": [{ "task": "find_objects", "variant": "blue", "count": 100 }] }"#],
    ),
    (
        "Regime",
        &[
            r#"{ "task": "find_objects", "variant": "red", "count": 100, "seed": 7, "first_index": 0 }"#,
            r#"{ "task": "find_objects", "variant": "red", "values": { "light": 1.2 }, "name": "red-dim", "count": 100 }"#,
            r#"{ "task": "Task1", "variant": "yard", "world": "maps/yard.json", "max_steps": 200, "count": 10 }"#,
            r#"{ "task": "find_objects", "variant": "red", "count": 100, "drift": { "to": "dusk", "schedule": "cosine" } }"#,
        ],
    ),
    (
        "RegimeDrift",
        &[
            r#"{ "to": "dusk" }"#,
            r#"{ "to": "dusk", "values": { "light": 1.2 }, "name": "dim" }"#,
            r#"{ "to": "dusk", "schedule": { "steps": 4 }, "switch": "mixture", "from": 0, "until": 0.5 }"#,
        ],
    ),
    ("DriftSchedule", &[r#""linear""#, r#"{ "sawtooth": 3 }"#]),
    (
        "MapLayout",
        &[r#"{ "id": 2, "name": "yard", "excluded_regions": [[[-5, -5], [5, -5], [5, 5], [-5, 5]]] }"#],
    ),
];

/// Adds to a schema the examples of its definitions, and its own.
pub(super) fn add(schema: &mut Value, title: &str) {
    let examples_of = |name: &str| -> Option<Vec<Value>> {
        let (_, texts) = EXAMPLES.iter().find(|(known, _)| *known == name)?;
        texts
            .iter()
            .map(|text| serde_json::from_str::<Value>(text).ok())
            .collect()
    };
    if let Some(examples) = examples_of(title) {
        schema["examples"] = examples.into();
    }
    for (name, definition) in schema["$defs"].as_object_mut().into_iter().flatten() {
        if let Some(examples) = examples_of(name) {
            definition["examples"] = examples.into();
        }
    }
}
