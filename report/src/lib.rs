//! Reports of lifetimes that people want to look at.
//!
//! Not here: scoring, which is `driftworld_metrics`'; distances and clocks, which are handed in; files, which are the command's.

mod error;
mod figure;
mod page;
mod words;

pub use error::ReportError;
pub use figure::{Figure, FigureOptions, Figures, Layout, Unit};
pub use page::{Chapter, ChapterOptions, Comparison, MAX_LIFETIMES, Report};

use driftworld_metrics::Lifetime;

/// The names of each two neighbouring learning blocks of a lifetime, in order: between them a distance can be given.
pub fn neighbours(lifetime: &Lifetime) -> Vec<[&str; 2]> {
    let learnt: Vec<&str> = (lifetime.regimes().iter())
        .filter(|regime| regime.is_wake_training())
        .map(|regime| regime.task_name.as_str())
        .collect();
    learnt.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}
