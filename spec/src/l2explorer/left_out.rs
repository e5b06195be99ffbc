//! What a reset file of the original has no key for: all of it in one summary.

use super::write::warning;
use crate::warning::Warning;

/// The keys that are left out, each once, in the order in which they were met.
#[derive(Default)]
pub(super) struct LeftOut {
    /// The pointer to the first of them.
    first: String,
    /// Pointers in which `*` stands for any object.
    keys: Vec<String>,
}

impl LeftOut {
    /// A key of the world or of one of its parts.
    pub(super) fn key(&mut self, pointer: String) {
        self.add(pointer.clone(), pointer);
    }

    /// A key of an object.
    pub(super) fn of_object(&mut self, index: usize, key: &str) {
        self.add(format!("/objects/{index}/{key}"), format!("/objects/*/{key}"));
    }

    fn add(&mut self, pointer: String, key: String) {
        if self.keys.is_empty() {
            self.first = pointer;
        }
        if !self.keys.contains(&key) {
            self.keys.push(key);
        }
    }

    /// The summary, if anything was left out. It has no numbers of objects: worlds of one variant lose the same.
    pub(super) fn summary(self) -> Option<Warning> {
        let what = match self.keys.len() {
            0 => return None,
            1 => "key",
            _ => "keys",
        };
        let text = format!("left out, L2Explorer has no such {what}: {}", self.keys.join(", "));
        Some(warning(self.first, text))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value as Json, json};

    use crate::World;
    use crate::l2explorer::{PARTS, Part};

    /// The world of a document for tests, with all keys that there are.
    fn full() -> Json {
        let read = |name: &str| -> Json {
            let path = format!(
                "{}/../tests/documents/good/task/{name}.json",
                env!("CARGO_MANIFEST_DIR")
            );
            let text = std::fs::read_to_string(&path).unwrap();
            serde_json::from_str::<Json>(&text).unwrap()["world"].take()
        };
        let mut world = read("world_with_every_key");
        world["objects"] = read("fixtures_with_every_key")["objects"].take();
        world["objects"].as_array_mut().unwrap().truncate(1);
        world["environment_params"]["predefined_map"] = json!(0);
        world["environment_params"]["layout"] =
            json!({ "rooms": { "grid": [3, 2], "room": [20, 20], "seed": 4, "doors": "none" } });
        world["environment_params"]["zones"] =
            json!([{ "disc": { "center": [5, 5], "radius": 1 }, "ends": "failure" }]);
        world["agent_params"]["coordinates"] = json!([5, 5]);
        world
    }

    /// The document of a world as we write it.
    fn canonical(world: &Json) -> Json {
        let world = World::from_json("every key", &world.to_string()).unwrap_or_else(|error| panic!("{error}"));
        serde_json::from_str(&world.to_json()).unwrap()
    }

    /// The parts with the pointers to them, but objects, and the key by which each is known.
    fn parts() -> [(&'static str, &'static Part); 4] {
        [
            ("", &PARTS.world),
            ("/environment_params", &PARTS.environment),
            ("/agent_params", &PARTS.agent),
            ("/rules", &PARTS.rules),
        ]
    }

    /// Every key of ours that stands in a world, but those that have a warning of their own, as the summary calls it.
    fn ours(world: &Json) -> Vec<String> {
        let mut keys = Vec::new();
        for (at, part) in parts() {
            let own = part
                .ours
                .iter()
                .filter(|key| !["rules", "max_seconds", "progress"].contains(*key));
            let stands = |key: &&&str| {
                let value = world.pointer(&format!("{at}/{key}"));
                value.is_some_and(|value| part.defaults.get(**key) != Some(value))
            };
            keys.extend(own.filter(stands).map(|key| format!("{at}/{key}")));
        }
        for key in &PARTS.object.ours {
            let mut objects = world["objects"].as_array().into_iter().flatten();
            let differs = |object: &Json| {
                object
                    .get(*key)
                    .is_some_and(|own| PARTS.object.defaults.get(*key) != Some(own))
            };
            if objects.any(differs) {
                keys.push(format!("/objects/*/{key}"));
            }
        }
        keys
    }

