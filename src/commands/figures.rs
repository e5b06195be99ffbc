//! The options that choose the figures of lifetimes.

use crate::Failure;
use crate::report::{Figure, FigureOptions, ReportError, Unit};
use clap::Args;

/// Which figures are drawn, and how.
#[derive(Args)]
#[command(next_help_heading = "Figures")]
pub(crate) struct FigureChoice {
    /// Figures to draw: all, or any of raw, lb, eb, ste, timeline.
    ///
    /// lb shows learning blocks, eb evaluation blocks, ste the comparison with single-task experts.
    #[arg(short = 'T', long, value_name = "TYPE", num_args = 1.., default_value = "all")]
    plot_types: Vec<String>,
    /// Unit of the horizontal axis: `exp_num`, or `steps` (column `episode_step_count`).
    #[arg(short, long, value_name = "UNIT", default_value = "exp_num")]
    unit: String,
    /// Do not connect evaluation means across learning blocks.
    #[arg(long)]
    no_show_eval_lines: bool,
    /// Connect them. This is the default.
    #[arg(short = 'e', long, hide = true, conflicts_with = "no_show_eval_lines")]
    show_eval_lines: bool,
}

impl FigureChoice {
    /// The chosen figures, in the order of a report.
    pub(crate) fn shown(&self) -> Result<Vec<Figure>, Failure> {
        let asked = self.plot_types.iter().map(|word| Figure::asked_for(word));
        let asked = asked
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| in_arguments(&error))?
            .concat();
        Ok(Figure::ALL
            .into_iter()
            .filter(|figure| asked.contains(figure))
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
