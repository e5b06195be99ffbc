//! The one error type of this crate: what can keep a report from being made.
//!
//! Not here: what is wrong with a log, see `driftworld_metrics::MetricsError`.

use driftworld_text::one_line;

/// Everything that can stop a figure or a page.
///
/// Every message reads: where, what was found, what was expected, and what to do where that is not plain.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "report/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum ReportError {
    /// The plotting library could not draw.
    #[error("figure {figure}: drawing failed: {source}")]
    Drawing {
        /// The figure, by its name in files.
        figure: &'static str,
        /// What the plotting library said.
        source: Box<dyn std::error::Error + Send + Sync>,
    },

    /// A picture has no pixels, or others than its size says.
    #[error("picture: cannot be written as PNG: {0}")]
    Png(#[from] png::EncodingError),

    /// A film cannot be written as GIF.
    #[error("film: cannot be written as GIF: {0}")]
    Gif(#[from] gif::EncodingError),

    /// A film of no pictures, or of some that do not fit.
    #[error("film: found {found}, expected {expected}")]
    FilmSize {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },

    /// A name of a figure that is none.
    #[error("plot type: found {found:?}, expected one of all, raw, lb, eb, ste, timeline")]
    UnknownFigure {
        /// What was asked for.
        found: String,
    },

    /// A name of a unit that is none.
    #[error("unit: found {found:?}, expected exp_num or steps")]
    UnknownUnit {
        /// What was asked for.
        found: String,
    },

    /// The horizontal axis cannot count steps.
    #[error(
        "log {run_id}: found no steps for every experience, expected the column episode_step_count with a number of 0 or more in \
         each complete row; leave the unit at exp_num",
        run_id = one_line(run_id)
    )]
    NoSteps {
        /// The log.
        run_id: String,
    },

    /// Distances that do not belong to the lifetime.
    #[error(
        "log {run_id}: found {found} distances, expected {expected}: one for each two neighbouring learning blocks, as \
         neighbours() lists them",
        run_id = one_line(run_id)
    )]
    Distances {
        /// The log.
        run_id: String,
        /// How many were given.
        found: usize,
        /// How many there must be.
        expected: usize,
    },

    /// More lifetimes than one page can show.
    #[error("found {found} lifetimes, expected at most {limit} on one page; make several reports")]
    TooManyLifetimes {
        /// How many there are.
        found: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl ReportError {
    /// A name for the kind of error that stays the same between versions.
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use strum::VariantNames;

    #[test]
    fn every_error_has_its_message() {
        let run_id = || "life".to_owned();
        let all = [
            ReportError::Drawing {
                figure: "raw",
                source: "no font".into(),
            },
            ReportError::Png(png::EncodingError::LimitsExceeded),
            ReportError::Gif(gif::EncodingError::OutOfMemory),
            ReportError::FilmSize {
                found: "a picture of 2 × 3 pixels".to_owned(),
                expected: "2 × 2, as the film's first".to_owned(),
            },
            ReportError::UnknownFigure {
                found: "pie".to_owned(),
            },
            ReportError::UnknownUnit {
                found: "hours".to_owned(),
            },
            ReportError::NoSteps { run_id: run_id() },
            ReportError::Distances {
                run_id: run_id(),
                found: 2,
                expected: 3,
            },
            ReportError::TooManyLifetimes { found: 99, limit: 40 },
        ];
        let lines: Vec<String> = all.iter().map(|error| format!("{}: {error}", error.code())).collect();
        insta::assert_snapshot!(lines.join("\n"));
        assert!(
            all.iter()
                .map(ReportError::code)
                .eq(ReportError::VARIANTS.iter().copied())
        );
    }
}
