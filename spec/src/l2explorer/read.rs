//! Reading the dialect of L2Explorer's reset files into a [`World`], with a warning for everything that was not plain.
//! How a single value may be written is in `lenient.rs`; our own form of a world is read, strictly, in `world/mod.rs`.

use std::collections::BTreeSet;

use serde_json::{Map, Value as Json, json};

use super::lenient::{drop_decimal_point, stimuli, word};
use super::{AGENT, ENVIRONMENT, IMAGE, Keys, OBJECT, RULES, WORLD, Warning, black_is_chosen};
use crate::document::{Document, describe, escape};
use crate::error::{Problem, SpecError};
use crate::schema;
use crate::world::{Object, World};

impl World {
    /// Reads a reset file of the original: words in any case, numbers as strings, colours in 0..255, old keys.
    ///
    /// A colour of (0, 0, 0) is the original's default; on anything but `geometric`, `cube` and `icosphere` it is read as
    /// the asset's own colours.
    ///
    /// # Errors
    /// [`SpecError`] where the file is not JSON, or holds a value that no leniency can make sense of.
    pub fn from_l2explorer(name: &str, text: &str) -> Result<(Self, Vec<Warning>), SpecError> {
        let mut document = Document::parse(name, text)?;
        let mut reader = Reader::default();
        let value = reader.world(&document.value);
        document.value = value;
        let kept = reader.kept;
        let original = |mut problem: Problem| {
            problem.pointer = original_pointer(&problem.pointer, &kept);
            problem
        };
        document.fail_on(
            schema::world()
                .problems(&document.value)
                .into_iter()
                .map(original)
                .collect(),
        )?;
        let world: Self = document.deserialize()?;
        document.fail_on(world.problems().into_iter().map(original).collect())?;
        let warnings = document.warnings(reader.warnings.into_iter().chain(outside(&world, &kept)));
        Ok((world, warnings))
    }
}

impl Object {
    /// Reads one object as the original writes it, as [`World::from_l2explorer`] reads the objects of a world.
    ///
    /// # Errors
    /// [`SpecError`] where the text is not JSON, has no class, or holds a value that no leniency can make sense of.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Object;
    /// let text = r#"{ "class": "Tree", "model": 2, "coordinates": ["3", 4], "reward_stimulus": "agentcollide" }"#;
    /// let (tree, warnings) = Object::from_l2explorer("payload", text)?;
    /// assert_eq!((tree.class.as_str(), tree.coordinates), ("tree", [3.0, 4.0]));
    /// assert_eq!(warnings[0].to_string(), "payload:1:47 (/coordinates): the text \"3\" is read as a number");
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn from_l2explorer(name: &str, text: &str) -> Result<(Self, Vec<Warning>), SpecError> {
        let mut document = Document::parse(name, text)?;
        let mut reader = Reader::default();
        if let Some(map) = document.value.as_object().cloned() {
            document.value = Json::Object(reader.object("", &map));
        }
        document.check_schema(schema::object())?;
        let object = document.deserialize()?;
        Ok((object, document.warnings(reader.warnings)))
    }
}

impl Document<'_> {
    /// What the reader remarked, in the order of the text.
    pub(super) fn warnings(&self, remarks: impl IntoIterator<Item = (String, String)>) -> Vec<Warning> {
        let remarks: Vec<(String, String)> = remarks.into_iter().collect();
        let pointers: Vec<&str> = remarks.iter().map(|(pointer, _)| pointer.as_str()).collect();
        let places = self.places(&pointers);
        let warning = |((pointer, text), (line, column))| {
            let name = self.name.to_owned();
            Warning {
                name,
                pointer,
                line,
                column,
                text,
            }
        };
        let mut warnings: Vec<Warning> = remarks.into_iter().zip(places).map(warning).collect();
        warnings.sort_by_key(|warning| (warning.line, warning.column));
        warnings
    }
}

/// Objects were skipped on reading: names the place in the file of a place in the world.
fn original_pointer(pointer: &str, kept: &[usize]) -> String {
    let mut tokens: Vec<String> = pointer.split('/').map(str::to_owned).collect();
    if let [_, list, index, ..] = &mut tokens[..]
        && list == "objects"
        && let Some(original) = index.parse::<usize>().ok().and_then(|index| kept.get(index))
    {
        *index = original.to_string();
    }
    tokens.join("/")
}

