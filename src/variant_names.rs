//! [`VariantNames`]: maps names in logs, which contain only letters and digits as l2logger requires, to the usual names of
//! variants, `TASK#VARIANT`.

use std::collections::BTreeMap;
use std::path::Path;

use driftworld_curriculum::log_name_of_label;
use serde_json::Value;

use crate::log_folders;

/// The usual names of variants, by their names in logs.
#[derive(Clone, Debug, Default)]
pub(crate) struct VariantNames(BTreeMap<String, String>);

impl VariantNames {
    /// Reads the names from the logs in these folders. Logs of other programs lack them, which is not an error.
    pub(crate) fn of_logs<P: AsRef<Path>>(folders: &[P]) -> Self {
        let mut names = BTreeMap::new();
        for folder in folders {
            let info = log_folders::scenario_info(folder.as_ref());
            let variants = info.get("made_from").and_then(Value::as_object);
            for name in variants.into_iter().flat_map(|variants| variants.keys()) {
                if name.contains('#') {
                    names.insert(log_name_of_label(name), name.clone());
                }
            }
        }
        Self(names)
    }

    /// The usual name of the variant with this name in a log; the log's name if it is unknown.
    pub(crate) fn shown<'a>(&'a self, in_log: &'a str) -> &'a str {
        self.0.get(in_log).map_or(in_log, String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log_gives_the_names_of_its_variants() {
        let folder = tempfile::tempdir().expect("a temporary folder can be created");
        let info = r#"{ "made_from": { "berries#all-0.6-1": {}, "a_map.json": {} } }"#;
        std::fs::write(folder.path().join("scenario_info.json"), info).expect("the folder is writable");
        let names = VariantNames::of_logs(&[folder.path(), Path::new("nowhere")]);
        assert_eq!(names.shown("berries_all061"), "berries#all-0.6-1");
        assert_eq!(names.shown("other_task"), "other_task");
    }
}
