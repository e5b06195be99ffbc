//! Reads L2Explorer's reset files into a [`World`], with a warning for everything that is not in standard form.

use std::collections::BTreeSet;

use serde_json::{Map, Value as Json};

use super::lenient::{drop_decimal_point, word};
use super::mend::Entry;
use super::reader::{Reader, as_spelled};
use super::{PARTS, Part};
use crate::describe::escape;
use crate::document::Document;
use crate::error::{Listed, Problem, SpecError};
use crate::limits::{MAX_VALUES, MAX_WORLD_VALUES};
use crate::maps::{self, MapLibrary};
use crate::warning::Warning;
use crate::world::{Enclosure, Object, World, WorldDraft};

impl World {
    /// Reads a reset file of the original leniently: words in any case, numbers as strings, colours in 0..255, old keys.
    ///
    /// The original's default colour is (0, 0, 0); on anything but `geometric`, `cube` and `icosphere` it is read as the
    /// asset's own colours.
    ///
    /// Entries of the original's keys that are empty or of the wrong type get their defaults, or their readable part, each with
    /// a warning that says what is assumed: an object without coordinates is placed at (0, 0), a moving object gets 2 m/s
    /// unless our own key `speed` is given. Objects outside the arena or inside walls stay where they are, with a warning. The
    /// original's predefined maps are written into the world as `map_regions`.
    ///
    /// # Errors
    /// [`SpecError`] if the file is not a JSON object, has a number out of range, has more objects than a world may hold, or
    /// has invalid values for our own keys.
    pub fn from_l2explorer(name: &str, text: &str) -> Result<(Self, Vec<Warning>), SpecError> {
        Self::from_l2explorer_with(name, text, &MapLibrary::default())
    }

    /// Like [`World::from_l2explorer`], with the layouts of a library replacing the original's. They are written into the world
    /// like [`World::with_maps`] does, before the check for objects inside walls.
    ///
    /// # Errors
    /// As [`World::from_l2explorer`].
    pub fn from_l2explorer_with(name: &str, text: &str, maps: &MapLibrary) -> Result<(Self, Vec<Warning>), SpecError> {
        let (mut document, repeated) = Document::parse_leniently(name, text, MAX_WORLD_VALUES)?;
        let mut reader = Reader::default();
        for pointer in repeated {
            reader.warn(pointer, "the key is repeated; its last value counts");
        }
        // Each part is replaced as soon as it is read, so that a large world is not in memory twice.
        document.value = reader.world(std::mem::take(&mut document.value));
        let kept = std::mem::take(&mut reader.kept);
        let spelled = reader.spelled.clone();
        let original = |mut problem: Problem| {
            problem.pointer = as_spelled(original_pointer(&problem.pointer, &kept), &spelled);
            problem
        };
        let Listed { problems, more } = World::schema().problems(&document.value);
        let problems = problems.into_iter().map(original).collect();
        document.fail_on(Listed { problems, more })?;
        let draft: WorldDraft = document.deserialize()?;
        document.fail_on(draft.problems().into_iter().map(original).collect::<Vec<_>>())?;
        let world = draft.check_in_range()?;
        let has_regions = world.environment_params.map_regions.is_some();
        let world = if has_regions {
            world
        } else {
            world.with_maps(maps::of_l2explorer())
        };
        let world = world.with_maps(maps);
        for (object, index) in world.objects.iter().zip(&kept) {
            let Some(mut text) = world.out_of_reach(object) else {
                continue;
            };
            // The regions are not in the file: they come from its map.
            if let (false, Some(Enclosure::OwnRegion { index })) = (has_regions, world.enclosure(object.coordinates)) {
                let (map, count) = (world.environment_params.map(), world.environment_params.regions().len());
                let name = maps.layout(map).map_or_else(|| maps::name(map), |layout| &layout.name);
                let region = format!("region {} of {count} of map {map} ({name})", index + 1);
                text = text.replace(&format!("the region /environment_params/map_regions/{index}"), &region);
            }
            reader.warn(format!("/objects/{index}/coordinates"), text);
        }
        let warnings = reader.warnings.in_text(name, text);
        Ok((world, warnings))
    }
}

