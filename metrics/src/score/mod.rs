//! Scores a lifetime: one file per metric, and shared parts.

mod assessment;
mod average_performance;
mod exchange;
mod metric;
mod null_bands;
mod performance_maintenance;
mod performance_recovery;
mod sample_efficiency;
mod saturation;
mod scorer;
mod ste_relative_performance;
mod terminal_performance;
mod transfer;

pub use assessment::Assessment;
pub use metric::Metric;
pub use null_bands::NULL_PERMUTATIONS;
pub use scorer::{Scorer, score};

use crate::results::Headline;
use crate::{MaintenanceMethod, Options, TransferMethod};

/// The metrics of this crate, in the order in which they are computed and shown.
fn built_in() -> Vec<Box<dyn Metric>> {
    vec![
        Box::new(saturation::Saturation),
        Box::new(terminal_performance::TerminalPerformance),
        Box::new(performance_recovery::PerformanceRecovery),
        Box::new(average_performance::AveragePerformance),
        Box::new(performance_maintenance::PerformanceMaintenance),
        Box::new(transfer::Transfer),
        Box::new(ste_relative_performance::SteRelativePerformance),
        Box::new(sample_efficiency::SampleEfficiency),
    ]
}

/// The headlines of this crate's metrics, including those that were not requested.
pub(crate) fn built_in_headlines() -> Vec<Headline> {
    let metrics = built_in();
    metrics
        .iter()
        .flat_map(|metric| metric.headlines(&all_requested()))
        .collect()
}

/// Options that request every value.
fn all_requested() -> Options {
    Options {
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    }
}
