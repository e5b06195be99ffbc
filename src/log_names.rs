//! Maps the names of tasks in a log, such as `findobjects_red`, to `task#variant` as in its scenario.

use std::collections::BTreeMap;

use driftworld_curriculum::log_name;
use driftworld_metrics::Log;
use serde_json::Value;

/// The names of the variants in a log's scenario, by their log names; empty without a scenario. Omits log names that two variants
/// share.
pub(crate) fn called_in(log: &Log) -> BTreeMap<String, String> {
    log.scenario_info.extra.get("scenario").map(names).unwrap_or_default()
}

fn names(scenario: &Value) -> BTreeMap<String, String> {
    let mut names: BTreeMap<String, Option<String>> = BTreeMap::new();
    let blocks = scenario.get("blocks").and_then(Value::as_array).into_iter().flatten();
    let regimes = blocks.filter_map(|block| block.get("regimes")?.as_array()).flatten();
    for regime in regimes {
        let word = |key: &str| regime.get(key).and_then(Value::as_str);
        // The log name of a drift names both of its ends already, so it is not mapped.
        let variant = word("name").or_else(|| word("variant"));
        let (Some(task), Some(variant), None) = (word("task"), variant, regime.get("drift")) else {
            continue;
        };
        let file = task.rsplit(['/', '\\']).next().unwrap_or(task);
        let task = file.strip_suffix(".json").unwrap_or(file);
        let name = format!("{task}#{variant}");
        let known = names
            .entry(log_name(task, variant))
            .or_insert_with(|| Some(name.clone()));
        if known.as_ref().is_some_and(|known| *known != name) {
            *known = None;
        }
    }
    names.into_iter().filter_map(|(log, name)| Some((log, name?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_keep_the_names_of_their_members() {
        let scenario = serde_json::json!({ "blocks": [
            { "regimes": [{ "task": "a/berries.json", "variant": "all-106-gold", "count": 1 }] },
            { "regimes": [
                { "task": "berries", "variant": "x", "values": { "n": 1 }, "name": "two words", "count": 1 },
                { "task": "berries", "variant": "x", "drift": { "to": "y" }, "count": 1 },
                { "task": "t", "variant": "a_b", "count": 1 }, { "task": "t", "variant": "ab", "count": 1 }
            ] }
        ] });
        let found = names(&scenario);
        let expected = [
            ("berries_all106gold", "berries#all-106-gold"),
            ("berries_twowords", "berries#two words"),
        ];
        let expected: BTreeMap<String, String> = expected
            .into_iter()
            .map(|(log, name)| (log.to_owned(), name.to_owned()))
            .collect();
        assert_eq!(found, expected);
        assert!(names(&Value::Null).is_empty());
    }
}
