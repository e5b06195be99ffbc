//! [`Contents`]: recognises the kind of a file or folder by its keys, so that a command can report a document of the wrong
//! kind.

use std::path::Path;

use crate::top_level::TopLevel;
use driftworld_text::ShownPath;

/// Whether a folder has one of a log's info files.
pub(crate) fn has_info(folder: &Path) -> bool {
    ["logger_info.json", "scenario_info.json"]
        .iter()
        .any(|name| folder.join(name).is_file())
}

/// The kind of a file or folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contents {
    /// A task spec.
    Task,
    /// A world, in our format or L2Explorer's.
    World,
    /// A scenario, in our format or L2Explorer's.
    Scenario,
    /// Layouts.
    Maps,
    /// Scoring settings: l2metrics', or ours.
    Settings,
    /// A distance matrix.
    Matrix,
    /// The folder of a log, or its info file.
    Log,
    /// A folder that is not a log.
    Folder,
}

impl Contents {
    /// The kind of a JSON text; `None` if it is not recognised, or not JSON.
    pub fn of_text(text: &str) -> Option<Self> {
        // The reader of the document refuses a text that is too long.
        let keys = TopLevel::of(text)?;
        let has = |wanted: &[&str]| keys.has_any(wanted);
        if has(&["blocks"]) || keys.is_l2explorer_scenario() {
            Some(Self::Scenario)
        } else if has(&["maps"]) {
            Some(Self::Maps)
        } else if has(&["labels"]) && has(&["values"]) {
            Some(Self::Matrix)
        } else if has(&["metrics_columns", "scenario_type"]) {
            Some(Self::Log)
        } else if has(&[
            "perf_measure",
            "maintenance_method",
            "transfer_method",
            "normalization_method",
        ]) {
            Some(Self::Settings)
        } else if has(&["parameters", "groups", "variants", "world"]) {
            Some(Self::Task)
        } else if has(&[
            "environment_params",
            "agent_params",
            "objects",
            "game_mode",
            "image_params",
        ]) {
            Some(Self::World)
        } else {
            None
        }
    }

    /// The kind of a folder; `None` for anything else.
    pub fn of_folder(path: &Path) -> Option<Self> {
        path.is_dir()
            .then(|| if has_info(path) { Self::Log } else { Self::Folder })
    }

    /// The kind's name in messages, with an article.
    pub fn name(self) -> &'static str {
        match self {
            Self::Task => "a task spec",
            Self::World => "a world",
            Self::Scenario => "a scenario",
            Self::Maps => "a maps file",
            Self::Settings => "scoring settings",
            Self::Matrix => "a distance matrix",
            Self::Log => "a log",
            Self::Folder => "a folder",
        }
    }

    /// Advice if one of the `wanted` kinds was expected: how to make one from this document, or else which command accepts it.
    fn advice(self, wanted: &[Self], path: &Path) -> String {
        let path = path.shown();
        match self {
            Self::Task if wanted.contains(&Self::Scenario) => {
                format!("`driftworld curriculum {path} -o scenario.json` makes one from its variants")
            }
            Self::Task if wanted.contains(&Self::World) => {
                format!("`driftworld sample {path} -o world.json` draws one")
            }
            Self::Task if wanted.contains(&Self::Matrix) => {
                format!("`driftworld order {path} --matrix matrix.json` writes one")
            }
            Self::Scenario if wanted.contains(&Self::Log) => format!("`driftworld run {path} -o DIR` writes one"),
            Self::Task => format!("`driftworld sample {path}` draws its worlds"),
            Self::World => format!("`driftworld render {path}` draws it"),
            Self::Scenario => format!("`driftworld run {path}` runs it"),
            Self::Maps => format!("`driftworld sample TASK --maps {path}` draws worlds with its layouts"),
            Self::Settings => format!("`driftworld metrics LOG --load-settings {path}` scores with them"),
            Self::Matrix => format!("`driftworld order --from-matrix {path}` orders its items"),
            Self::Log => "`driftworld metrics DIR` scores the log in the folder DIR".to_owned(),
            Self::Folder => "name a file in it".to_owned(),
        }
    }

    /// The names of several kinds, as listed in messages.
    pub(crate) fn either(kinds: &[Self]) -> String {
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        match names.split_last() {
            Some((last, before)) if !before.is_empty() => format!("{} or {last}", before.join(", ")),
            _ => names.concat(),
        }
    }
}

/// The error for a document of the wrong kind. Names the file, both kinds, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: found {found}, expected {expected}; {advice}")]
pub struct OtherContents {
    path: String,
    found: &'static str,
    expected: String,
    advice: String,
}

impl OtherContents {
    /// The error if `found` is a kind that is not `wanted`; `None` for a wanted or unrecognised kind.
    pub(crate) fn check(path: &Path, found: Option<Contents>, wanted: &[Contents]) -> Option<Self> {
        let found = found.filter(|found| !wanted.contains(found))?;
        Some(Self {
            path: path.shown().to_string(),
            found: found.name(),
            expected: Contents::either(wanted),
            advice: found.advice(wanted, path),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kind_is_recognised_by_keys() {
        let check = |text: &str, expected: Option<Contents>| assert_eq!(Contents::of_text(text), expected, "{text}");
        check(r#"{ "name": "s", "blocks": [] }"#, Some(Contents::Scenario));
        check(r#"{ "maps": [] }"#, Some(Contents::Maps));
        check(r#"{ "labels": ["a"], "values": [[0]] }"#, Some(Contents::Matrix));
        check(r#"{ "perf_measure": "reward" }"#, Some(Contents::Settings));
        check(r#"{ "metrics_columns": ["reward"] }"#, Some(Contents::Log));
        check("\u{feff}{ \"name\": \"t\", \"groups\": [] }", Some(Contents::Task));
        // A document with only a name may be a scenario with misspelt keys.
        check(r#"{ "name": "t" }"#, None);
        check(r#"{ "max_steps": 3, "objects": [] }"#, Some(Contents::World));
        check(r#"{ "max_steps": 3 }"#, None);
        check("[1]", None);
        check("{", None);
    }

    #[test]
    fn wanted_or_unrecognised_kinds_pass() {
        let path = Path::new("a.json");
        assert_eq!(OtherContents::check(path, None, &[Contents::Task]), None);
        assert_eq!(
            OtherContents::check(path, Some(Contents::Task), &[Contents::World, Contents::Task]),
            None
        );
        let other = OtherContents::check(path, Some(Contents::Task), &[Contents::Scenario]).unwrap();
        assert_eq!(
            other.to_string(),
            "a.json: found a task spec, expected a scenario; `driftworld curriculum a.json -o scenario.json` makes one from its variants"
        );
    }
}
