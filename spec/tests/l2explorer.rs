//! L2Explorer's dialect: its own map files, and every world that it can describe, are read. Lenient forms of single values are
//! tested next to the code.
//!
//! The original's files are not in the repository; without them, their test is skipped with a message.

use driftworld_spec::{
    ActionModel, AgentParams, Color, EnvironmentParams, GameMode, ImageParams, Model, MotionModel, Object, Rules,
    Stimulus, WORLD_VERSION, World, WorldDraft,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use crate::reference_data::reference;

#[test]
fn every_map_of_the_original_is_read() {
    for (file, objects, warnings) in [
        ("map_findobjects_0", 8, 7),
        ("map_simple", 3, 1),
        ("map_spawning", 3, 1),
    ] {
        let Some(path) = reference(&format!("l2explorer/{file}.json")) else {
            return;
        };
        let text = std::fs::read_to_string(path).expect("the original's maps are text");
        let (world, found) = World::from_l2explorer(file, &text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(world.objects.len(), objects, "{file}");
        assert_eq!(found.len(), warnings, "{file}: {found:#?}");
        let reread = World::from_json(file, &world.to_json()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(reread, world, "{file}: written and read strictly");
    }
}

const BLACK: Color = Color([0.0; 3]);

/// Assumed speed of moving objects in metres per second, which the original's files do not contain.
const ASSUMED_SPEED: f64 = 2.0;

fn moves(model: MotionModel) -> bool {
    !matches!(model, MotionModel::Stationary | MotionModel::Patrol)
}

fn black_is_chosen(class: &str) -> bool {
    ["geometric", "cube", "icosphere"].contains(&class)
}

fn color() -> impl Strategy<Value = Color> {
    [0.0..=1.0, 0.0..=1.0, 0.0..=1.0].prop_map(Color)
}

fn stimuli() -> impl Strategy<Value = Vec<Stimulus>> {
    let all = vec![Stimulus::AgentCollide, Stimulus::AgentInteract, Stimulus::AgentInRange];
    proptest::sample::subsequence(all, 0..=3)
}

/// Arenas, with the largest coordinates of an object along x and y.
fn environment() -> impl Strategy<Value = EnvironmentParams> {
    (color(), 0.0..=100.0, 0u8..=4, [0.5..=300.0, 0.5..=300.0]).prop_map(
        |(bounding_wall_color, light_intensity, predefined_map, map_size)| EnvironmentParams {
            bounding_wall_color,
            light_intensity,
            predefined_map,
            map_size,
            ..EnvironmentParams::default()
        },
    )
}

fn agent() -> impl Strategy<Value = AgentParams> {
    let models = [
        ActionModel::ByVelocity,
        ActionModel::ByWaypoint,
        ActionModel::OnRails,
        ActionModel::None,
    ];
    (
        select(models.to_vec()),
        (0.1..=10.0, 0.05..=10.0),
        (0.0..=100.0, 0.0..=3600.0),
        1u32..=4096,
        [-300.0..=300.0, -300.0..=300.0],
        0.0..=360.0,
    )
        .prop_map(
            |(action_model, size, speed, observation_size, coordinates, heading)| AgentParams {
                action_model,
                agent_height: size.0,
                agent_width: size.1,
                max_linear_speed: speed.0,
                max_angular_speed: speed.1,
                observation_size,
                coordinates,
                heading,
                ..AgentParams::default()
            },
        )
}

/// An object that the original can describe, with its position as a share of the arena; the flag says whether it gets a name
/// later.
fn object() -> impl Strategy<Value = (Object, bool)> {
    let class = prop_oneof![
        select(vec!["geometric", "cube", "icosphere", "tree", "barrel"]).prop_map(str::to_owned),
        "[a-zé_]{1,12}"
    ];
    let motion = [
        MotionModel::Stationary,
        MotionModel::Predator,
        MotionModel::Prey,
        MotionModel::RandomWaypoint,
    ];
    (
        (class, prop_oneof!["[0-9]{1,3}", "\\PC{1,9}"]),
        [-0.5..=0.5, -0.5..=0.5],
        prop_oneof![Just(BLACK), color()],
        any::<bool>(),
        select(motion.to_vec()),
        (-1e9..=1e9, 0.0..=1000.0),
        [stimuli(), stimuli(), stimuli()],
        any::<bool>(),
    )
        .prop_map(
            |((class, model), coordinates, color, own, motion_model, numbers, stimuli, named)| {
                let chosen = black_is_chosen(&class);
                let mut object = Object::new(class, coordinates);
                object.model = Model(model);
                object.color = Some(color).filter(|color| chosen || !(own || *color == BLACK));
                object.motion_model = motion_model;
                object.speed = if moves(motion_model) { ASSUMED_SPEED } else { 0.0 };
                (object.reward, object.range_stimulus_distance) = numbers;
                [
                    object.reward_stimulus,
                    object.reward_once_stimulus,
                    object.destroy_stimulus,
                ] = stimuli;
                (object, named)
            },
        )
}

/// Worlds that the original can describe completely.
fn describable_world() -> impl Strategy<Value = WorldDraft> {
    let image =
        (0.1..=100.0, 1u32..=360, 1u32..=360).prop_map(|(zoom, yaw_subdivisions, vertical_subdivisions)| ImageParams {
            zoom,
            yaw_subdivisions,
            vertical_subdivisions,
        });
    (
        select(vec![GameMode::Learn, GameMode::CollectImages]),
        0u32..=1_000_000_000,
        environment(),
        agent(),
        proptest::option::of(image),
        vec(object(), 0..6),
    )
        .prop_map(
            |(game_mode, max_steps, environment_params, agent_params, image_params, objects)| {
                let [width, depth] = environment_params.arena_size();
                let place = |(index, (mut object, named)): (usize, (Object, bool))| {
                    object.coordinates = [object.coordinates[0] * width, object.coordinates[1] * depth];
                    object.unique_name = named.then(|| format!("\"{index}\" of a World"));
                    object
                };
                WorldDraft {
                    schema: None,
                    version: WORLD_VERSION,
                    seed: None,
                    game_mode,
                    max_steps,
                    max_seconds: 0.0,
                    environment_params,
                    agent_params,
                    image_params,
                    rules: Rules::default(),
                    objects: objects.into_iter().enumerate().map(place).collect(),
                    progress: None,
                }
            },
        )
}

/// The keys of the original, by part.
const KEYS: [(&str, &str); 4] = [
    (
        "",
        "game_mode max_steps environment_params agent_params image_params objects",
    ),
    (
        "/environment_params",
        "bounding_wall_color light_intensity predefined_map map_size",
    ),
    (
        "/agent_params",
        "action_model agent_height agent_width max_linear_speed max_angular_speed observation_size coordinates heading",
    ),
    (
        "/objects/*",
        "class model coordinates color motion_model reward reward_stimulus reward_once_stimulus destroy_stimulus \
         range_stimulus_distance unique_name",
    ),
];

/// A world as a file of the original, with only the original's keys.
fn original(world: &World) -> String {
    let mut json: serde_json::Value = serde_json::from_str(&world.to_json()).expect("a world is JSON");
    let keep = |part: &mut serde_json::Value, keys: &str| {
        let part = part.as_object_mut().expect("a part is an object");
        part.retain(|key, _| keys.split(' ').any(|kept| kept == key));
    };
    for (at, keys) in KEYS {
        if at == "/objects/*" {
            let objects = json["objects"].as_array_mut().expect("objects are a list");
            for object in objects {
                keep(object, keys);
            }
        } else {
            keep(json.pointer_mut(at).expect("every part is written"), keys);
        }
    }
    json.to_string()
}

fn checked(world: WorldDraft) -> Result<World, TestCaseError> {
    world.check().map_err(|error| TestCaseError::fail(error.to_string()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 192)))]

    #[test]
    fn world_that_the_original_can_describe_is_read_without_other_warnings(world in describable_world()) {
        let world = checked(world)?;
        let text = original(&world);
        let (reread, found) = World::from_l2explorer("written", &text).map_err(|e| TestCaseError::fail(e.to_string()))?;
        // The only warnings are about the assumed speed of moving objects, and objects inside the walls of a map.
        let movers = world.objects.iter().filter(|object| moves(object.motion_model)).count();
        let assumed = found.iter().filter(|warning| warning.text.contains("m/s is assumed")).count();
        let walled = found.iter().filter(|warning| warning.text.contains("inside region")).count();
        prop_assert_eq!((assumed, found.len()), (movers, movers + walled), "{:?}", found);
        // The map comes from the original.
        prop_assert_eq!(reread, world.with_maps(driftworld_spec::maps::of_l2explorer()));
    }
}

/// The documents edited in the test below: a small one like those from the original's generator, and the original's examples if
/// available.
fn originals() -> Vec<(String, serde_json::Value)> {
    let object = |class: &str, x: f64| {
        serde_json::json!({
            "model": "1", "class": class, "coordinates": [x, 18.95], "color": [0.0, 0.0, 1.0], "motion_model": "random_waypoint",
            "destroy_stimulus": ["AgentCollide"], "reward_once_stimulus": ["AgentInRange"], "range_stimulus_distance": 2,
            "reward": 100.0, "unique_name": format!("{class} at {x}")
        })
    };
    let own = serde_json::json!({
        "game_mode": "learn", "max_steps": 3000,
        "environment_params": {
            "bounding_wall_color": [0, 100, 255], "light_intensity": 3.5, "predefined_map": "1", "map_size": [100, 100]
        },
        "agent_params": {
            "action_model": "byvelocity", "agent_height": 1.0, "agent_width": 1.0, "max_linear_speed": 15.0,
            "max_angular_speed": 85.0, "observation_size": 84, "coordinates": [10.0, 10.0], "heading": 0.0, "pickup_range": 5.0
        },
        "image_params": { "zoom": 5, "yaw_subdivisions": 4, "vertical_subdivisions": 22 },
        "objects": [
            object("geometric", 9.5), object("tree", -76.8),
            {
                "model": 2, "class": "bag", "coordinates": [1, 2], "reward": 5, "collectible": true, "reward_on": "pickup",
                "interaction_distance": 2.5
            }
        ]
    });
    let mut found = vec![("own".to_owned(), own)];
    for file in ["map_findobjects_0", "map_simple", "map_spawning"] {
        if let Some(path) = reference(&format!("l2explorer/{file}.json")) {
            let text = std::fs::read_to_string(path).expect("the original's maps are text");
            let map = serde_json::from_str(&text).expect("the original's maps are JSON");
            found.push((file.to_owned(), map));
        }
    }
    found
}

/// Every entry and item of a document, by pointer.
fn pointers(value: &serde_json::Value, at: &str, all: &mut Vec<String>) {
    let inner: Vec<(String, &serde_json::Value)> = match value {
        serde_json::Value::Object(map) => map.iter().map(|(key, value)| (key.clone(), value)).collect(),
        serde_json::Value::Array(items) => items
            .iter()
            .enumerate()
            .map(|(k, value)| (k.to_string(), value))
            .collect(),
        _ => Vec::new(),
    };
    for (key, value) in inner {
        let pointer = format!("{at}/{key}");
        pointers(value, &pointer, all);
        all.push(pointer);
    }
}

/// The replacement of an entry; `None` removes it.
fn replacement() -> impl Strategy<Value = Option<serde_json::Value>> {
    use serde_json::json;
    prop_oneof![
        2 => Just(None),
        8 => select(vec![
            json!(""), json!(null), json!(true), json!(false), json!([]), json!({}), json!(-1), json!(0), json!(1e18), json!(-1e300),
            json!(2.5), json!("12"), json!("NORTH"), json!([1]), json!([null, "x"]), json!(["AgentCollide", "AgentCollide", "InRange", "AgentCollide"]), json!({ "x": 1 }),
            json!("é".repeat(300)), json!([[0, 0], [1]]), json!(u64::MAX), json!("contact"), json!([300, -5, 7, 8]),
        ]).prop_map(Some),
    ]
}

fn has_number_or_long_text(value: &serde_json::Value) -> bool {
    match value {
        serde_json::Value::Number(_) => true,
        serde_json::Value::String(text) => text.parse::<f64>().is_ok() || text.chars().count() > 100,
        serde_json::Value::Array(items) => items.iter().any(has_number_or_long_text),
        _ => false,
    }
}

fn put(document: &mut serde_json::Value, pointer: &str, value: Option<serde_json::Value>) {
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer begins with a slash");
    match (document.pointer_mut(parent), value) {
        (Some(serde_json::Value::Object(map)), Some(value)) => {
            map.insert(key.to_owned(), value);
        }
        (Some(serde_json::Value::Object(map)), None) => {
            map.shift_remove(key);
        }
        (Some(serde_json::Value::Array(items)), value) => {
            let index: usize = key.parse().expect("the item is there");
            match value {
                Some(value) if index < items.len() => items[index] = value,
                None if index < items.len() => drop(items.remove(index)),
                _ => {}
            }
        }
        _ => {}
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 1024)))]

    /// After any edits of the original's keys, the document loads unless a number is out of range; unedited parts are read as
    /// before, and each assumption gives one warning at its pointer.
    #[test]
    fn edited_document_of_the_original_loads_and_nothing_else_changes(
        which in any::<proptest::sample::Index>(),
        edits in vec((any::<proptest::sample::Index>(), replacement(), any::<bool>()), 1..4),
    ) {
        let originals = originals();
        let (name, document) = which.get(&originals);
        let mut changed = document.clone();
        let mut touched = Vec::new();
        for (place, value, in_capitals) in edits {
            let mut all = Vec::new();
            pointers(&changed, "", &mut all);
            if all.is_empty() {
                continue;
            }
            let pointer = place.get(&all).clone();
            let value = match changed.pointer(&pointer).and_then(serde_json::Value::as_str) {
                Some(word) if in_capitals => Some(serde_json::json!(word.to_uppercase())),
                _ => value,
            };
            put(&mut changed, &pointer, value);
            touched.push(pointer);
        }
        let read = |json: &serde_json::Value| World::from_l2explorer(name, &json.to_string());
        let (before, _) = read(document).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let (after, warnings) = match read(&changed) {
            Ok(read) => read,
            Err(error) => {
                // Only numbers out of range and overlong strings are rejected, at their pointer.
                for problem in error.problems() {
                    let found = changed.pointer(&problem.pointer).cloned().unwrap_or_default();
                    let is_out_of_range = has_number_or_long_text(&found);
                    // Items shift when an earlier one is removed, so pointers are compared by part.
                    let part = |pointer: &str| pointer.split('/').nth(1).map(str::to_owned);
                    let is_edited = touched.iter().any(|place| part(place) == part(&problem.pointer));
                    let is_side = problem.pointer == "/environment_params/map_size";
                    prop_assert!(is_out_of_range && is_edited || is_side, "{}\n{}", error, changed);
                }
                prop_assert!(!error.problems().is_empty(), "{}", error);
                return Ok(());
            }
        };
        let strict = World::from_json("read", &after.to_json());
        prop_assert!(strict.is_ok(), "{:?}", strict);
        let mut reported: Vec<(&str, &str)> = warnings.iter().map(|w| (w.pointer.as_str(), w.text.as_str())).collect();
        let count = reported.len();
        reported.sort_unstable();
        reported.dedup();
        prop_assert_eq!(reported.len(), count, "each is reported once: {:?}", warnings);
        prop_assert!(warnings.iter().all(|w| w.line > 0 && changed.pointer(&w.pointer).is_some()), "{:?}", warnings);
        let is_touched = |part: &str| touched.iter().any(|pointer| pointer.starts_with(part));
        if !is_touched("/environment_params") {
            prop_assert_eq!(&after.environment_params, &before.environment_params);
        }
        if !is_touched("/agent_params") {
            prop_assert_eq!(&after.agent_params, &before.agent_params);
        }
        if !is_touched("/objects") {
            prop_assert_eq!(&after.objects, &before.objects);
        }
        if !is_touched("/max_steps") && !is_touched("/game_mode") {
            prop_assert_eq!((after.max_steps, after.game_mode), (before.max_steps, before.game_mode));
        }
    }
}
