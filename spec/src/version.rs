//! Versions of the document formats: rejects newer ones and upgrades older ones.

use serde_json::{Map, Value as Json, json};

use crate::error::Problem;

/// Current version of world documents.
pub const WORLD_VERSION: u32 = 1;

/// Current version of task specs.
pub const TASK_VERSION: u32 = 2;

/// Current version of scenarios.
pub const SCENARIO_VERSION: u32 = 1;

/// A kind of document with its upgrades.
pub(crate) struct Format {
    name: &'static str,
    current: u32,
    /// The first upgrades version 1 to version 2, and so on.
    upgrades: &'static [fn(&mut Map<String, Json>)],
}

pub(crate) const WORLD: Format = Format {
    name: "world",
    current: WORLD_VERSION,
    upgrades: &[],
};
pub(crate) const TASK: Format = Format {
    name: "task spec",
    current: TASK_VERSION,
    upgrades: &[margins_to_keep_out],
};
pub(crate) const SCENARIO: Format = Format {
    name: "scenario",
    current: SCENARIO_VERSION,
    upgrades: &[],
};

impl Format {
    /// Upgrades a document to the current version. A document without a version counts as version 1.
    pub(crate) fn upgrade(&self, document: &mut Json) -> Option<Problem> {
        let map = document.as_object_mut()?;
        let found = match map.get("version") {
            None => 1,
            // The schema rejects anything but an integer from 1.
            Some(version) => version.as_u64().filter(|version| *version >= 1)?,
        };
        if found > u64::from(self.current) {
            let name = self.name;
            let expected = format!("a {name} of version {} or older", self.current);
            // A document of unknown kind is read as a world; only task specs have reached this version.
            let advice = if self.name == "world" && found <= u64::from(TASK.current) {
                "it may be a task spec, which has a name: {\"version\": 2, \"name\": …}"
            } else {
                "it was made for a newer Driftworld: update driftworld to read it"
            };
            return Some(
                Problem::new("spec/newer-version", "/version", format!("version {found}"), expected).advise(advice),
            );
        }
        for upgrade in &self.upgrades[found as usize - 1..] {
            upgrade(map);
        }
        if map.contains_key("version") {
            map.insert("version".to_owned(), json!(self.current));
        }
        None
    }
}

/// The margins of version 1 of the task spec, with their names under `keep_out` in version 2.
pub(crate) const OLD_MARGINS: [(&str, &str); 2] = [("wall_margin", "walls"), ("agent_margin", "agent")];

/// Version 1 had `wall_margin` and `agent_margin`; version 2 has `keep_out`, which also names groups.
fn margins_to_keep_out(task: &mut Map<String, Json>) {
    let groups = task
        .get_mut("groups")
        .and_then(Json::as_array_mut)
        .into_iter()
        .flatten();
    for group in groups.filter_map(Json::as_object_mut) {
        for (old, new) in OLD_MARGINS {
            if let Some(margin) = group.shift_remove(old) {
                let keep_out = group.entry("keep_out").or_insert_with(|| json!({}));
                if let Some(keep_out) = keep_out.as_object_mut() {
                    keep_out.entry(new).or_insert(margin);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn older_task_is_upgraded() {
        let mut task =
            json!({ "version": 1, "name": "t", "groups": [{ "name": "g", "wall_margin": 3, "agent_margin": 4 }] });
        assert!(TASK.upgrade(&mut task).is_none());
        assert_eq!(
            task,
            json!({ "version": 2, "name": "t", "groups": [{ "name": "g", "keep_out": { "walls": 3, "agent": 4 } }] })
        );
    }

    #[test]
    fn newer_document_is_refused_with_advice() {
        let problem = SCENARIO.upgrade(&mut json!({ "version": 7 })).unwrap();
        assert_eq!(
            problem.to_string(),
            "(/version): found version 7, expected a scenario of version 1 or older; \
             it was made for a newer Driftworld: update driftworld to read it"
        );
    }
}
