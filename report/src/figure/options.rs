//! [`FigureOptions`]: what figures show and in which unit; [`Layout`]: how wide they are.

use std::collections::BTreeMap;
use std::str::FromStr;

use crate::ReportError;
use crate::words::shown;

/// The width that a figure is drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// 960 pixels, for screens and paper.
    Wide,
    /// 360 pixels, for phones.
    Narrow,
}

/// The unit of the horizontal axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Unit {
    /// Experiences, by their numbers (default).
    #[default]
    Experiences,
    /// Environment steps, summed over the preceding experiences.
    Steps,
}

impl FromStr for Unit {
    type Err = ReportError;

    /// Parses the names used by the reference implementation: `exp_num` or `steps`.
    fn from_str(word: &str) -> Result<Self, ReportError> {
        match word {
            "exp_num" => Ok(Self::Experiences),
            "steps" => Ok(Self::Steps),
            _ => Err(ReportError::UnknownUnit { found: shown(word) }),
        }
    }
}

/// Options of figures.
#[derive(Debug, Clone, PartialEq)]
pub struct FigureOptions {
    /// The unit of the horizontal axis; default experiences.
    pub unit: Unit,
    /// Whether the means of evaluations are joined across learning blocks; default `true`.
    pub show_eval_lines: bool,
    /// Distances between neighbouring learning blocks, in the order of [`neighbours`](crate::neighbours); an unknown distance is
    /// `None` in the list. By default the timeline shows no distances.
    pub distances: Option<Vec<Option<f64>>>,
    /// Display names of tasks in legends and tables, keyed by their log names. Other tasks are shown by their log names.
    pub names: BTreeMap<String, String>,
}

impl Default for FigureOptions {
    fn default() -> Self {
        Self {
            unit: Unit::Experiences,
            show_eval_lines: true,
            distances: None,
            names: BTreeMap::new(),
        }
    }
}
