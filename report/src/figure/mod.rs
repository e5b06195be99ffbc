//! Figures of a lifetime, each drawn by one function as vectors or pixels.

mod evaluation;
mod experts;
mod learning;
mod options;
mod palette;
mod panels;
mod paper;
mod raw;
mod scene;
mod strip;
mod thinning;
mod timeline;

use driftworld_metrics::Lifetime;
use plotters::prelude::*;

pub use options::{FigureOptions, Layout, Unit};
pub(crate) use palette::{dark_rules, task_color};
pub(crate) use strip::{strip, thinned_count};

use crate::ReportError;
use crate::drawing::{Drawing, Recorder};
use crate::words::shown;
use paper::{Area, Drawn, Paper};
use scene::Scene;

/// The figures of a lifetime.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Figure {
    /// Raw values as points, with the smoothed curve.
    Raw,
    /// Learning curves, with evaluations shaded and their means joined.
    Learning,
    /// Means of evaluations with 95 % intervals, one panel per task.
    Evaluation,
    /// The learning of each task, end to end, compared with its single-task expert.
    #[strum(serialize = "ste")]
    Experts,
    /// The blocks of the lifetime, one row per task, and the distances between neighbours.
    Timeline,
}

impl Figure {
    /// All figures, in the order of a report.
    pub const ALL: [Self; 5] = [
        Self::Timeline,
        Self::Learning,
        Self::Evaluation,
        Self::Experts,
        Self::Raw,
    ];

    /// The name used in files, `NAME_raw.png`; the reference's name if it has the figure.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The figures for a word of the reference's option: `all`, or one of `raw`, `lb`, `eb`, `ste`; `timeline` is an addition.
    ///
    /// # Errors
    /// [`ReportError::UnknownFigure`] for any other word.
    pub fn asked_for(word: &str) -> Result<Vec<Self>, ReportError> {
        Ok(vec![match word {
            "all" => return Ok(Self::ALL.to_vec()),
            "raw" => Self::Raw,
            "lb" => Self::Learning,
            "eb" => Self::Evaluation,
            "ste" => Self::Experts,
            "timeline" => Self::Timeline,
            _ => {
                return Err(ReportError::UnknownFigure { found: shown(word) });
            }
        }])
    }
}

/// The figures of one lifetime.
pub struct Figures<'a> {
    scene: Scene<'a>,
}

impl<'a> Figures<'a> {
    /// Prepares a lifetime's figures. `column` is the name of its performance column.
    ///
    /// # Errors
    /// [`ReportError::NoSteps`] if the unit is steps and the log has none, [`ReportError::Distances`] unless there is one distance
    /// for each pair of [`neighbours`](crate::neighbours).
    pub fn of(lifetime: &'a Lifetime, column: &'a str, options: &'a FigureOptions) -> Result<Self, ReportError> {
        Ok(Self {
            scene: Scene::new(lifetime, column, options)?,
        })
    }

    /// Whether the figure has anything to show; a lifetime without experts, for example, has no comparison with them.
    pub fn has(&self, figure: Figure) -> bool {
        let has = |learns: bool| self.scene.stretches.iter().any(|stretch| stretch.learns() == learns);
        match figure {
            Figure::Raw | Figure::Timeline => true,
            Figure::Learning => has(true),
            Figure::Evaluation => has(false),
            Figure::Experts => experts::any(&self.scene),
        }
    }

    /// The figure as an SVG file on white, with a title.
    ///
    /// # Errors
    /// [`ReportError::Drawing`] if the plotting library fails.
    pub fn svg(&self, figure: Figure) -> Result<String, ReportError> {
        let paper = self.titled(figure);
        vectors(figure.name(), (paper.width(), self.height(figure, &paper)), |area| {
            area.fill(&WHITE)?;
            self.draw(figure, area, &paper)
        })
    }

    /// The figure as a PNG file on white, with a title, at two dots per SVG pixel.
    ///
    /// # Errors
    /// [`ReportError::Drawing`] if the plotting library fails.
    pub fn png(&self, figure: Figure) -> Result<Vec<u8>, ReportError> {
        let paper = self.titled(figure);
        let size = (paper.width(), self.height(figure, &paper));
        pixels(figure.name(), size, |area| {
            area.fill(&WHITE)?;
            self.draw(figure, area, &paper)
        })
    }

