//! Reads the original's scenario files into a [`Scenario`] whose regimes name world files.
//!
//! ```text
//! { "logging_base_dir": "logs", "scenario": [{ "type": "train", "regimes":
//!     [{ "task": "Task1", "count": 2, "params": { "map": "../map.json", "maxsteps": 200 } }] }] }
//! ```

use std::collections::{BTreeMap, BTreeSet};

use driftworld_text::check_name;
use serde_json::{Map, Value as Json};

use crate::describe::{describe, escape};
use crate::document::Document;
use crate::error::{MAX_PROBLEMS, Problem, SpecError, cut};
use crate::limits::MAX_SCENARIO_VALUES;
use crate::scenario::{Block, BlockKind, MAX_EXPERIENCES, Regime, Scenario};
use crate::warning::{Remarks, Warning};

/// Maximum number of steps that a regime may allow, as in our own documents.
const MAX_STEPS: u64 = 1_000_000_000;

impl Scenario {
    /// Reads a scenario file of the original. Each map becomes the world file of a regime; its name without folders or extension
    /// becomes the regime's variant.
    ///
    /// # Errors
    /// [`SpecError`] if the file is not JSON, or a regime lacks a required key.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Scenario;
    /// let text = r#"{ "logging_base_dir": "logs", "scenario": [{ "type": "train", "regimes":
    ///     [{ "task": "Task1", "count": 2, "params": { "map": "../map_1.json", "maxsteps": 200 } }] }] }"#;
    /// let (scenario, warnings) = Scenario::from_l2explorer("s.json", text)?;
    /// let regime = &scenario.blocks[0].regimes[0];
    /// assert_eq!((regime.task.as_str(), regime.variant.as_str(), regime.max_steps), ("Task1", "map_1", Some(200)));
    /// assert!(warnings.is_empty());
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn from_l2explorer(name: &str, text: &str) -> Result<(Self, Vec<Warning>), SpecError> {
        let document = Document::parse(name, text, MAX_SCENARIO_VALUES)?;
        let mut reader = Reader::default();
        let scenario = reader.scenario(&document.value);
        document.fail_on(reader.problems)?;
        Ok((scenario, reader.warnings.in_text(name, text)))
    }
}

#[derive(Default)]
struct Reader {
    warnings: Remarks,
    problems: Vec<Problem>,
    /// The variant of each map, by task and map.
    variants: BTreeMap<(String, String), String>,
    /// The names already taken in each task, reduced to lower-case letters and digits.
    taken: BTreeMap<String, BTreeSet<String>>,
    /// The last number appended to a stem, by task and stem.
    numbers: BTreeMap<(String, String), u32>,
}

impl Reader {
    fn scenario(&mut self, json: &Json) -> Scenario {
        let empty = Map::new();
        let map = json.as_object().unwrap_or(&empty);
        self.unknown("", map, &["logging_base_dir", "scenario"]);
        let name = self.name(map.get("logging_base_dir"));
        let blocks = self.list("", map, "scenario", "block");
        let blocks = blocks.iter().enumerate();
        let blocks = blocks.map(|(b, block)| self.block(&format!("/scenario/{b}"), block));
        Scenario::new(name, blocks.collect())
    }

