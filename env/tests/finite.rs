//! Worlds in which any number may be at a limit of its range: all numbers in a step are finite, and the saved world resumes.

use driftworld_env::{Action, Environment};
use driftworld_spec::World;
use proptest::prelude::*;
use serde_json::{Map, Value, json};

/// A deterministic source of numbers from a seed.
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        ((mixed ^ (mixed >> 27)) >> 32) as usize % sides.max(1)
    }

    fn unit(&mut self) -> f64 {
        self.roll(1001) as f64 / 1000.0
    }
}

/// Words for string values in the world's schema.
const WORDS: &str = "a b tree geometric door switch rock animal red 2";

fn resolved<'a>(root: &'a Value, mut node: &'a Value) -> &'a Value {
    while let Some(target) = node["$ref"].as_str() {
        node = root.pointer(&target[1..]).expect("the schema's references resolve");
    }
    node
}

/// A value that a schema allows; numbers are often at a limit of their range.
fn value(root: &Value, node: &Value, dice: &mut Dice) -> Value {
    let node = resolved(root, node);
    if let Some(forms) = node["anyOf"].as_array().or_else(|| node["oneOf"].as_array()) {
        return value(root, &forms[dice.roll(forms.len())], dice);
    }
    if let Some(words) = node["enum"].as_array() {
        return words[dice.roll(words.len())].clone();
    }
    if node.get("const").is_some() {
        return node["const"].clone();
    }
    match node["type"].as_str().or_else(|| node["type"][0].as_str()) {
        Some("boolean") => json!(dice.roll(2) == 0),
        Some("string") => json!(WORDS.split(' ').nth(dice.roll(10))),
        Some(kind @ ("number" | "integer")) => {
            let [low, high] = ["minimum", "maximum"].map(|end| node[end].as_f64().unwrap_or(0.0));
            let near = low + (high - low).min(20.0) * dice.unit();
            let middle = f64::midpoint(low, high) + (high - low).min(20.0) * (dice.unit() - 0.5);
            let number = [low, high, near, middle][dice.roll(4)];
            if kind == "integer" {
                json!(number.round() as i64)
            } else {
                json!(number)
            }
        }
        Some("array") => {
            let least = node["minItems"].as_u64().unwrap_or(0) as usize;
            let most = node["maxItems"].as_u64().map_or(4, |most| most.min(4)) as usize;
            let length = least + dice.roll(most.saturating_sub(least) + 1);
            (0..length).map(|_| value(root, &node["items"], dice)).collect()
        }
        Some("object") => {
            let required = node["required"].as_array().into_iter().flatten();
            let required: Vec<&str> = required.filter_map(Value::as_str).collect();
            let properties = node["properties"].as_object().into_iter().flatten();
            let mut chosen = Map::new();
            for (key, property) in properties {
                if required.contains(&key.as_str()) || dice.roll(4) == 0 {
                    chosen.insert(key.clone(), value(root, property, dice));
                }
            }
            Value::Object(chosen)
        }
        _ => Value::Null,
    }
}

/// A random world: keeps each drawn value that leaves the world valid.
fn world(dice: &mut Dice) -> World {
    let root = World::schema().json();
    let mut text = json!({});
    let mut sound = World::default();
    let parts = ["agent_params", "environment_params", "rules", ""];
    for _ in 0..30 {
        let mut next = text.clone();
        let part = parts[dice.roll(parts.len())];
        let (place, node) = if part.is_empty() {
            (&mut next, root)
        } else {
            (&mut next[part], resolved(root, &root["properties"][part]))
        };
        let properties = node["properties"].as_object().expect("the schema has properties");
        let keys: Vec<&String> = properties
            .keys()
            .filter(|key| !["$schema", "version", "progress"].contains(&key.as_str()))
            .collect();
        let key = keys[dice.roll(keys.len())];
        let drawn = value(root, &properties[key], dice);
        match (&mut place[key.as_str()], drawn) {
            // Lists grow, sometimes by many overlapping objects.
            (Value::Array(list), Value::Array(more)) if key != "modalities" => {
                let times = [1, 1, 1, 25][dice.roll(4)];
                list.extend(more.iter().flat_map(|one| std::iter::repeat_n(one.clone(), times)));
            }
            (old, drawn) => *old = drawn,
        }
        if let Ok(read) = World::from_json("w", &next.to_string()) {
            (text, sound) = (next, read);
        }
    }
    let small = sound.edit(|world| {
        (
            world.agent_params.observation_size,
            world.agent_params.observation_width,
        ) = (8, None);
        world.agent_params.supersampling = 1;
        world.agent_params.frame_skip = world.agent_params.frame_skip.min(20);
    });
    small.expect("these settings fit every valid world")
}

/// Number of worlds to try; `DRIFTWORLD_FINITE` overrides it.
fn num_worlds() -> u32 {
    let asked = std::env::var("DRIFTWORLD_FINITE")
        .ok()
        .and_then(|number| number.parse().ok());
    asked.unwrap_or_else(|| crate::tier::quick_or_full(48, 3000))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(num_worlds()))]

    #[test]
    fn steps_are_finite_and_saved_worlds_resume(seed in any::<u64>()) {
        let dice = &mut Dice(seed);
        let world = world(dice);
        let shown = world.to_json();
        let mut environment = Environment::new(world);
        for _ in 0..8 {
            if environment.ended() {
                break;
            }
            let action = match environment.world().agent_params.num_actions() {
                Some(rows) => Action::Discrete(dice.roll(rows)),
                None => Action::Continuous([(); 3].map(|()| [0.0, 1.0, 1.0, 1e9, -1.0, f64::MAX][dice.roll(6)])),
            };
            let Ok(step) = environment.step(action) else { break };
            let made = format!("{step:?} {:?} {:?} {:?}", environment.agent(), environment.objects(), environment.state_vector());
            let total = environment.episode_return();
            prop_assert!(total.is_finite() && !made.contains("NaN") && !made.contains("inf"), "{made}\n{shown}");
            let written = environment.state();
            let read = World::from_json("state", &written.to_json());
            prop_assert!(read.is_ok(), "{}\n{shown}", read.unwrap_err());
            let read = read.expect("the document is valid");
            prop_assert_eq!(&read, &written);
            prop_assert_eq!(Environment::new(read).state().to_json(), written.to_json(), "{}", shown);
        }
        prop_assert!(environment.observe().depth.iter().all(|metres| metres.is_finite()), "{shown}");
    }
}
