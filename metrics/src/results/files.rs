//! Saves results in files with the reference's names.

use std::fs;
use std::path::{Path, PathBuf};

use indexmap::IndexSet;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{LifetimeMetrics, regimes_tsv};
use crate::log::{line, write_json, write_whole};
use crate::{MetricsError, Options};

/// The contents of `NAME_settings.json`: the log's path, and the scoring options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Directory of the log, as the user gave it.
    pub log_dir: String,
    /// The options; their fields are at the top level of the JSON.
    #[serde(flatten)]
    pub options: Options,
}

impl LifetimeMetrics {
    /// Saves the results in a directory, which is created if necessary: lifetime and tasks in `NAME_metrics.json`, regimes in
    /// `NAME_regime.tsv` and the options in `NAME_settings.json`. Existing files are replaced. Spaces in `name` become
    /// underscores. Returns the files in this order.
    ///
    /// # Errors
    /// [`MetricsError::Io`]; [`MetricsError::BadOption`] for a name that is empty or contains `/` or `\`.
    pub fn save(&self, dir: impl AsRef<Path>, name: &str, settings: &Settings) -> Result<Vec<PathBuf>, MetricsError> {
        let mut saving = Saving::new(dir.as_ref(), name)?;
        write_json(saving.file("_metrics.json"), self)?;
        write_whole(saving.file("_regime.tsv"), self.regime_tsv().as_bytes())?;
        write_json(saving.file("_settings.json"), settings)?;
        Ok(saving.files)
    }
}

/// Saves the results of several lifetimes, under the names of the reference's recursive mode: a row per lifetime in `NAME.tsv`,
/// a list of their `_metrics.json` contents in `NAME.json`, the regimes of all in `NAME_regime.tsv` and the options in
/// `NAME_settings.json`. Returns the files in this order.
///
/// # Errors
/// Those of [`LifetimeMetrics::save`].
pub fn save_all(
    lifetimes: &[LifetimeMetrics],
    dir: impl AsRef<Path>,
    name: &str,
    settings: &Settings,
) -> Result<Vec<PathBuf>, MetricsError> {
    let mut saving = Saving::new(dir.as_ref(), name)?;
    write_whole(saving.file(".tsv"), lifetimes_tsv(lifetimes).as_bytes())?;
    write_json(saving.file(".json"), &lifetimes)?;
    write_whole(saving.file("_regime.tsv"), regimes_tsv(lifetimes).as_bytes())?;
    write_json(saving.file("_settings.json"), settings)?;
    Ok(saving.files)
}

/// The files of one save, all in one directory and with one prefix.
struct Saving<'a> {
    dir: &'a Path,
    name: String,
    files: Vec<PathBuf>,
}

impl<'a> Saving<'a> {
    fn new(dir: &'a Path, name: &str) -> Result<Self, MetricsError> {
        if name.is_empty() || name.contains(['/', '\\', '\0']) {
            let expected = "a file name without / and \\".to_owned();
            return Err(MetricsError::bad_option("output name", format!("{name:?}"), expected));
        }
        fs::create_dir_all(dir).map_err(MetricsError::io(dir, "make this directory"))?;
        let (name, files) = (name.replace(' ', "_"), Vec::new());
        Ok(Self { dir, name, files })
    }

    fn file(&mut self, ending: &str) -> &Path {
        self.files.push(self.dir.join(format!("{}{ending}", self.name)));
        &self.files[self.files.len() - 1]
    }
}

/// Fields that get no column, because they are too long for a cell; the JSON contains them.
const OMITTED: [&str; 4] = ["normalization_data_range", "as_logged", "notes", "task_metrics"];

/// One row per lifetime, with the log in the first column, and a column for every value that any lifetime has.
pub(super) fn lifetimes_tsv(lifetimes: &[LifetimeMetrics]) -> String {
    let rows = lifetimes
        .iter()
        .map(|lifetime| serde_json::to_value(lifetime).expect("results always serialise"));
    let rows: Vec<Value> = rows.collect();
    let names = rows.iter().filter_map(Value::as_object).flat_map(Map::keys);
    let mut columns = IndexSet::from(["run_id"]);
    columns.extend(names.map(String::as_str).filter(|name| !OMITTED.contains(name)));
    let mut text = line(&columns);
    for row in &rows {
        text.extend(line(columns.iter().map(|name| cell(&row[name]))));
    }
    String::from_utf8(text).expect("cells are text, and quoting adds only quotes")
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => driftworld_text::cell(text).into_owned(),
        other => other.to_string(),
    }
}