fn outside(world: &World, kept: &[usize]) -> impl Iterator<Item = (String, String)> {
    let arena = &world.environment_params;
    let [width, depth] = arena.arena_size();
    world
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| !arena.contains(object.coordinates))
        .map(move |(index, object)| {
            let [x, y] = object.coordinates;
            let text = format!(
                "the {} stands at ({x:.1}, {y:.1}), outside the {width} × {depth} m arena; it is kept, out of reach",
                object.class
            );
            (format!("/objects/{}/coordinates", kept[index]), text)
        })
}

#[derive(Default)]
pub(super) struct Reader {
    warnings: Vec<(String, String)>,
    /// For each object of the world, its index in the file.
    kept: Vec<usize>,
}

impl Reader {
    pub(super) fn warn(&mut self, pointer: impl Into<String>, text: impl Into<String>) {
        self.warnings.push((pointer.into(), text.into()));
    }

    fn world(&mut self, json: &Json) -> Json {
        let Some(map) = json.as_object() else {
            return json.clone();
        };
        let mut world = self.keys("", map, &WORLD);
        word(&mut world, "game_mode");
        self.whole("", &mut world, "max_steps");
        if let Some(Json::Object(map)) = world.get("environment_params").cloned() {
            world.insert("environment_params".into(), Json::Object(self.environment(&map)));
        }
        if let Some(Json::Object(map)) = world.get("agent_params").cloned() {
            world.insert("agent_params".into(), Json::Object(self.agent(&map)));
        }
        if let Some(Json::Object(map)) = world.get("image_params").cloned() {
            let at = "/image_params";
            let mut image = self.keys(at, &map, &IMAGE);
            self.number(at, &mut image, "zoom");
            self.whole(at, &mut image, "yaw_subdivisions");
            self.whole(at, &mut image, "vertical_subdivisions");
            world.insert("image_params".into(), Json::Object(image));
        }
        if let Some(Json::Object(map)) = world.get("rules").cloned() {
            let mut rules = self.keys("/rules", &map, &RULES);
            word(&mut rules, "success");
            word(&mut rules, "failure");
            world.insert("rules".into(), Json::Object(rules));
        }
        if let Some(Json::Array(objects)) = world.get("objects").cloned() {
            world.insert("objects".into(), Json::Array(self.objects(&objects)));
        }
        Json::Object(world)
    }

    /// The entries with their keys as we write them; keys that are not known are left out with a warning.
    fn keys(&mut self, pointer: &str, map: &Map<String, Json>, known: &Keys) -> Map<String, Json> {
        let plain = |key: &str| key.replace('_', "").to_lowercase();
        let mut renamed = Map::new();
        let mut seen = BTreeSet::new();
        for (key, value) in map {
            let old = match (pointer, plain(key).as_str()) {
                ("/agent_params", "initialcoordinates") => Some("coordinates"),
                ("", "$schema") => continue,
                _ => None,
            };
            let place = format!("{pointer}/{}", escape(key));
            let Some(name) = old.or_else(|| known.all().find(|name| plain(name) == plain(key))) else {
                self.warn(place, format!("the key {key:?} has no meaning here and is left out"));
                continue;
            };
            if key != name {
                self.warn(place, format!("the key {key:?} is read as {name:?}"));
            }
            if seen.insert(name) {
                renamed.insert(name.to_owned(), value.clone());
            }
        }
        renamed
    }

    fn environment(&mut self, map: &Map<String, Json>) -> Map<String, Json> {
        let at = "/environment_params";
        let mut environment = self.keys(at, map, &ENVIRONMENT);
        for key in ["light_intensity", "map_size", "wall_height"] {
            self.number(at, &mut environment, key);
        }
        self.whole(at, &mut environment, "predefined_map");
        self.color(at, &mut environment, "bounding_wall_color");
        environment
    }

    fn agent(&mut self, map: &Map<String, Json>) -> Map<String, Json> {
        let at = "/agent_params";
        let mut agent = self.keys(at, map, &AGENT);
        for key in ["action_model", "modalities", "actions"] {
            word(&mut agent, key);
        }
        if agent.shift_remove("pickup_range").is_some() {
            self.warn(
                format!("{at}/pickup_range"),
                "pickup_range is an old key; interacting reaches 1 m ahead, and it is left out",
            );
        }
        let numbers = [
            "agent_height",
            "agent_width",
            "max_linear_speed",
            "max_angular_speed",
            "coordinates",
            "heading",
        ];
        for key in numbers {
            self.number(at, &mut agent, key);
        }
        self.whole(at, &mut agent, "observation_size");
        self.heading(at, &mut agent);
        agent
    }

