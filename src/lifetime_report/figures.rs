//! [`FigureChoice`]: which figures of lifetimes are drawn, and how.

use clap::Args;
use driftworld_report::{Figure, FigureOptions, ReportError, Unit};
use serde::Deserialize;

use crate::{Failure, request};

/// Which figures are drawn, and how: arguments of `driftworld metrics` and `driftworld report`.
#[derive(Args, Clone, Debug, Deserialize)]
#[group(skip)]
#[command(next_help_heading = "Figures")]
#[serde(default, deny_unknown_fields)]
pub struct FigureChoice {
    /// Figures to draw: all, or any of raw, lb, eb, ste, timeline.
    ///
    /// lb shows learning blocks, eb evaluation blocks, ste the comparison with single-task experts.
    #[arg(short = 'T', long, value_name = "TYPE", num_args = 1.., default_value = "all")]
    pub plot_types: Vec<String>,
    /// Unit of the horizontal axis: `exp_num`, or `steps` (column `episode_step_count`).
    #[arg(short, long, value_name = "UNIT", default_value = "exp_num")]
    pub unit: String,
    /// Do not connect evaluation means across learning blocks.
    #[arg(long)]
    pub no_show_eval_lines: bool,
    /// Connect them. This is the default.
    #[arg(short = 'e', long, hide = true, conflicts_with = "no_show_eval_lines")]
    #[serde(skip)]
    pub show_eval_lines: bool,
}

impl Default for FigureChoice {
    fn default() -> Self {
        request::usual()
    }
}

impl FigureChoice {
    /// The chosen figures, in the order of a report; all if none is chosen.
    pub(crate) fn shown(&self) -> Result<Vec<Figure>, Failure> {
        let requested = self.plot_types.iter().map(|word| Figure::asked_for(word));
        let requested = requested
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| in_arguments(&error))?
            .concat();
        Ok(Figure::ALL
            .into_iter()
            .filter(|figure| requested.is_empty() || requested.contains(figure))
            .collect())
    }

    pub(crate) fn options(&self) -> Result<FigureOptions, Failure> {
        Ok(FigureOptions {
            unit: self.unit.parse::<Unit>().map_err(|error| in_arguments(&error))?,
            show_eval_lines: !self.no_show_eval_lines,
            ..FigureOptions::default()
        })
    }
}

fn in_arguments(error: &ReportError) -> Failure {
    Failure::usage(error.to_string())
}
