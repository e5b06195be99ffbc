//! Figures of lifetimes: which are asked for, and their bytes. What they show is `report`'s.

mod files;

use crate::metrics::Lifetime;
use crate::report::{Figure, FigureOptions, Figures, ReportError, Unit};
use clap::Args;

pub(crate) use files::Files;

use super::Failure;

/// What is drawn, and how.
#[derive(Args)]
#[command(next_help_heading = "Figures")]
pub(crate) struct FigureChoice {
    /// Which figures: all, or some of raw, lb (learning), eb (evaluation), ste (against the expert), timeline.
    #[arg(short = 'T', long, value_name = "TYPE", num_args = 1.., default_value = "all")]
    plot_types: Vec<String>,
    /// What the horizontal axis counts: `exp_num`, or steps by the column `episode_step_count`.
    #[arg(short, long, value_name = "UNIT", default_value = "exp_num")]
    unit: String,
    /// Do not join the means of evaluations across learning.
    #[arg(long)]
    no_show_eval_lines: bool,
    /// Join them, as is done anyway.
    #[arg(short = 'e', long, hide = true, conflicts_with = "no_show_eval_lines")]
    show_eval_lines: bool,
}

impl FigureChoice {
    /// The figures asked for, in the order of a report.
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
            distances: None,
        })
    }
}

fn in_arguments(error: &ReportError) -> Failure {
    Failure::usage(error.to_string())
}

/// The figures of one lifetime as the bytes of files.
pub(crate) struct Drawn {
    run_id: String,
    /// The end of each name, such as `raw.png`, and the bytes.
    files: Vec<(String, Vec<u8>)>,
}

/// Draws a lifetime's figures, each as PNG and as SVG.
pub(crate) fn drawn(
    lifetime: &Lifetime,
    column: &str,
    shown: &[Figure],
    options: &FigureOptions,
) -> Result<Drawn, Failure> {
    let figures = Figures::of(lifetime, column, options)?;
    let mut files = Vec::new();
    for figure in shown.iter().copied().filter(|figure| figures.has(*figure)) {
        files.push((format!("{}.png", figure.name()), figures.png(figure)?));
        files.push((format!("{}.svg", figure.name()), figures.svg(figure)?.into_bytes()));
    }
    // Names of several logs may be paths.
    let run_id = lifetime.run_id().replace(['/', '\\'], "_");
    Ok(Drawn { run_id, files })
}
