//! Two variants under one seed share every random draw that their difference does not affect: worlds that differ in nothing
//! that affects motion follow the same paths, to the last bit.

use std::collections::{BTreeMap, BTreeSet};

use driftworld::env::{Action, Agent, Environment, RandomAgent};
use driftworld::generator::Sampler;
use driftworld::spec::{
    ActionModel, Looks, MotionModel, Object, Pushable, Respawn, Stimulus, Variant, Wall, World, WorldDraft,
};
use driftworld::tasks;
use serde_json::Value;

/// Whether paths depend on a key. A verdict also covers everything below the key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// Affects motion, or the presence of bodies.
    Moves,
    /// Only decides when an episode ends.
    Ends,
    /// Affects no path at all.
    Idle,
    /// Describes the document's format.
    Form,
    /// Seeds random numbers.
    Chance,
}

use Verdict::{Chance, Ends, Form, Idle, Moves};

/// Every key of a world. A new key needs a verdict here.
const VERDICTS: &[(&str, Verdict)] = &[
    ("/$schema", Form),
    ("/version", Form),
    ("/seed", Chance),
    ("/progress", Form),
    ("/game_mode", Idle),
    ("/max_steps", Ends),
    ("/max_seconds", Ends),
    ("/image_params", Idle),
    ("/environment_params/bounding_wall_color", Idle),
    ("/environment_params/light_intensity", Idle),
    ("/environment_params/predefined_map", Moves),
    ("/environment_params/map_regions", Moves),
    ("/environment_params/map_size", Moves),
    ("/environment_params/wall_height", Idle),
    ("/environment_params/walls/*/polygon", Moves),
    ("/environment_params/walls/*/height", Idle),
    ("/environment_params/walls/*/color", Idle),
    ("/environment_params/sun_direction", Idle),
    ("/environment_params/light_color", Idle),
    ("/environment_params/ambient_light", Idle),
    ("/environment_params/sky_color", Idle),
    ("/environment_params/ground_color", Idle),
    ("/environment_params/fog_distance", Idle),
    ("/environment_params/zones/*/disc", Moves),
    ("/environment_params/zones/*/polygon", Moves),
    ("/environment_params/zones/*/name", Idle),
    ("/environment_params/zones/*/reward_per_second", Ends),
    ("/environment_params/zones/*/reward_on_entering", Ends),
    ("/environment_params/zones/*/speed_factor", Moves),
    ("/environment_params/zones/*/ends", Ends),
    ("/environment_params/zones/*/teleport", Moves),
    ("/environment_params/zones/*/color", Idle),
    ("/environment_params/zones/*/visible", Idle),
    ("/environment_params/layout", Moves),
    ("/environment_params/looks", Idle),
    ("/agent_params/action_model", Moves),
    // The height at which ranges are measured.
    ("/agent_params/agent_height", Moves),
    ("/agent_params/agent_width", Moves),
    ("/agent_params/max_linear_speed", Moves),
    ("/agent_params/max_angular_speed", Moves),
    ("/agent_params/observation_size", Idle),
    ("/agent_params/observation_width", Idle),
    ("/agent_params/supersampling", Idle),
    ("/agent_params/coordinates", Moves),
    ("/agent_params/heading", Moves),
    ("/agent_params/time_step", Moves),
    ("/agent_params/frame_skip", Moves),
    ("/agent_params/field_of_view", Idle),
    ("/agent_params/modalities", Idle),
    ("/agent_params/state_features", Idle),
    ("/agent_params/instruction", Idle),
    ("/agent_params/actions", Moves),
    ("/agent_params/interact", Moves),
    ("/agent_params/energy", Ends),
    ("/agent_params/carry_limit", Moves),
    ("/agent_params/show_carried", Idle),
    ("/rules/step_reward", Ends),
    ("/rules/reward_per_second", Ends),
    ("/rules/order_penalty", Ends),
    ("/rules/shaping", Ends),
    ("/rules/success", Ends),
    ("/rules/failure", Ends),
    // The shape of the body.
    ("/objects/*/class", Moves),
    ("/objects/*/model", Moves),
    ("/objects/*/body_model", Moves),
    ("/objects/*/text", Idle),
    ("/objects/*/coordinates", Moves),
    ("/objects/*/heading", Moves),
    ("/objects/*/scale", Moves),
    ("/objects/*/color", Idle),
    ("/objects/*/surface", Idle),
    ("/objects/*/solid", Moves),
    ("/objects/*/pushable", Moves),
    ("/objects/*/reward", Ends),
    // An object that has paid counts as collected, and then the next object of its sequence can be destroyed.
    ("/objects/*/reward_probability", Moves),
    ("/objects/*/reward_stimulus", Moves),
    ("/objects/*/reward_once_stimulus", Moves),
    ("/objects/*/destroy_stimulus", Moves),
    ("/objects/*/range_stimulus_distance", Moves),
    ("/objects/*/motion_model", Moves),
    ("/objects/*/speed", Moves),
    ("/objects/*/turn_rate", Moves),
    ("/objects/*/sight_range", Moves),
    ("/objects/*/waypoints", Moves),
    ("/objects/*/order", Moves),
    ("/objects/*/respawn", Moves),
    ("/objects/*/seed", Chance),
    ("/objects/*/tag", Ends),
    ("/objects/*/unique_name", Idle),
    ("/objects/*/energy", Ends),
    ("/objects/*/range_trigger", Moves),
    ("/objects/*/contact_trigger", Moves),
    ("/objects/*/door", Moves),
    ("/objects/*/switch", Moves),
    ("/objects/*/portable", Moves),
];

