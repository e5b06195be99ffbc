//! [`score`]: scores one lifetime or several, aggregates them, compares them with another agent's, and saves them in files named
//! as by l2metrics.

use std::path::{Path, PathBuf};

use driftworld_metrics::{LifetimeMetrics, Options, Settings, WholeLifetime, save_all};
use serde::{Serialize, Serializer};

use super::scored_log::each_log;
use super::varied::{Makeup, Varied};
use super::{Comparison, ScoredLog, ScoringRequest, Setup, score_logs};
use crate::{Failure, Warn, output_file};

/// Default name of the files for several lifetimes, as in l2metrics.
const NAME_OF_SEVERAL: &str = "ll_metrics";

/// The scores of lifetimes. Serialises to the output of `driftworld metrics --json`: one lifetime alone, or several with their
/// aggregates.
#[derive(Debug)]
#[non_exhaustive]
pub struct Scores {
    /// The lifetimes separately, in the order of their logs.
    pub lifetimes: Vec<LifetimeMetrics>,
    /// The other agent's lifetimes.
    pub lifetimes_against: Vec<LifetimeMetrics>,
    /// The aggregates of the lifetimes; `None` for a single lifetime.
    pub comparison: Option<Comparison>,
    /// The differences between the lifetimes; `None` for a single lifetime.
    pub varied: Option<Varied>,
    /// The scoring options.
    pub options: Options,
    /// The requested folders.
    folders: Vec<PathBuf>,
    recursive: bool,
}

/// Scores the logs of a request. `warn` receives warnings for each log.
///
/// # Errors
/// [`Failure`] if a log cannot be read or scored, or the request contradicts itself; among several logs it names all that fail.
pub fn score(request: &ScoringRequest, warn: Warn<'_>) -> Result<Scores, Failure> {
    score_looking(request, warn, |_| Ok(()))
}

/// Like [`score`], and passes each log with its lifetime to `look`, from any thread.
pub(crate) fn score_looking(
    request: &ScoringRequest,
    warn: Warn<'_>,
    look: impl Fn(&ScoredLog) -> Result<(), Failure> + Sync,
) -> Result<Scores, Failure> {
    let Setup {
        logs,
        options,
        experts,
        others,
    } = Setup::new(request.folders()?, request, warn)?;
    let scored = each_log(&logs, &experts, &options, warn, |log| {
        look(&log)?;
        Ok((Makeup::of(&log.log), log.metrics))
    })?;
    let (makeups, lifetimes): (Vec<_>, Vec<_>) = scored.into_iter().unzip();
    let lifetimes_against = score_logs(&others, &experts, &options, warn)?;
    check_power(request.power, lifetimes.len())?;
    let is_alone = lifetimes.len() == 1 && !request.recursive && request.against.is_empty();
    let comparison = (!is_alone).then(|| {
        Comparison::new(
            &lifetimes,
            &lifetimes_against,
            &request.intervals.options(),
            request.power,
        )
    });
    Ok(Scores {
        comparison: comparison.transpose()?,
        varied: Varied::between(&makeups),
        lifetimes,
        lifetimes_against,
        options,
        folders: request.logs.clone(),
        recursive: request.recursive,
    })
}

impl Scores {
    /// Saves the results in a folder, which is created if necessary: for one lifetime `NAME_metrics.json`, `NAME_regime.tsv`
    /// and `NAME_settings.json`; for several, or after searching folders, `NAME.json`, `NAME.tsv`, `NAME_regime.tsv`,
    /// `NAME_settings.json`; and `NAME_repeats.json` with their aggregates. Returns the files.
    ///
    /// `name` defaults to the log's, or `ll_metrics` for several.
    ///
    /// # Errors
    /// [`Failure`] if a file cannot be written, or the name is not a valid file name.
    pub fn save(&self, folder: &Path, name: Option<&str>) -> Result<Vec<PathBuf>, Failure> {
        let logs = self.folders.iter().map(|log| log.display().to_string());
        let settings = Settings {
            log_dir: logs.collect::<Vec<_>>().join(" "),
            options: self.options.clone(),
        };
        let several = name.unwrap_or(NAME_OF_SEVERAL);
        let mut files = match self.lifetimes.as_slice() {
            [lifetime] if !self.recursive => lifetime.save(folder, name.unwrap_or(&lifetime.run_id), &settings)?,
            lifetimes => save_all(lifetimes, folder, several, &settings)?,
        };
        if let Some(comparison) = &self.comparison {
            let file = folder.join(format!("{}_repeats.json", several.replace(' ', "_")));
            output_file::write(&file, serde_json::to_string_pretty(comparison)?.as_bytes())?;
            files.push(file);
        }
        Ok(files)
    }
}

impl Serialize for Scores {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct ComparedLifetimes<'a> {
            #[serde(flatten)]
            comparison: &'a Comparison,
            #[serde(skip_serializing_if = "Option::is_none")]
            varied: Option<Varied>,
            lifetimes: Vec<WholeLifetime<'a>>,
            #[serde(skip_serializing_if = "Vec::is_empty")]
            lifetimes_against: Vec<WholeLifetime<'a>>,
        }
        match (&self.comparison, self.lifetimes.as_slice()) {
            (None, [lifetime]) => lifetime.whole().serialize(serializer),
            (None, lifetimes) => whole(lifetimes).serialize(serializer),
            (Some(comparison), lifetimes) => ComparedLifetimes {
                comparison,
                varied: self.varied,
                lifetimes: whole(lifetimes),
                lifetimes_against: whole(&self.lifetimes_against),
            }
            .serialize(serializer),
        }
    }
}

/// Refuses power calculations for a single lifetime, or for an invalid difference.
fn check_power(effect: Option<f64>, num: usize) -> Result<(), Failure> {
    let Some(effect) = effect else { return Ok(()) };
    let (found, expected) = if !(effect.is_finite() && effect > 0.0) {
        (effect.to_string(), "a difference above 0")
    } else if num < 2 {
        (format!("{num} lifetime"), "at least two, to see how much they vary")
    } else {
        return Ok(());
    };
    Err(Failure::in_argument(
        "power",
        format!("found {found}, expected {expected}"),
    ))
}

/// Each lifetime with the values for which l2metrics' files have no field.
fn whole(lifetimes: &[LifetimeMetrics]) -> Vec<WholeLifetime<'_>> {
    lifetimes.iter().map(LifetimeMetrics::whole).collect()
}