    fn written(world: &Json) -> (Json, Vec<String>, Vec<String>) {
        let world = World::from_json("every key", &world.to_string()).unwrap_or_else(|error| panic!("{error}"));
        let (text, warnings) = world.to_l2explorer();
        let texts = || warnings.iter().map(|warning| warning.text.as_str());
        let summaries = texts().filter_map(|text| {
            let listed = text.strip_prefix("left out, L2Explorer has no such key")?;
            listed.trim_start_matches('s').strip_prefix(": ")
        });
        let summaries: Vec<&str> = summaries.collect();
        assert!(summaries.len() <= 1, "{summaries:?}");
        let mut listed: Vec<String> = summaries
            .iter()
            .flat_map(|listed| listed.split(", "))
            .map(str::to_owned)
            .collect();
        listed.sort();
        let again = World::from_l2explorer("written", &text).unwrap_or_else(|error| panic!("{error}"));
        (
            serde_json::from_str(&text).unwrap(),
            listed,
            again.1.iter().map(ToString::to_string).collect(),
        )
    }

    /// One summary names every key that is left out and no other, and the file has none of them.
    #[test]
    fn one_summary_names_all_keys_of_ours() {
        let world = full();
        let mut expected = ours(&canonical(&world));
        expected.sort();
        let (text, listed, _) = written(&world);
        assert_eq!(listed, expected);
        for key in [
            "layout",
            "zones",
            "walls",
            "energy",
            "carry_limit",
            "show_carried",
            "door",
            "switch",
            "portable",
        ] {
            assert!(
                listed.iter().any(|listed| listed.ends_with(&format!("/{key}"))),
                "{key} in {listed:?}"
            );
        }
        for (at, part) in parts() {
            for key in &part.ours {
                assert_eq!(text.pointer(&format!("{at}/{key}")), None);
            }
        }
        for (object, key) in text["objects"].as_array().unwrap().iter().zip(&PARTS.object.ours) {
            assert_eq!(object.get(*key), None);
        }
    }

    /// Each key of ours alone has a summary of itself alone, and what is written without it has none.
    #[test]
    fn each_key_alone_is_named_alone() {
        let every = full();
        // Another model than that whose body the document of all keys has.
        let plain = json!({ "objects": [{ "class": "tree", "model": "3", "coordinates": [9, 9] }] });
        assert_eq!(written(&plain).1, Vec::<String>::new());
        let mut named = 0;
        let own = |(at, part): (&'static str, &'static Part)| part.ours.iter().map(move |key| (at, *key));
        let objects = PARTS.object.ours.iter().map(|key| ("/objects/0", *key));
        let special = ["rules", "max_seconds", "progress"];
        let keys = parts().into_iter().flat_map(own).chain(objects);
        for (at, key) in keys.filter(|(_, key)| !special.contains(key)) {
            let Some(value) = every.pointer(&format!("{at}/{key}")) else {
                continue;
            };
            let mut world = plain.clone();
            match at {
                "" => world[key] = value.clone(),
                "/objects/0" => world["objects"][0][key] = value.clone(),
                part => world[&part[1..]] = json!({ key: value }),
            }
            // Some keys go with others alone, and some stand at their defaults.
            if World::from_json("alone", &world.to_string()).is_err() {
                continue;
            }
            let expected = ours(&canonical(&world));
            assert_eq!(written(&world).1, expected);
            if !expected.is_empty() {
                assert_eq!(expected, [format!("{}/{key}", at.replace('0', "*"))]);
                named += 1;
            }
        }
        assert!(named > 40, "{named} keys were tried");
    }

    /// The arena of a layout is as large without it.
    #[test]
    fn the_arena_keeps_its_size() {
        assert_eq!(
            written(&full()).0["environment_params"]["map_size"],
            json!([60.0, 40.0])
        );
    }
}