const STEPS: usize = 500;

fn verdict(key: &str) -> Option<Verdict> {
    let holds = |judged: &str| key == judged || key.strip_prefix(judged).is_some_and(|rest| rest.starts_with('/'));
    VERDICTS
        .iter()
        .find(|(judged, _)| holds(judged))
        .map(|(_, verdict)| *verdict)
}

/// Every leaf of a document by its key, list indices as `*`, with all values found there.
fn leaves(value: &Value, key: &str, found: &mut BTreeMap<String, Vec<Value>>) {
    match value {
        Value::Object(map) if !map.is_empty() => {
            for (name, value) in map {
                leaves(value, &format!("{key}/{name}"), found);
            }
        }
        Value::Array(list) if list.iter().any(|value| value.is_object() || value.is_array()) => {
            for value in list {
                leaves(value, &format!("{key}/*"), found);
            }
        }
        leaf => found.entry(key.to_owned()).or_default().push(leaf.clone()),
    }
}

/// The worlds of the valid documents, which together contain every key.
fn documents() -> Vec<Value> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/documents/good/world");
    let files = std::fs::read_dir(folder).expect("the folder is part of the tree");
    let read = |file: std::io::Result<std::fs::DirEntry>| {
        let text = std::fs::read_to_string(file.expect("it can be listed").path()).expect("it can be read");
        serde_json::from_str(&text).expect("it is JSON")
    };
    files.map(read).collect()
}

/// A world of each built-in task, each of a different variant, with an example of everything that moves, pays randomly, returns or
/// can be pushed.
fn worlds() -> Vec<World> {
    let mut worlds = Vec::new();
    for (number, task) in tasks::built_in_names().into_iter().enumerate() {
        let variants = tasks::variants(task).expect("built-in tasks are valid");
        let variant = &variants[(7 * number + 3) % variants.len()];
        let world = draw(variant, number as u64, 5).edit(|world| {
            add_examples(world);
            // Every other world has no seed, so that the positions of objects determine their random numbers.
            world.seed = world.seed.filter(|_| number % 2 == 0);
            if number % 2 == 0 {
                world.environment_params.looks = Looks::default();
            }
        });
        worlds.push(world.expect("the world is valid"));
    }
    worlds
}

fn draw(variant: &Variant, seed: u64, index: u64) -> World {
    Sampler::new(variant, seed)
        .world(index)
        .unwrap_or_else(|error| panic!("{error}"))
}