impl Object {
    /// Reads one object in the original's form, as [`World::from_l2explorer`] reads the objects of a world.
    ///
    /// # Errors
    /// [`SpecError`] if the text is not JSON, has no class, or holds a value that cannot be read even leniently.
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
        let mut document = Document::parse(name, text, MAX_VALUES)?;
        let mut reader = Reader::default();
        document.value = match std::mem::take(&mut document.value) {
            Json::Object(map) => Json::Object(reader.object("", map)),
            other => other,
        };
        document.fail_on(Object::schema().problems(&document.value))?;
        let object = document.deserialize()?;
        Ok((object, reader.warnings.in_text(name, text)))
    }
}

/// Maps a pointer into the world to a pointer into the file, where skipped objects shift the indices.
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

impl Reader {
    fn world(&mut self, json: Json) -> Json {
        let Json::Object(map) = json else {
            return json;
        };
        let mut world = self.entries("", map, &PARTS.world);
        self.mend("", &mut world, &PARTS.world);
        for (key, part) in [
            ("environment_params", &PARTS.environment),
            ("agent_params", &PARTS.agent),
            ("image_params", &PARTS.image),
        ] {
            let Some(map) = self.part(&mut world, key) else {
                continue;
            };
            let at = format!("/{key}");
            let mut read = self.entries(&at, map, part);
            match key {
                "environment_params" => self.number(&at, &mut read, "wall_height"),
                "agent_params" => self.agent(&at, &mut read),
                _ => {}
            }
            self.mend(&at, &mut read, part);
            world.insert(key.into(), Json::Object(read));
        }
        if let Some(Json::Object(map)) = world.get("rules").cloned() {
            let mut rules = self.keys("/rules", map, &PARTS.rules);
            word(&mut rules, "success");
            word(&mut rules, "failure");
            world.insert("rules".into(), Json::Object(rules));
        }
        let objects = world.get_mut("objects").map(std::mem::take);
        match objects {
            Some(Json::Array(objects)) => {
                world.insert("objects".into(), Json::Array(self.objects(objects)));
            }
            Some(other) => {
                self.warn_instead("/objects", &other, "a list of objects; none is assumed");
                world.shift_remove("objects");
            }
            None => {}
        }
        Json::Object(world)
    }

    /// Renames keys to our names; unknown keys are dropped with a warning.
    fn keys(&mut self, pointer: &str, map: Map<String, Json>, known: &Part) -> Map<String, Json> {
        let plain = |key: &str| key.replace('_', "").to_lowercase();
        let mut renamed = Map::new();
        let mut seen = BTreeSet::new();
        for (key, value) in map {
            let old = match (pointer, plain(&key).as_str()) {
                ("/agent_params", "initialcoordinates") => Some("coordinates"),
                ("", "$schema") => continue,
                _ => None,
            };
            let place = format!("{pointer}/{}", escape(&key));
            let Some(name) = old.or_else(|| known.keys.iter().copied().find(|name| plain(name) == plain(&key))) else {
                self.warn(place, format!("the key {key:?} has no meaning here and is left out"));
                continue;
            };
            if key.as_str() != name {
                self.warn(place.clone(), format!("the key {key:?} is read as {name:?}"));
            }
            if seen.insert(name) {
                if key.as_str() != name {
                    self.spelled.insert(format!("{pointer}/{name}"), place);
                }
                renamed.insert(name.to_owned(), value);
            } else {
                self.warn(place, format!("{name:?} is already given; the first value counts"));
            }
        }
        renamed
    }

