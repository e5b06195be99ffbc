//! Errors of this crate.

use driftworld_text::one_line;

/// Errors raised while making a figure or a page.
///
/// Every message states where the problem is, what was found, what was expected, and what to do if that is not obvious.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "report/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum ReportError {
    /// The plotting library failed.
    #[error("figure {figure}: drawing failed: {source}")]
    Drawing {
        /// The figure, by its name in files.
        figure: &'static str,
        /// The plotting library's error.
        source: Box<dyn std::error::Error + Send + Sync>,
    },

    /// An image has no pixels, or its number of pixels does not match its size.
    #[error("picture: cannot be written as PNG: {0}")]
    Png(#[from] png::EncodingError),

    /// A film cannot be written as GIF.
    #[error("film: cannot be written as GIF: {0}")]
    Gif(#[from] gif::EncodingError),

    /// A film without images, or with images of different sizes.
    #[error("film: found {found}, expected {expected}")]
    FilmSize {
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
    },

    /// An unknown figure.
    #[error("plot type: found {found:?}, expected one of all, raw, lb, eb, ste, timeline")]
    UnknownFigure {
        /// The requested name.
        found: String,
    },

    /// An unknown unit.
    #[error("unit: found {found:?}, expected exp_num or steps")]
    UnknownUnit {
        /// The requested name.
        found: String,
    },

    /// The horizontal axis cannot count steps.
    #[error(
        "log {run_id}: found no steps for every experience, expected the column episode_step_count with a non-negative number \
         in each complete row; leave the unit at exp_num",
        run_id = one_line(run_id)
    )]
    NoSteps {
        /// The log.
        run_id: String,
    },

    /// Distances that do not match the lifetime.
    #[error(
        "log {run_id}: found {found} distances, expected {expected}: one for each pair of neighbouring learning blocks, as \
         listed by neighbours()",
        run_id = one_line(run_id)
    )]
    Distances {
        /// The log.
        run_id: String,
        /// Number of distances given.
        found: usize,
        /// Number of distances expected.
        expected: usize,
    },

    /// More lifetimes than one page supports.
    #[error("found {found} lifetimes, expected at most {limit} on one page; make several reports")]
    TooManyLifetimes {
        /// Number of lifetimes given.
        found: usize,
        /// Maximum number of lifetimes.
        limit: usize,
    },
}

impl ReportError {
    /// A name for the kind of error, stable between versions.
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
                expected: "2 × 2, the size of the film".to_owned(),
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