    fn name(&mut self, found: Option<&Json>) -> String {
        let fits = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '-');
        let Some(text) = found.and_then(Json::as_str).filter(|text| !text.is_empty()) else {
            self.warnings.push(
                "",
                "without the key \"logging_base_dir\" the scenario is called \"scenario\"",
            );
            return "scenario".to_owned();
        };
        let mut name: String = text.chars().take(100).map(|c| if fits(c) { c } else { '_' }).collect();
        // Invalid file names: a leading dot or hyphen, a trailing dot, a Windows device name.
        if name.starts_with(['.', '-']) {
            name.replace_range(..1, "_");
        }
        if name.ends_with('.') {
            name.replace_range(name.len() - 1.., "_");
        }
        if check_name(&name).is_err() {
            name = format!("{}_", name.replace('.', "_"));
        }
        if name != text {
            self.warnings.push(
                "/logging_base_dir",
                format!("{} is read as the name {name:?}", cut(&format!("{text:?}"))),
            );
        }
        name
    }

    fn block(&mut self, at: &str, json: &Json) -> Block {
        let empty = Map::new();
        let map = json.as_object().unwrap_or(&empty);
        self.unknown(at, map, &["type", "regimes"]);
        let kind = map.get("type").and_then(Json::as_str).map(str::to_ascii_lowercase);
        let kind = match kind.as_deref() {
            Some("train") => BlockKind::Learning,
            Some("test") => BlockKind::Evaluation,
            _ => {
                self.wrong(at, map, "type", "\"train\" or \"test\"");
                BlockKind::Learning
            }
        };
        let regimes = self.list(at, map, "regimes", "regime");
        let regimes = regimes.iter().enumerate();
        let regimes = regimes.map(|(r, regime)| self.regime(&format!("{at}/regimes/{r}"), regime));
        Block::new(kind, regimes.collect())
    }

    fn regime(&mut self, at: &str, json: &Json) -> Regime {
        let empty = Map::new();
        let map = json.as_object().unwrap_or(&empty);
        self.unknown(at, map, &["task", "count", "params"]);
        let task = self.text(at, map, "task");
        let count = self.whole(at, map, "count", 1, u64::from(MAX_EXPERIENCES)).unwrap_or(1);
        let params = format!("{at}/params");
        let params_map = map.get("params").and_then(Json::as_object).unwrap_or(&empty);
        self.unknown(&params, params_map, &["map", "maxsteps"]);
        if map.get("params").is_none_or(Json::is_object) {
            let world = self.text(&params, params_map, "map");
            let max_steps = params_map
                .contains_key("maxsteps")
                .then(|| self.whole(&params, params_map, "maxsteps", 0, MAX_STEPS))
                .flatten();
            return Regime {
                max_steps: max_steps.map(|steps| steps as u32),
                world: Some(world.clone()),
                ..Regime::new(&task, self.variant(&task, &world), count as u32)
            };
        }
        self.wrong(at, map, "params", "an object with the key \"map\"");
        Regime::new(task, "map", count as u32)
    }

    /// The variant of a task's map: the file's name, with a number appended if two would be the same in a log.
    fn variant(&mut self, task: &str, world: &str) -> String {
        let key = (task.to_owned(), world.to_owned());
        if let Some(known) = self.variants.get(&key) {
            return known.clone();
        }
        let stem = stem(world);
        let plain = |name: &str| -> String {
            let chars = name.chars().filter(char::is_ascii_alphanumeric);
            chars.collect::<String>().to_ascii_lowercase()
        };
        let taken = self.taken.entry(task.to_owned()).or_default();
        let number = self.numbers.entry((task.to_owned(), stem.clone())).or_insert(1);
        let mut name = stem.clone();
        // Names are never released, so the search continues where it ended for the last map of this name.
        while taken.contains(&plain(&name)) {
            *number += 1;
            name = format!("{stem}-v{number}");
        }
        taken.insert(plain(&name));
        self.variants.insert(key, name.clone());
        name
    }

    fn list<'m>(&mut self, at: &str, map: &'m Map<String, Json>, key: &str, item: &str) -> &'m [Json] {
        match map.get(key).and_then(Json::as_array) {
            Some(items) if (1..=100_000).contains(&items.len()) => items,
            _ => {
                self.wrong(at, map, key, &format!("a list of 1 to 100000 {item}s"));
                &[]
            }
        }
    }

    fn text(&mut self, at: &str, map: &Map<String, Json>, key: &str) -> String {
        match map.get(key).and_then(Json::as_str) {
            Some(text) if (1..=4096).contains(&text.chars().count()) => text.to_owned(),
            _ => {
                self.wrong(at, map, key, "a string of 1 to 4096 characters");
                String::new()
            }
        }
    }

    fn whole(&mut self, at: &str, map: &Map<String, Json>, key: &str, min: u64, max: u64) -> Option<u64> {
        let number = map.get(key).and_then(Json::as_f64);
        let number = number.filter(|number| number.fract() == 0.0 && (min as f64..=max as f64).contains(number));
        if number.is_none() {
            self.wrong(at, map, key, &format!("a whole number in {min}..{max}"));
        }
        number.map(|number| number as u64)
    }

    /// Reports a key that is missing or has an invalid value.
    fn wrong(&mut self, at: &str, map: &Map<String, Json>, key: &str, expected: &str) {
        // Further problems would not be listed.
        if self.problems.len() > MAX_PROBLEMS {
            return;
        }
        let problem = match map.get(key) {
            Some(value) => Problem::new("spec/value", format!("{at}/{key}"), describe(value), expected),
            None => Problem::new(
                "spec/missing-key",
                at,
                "nothing",
                format!("the key {key:?} with {expected}"),
            ),
        };
        self.problems.push(problem);
    }

    fn unknown(&mut self, at: &str, map: &Map<String, Json>, known: &[&str]) {
        for key in map.keys().filter(|key| !known.contains(&key.as_str())) {
            let text = format!("the key {key:?} has no meaning here and is left out");
            self.warnings.push(format!("{at}/{}", escape(key)), text);
        }
    }
}

