//! Reports of lifetimes: figures as SVG and PNG, and one self-contained page. Also images of worlds, distances and curricula.
//!
//! A [`Chapter`] renders one lifetime, a [`Report`] puts chapters on a page, and [`Figures`] renders each figure as a file.
//!
//! ```
//! use driftworld_metrics::{BlockType, Lifetime, LogWriter, LoggerInfo, Options, Record, ScenarioInfo, Scorer, Timestamp, read_log};
//! use driftworld_report::{Chapter, ChapterOptions, Report};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let base = tempfile::tempdir()?;
//! let dir = base.path().join("my_life");
//! let mut writer = LogWriter::create(&dir, &LoggerInfo::new(["reward"])?, &ScenarioInfo::default())?;
//! for (exp_num, reward) in [(0, 1.0), (1, 3.0)] {
//!     let when = Timestamp::from_unix_micros(1_600_000_000_000_000)?;
//!     writer.write(&Record::new(0, exp_num, BlockType::Train, "find_red", when).with_metric("reward", reward))?;
//! }
//! let (log, options) = (read_log(&dir)?, Options::default());
//! let lifetime = Lifetime::prepare(&log, &[], &options)?;
//! let metrics = Scorer::default().judge(&log, &lifetime, &options)?;
//! let chapters = vec![Chapter::write(&lifetime, &metrics, &ChapterOptions::default())?];
//! let page = Report { chapters, ..Report::default() }.to_html()?;
//! assert!(page.contains("<h1>my_life</h1>"));
//! # Ok(())
//! # }
//! ```
//!
//! The caller passes in scores, distances and the date, and writes the files.

mod drawing;
mod error;
mod figure;
pub mod film;
mod page;
pub mod picture;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;
mod words;

pub use error::ReportError;
pub use figure::{Figure, FigureOptions, Figures, Layout, Unit};
pub use page::{Chapter, ChapterOptions, Comparison, MAX_LIFETIMES, Report};

use driftworld_metrics::Lifetime;

/// The task names of each pair of neighbouring learning blocks of a lifetime, in order, as [`FigureOptions::distances`] requires.
pub fn neighbours(lifetime: &Lifetime) -> Vec<[&str; 2]> {
    let learned: Vec<&str> = (lifetime.regimes().iter())
        .filter(|regime| regime.is_wake_training())
        .map(|regime| regime.task_name.as_str())
        .collect();
    learned.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The minimum and maximum of some numbers.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}
