//! Reads the objects of a reset file: skips unusable objects, converts early keys and fills in missing entries.

use std::collections::BTreeSet;

use serde_json::{Map, Value as Json, json};

use super::lenient::{stimulus, word};
use super::mend::Entry;
use super::reader::Reader;
use super::{ASSUMED_SPEED, PARTS, black_is_chosen};
use crate::describe::describe;
use crate::limits::MAX_OBJECTS;

impl Reader {
    pub(super) fn objects(&mut self, objects: Vec<Json>) -> Vec<Json> {
        // The schema will reject too many objects, so reading them one by one first would be wasted work.
        if objects.len() > MAX_OBJECTS {
            return objects;
        }
        let mut read = Vec::new();
        let mut names = BTreeSet::new();
        for (index, json) in objects.into_iter().enumerate() {
            let at = format!("/objects/{index}");
            let Json::Object(map) = json else {
                self.warn_instead(at, &json, "an object with a class; it is skipped");
                continue;
            };
            let class = map.iter().find(|(key, _)| key.eq_ignore_ascii_case("class"));
            let is_class = |class: &Json| class.as_str().is_some_and(|class| !class.is_empty());
            if !class.is_some_and(|(_, class)| is_class(class)) {
                self.warn(at, "an object without a class is skipped");
                continue;
            }
            let mut object = self.object(&at, map);
            if let Some(Json::String(name)) = object.get("unique_name")
                && !names.insert(name.clone())
            {
                let text = format!("another object already has the name {name:?}; the name is left out");
                self.warn(format!("{at}/unique_name"), text);
                object.shift_remove("unique_name");
            }
            read.push(Json::Object(object));
            self.kept.push(index);
        }
        read
    }

    pub(super) fn object(&mut self, at: &str, map: Map<String, Json>) -> Map<String, Json> {
        let mut object = self.entries(at, map, &PARTS.object);
        word(&mut object, "class");
        if object
            .get("motion_model")
            .is_some_and(|model| model == "random_waypoints")
        {
            object.insert("motion_model".into(), json!("random_waypoint"));
        }
        for key in ["heading", "scale", "interaction_distance"] {
            self.number(at, &mut object, key);
        }
        for key in ["reward_stimulus", "reward_once_stimulus", "destroy_stimulus"] {
            self.stimuli(at, &mut object, key);
        }
        self.heading(at, &mut object);
        self.old_reward(at, &mut object);
        if !object.contains_key("coordinates") {
            self.warn(at, "an object without coordinates is put at (0, 0)");
            self.spelled.insert(format!("{at}/coordinates"), at.to_owned());
            object.insert("coordinates".into(), json!([0.0, 0.0]));
        }
        self.mend(at, &mut object, &PARTS.object);
        object.entry("coordinates").or_insert_with(|| json!([0.0, 0.0]));
        self.own_speed(at, &mut object);
        let class = object.get("class").and_then(Json::as_str).unwrap_or_default();
        let channels = object.get("color").and_then(Json::as_array);
        let is_black = channels.is_some_and(|channels| channels.iter().all(|channel| channel.as_f64() == Some(0.0)));
        if is_black && !black_is_chosen(class) {
            object.shift_remove("color");
        }
        object
    }

    /// Gives objects that move by themselves a speed, which the original's files do not have.
    fn own_speed(&mut self, at: &str, object: &mut Map<String, Json>) {
        if object.get("speed").is_some_and(Json::is_null) {
            object.shift_remove("speed");
        }
        let model = object.get("motion_model").and_then(Json::as_str);
        let Some(model) = model.filter(|model| *model != "stationary" && !object.contains_key("speed")) else {
            return;
        };
        let text = format!(
            "{model} has no speed; {ASSUMED_SPEED} m/s is assumed; Driftworld's key \"speed\" sets another speed"
        );
        self.warn(format!("{at}/motion_model"), text);
        object.insert("speed".into(), json!(ASSUMED_SPEED));
    }

    /// Converts the keys of early files: `collectible`, `reward_on`, `interaction_distance`.
    fn old_reward(&mut self, at: &str, object: &mut Map<String, Json>) {
        let distance = Entry::Number(0.0, 1000.0);
        self.mend_entry(at, object, ("interaction_distance", &distance), None);
        if let Some(range) = object.shift_remove("interaction_distance")
            && !object.contains_key("range_stimulus_distance")
        {
            let early = format!("{at}/interaction_distance");
            self.spelled.insert(format!("{at}/range_stimulus_distance"), early);
            object.insert("range_stimulus_distance".into(), range);
        }
        let collectible = object.shift_remove("collectible");
        let Some(reward_on) = object.shift_remove("reward_on") else {
            if let Some(collectible) = collectible {
                self.warn(
                    format!("{at}/collectible"),
                    format!("collectible {} without reward_on is left out", describe(&collectible)),
                );
            }
            return;
        };
        let words = match &reward_on {
            Json::Array(words) => words.as_slice(),
            word => std::slice::from_ref(word),
        };
        let mut list: Vec<&str> = Vec::new();
        let mut is_understood = true;
        for word in words {
            match word.as_str().map(|word| (stimulus(word), word.to_lowercase())) {
                Some((Some(name), _)) if !list.contains(&name) => list.push(name),
                Some((Some(_), _)) => {}
                Some((None, word)) if word == "none" => {}
                _ => is_understood = false,
            }
        }
        let mut text = format!("reward_on {} is read as reward_stimulus {list:?}", describe(&reward_on));
        if !is_understood {
            text.push_str("; expected pickup, in_range, contact or none");
        }
        if object.contains_key("reward_stimulus") {
            text = format!(
                "reward_on {} is left out, because there is a reward_stimulus",
                describe(&reward_on)
            );
        }
        self.warn(format!("{at}/reward_on"), text);
        object.entry("reward_stimulus").or_insert_with(|| json!(list));
        let is_collectible = match &collectible {
            Some(Json::Bool(is_collectible)) => *is_collectible,
            Some(other) => {
                let is_true = matches!(other.as_str(), Some(word) if word.eq_ignore_ascii_case("true"))
                    || other.as_f64().is_some_and(|number| number != 0.0);
                let expected = format!("true or false; {is_true} is assumed");
                self.warn_instead(format!("{at}/collectible"), other, &expected);
                is_true
            }
            None => false,
        };
        if is_collectible {
            object.entry("destroy_stimulus").or_insert_with(|| json!(list));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::Stimulus;
    use crate::l2explorer::read::tests::read;

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
    fn objects_inside_walls_and_regions_get_a_warning_with_the_wall() {
        let (world, warnings) = read(
            r#"{ "environment_params": { "predefined_map": 2, "walls": [{ "polygon": [[0, 0], [9, 0], [9, 9]] }] },
  "objects": [{}, { "class": "tree", "coordinates": [-20, 70] }, { "class": "bag", "coordinates": [8, 1] },
    { "class": "pot", "coordinates": [0, 1] }, { "class": "car", "coordinates": [0, 101] }] }"#,
        );
        assert_eq!(world.objects.len(), 4);
        assert_eq!(
            warnings[1..],
            [
                "map.json:2:53 (/objects/1/coordinates): the tree stands at (-20.0, 70.0), inside region 1 of 13 of map 2 (village); it is kept but unreachable",
                "map.json:2:99 (/objects/2/coordinates): the bag stands at (8.0, 1.0), inside the wall /environment_params/walls/0; it is kept but unreachable",
                "map.json:3:81 (/objects/4/coordinates): the car stands at (0.0, 101.0), outside the 200 × 200 m arena; it is kept but unreachable",
            ]
        );
    }
}