    /// The entries of a part; values of the original's keys are accepted in any of their forms.
    pub(super) fn entries(&mut self, at: &str, map: Map<String, Json>, part: &Part) -> Map<String, Json> {
        let mut map = self.keys(at, map, part);
        for (key, entry) in &part.entries {
            match entry {
                Entry::Number(..) | Entry::Pair(..) => self.number(at, &mut map, key),
                Entry::Whole(..) => self.whole(at, &mut map, key),
                Entry::Word(_) => word(&mut map, key),
                Entry::Color => self.color(at, &mut map, key),
                Entry::Model => drop_decimal_point(&mut map, key),
                Entry::Text => {}
            }
        }
        map
    }

    /// Repairs the entries of a part of the file.
    pub(super) fn mend(&mut self, at: &str, map: &mut Map<String, Json>, part: &Part) {
        for (key, entry) in &part.entries {
            self.mend_entry(at, map, (*key, entry), part.defaults.get(*key));
        }
    }

    /// Reads the agent's entries that need more than the common rules.
    fn agent(&mut self, at: &str, agent: &mut Map<String, Json>) {
        for key in ["modalities", "actions"] {
            word(agent, key);
        }
        if agent.shift_remove("pickup_range").is_some() {
            self.warn(
                format!("{at}/pickup_range"),
                "pickup_range is an obsolete key and is left out; an interaction reaches 1 m ahead",
            );
        }
        self.heading(at, agent);
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::{ActionModel, ActionSpace, Color, EndCondition, GameMode, Modality, MotionModel, Stimulus};

    pub(in crate::l2explorer) fn read(text: &str) -> (World, Vec<String>) {
        let (world, warnings) = World::from_l2explorer("map.json", text).unwrap();
        (world, warnings.iter().map(ToString::to_string).collect())
    }

    #[test]
    fn lenient_words_numbers_and_colours_are_read_with_warnings() {
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
                "map.json:2:98 (/agent_params/pickup_range): pickup_range is an obsolete key and is left out; an interaction reaches 1 m ahead",
                "map.json:2:112 (/agent_params/heading): the heading -90 is read as 270",
            ]
        );
    }

    #[test]
    fn words_in_any_case_and_integers_with_a_point_are_read() {
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
        assert_eq!(world.image_params.as_ref().map(|image| image.yaw_subdivisions), Some(4));
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
        assert_eq!(warnings.len(), 3, "{warnings:?}");
        assert!(warnings[2].contains("random_waypoint has no speed"), "{warnings:?}");
        assert!(warnings[0].ends_with("(/environment_params/map_size): the text \"50\" is read as a number"));
        assert!(warnings[1].ends_with("(/agent_params/observation_size): the text \"64\" is read as a number"));
    }

    #[test]
    fn our_own_keys_are_checked_strictly() {
        let text = r#"{ "objects": [{}, { "class": "tree", "coordinates": [1, 1], "scale": "large" }] }"#;
        let error = World::from_l2explorer("map.json", text).unwrap_err();
        assert_eq!(
            error.to_string(),
            "map.json:1:70 (/objects/1/scale): found \"large\", expected a number"
        );
        for text in ["[]", "3", "null", "{"] {
            assert!(World::from_l2explorer("map.json", text).is_err(), "{text}");
        }
    }

    #[test]
    fn unusable_entries_get_defaults_with_a_warning_each() {
        let (world, warnings) = read(
            r#"{ "max_steps": "", "game_mode": null, "image_params": [], "environment_params": { "map_size": [null, 50], "predefined_map": {}, "lightIntensity": "bright" },
  "agent_params": { "observation_size": 9.7, "heading": {}, "agent_height": "", "coordinates": ["here", 4] },
  "objects": ["tree", { "class": "Bag", "model": "", "coordinates": [1], "color": [2], "motion_model": "hop", "reward": null, "unique_name": 7 },
    { "class": "tree", "motion_model": "Prey", "reward_stimulus": ["collision", "smell", "AgentCollide"], "reward_on": "collision" },
    { "class": "tree", "coordinates": [1, 2, 3], "unique_name": "7", "reward_on": "Collision", "collectible": "True", "interaction_distance": "" }] }"#,
        );
        let expected = [
            "map.json:1:16 (/max_steps): found \"\", expected a whole number from 0 to 1000000000; the default 0 is assumed",
            "map.json:1:33 (/game_mode): found null, expected one of learn, collect_images; the default \"learn\" is assumed",
            "map.json:1:55 (/image_params): found [], expected an object; its defaults are assumed",
            "map.json:1:95 (/environment_params/map_size): found [null,50], expected two numbers from 0 to 300; [100, 50] is assumed",
            "map.json:1:125 (/environment_params/predefined_map): found {}, expected a whole number from 0 to 4; the default 0 is assumed",
            "map.json:1:147 (/environment_params/lightIntensity): the key \"lightIntensity\" is read as \"light_intensity\"",
            "map.json:1:147 (/environment_params/lightIntensity): found \"bright\", expected a number from 0 to 100; the default 2.3 is assumed",
            "map.json:2:41 (/agent_params/observation_size): found 9.7, expected a whole number from 1 to 4096; 10 is assumed",
            "map.json:2:57 (/agent_params/heading): found {}, expected a number from 0 to 360; the default 0 is assumed",
            "map.json:2:77 (/agent_params/agent_height): found \"\", expected a number from 0.1 to 10; the default 1 is assumed",
            "map.json:2:96 (/agent_params/coordinates): found [\"here\",4], expected two numbers from -300 to 300; [0, 4] is assumed",
            "map.json:3:15 (/objects/0): found \"tree\", expected an object with a class; it is skipped",
            "map.json:3:50 (/objects/1/model): found \"\", expected a string of 1 to 100 characters, or a whole number up to 1000000; the default \"1\" is assumed",
            "map.json:3:69 (/objects/1/coordinates): found [1], expected two numbers from -300 to 300; [1, 0] is assumed",
            "map.json:3:83 (/objects/1/color): found [2], expected a colour of three numbers in 0..1; the asset's own colours are assumed",
            "map.json:3:104 (/objects/1/motion_model): found \"hop\", expected one of stationary, predator, prey, random_waypoint, patrol; the default \"stationary\" is assumed",
            "map.json:3:121 (/objects/1/reward): found null, expected a number from -1000000000 to 1000000000; the default 0 is assumed",
            "map.json:3:142 (/objects/1/unique_name): found 7, expected a string of 1 to 100 characters; \"7\" is assumed",
            "map.json:4:5 (/objects/2): an object without coordinates is put at (0, 0)",
            "map.json:4:40 (/objects/2/motion_model): prey has no speed; 2 m/s is assumed; Driftworld's key \"speed\" sets another speed",
            "map.json:4:68 (/objects/2/reward_stimulus/0): \"collision\" is read as \"AgentCollide\"",
            "map.json:4:81 (/objects/2/reward_stimulus/1): found \"smell\", expected AgentCollide, AgentInteract or AgentInRange; it is left out",
            "map.json:4:90 (/objects/2/reward_stimulus/2): \"AgentCollide\" is already in the list and is left out",
            "map.json:4:120 (/objects/2/reward_on): reward_on \"collision\" is left out, because there is a reward_stimulus",
            "map.json:5:39 (/objects/3/coordinates): found [1,2,3], expected two numbers from -300 to 300; [1, 2] is assumed",
            "map.json:5:65 (/objects/3/unique_name): another object already has the name \"7\"; the name is left out",
            "map.json:5:83 (/objects/3/reward_on): reward_on \"Collision\" is read as reward_stimulus [\"AgentCollide\"]",
            "map.json:5:111 (/objects/3/collectible): found \"True\", expected true or false; true is assumed",
            "map.json:5:143 (/objects/3/interaction_distance): found \"\", expected a number from 0 to 1000; it is left out",
        ];
        assert_eq!(warnings, expected, "{warnings:#?}");
        assert_eq!(world.agent_params.coordinates, [0.0, 4.0]);
        assert_eq!(
            (world.objects[1].motion_model, world.objects[1].speed),
            (MotionModel::Prey, 2.0)
        );
        assert_eq!(world.objects[2].destroy_stimulus, [Stimulus::AgentCollide]);
    }
}
