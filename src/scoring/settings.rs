//! Reads settings saved by l2metrics or by this command, and ranges of tasks.

use std::path::{Path, PathBuf};

use driftworld_metrics::{DataRange, DataRanges, Definitions, Noise, Options, Scales};
use driftworld_spec::did_you_mean;
use driftworld_text::json::{Wanted, lines_and_columns, offsets, repeated};
use driftworld_text::{ShownPath, in_plain_words, one_line};
use serde_json::{Map, Value, json};

use crate::contents::Contents;
use crate::{Failure, documents};

/// Keys of l2metrics' settings about input, output or drawing, which do not affect scores.
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

/// The contents of a settings file.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) options: Options,
    /// The log for which the settings were saved.
    pub(super) log_dir: Option<PathBuf>,
}

/// Reads a settings file, l2metrics' or ours.
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
    if let Some(unknown) = settings.keys().find(|key| known().all(|known| known != *key)) {
        let near = did_you_mean(unknown, known());
        let names = known()
            .map(String::as_str)
            .chain(NOT_SCORING)
            .collect::<Vec<_>>()
            .join(", ");
        return Err(Failure::input(format!(
            "{}: found the setting {unknown:?}, expected one of {names}{near}",
            location(path, &text, unknown)
        )));
    }
    for (key, value) in &settings {
        let alone = Map::from_iter([(key.clone(), value.clone())]);
        serde_json::from_value::<Options>(Value::Object(alone)).map_err(|error| {
            let error = one_line(in_plain_words(error)).to_string();
            Failure::input(format!("{}, {key:?}: {error}", location(path, &text, key)))
        })?;
    }
    let mut options: Options = serde_json::from_value(Value::Object(settings))
        .map_err(|error| Failure::input(format!("{}: {}", path.shown(), one_line(in_plain_words(error)))))?;
    if let (Some(file), None) = (range_file, &options.data_range) {
        options.data_range = Some(data_ranges(&file)?);
    }
    Ok(Loaded { options, log_dir })
}

/// l2metrics writes noise as `[MEAN, STD]`, and `[0, 0]` for no noise.
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
/// [`Failure`] if it cannot be read or has the wrong contents.
pub(super) fn data_ranges(path: &Path) -> Result<DataRanges, Failure> {
    let expected = "an object of ranges, such as {\"find_red\": {\"min\": 0, \"max\": 10}}";
    let mut ranges = DataRanges::new();
    let text = documents::text(path)?;
    for (task, range) in object(path, &text, expected)? {
        let range: DataRange = serde_json::from_value(range).map_err(|error| {
            Failure::input(format!(
                "{}, {task:?}: {}; expected {expected}",
                location(path, &text, &task),
                one_line(in_plain_words(error))
            ))
        })?;
        if range.min >= range.max {
            return Err(Failure::input(format!(
                "{}, {task:?}: found min {} and max {}, expected min below max",
                location(path, &text, &task),
                range.min,
                range.max
            )));
        }
        ranges.insert(task.to_lowercase(), range);
    }
    Ok(ranges)
}

/// The file with the line and column of a key in its object.
fn location(path: &Path, text: &str, key: &str) -> String {
    let pointer = format!("/{}", key.replace('~', "~0").replace('/', "~1"));
    let wanted = [Wanted {
        pointer: &pointer,
        at_key: true,
    }];
    let (line, column) = lines_and_columns(text, &offsets(text, &wanted))[0];
    format!("{}:{line}:{column}", path.shown())
}

fn object(path: &Path, text: &str, expected: &str) -> Result<Map<String, Value>, Failure> {
    if let Some(pointer) = repeated(text, 1).first() {
        let key = pointer
            .rsplit('/')
            .next()
            .unwrap_or_default()
            .replace("~1", "/")
            .replace("~0", "~");
        return Err(Failure::input(format!(
            "{}: found the key {key:?} twice, expected each key once; remove one of the two",
            path.shown()
        )));
    }
    match serde_json::from_str(text) {
        Ok(Value::Object(object)) => Ok(object),
        Ok(_) => Err(Failure::in_file(path, format!("found other JSON, expected {expected}"))),
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
        let folder = tempfile::tempdir().expect("a temporary folder can be created");
        let path = folder.path().join("settings.json");
        std::fs::write(&path, text).expect("a file can be written there");
        let here = format!("{}/", folder.path().display());
        load(&path).map_err(|failure| Failure::input(failure.to_string().replace(&here, "")))
    }

    #[test]
    fn l2metrics_settings_are_understood() {
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
    fn unknown_settings_are_named() {
        let check = |text: &str, expected: &str| {
            assert_eq!(loaded(text).expect_err("it is wrong").to_string(), expected);
        };
        check(
            r#"{"window_length": "x"}"#,
            "settings.json:1:2, \"window_length\": invalid type: string \"x\", expected a whole number",
        );
        check(
            r#"{"noise": null, "noise": [0, 1]}"#,
            "settings.json: found the key \"noise\" twice, expected each key once; remove one of the two",
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