    /// The figure for a page: without a title or a background.
    pub(crate) fn inline(&self, figure: Figure, layout: Layout) -> Result<String, ReportError> {
        let paper = Paper { layout, title: None };
        let size = (paper.width(), self.height(figure, &paper));
        vectors(figure.name(), size, |area| self.draw(figure, area, &paper))
    }

    fn titled(&self, figure: Figure) -> Paper {
        let what = match figure {
            Figure::Raw => "Raw and smoothed values",
            Figure::Learning => "Learning performance, scaled as for the metrics",
            Figure::Evaluation => "Evaluation performance, scaled as for the metrics: means with 95 % intervals",
            Figure::Experts => "Learning against the single-task expert, scaled as for the metrics",
            Figure::Timeline => "Curriculum",
        };
        Paper {
            layout: Layout::Wide,
            title: Some(format!("{what} · {}", shown(self.scene.lifetime.run_id()))),
        }
    }

    fn height(&self, figure: Figure, paper: &Paper) -> i32 {
        match figure {
            Figure::Raw => raw::height(&self.scene, paper),
            Figure::Learning => learning::height(&self.scene, paper),
            Figure::Evaluation => evaluation::height(&self.scene, paper),
            Figure::Experts => experts::height(&self.scene, paper),
            Figure::Timeline => timeline::height(&self.scene, paper),
        }
    }

    fn draw<DB: DrawingBackend>(&self, figure: Figure, area: &Area<DB>, paper: &Paper) -> Drawn<DB> {
        match figure {
            Figure::Raw => raw::draw(&self.scene, area, paper),
            Figure::Learning => learning::draw(&self.scene, area, paper),
            Figure::Evaluation => evaluation::draw(&self.scene, area, paper),
            Figure::Experts => experts::draw(&self.scene, area, paper),
            Figure::Timeline => timeline::draw(&self.scene, area, paper),
        }
    }
}

/// Draws a figure as SVG; the size is in layout pixels.
fn vectors(
    figure: &'static str,
    (width, height): (i32, i32),
    draw: impl for<'b> FnOnce(&Area<SVGBackend<'b>>) -> Drawn<SVGBackend<'b>>,
) -> Result<String, ReportError> {
    let mut text = String::new();
    let dots = (Paper::dots(width) as u32, Paper::dots(height) as u32);
    draw_with(figure, SVGBackend::with_string(&mut text, dots), draw)?;
    Ok(compact(text).replacen(
        &format!("width=\"{}\" height=\"{}\"", dots.0, dots.1),
        &format!("width=\"{width}\" height=\"{height}\""),
        1,
    ))
}

/// Draws a figure as PNG, with two pixels per layout pixel along each side.
fn pixels(
    figure: &'static str,
    (width, height): (i32, i32),
    draw: impl for<'b> FnOnce(&Area<Recorder<'b>>) -> Drawn<Recorder<'b>>,
) -> Result<Vec<u8>, ReportError> {
    let mut drawing = Drawing::blank(Paper::dots(width) as u32, Paper::dots(height) as u32);
    draw_with(figure, Recorder::onto(&mut drawing), draw)?;
    drawing.to_png()
}

/// Draws a figure with a backend, and finishes the output.
fn draw_with<DB: DrawingBackend<ErrorType: 'static>>(
    figure: &'static str,
    backend: DB,
    draw: impl FnOnce(&Area<DB>) -> Drawn<DB>,
) -> Result<(), ReportError> {
    paper::load_font();
    let area = backend.into_drawing_area();
    let draw_with = draw(&area).and_then(|()| area.present());
    draw_with.map_err(|error| ReportError::Drawing {
        figure,
        source: Box::new(error),
    })
}

/// Removes attributes that the library writes needlessly. Text is never affected, because its quotation marks are escaped.
fn compact(svg: String) -> String {
    [
        (" opacity=\"1\"", ""),
        (" stroke=\"none\" stroke-width=\"1\"", ""),
        (" stroke-width=\"1\"", ""),
        (" stroke=\"none\"", ""),
        (" \"/>", "\"/>"),
    ]
    .into_iter()
    .fold(svg, |svg, (found, instead)| svg.replace(found, instead))
}