fn add_examples(world: &mut WorldDraft) {
    world.agent_params.action_model = ActionModel::ByVelocity;
    // Endings are tested separately.
    world.limit_steps(0);
    (world.rules.success, world.rules.failure) = (Vec::new(), Vec::new());
    let [x, y] = world.agent_params.coordinates;
    let near = |class: &str, dx: f64, dy: f64| Object::new(class, [x + dx, y + dy]);
    let mut box_ = near("cube", 0.2, 1.6);
    box_.pushable = Some(Pushable {
        mass: 10.0,
        friction: 0.2,
    });
    let mut coin = near("geometric", -1.5, 1.0);
    (coin.reward, coin.solid, coin.range_stimulus_distance) = (1.0, false, 2.0);
    coin.reward_stimulus = vec![Stimulus::AgentInRange];
    coin.destroy_stimulus = vec![Stimulus::AgentInRange];
    coin.respawn = Some(Respawn {
        delay: 0.5,
        radius: 4.0,
    });
    let mut arm = near("pot", 2.0, 2.0);
    (arm.reward, arm.reward_probability, arm.order) = (2.0, 0.5, Some(1));
    arm.reward_stimulus = vec![Stimulus::AgentInRange, Stimulus::AgentCollide];
    arm.range_stimulus_distance = 3.0;
    // It disappears once the arm has paid.
    let mut after = near("bag", -2.0, -2.0);
    (after.order, after.range_stimulus_distance) = (Some(2), 3.0);
    after.destroy_stimulus = vec![Stimulus::AgentInRange];
    let mut wanderer = near("mushroom", 4.0, -3.0);
    (wanderer.motion_model, wanderer.speed) = (MotionModel::RandomWaypoint, 2.0);
    let mut hunter = near("barrel", -5.0, 4.0);
    (hunter.motion_model, hunter.speed, hunter.turn_rate) = (MotionModel::Predator, 1.0, Some(120.0));
    let mut prey = near("chair", 5.0, 5.0);
    (prey.motion_model, prey.speed, prey.sight_range) = (MotionModel::Prey, 1.5, Some(8.0));
    world.environment_params.walls.push(Wall {
        polygon: [[6.0, -6.0], [8.0, -6.0], [8.0, -2.0]]
            .map(|[dx, dy]| [x + dx, y + dy])
            .to_vec(),
        height: None,
        color: None,
    });
    world.objects.extend([box_, coin, arm, after, wanderer, hunter, prey]);
    // No agent or object enters it: the effects of zones are tested in `env`.
    let [east, north] = world.environment_params.arena_size().map(|side| side / 2.0);
    let zone = serde_json::json!({ "disc": { "center": [east, north], "radius": 0.1 } });
    let zone = serde_json::from_value(zone).expect("it is a zone");
    world.environment_params.zones.push(zone);
}

/// All paths of an episode, as bits: the agent's and every object's position, heading and presence, step by step. The agent acts
/// at random, with its own seed.
fn paths_of(world: &World, seed: u64) -> Vec<Vec<u32>> {
    let mut environment = Environment::new(world.clone());
    let mut agent = RandomAgent::new(seed);
    let mut paths = Vec::with_capacity(STEPS);
    while paths.len() < STEPS && !environment.ended() {
        let action = agent.act(&environment);
        environment.step(action).unwrap_or_else(|error| panic!("{error}"));
        let now = environment.agent();
        let mut bits = vec![
            now.position[0].to_bits(),
            now.position[1].to_bits(),
            now.heading_deg.to_bits(),
        ];
        for item in &environment.scene().items {
            bits.extend([item.position[0].to_bits(), item.position[1].to_bits()]);
            bits.extend([item.heading_deg.to_bits(), u32::from(item.visible)]);
        }
        paths.push(bits);
    }
    paths
}

/// The first step in which two episodes differ; one may end before the other.
fn first_difference(a: &[Vec<u32>], b: &[Vec<u32>]) -> Option<usize> {
    a.iter().zip(b).position(|(a, b)| a != b)
}

