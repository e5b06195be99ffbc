//! The scoring options, under l2metrics' names, shared by `metrics` and `report`.

use std::path::{Path, PathBuf};

use crate::Failure;
use crate::metrics::{BootstrapOptions, Noise, Resampling};
use crate::scales::ScalesFile;
use crate::scoring::{ScoringChoice, ScoringSettings, data_ranges};
use clap::Args;

/// How a lifetime is scored, and which experts it is compared with.
#[derive(Args, Default)]
#[command(next_help_heading = "Scoring")]
pub(crate) struct Scoring {
    #[command(flatten)]
    choice: ScoringChoice,
    /// Read each task's range from a JSON file: `{"find_red": {"min": 0, "max": 10}}`.
    #[arg(short, long, value_name = "FILE")]
    data_range_file: Option<PathBuf>,
    /// Scale each task from its floor to its ceiling, as `driftworld scales` measures them.
    ///
    /// A task that is not in the file, or whose ceiling is not above its floor, is scaled by its own range.
    #[arg(long, value_name = "FILE", conflicts_with = "data_range_file")]
    scales: Option<PathBuf>,
    /// Add Gaussian noise to the performance, in normalised units.
    #[arg(short = 'N', long, num_args = 2, value_names = ["MEAN", "STD"], allow_negative_numbers = true)]
    noise: Option<Vec<f64>>,
    /// Seed of the noise.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        requires = "noise", allow_negative_numbers = true, value_parser = crate::numbers::seed
    )]
    noise_seed: u64,
    /// Follow the published definitions where the reference program differs.
    ///
    /// docs/metrics.md lists the differences.
    #[arg(long)]
    strict_definitions: bool,
    /// Read settings from a JSON file, l2metrics' or ours. Command-line options win.
    #[arg(short = 'c', long, value_name = "FILE")]
    load_settings: Option<PathBuf>,
}

impl Scoring {
    /// Converts the options to the library's settings.
    pub(crate) fn settings(&self) -> Result<ScoringSettings, Failure> {
        let noise = self.noise.as_deref().and_then(|noise| match noise {
            [mean, std] => Some(Noise {
                mean: *mean,
                std: *std,
                seed: self.noise_seed,
            }),
            // The parser accepts exactly two.
            _ => None,
        });
        Ok(ScoringSettings {
            choice: self.choice.clone(),
            file: self.load_settings.clone(),
            data_range: self.data_range_file.as_deref().map(data_ranges).transpose()?,
            scales: (self.scales.as_deref())
                .map(|path| ScalesFile::read(path).map(|file| file.anchors()))
                .transpose()?,
            noise,
            strict_definitions: self.strict_definitions,
        })
    }

    /// The folder of stored experts.
    pub(crate) fn ste_data(&self) -> Option<&Path> {
        self.choice.expert_store.as_deref()
    }
}

/// How several lifetimes are combined, and the confidence intervals.
#[derive(Args)]
#[command(next_help_heading = "Several lifetimes")]
pub(crate) struct Intervals {
    /// Normalise each task by its range over all lifetimes. --against always does.
    #[arg(long)]
    pub(crate) common_ranges: bool,
    /// Confidence level of the bootstrap intervals.
    #[arg(long, value_name = "SHARE", default_value_t = BootstrapOptions::default().confidence, value_parser = crate::numbers::share)]
    confidence: f64,
    /// Number of bootstrap resamples. Use 50000 for a published figure.
    #[arg(long, value_name = "N", default_value_t = BootstrapOptions::default().resamples)]
    resamples: u32,
    /// What to resample: runs (whole lifetimes) or strata (within each task).
    ///
    /// `strata` does as rliable does: it treats the tasks of a lifetime as independent.
    #[arg(long, value_name = "WHAT", default_value_t = BootstrapOptions::default().resampling)]
    resampling: Resampling,
    /// Seed of the bootstrap.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    bootstrap_seed: u64,
}

impl Intervals {
    pub(crate) fn options(&self) -> BootstrapOptions {
        BootstrapOptions {
            confidence: self.confidence,
            resamples: self.resamples,
            resampling: self.resampling,
            seed: self.bootstrap_seed,
        }
    }
}