    fn objects(&mut self, objects: &[Json]) -> Vec<Json> {
        let mut read = Vec::new();
        for (index, json) in objects.iter().enumerate() {
            let at = format!("/objects/{index}");
            let Some(map) = json.as_object() else {
                read.push(json.clone());
                self.kept.push(index);
                continue;
            };
            let object = self.object(&at, map);
            if object.get("class").is_none_or(|class| class.is_null() || class == "") {
                self.warn(at, "an object without a class is skipped");
                continue;
            }
            read.push(Json::Object(object));
            self.kept.push(index);
        }
        read
    }

    fn object(&mut self, at: &str, map: &Map<String, Json>) -> Map<String, Json> {
        let mut object = self.keys(at, map, &OBJECT);
        word(&mut object, "class");
        drop_decimal_point(&mut object, "model");
        word(&mut object, "motion_model");
        if object
            .get("motion_model")
            .is_some_and(|model| model == "random_waypoints")
        {
            object.insert("motion_model".into(), json!("random_waypoint"));
        }
        for key in [
            "coordinates",
            "heading",
            "scale",
            "reward",
            "range_stimulus_distance",
            "interaction_distance",
        ] {
            self.number(at, &mut object, key);
        }
        for key in ["reward_stimulus", "reward_once_stimulus", "destroy_stimulus"] {
            stimuli(&mut object, key);
        }
        self.heading(at, &mut object);
        self.old_reward(at, &mut object);
        self.color(at, &mut object, "color");
        let class = object.get("class").and_then(Json::as_str).unwrap_or_default();
        if object.get("color") == Some(&json!([0.0, 0.0, 0.0])) && !black_is_chosen(class) {
            object.shift_remove("color");
        }
        object
    }