/// A different value.
fn other(value: &Value, examples: &[Value]) -> Option<Value> {
    if let Some(example) = examples.iter().find(|example| *example != value && !example.is_null()) {
        return Some(example.clone());
    }
    match value {
        Value::Bool(truth) => Some(Value::from(!truth)),
        Value::Number(number) => number.as_f64().map(|number| Value::from(number / 2.0 + 0.25)),
        Value::String(text) => Some(Value::from(format!("{text} too"))),
        _ => None,
    }
}

/// Changes a key wherever it occurs or could occur, if the world is valid afterwards.
fn change(world: &World, key: &str, examples: &[Value]) -> Option<World> {
    let mut document = serde_json::to_value(world).expect("a world serialises");
    let path: Vec<&str> = key.split('/').skip(1).collect();
    let mut number = 0;
    put(&mut document, &path, examples, &mut number);
    let text = document.to_string();
    let changed = World::from_json(key, &text).ok()?;
    (changed != *world).then_some(changed)
}

fn put(place: &mut Value, path: &[&str], examples: &[Value], number: &mut usize) {
    let Some((step, rest)) = path.split_first() else { return };
    match (*step, place) {
        ("*", Value::Array(list)) => {
            for value in list {
                if rest.is_empty() {
                    return;
                }
                put(value, rest, examples, number);
            }
        }
        (name, Value::Object(map)) if rest.is_empty() => {
            let old = map.get(name).cloned().unwrap_or(Value::Null);
            if let Some(mut value) = other(&old, examples) {
                if name == "unique_name" {
                    value = Value::from(format!("object {number}"));
                }
                *number += 1;
                map.insert(name.to_owned(), value);
            }
        }
        (name, Value::Object(map)) if map.contains_key(name) => put(&mut map[name], rest, examples, number),
        _ => {}
    }
}

#[test]
fn every_key_has_a_verdict_and_idle_keys_do_not_change_paths() {
    let mut found = BTreeMap::new();
    for document in documents() {
        leaves(&document, "", &mut found);
    }
    let worlds = worlds();
    for world in &worlds {
        leaves(
            &serde_json::to_value(world).expect("a world serialises"),
            "",
            &mut found,
        );
    }
    // An empty document is one leaf without a key.
    found.remove("");
    let unjudged: Vec<&String> = found.keys().filter(|key| verdict(key).is_none()).collect();
    assert!(
        unjudged.is_empty(),
        "do paths depend on these keys? Add them to VERDICTS: {unjudged:?}"
    );
    let gone = VERDICTS.iter().filter(|(key, _)| {
        !found
            .keys()
            .any(|leaf| leaf == key || leaf.strip_prefix(key).is_some_and(|rest| rest.starts_with('/')))
    });
    let gone: Vec<&(&str, Verdict)> = gone.collect();
    assert!(gone.is_empty(), "no document has these keys: {gone:?}");

    // Parts that only some documents contain are added to all worlds as a whole.
    let wholes = ["/image_params", "/rules/shaping", "/rules/success", "/rules/failure"];
    let mut keys: BTreeSet<String> = VERDICTS
        .iter()
        .filter(|(_, verdict)| [Idle, Ends].contains(verdict))
        .map(|(key, _)| (*key).to_owned())
        .collect();
    let examples_of = |key: &str| -> Vec<Value> {
        let at = |document: &Value| document.pointer(key).cloned();
        if wholes.contains(&key) || !found.contains_key(key) {
            return documents().iter().filter_map(at).collect();
        }
        found[key].clone()
    };
    let mut tried: BTreeMap<String, usize> = BTreeMap::new();
    for (number, world) in worlds.iter().enumerate() {
        let seed = number as u64;
        let before = paths_of(world, seed);
        assert_eq!(before.len(), STEPS);
        let moved = before
            .first()
            .zip(before.last())
            .is_some_and(|(first, last)| first[3..] != last[3..]);
        assert!(moved, "objects move in world {number}");
        // Change all keys at once; try single keys only after a failure.
        let mut changed = world.clone();
        for key in &keys {
            let examples = examples_of(key);
            if let Some(next) = change(&changed, key, &examples) {
                changed = next;
                *tried.entry(key.clone()).or_default() += 1;
            }
        }
        let changed = changed.edit(|world| {
            world.max_steps = world.max_steps.max(1000);
            if world.max_seconds > 0.0 {
                world.max_seconds = 1e6;
            }
            (world.rules.success, world.rules.failure) = (Vec::new(), Vec::new());
        });
        let after = paths_of(&changed.expect("the world is valid"), seed);
        if first_difference(&before, &after).is_some() || after.len() < STEPS {
            let culprits = keys.iter().filter_map(|key| {
                let alone = change(world, key, &examples_of(key))?;
                first_difference(&before, &paths_of(&alone, seed)).map(|step| format!("{key} in step {step}"))
            });
            panic!("world {number}: paths differ by {:?}", culprits.collect::<Vec<_>>());
        }
    }
    keys.retain(|key| !tried.contains_key(key));
    assert!(keys.is_empty(), "changed in no world: {keys:?}");
}