/// A file's name without folders or extension.
fn stem(path: &str) -> String {
    let file = path.rsplit(['/', '\\']).next().unwrap_or(path);
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let stem: String = stem.chars().take(90).collect();
    if stem.is_empty() { "map".to_owned() } else { stem }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scenario file of the original with one regime that has these entries.
    fn file(regime: &str) -> String {
        format!(r#"{{ "logging_base_dir": "logs", "scenario": [{{ "type": "train", "regimes": [{{ {regime} }}] }}] }}"#)
    }

    fn error_for(text: &str) -> String {
        Scenario::from_l2explorer("s.json", text).unwrap_err().to_string()
    }

    #[test]
    fn missing_regime_keys_are_reported_with_their_place() {
        let check = |regime: &str, expected: &str| {
            let messages = error_for(&file(regime));
            assert!(messages.ends_with(expected), "{messages}");
        };
        let params = r#""params": { "map": "m.json" }"#;
        check(
            &format!(r#""task": "a", "count": 0, {params}"#),
            "(/scenario/0/regimes/0/count): found 0, expected a whole number in 1..10000000",
        );
        check(
            &format!(r#""count": 1, {params}"#),
            "(/scenario/0/regimes/0): found nothing, expected the key \"task\" with a string of 1 to 4096 characters",
        );
        check(
            r#""task": "a", "count": 1, "params": {}"#,
            "expected the key \"map\" with a string of 1 to 4096 characters",
        );
        check(
            r#""task": "a", "count": 1, "params": [3]"#,
            "(/scenario/0/regimes/0/params): found [3], expected an object with the key \"map\"",
        );
        assert!(error_for("[1]").ends_with("expected the key \"scenario\" with a list of 1 to 100000 blocks"));
        let wake = file("").replace("train", "wake");
        assert!(
            error_for(&wake).contains("found \"wake\", expected \"train\" or \"test\""),
            "{}",
            error_for(&wake)
        );
    }

    #[test]
    fn unsupported_keys_give_warnings() {
        let text = file(r#""task": "a", "count": 2.0, "params": { "map": "m.json", "fog": 1 }"#)
            .replace("\"logs\"", "\"my logs\"");
        let (scenario, warnings) = Scenario::from_l2explorer("s.json", &text).unwrap();
        assert_eq!((scenario.name.as_str(), scenario.num_experiences()), ("my_logs", 2));
        let messages: Vec<&str> = warnings.iter().map(|warning| warning.text.as_str()).collect();
        let expected = [
            "\"my logs\" is read as the name \"my_logs\"",
            "the key \"fog\" has no meaning here and is left out",
        ];
        assert_eq!(messages, expected);
    }

    #[test]
    fn maps_with_the_same_name_become_different_variants() {
        let one = |map: &str| format!(r#"{{ "task": "a", "count": 1, "params": {{ "map": "{map}" }} }}"#);
        let regimes = ["x/m_1.json", "y/m_1.json", "x/m_1.json", "m1"].map(one).join(", ");
        let text =
            format!(r#"{{ "logging_base_dir": "l", "scenario": [{{ "type": "TEST", "regimes": [{regimes}] }}] }}"#);
        let (scenario, _) = Scenario::from_l2explorer("s.json", &text).unwrap();
        let names: Vec<&str> = scenario.blocks[0]
            .regimes
            .iter()
            .map(|regime| regime.variant.as_str())
            .collect();
        assert_eq!(names, ["m_1", "m_1-v2", "m_1", "m1-v3"]);
        assert_eq!(
            Scenario::from_json("s.json", &scenario.to_json_pretty()).unwrap(),
            scenario
        );
    }

    #[test]
    fn thousands_of_maps_with_the_same_name_are_disambiguated_fast() {
        let one = |number: u32| format!(r#"{{ "task": "a", "count": 1, "params": {{ "map": "{number}/m.json" }} }}"#);
        let regimes: Vec<String> = (1..=20_000).map(one).collect();
        let text = format!(
            r#"{{ "logging_base_dir": "l", "scenario": [{{ "type": "test", "regimes": [{}] }}] }}"#,
            regimes.join(", ")
        );
        let (scenario, _) = Scenario::from_l2explorer("s.json", &text).unwrap();
        let regimes = &scenario.blocks[0].regimes;
        assert_eq!(regimes[0].variant, "m");
        assert_eq!(regimes[19_999].variant, "m-v20000");
    }
}