    /// The keys of early files: `collectible`, `reward_on`, `interaction_distance`.
    fn old_reward(&mut self, at: &str, object: &mut Map<String, Json>) {
        let range = object.shift_remove("interaction_distance");
        let collectible = object.shift_remove("collectible");
        let Some(reward_on) = object.shift_remove("reward_on") else {
            if let Some(collectible) = collectible {
                self.warn(
                    format!("{at}/collectible"),
                    format!("collectible {collectible} without reward_on is left out"),
                );
            }
            return;
        };
        let stimulus = match reward_on.as_str().map(str::to_lowercase).as_deref() {
            Some("pickup") => Some("AgentInteract"),
            Some("in_range") => Some("AgentInRange"),
            Some("contact") => Some("AgentCollide"),
            _ => None,
        };
        let list: Vec<&str> = stimulus.into_iter().collect();
        self.warn(
            format!("{at}/reward_on"),
            format!("reward_on {} is read as reward_stimulus {list:?}", describe(&reward_on)),
        );
        object.entry("reward_stimulus").or_insert_with(|| json!(list));
        if collectible == Some(Json::Bool(true)) {
            object.entry("destroy_stimulus").or_insert_with(|| json!(list));
        }
        if let Some(range) = range {
            object.entry("range_stimulus_distance").or_insert(range);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ActionModel, ActionSpace, Color, EndCondition, GameMode, Modality, MotionModel, Stimulus};

    fn read(text: &str) -> (World, Vec<String>) {
        let (world, warnings) = World::from_l2explorer("map.json", text).unwrap();
        (world, warnings.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn words_in_any_case_numbers_as_text_and_byte_colours_are_read_with_warnings() {
        let (world, warnings) = read(
            r#"{ "environment_params": { "bounding_wall_color": [0, 100, 255], "lightIntensity": 3.5, "predefined_map": "1" },
  "agent_params": { "action_model": "ByVelocity", "initial_coordinates": [1, 2], "pickup_range": 5, "heading": -90 } }"#,
        );
        assert_eq!(world.environment_params.predefined_map, 1);
        assert_eq!(world.environment_params.light_intensity, 3.5);
        assert_eq!(world.environment_params.bounding_wall_color.0[2], 1.0);
        assert_eq!(world.agent_params.action_model, ActionModel::ByVelocity);
        assert_eq!(
            (world.agent_params.coordinates, world.agent_params.heading),
            ([1.0, 2.0], 270.0)
        );
        assert_eq!(
            warnings,
            [
                "map.json:1:50 (/environment_params/bounding_wall_color): a colour with a channel above 1 is read as 0..255",
                "map.json:1:83 (/environment_params/lightIntensity): the key \"lightIntensity\" is read as \"light_intensity\"",
                "map.json:1:106 (/environment_params/predefined_map): the text \"1\" is read as a number",
                "map.json:2:74 (/agent_params/initial_coordinates): the key \"initial_coordinates\" is read as \"coordinates\"",
                "map.json:2:98 (/agent_params/pickup_range): pickup_range is an old key; interacting reaches 1 m ahead, and it is left out",
                "map.json:2:112 (/agent_params/heading): the heading -90 is read as 270",
            ]
        );
    }

    #[test]
    fn early_reward_keys_become_stimuli() {
        let (world, warnings) = read(
            r#"{ "objects": [{ "model": 1 }, { "class": "Bag", "coordinates": [1, 1], "color": [0, 0, 0], "reward": "5",
  "collectible": true, "reward_on": "In_Range", "interaction_distance": 2 }] }"#,
        );
        let bag = &world.objects[0];
        assert_eq!((bag.class.as_str(), bag.color, bag.reward), ("bag", None, 5.0));
        assert_eq!(bag.reward_stimulus, [Stimulus::AgentInRange]);
        assert_eq!(bag.destroy_stimulus, [Stimulus::AgentInRange]);
        assert_eq!(bag.range_stimulus_distance, 2.0);
        assert_eq!(warnings.len(), 3, "{warnings:?}");
        assert!(
            warnings[0].contains("/objects/0): an object without a class is skipped"),
            "{warnings:?}"
        );
    }

    #[test]
    fn words_of_every_kind_are_read_in_any_case_and_whole_numbers_with_a_point() {
        let (world, warnings) = read(
            r#"{ "game_mode": "Collect_Images", "max_steps": 300.0, "environment_params": { "map_size": ["50", 60.5] },
  "agent_params": { "action_model": "OnRails", "observation_size": "64", "modalities": ["RGB"], "actions": "Continuous" },
  "image_params": { "yaw_subdivisions": 4.0 }, "rules": { "success": ["All_Collected"] },
  "objects": [{ "class": "Tree", "model": 2.0, "coordinates": [1, 1], "color": "Red", "motion_model": "Random_Waypoints",
    "reward_stimulus": "AGENTCOLLIDE", "reward_once_stimulus": ["agent_in_range"], "destroy_stimulus": ["agentInteract"] }] }"#,
        );
        assert_eq!((world.game_mode, world.max_steps), (GameMode::CollectImages, 300));
        assert_eq!(world.environment_params.map_size, [50.0, 60.5]);
        let agent = &world.agent_params;
        assert_eq!((agent.action_model, agent.observation_size), (ActionModel::OnRails, 64));
        assert_eq!(
            (&agent.modalities[..], &agent.actions),
            (&[Modality::Rgb][..], &ActionSpace::Continuous)
        );
        assert_eq!(world.image_params.map(|image| image.yaw_subdivisions), Some(4));
        assert_eq!(world.rules.success, [EndCondition::AllCollected]);
        let tree = &world.objects[0];
        assert_eq!((tree.class.as_str(), tree.model.0.as_str()), ("tree", "2"));
        assert_eq!(
            (tree.motion_model, tree.color),
            (MotionModel::RandomWaypoint, Color::from_name("red"))
        );
        assert_eq!(tree.reward_stimulus, [Stimulus::AgentCollide]);
        assert_eq!(tree.reward_once_stimulus, [Stimulus::AgentInRange]);
        assert_eq!(tree.destroy_stimulus, [Stimulus::AgentInteract]);
        assert_eq!(warnings.len(), 2, "{warnings:?}");
        assert!(warnings[0].ends_with("(/environment_params/map_size): the text \"50\" is read as a number"));
        assert!(warnings[1].ends_with("(/agent_params/observation_size): the text \"64\" is read as a number"));
    }

    #[test]
    fn what_no_leniency_can_read_is_an_error_at_its_place_in_the_file() {
        let text = r#"{ "objects": [{}, { "class": "tree", "coordinates": ["here", 1] }] }"#;
        let error = World::from_l2explorer("map.json", text).unwrap_err();
        assert_eq!(
            error.to_string(),
            "map.json:1:54 (/objects/1/coordinates/0): found \"here\", expected a number"
        );
    }
}