#[test]
fn endings_do_not_change_paths_before_the_end() {
    let world = &worlds()[0];
    let before = paths_of(world, 9);
    for (key, value) in [
        ("max_steps", serde_json::json!(40)),
        ("max_seconds", serde_json::json!(3.05)),
        (
            "rules",
            serde_json::json!({ "success": [{ "return_at_least": 20 }], "reward_per_second": 50 }),
        ),
        (
            "rules",
            serde_json::json!({ "failure": [{ "return_at_most": -20 }], "step_reward": -5 }),
        ),
    ] {
        let mut document = serde_json::to_value(world).expect("a world serialises");
        document[key] = value;
        let ending = World::from_json(key, &document.to_string()).unwrap_or_else(|error| panic!("{error}"));
        let after = paths_of(&ending, 9);
        assert!(after.len() < STEPS, "{key} ends the episode");
        assert_eq!(first_difference(&before, &after), None, "{key}");
    }
}

#[test]
fn pay_and_light_do_not_move_wandering_balls() {
    let task = tasks::variants("moving_object").expect("it is built in");
    let positions = |name: &str| {
        let variant = task.iter().find(|variant| variant.name() == name).expect("it exists");
        let mut environment = Environment::new(draw(variant, 3, 0));
        for _ in 0..60 {
            environment
                .step(Action::Continuous([0.0; 3]))
                .unwrap_or_else(|error| panic!("{error}"));
        }
        let items = environment.scene().items.iter();
        items.map(|item| (item.position, item.heading_deg)).collect::<Vec<_>>()
    };
    let wandering = positions("wandering");
    for name in ["modest", "dusk", "blue", "urgent", "patient"] {
        assert_eq!(positions(name), wandering, "{name}");
    }
    assert_ne!(positions("fast"), wandering);
}

#[test]
fn variants_of_a_task_share_the_seeds_of_worlds_and_of_objects() {
    for task in tasks::built_in_names() {
        let variants = tasks::variants(task).expect("built-in tasks are valid");
        let seeds = |variant: &Variant, seed: u64, index: u64| {
            let world = draw(variant, seed, index);
            let own = world
                .objects
                .iter()
                .filter_map(|object| Some((object.tag.clone()?, object.seed?)));
            (
                world.seed.expect("sampled worlds have a seed"),
                own.collect::<BTreeSet<_>>(),
            )
        };
        let (first, own) = seeds(&variants[0], 7, 3);
        assert_ne!(first, seeds(&variants[0], 7, 4).0);
        assert_ne!(first, seeds(&variants[0], 8, 3).0);
        for variant in &variants {
            let (seed, theirs) = seeds(variant, 7, 3);
            assert_eq!(seed, first, "{}", variant.id());
            let both: BTreeSet<&String> = own.iter().chain(&theirs).map(|(tag, _)| tag).collect();
            for tag in both {
                let of = |seeds: &BTreeSet<(String, u64)>| seeds.iter().filter(|(other, _)| other == tag).count();
                let shared = own.intersection(&theirs).filter(|(other, _)| other == tag).count();
                assert_eq!(shared, of(&own).min(of(&theirs)), "{}: {tag}", variant.id());
            }
        }
    }
}
