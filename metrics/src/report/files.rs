//! The three files of results, under the reference's names.
//!
//! Not here: what stands in them, see `lifetime_metrics` and `regime_table`.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::LifetimeMetrics;
use crate::log::{write_json, write_whole};
use crate::{MetricsError, Options};

/// What `NAME_settings.json` holds: where the log was, and the options it was scored under.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Directory of the log, as the user gave it.
    pub log_dir: String,
    /// The options; their fields stand at the top level of the JSON.
    #[serde(flatten)]
    pub options: Options,
}

/// Where results were saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedFiles {
    /// `NAME_metrics.json`: lifetime and tasks.
    pub metrics: PathBuf,
    /// `NAME_regime.tsv`: regimes.
    pub regimes: PathBuf,
    /// `NAME_settings.json`: the options.
    pub settings: PathBuf,
}

impl LifetimeMetrics {
    /// Saves the results in a directory, made if need be; files of that name are replaced. Spaces in `name` become
    /// underscores.
    ///
    /// # Errors
    /// [`MetricsError::Io`]; [`MetricsError::BadOption`] for a name that is empty or has a `/` or `\`.
    pub fn save(&self, dir: impl AsRef<Path>, name: &str, settings: &Settings) -> Result<SavedFiles, MetricsError> {
        let dir = dir.as_ref();
        if name.is_empty() || name.contains(['/', '\\', '\0']) {
            let expected = "a file name without / and \\".to_owned();
            return Err(MetricsError::BadOption {
                option: "output name",
                found: format!("{name:?}"),
                expected,
            });
        }
        let name = name.replace(' ', "_");
        fs::create_dir_all(dir).map_err(MetricsError::io(dir, "make this directory"))?;
        let files = SavedFiles {
            metrics: dir.join(format!("{name}_metrics.json")),
            regimes: dir.join(format!("{name}_regime.tsv")),
            settings: dir.join(format!("{name}_settings.json")),
        };
        write_json(&files.metrics, self)?;
        write_whole(&files.regimes, self.regime_tsv().as_bytes())?;
        write_json(&files.settings, settings)?;
        Ok(files)
    }
}
