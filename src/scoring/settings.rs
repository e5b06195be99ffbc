//! Settings from files: as l2metrics or this command saved them, and ranges of tasks.

use std::path::{Path, PathBuf};

use driftworld_metrics::{DataRange, DataRanges, Definitions, Noise, Options, Scales};
use driftworld_spec::did_you_mean;
use driftworld_text::{ShownPath, in_plain_words, one_line};
use serde_json::{Map, Value, json};

use crate::contents::Contents;
use crate::{Failure, documents};

/// Keys of l2metrics' settings that say what is read, written or drawn, not how a lifetime is scored.
const NOT_SCORING: [&str; 13] = [
    "log_dir",
    "output_dir",
    "output",
    "recursive",
    "ste_store_mode",
    "unit",
    "show_eval_lines",
    "do_plot",
    "plot_types",
    "do_save",
    "do_save_settings",
    "load_settings",
    "ste",
];

/// What a settings file says.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) options: Options,
    /// The log that the settings were saved for.
    pub(super) log_dir: Option<PathBuf>,
}

/// Reads a settings file, of l2metrics or ours.
pub(super) fn load(path: &Path) -> Result<Loaded, Failure> {
    let text = documents::text_of(path, &[Contents::Settings])?;
    let mut settings = object(
        path,
        &text,
        "an object of settings, such as {\"perf_measure\": \"reward\"}",
    )?;
    let log_dir = settings.get("log_dir").and_then(Value::as_str);
    let log_dir = log_dir.filter(|dir| !dir.is_empty()).map(PathBuf::from);
    if let Some(smooth) = settings.shift_remove("do_smooth_eval_data") {
        settings.insert("smooth_eval_data".to_owned(), smooth);
    }
    if let Some(noise) = settings.get_mut("noise") {
        *noise = noise_of_l2metrics(noise);
    }
    let range_file = settings
        .shift_remove("data_range_file")
        .and_then(|file| Some(PathBuf::from(file.as_str()?)));
    settings.retain(|key, _| !NOT_SCORING.contains(&key.as_str()));
    let known = json!(Options {
        noise: Some(Noise {
            mean: 0.0,
            std: 0.0,
            seed: 0
        }),
        definitions: Definitions::Published,
        scales: Some(Scales::new()),
        ..Options::default()
    });
    let known = || known.as_object().into_iter().flat_map(|known| known.keys());
    if let Some(strange) = settings.keys().find(|key| known().all(|known| known != *key)) {
        let near = did_you_mean(strange, known());
        return Err(Failure::input(format!(
            "{}: found the setting {strange:?}, expected one of l2metrics{near}",
            path.shown()
        )));
    }
    let mut options: Options = serde_json::from_value(Value::Object(settings))
        .map_err(|error| Failure::input(format!("{}: {}", path.shown(), one_line(in_plain_words(error)))))?;
    if let (Some(file), None) = (range_file, &options.data_range) {
        options.data_range = Some(data_ranges(&file)?);
    }
    Ok(Loaded { options, log_dir })
}

/// l2metrics says noise as `[MEAN, STD]`, and `[0, 0]` for none.
fn noise_of_l2metrics(noise: &Value) -> Value {
    match noise.as_array().map(Vec::as_slice) {
        Some([mean, std]) if mean.as_f64() == Some(0.0) && std.as_f64() == Some(0.0) => Value::Null,
        Some([mean, std]) => json!({ "mean": mean, "std": std }),
        _ => noise.clone(),
    }
}

/// Reads the ranges of tasks from a file: `{"find_red": {"min": 0, "max": 10}}`. Names are lower-cased, as in the metrics.
///
/// # Errors
/// [`Failure`] where it cannot be read or says something else.
pub fn data_ranges(path: &Path) -> Result<DataRanges, Failure> {
    let expected = "an object of ranges, such as {\"find_red\": {\"min\": 0, \"max\": 10}}";
    let mut ranges = DataRanges::new();
    for (task, range) in object(path, &documents::text(path)?, expected)? {
        let range: DataRange = serde_json::from_value(range).map_err(|error| {
            Failure::input(format!(
                "{}, {task:?}: {}; expected {expected}",
                path.shown(),
                one_line(in_plain_words(error))
            ))
        })?;
        ranges.insert(task.to_lowercase(), range);
    }
    Ok(ranges)
}

fn object(path: &Path, text: &str, expected: &str) -> Result<Map<String, Value>, Failure> {
    match serde_json::from_str(text) {
        Ok(Value::Object(object)) => Ok(object),
        Ok(_) => Err(Failure::input(format!(
            "{}: found other JSON, expected {expected}",
            path.shown()
        ))),
        Err(error) => Err(Failure::input(format!(
            "{}:{}:{}: found no JSON ({error}), expected {expected}",
            path.shown(),
            error.line(),
            error.column()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loaded(text: &str) -> Result<Loaded, Failure> {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let path = folder.path().join("settings.json");
        std::fs::write(&path, text).expect("a file can be written there");
        load(&path).map_err(|failure| {
            Failure::input(
                failure
                    .to_string()
                    .replace(&format!("{}/", folder.path().display()), ""),
            )
        })
    }

    #[test]
    fn settings_of_l2metrics_are_understood() {
        let text = r#"{"log_dir": "logs/a", "perf_measure": "performance", "maintenance_method": "both", "window_length": null,
            "noise": [0, 0.5], "do_smooth_eval_data": true, "show_eval_lines": true, "do_plot": true}"#;
        let Loaded { options, log_dir } = loaded(text).expect("these are settings");
        assert_eq!(
            (options.perf_measure.as_str(), options.smooth_eval_data),
            ("performance", true)
        );
        assert_eq!(options.noise.map(|noise| (noise.mean, noise.std)), Some((0.0, 0.5)));
        assert_eq!(log_dir, Some("logs/a".into()));
        assert_eq!(
            loaded(r#"{"noise": [0, 0]}"#).expect("no noise").options,
            Options::default()
        );
    }

    #[test]
    fn what_is_no_setting_is_named() {
        let check = |text: &str, expected: &str| {
            assert_eq!(loaded(text).expect_err("it is wrong").to_string(), expected);
        };
        check(
            r#"{"perf_mesure": "reward"}"#,
            "settings.json: found the setting \"perf_mesure\", expected one of l2metrics; did you mean \"perf_measure\"?",
        );
        check(
            "[1]",
            "settings.json: found other JSON, expected an object of settings, such as {\"perf_measure\": \"reward\"}",
        );
        check(
            "{",
            "settings.json:1:1: found no JSON (EOF while parsing an object at line 1 column 1), expected an object of settings, \
             such as {\"perf_measure\": \"reward\"}",
        );
    }
}
