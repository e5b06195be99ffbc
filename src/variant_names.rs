//! [`VariantNames`]: what variants are called everywhere, `TASK#VARIANT`, by the names that l2logger's form has for them in logs,
//! which are letters and digits alone.

use std::collections::BTreeMap;
use std::path::Path;

use driftworld_curriculum::log_name_of_label;
use serde_json::Value;

/// The most bytes of a log's information that are looked through for names.
const MAX_INFO_BYTES: u64 = 64 << 20;

/// What variants are called, by their names in logs.
#[derive(Clone, Debug, Default)]
pub(crate) struct VariantNames(BTreeMap<String, String>);

impl VariantNames {
    /// As the logs in these folders say it; logs of other programs say nothing, and are none the worse for it.
    pub(crate) fn of_logs<P: AsRef<Path>>(folders: &[P]) -> Self {
        let mut names = BTreeMap::new();
        for folder in folders {
            let file = folder.as_ref().join("scenario_info.json");
            let text = driftworld_files::text(&file, MAX_INFO_BYTES).unwrap_or_default();
            let info: Value = serde_json::from_str(&text).unwrap_or_default();
            let variants = info.get("made_from").and_then(Value::as_object);
            for name in variants.into_iter().flat_map(|variants| variants.keys()) {
                if name.contains('#') {
                    names.insert(log_name_of_label(name), name.clone());
                }
            }
        }
        Self(names)
    }

    /// What a variant is called that has this name in a log; that name itself where nobody says.
    pub(crate) fn shown<'a>(&'a self, in_log: &'a str) -> &'a str {
        self.0.get(in_log).map_or(in_log, String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_log_says_what_its_variants_are_called() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let info = r#"{ "made_from": { "berries#all-0.6-1": {}, "a_map.json": {} } }"#;
        std::fs::write(folder.path().join("scenario_info.json"), info).expect("the folder is ours");
        let names = VariantNames::of_logs(&[folder.path(), Path::new("nowhere")]);
        assert_eq!(names.shown("berries_all061"), "berries#all-0.6-1");
        assert_eq!(names.shown("other_task"), "other_task");
    }
}
