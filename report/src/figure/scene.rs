//! A lifetime prepared for figures: one stretch of rows per regime, with positions on the horizontal axis, and tasks with their
//! display names.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use driftworld_metrics::{BlockType, Lifetime, Regime};

use super::options::{FigureOptions, Unit};
use super::palette::{Look, SHADE};
use super::paper::{Entry, Sample};
use crate::words::shown;
use crate::{ReportError, extent};

/// Maximum number of tasks with curves; more could not be distinguished.
pub(super) const MAX_TASKS: usize = 28;
/// Maximum number of stretches drawn, each as a line of its own; if there are more, they are thinned out.
const MAX_STRETCHES: usize = 1200;

/// A lifetime, ready to be drawn.
pub(super) struct Scene<'a> {
    pub(super) lifetime: &'a Lifetime,
    pub(super) column: &'a str,
    pub(super) options: &'a FigureOptions,
    /// Display names, in the lifetime's order.
    pub(super) names: Vec<String>,
    pub(super) stretches: Vec<Stretch<'a>>,
    /// From the first experience to the end of the last.
    pub(super) span: Range<f64>,
}

/// The rows of one regime.
pub(super) struct Stretch<'a> {
    pub(super) regime: &'a Regime,
    pub(super) task: usize,
    pub(super) xs: Vec<f64>,
}

impl Stretch<'_> {
    pub(super) fn learns(&self) -> bool {
        self.regime.block_type == BlockType::Train
    }

    /// From its first row to one past its last.
    pub(super) fn range(&self) -> Range<f64> {
        let first = self.xs.first().copied().unwrap_or(0.0);
        first..self.xs.last().map_or(first, |last| last + 1.0)
    }

    pub(super) fn middle(&self) -> f64 {
        let range = self.range();
        f64::midpoint(range.start, range.end)
    }

    pub(super) fn mean(&self) -> f64 {
        self.regime.performance.iter().sum::<f64>() / self.regime.len().max(1) as f64
    }

    /// Curve points for values of its rows.
    pub(super) fn points(&self, values: &[f64]) -> Vec<(f64, f64)> {
        self.xs.iter().copied().zip(values.iter().copied()).collect()
    }
}

impl<'a> Scene<'a> {
    pub(super) fn new(
        lifetime: &'a Lifetime,
        column: &'a str,
        options: &'a FigureOptions,
    ) -> Result<Self, ReportError> {
        let task_indices: BTreeMap<&str, usize> = lifetime.tasks().iter().map(String::as_str).zip(0..).collect();
        let mut stretches = Vec::with_capacity(lifetime.regimes().len());
        for regime in lifetime.regimes() {
            stretches.push(Stretch {
                regime,
                task: task_indices.get(regime.task_name.as_str()).copied().unwrap_or(0),
                xs: positions(lifetime, regime, options.unit)?,
            });
        }
        let expected = crate::neighbours(lifetime).len();
        if let Some(distances) = &options.distances
            && distances.len() != expected
        {
            return Err(ReportError::Distances {
                run_id: lifetime.run_id().to_owned(),
                found: distances.len(),
                expected,
            });
        }
        let (first, _) = extent(stretches.iter().map(|stretch| stretch.range().start));
        let (_, last) = extent(stretches.iter().map(|stretch| stretch.range().end));
        Ok(Self {
            lifetime,
            column,
            options,
            names: (lifetime.tasks().iter())
                .map(|task| shown(options.names.get(task).unwrap_or(task)))
                .collect(),
            stretches,
            span: if first < last { first..last } else { 0.0..1.0 },
        })
    }

    /// Name of the horizontal axis.
    pub(super) fn x_name(&self) -> &'static str {
        match self.options.unit {
            Unit::Experiences => "experience",
            Unit::Steps => "step",
        }
    }

    /// Name of the vertical axis, with the scale if performances are normalised.
    pub(super) fn performance_name(&self) -> String {
        if self.lifetime.normalization_data_range().is_some() {
            format!("{}, scaled to 1…101", shown(self.column))
        } else {
            shown(self.column)
        }
    }

    /// Legend entries: the drawn tasks, the number of others, and the shade of evaluations if there are any.
    pub(super) fn entries(&self) -> Vec<Entry> {
        let mut entries: Vec<Entry> = self.names.iter().take(MAX_TASKS).enumerate().map(task_entry).collect();
        entries.extend(Entry::rest(self.names.len(), MAX_TASKS, ""));
        if self.stretches.iter().any(|stretch| !stretch.learns()) {
            entries.push(Entry::new("evaluation", Sample::Area(SHADE.light)));
        }
        entries
    }

    /// Maps a position to one of `columns` pixel columns.
    pub(super) fn column(&self, columns: i32) -> impl Fn(f64) -> i64 + '_ {
        let per_x = f64::from(columns) / (self.span.end - self.span.start);
        move |x| ((x - self.span.start) * per_x).floor() as i64
    }

    /// The learning or evaluation stretches of the drawn tasks. If there are too many, at most one per task and pixel column.
    pub(super) fn drawn(&self, learning: bool, columns: i32) -> Vec<&Stretch<'a>> {
        let matching = || {
            self.stretches
                .iter()
                .filter(move |stretch| stretch.learns() == learning && stretch.task < MAX_TASKS)
        };
        let mut kept: Vec<&Stretch> = matching().collect();
        let mut columns = columns;
        while kept.len() > MAX_STRETCHES && columns > 1 {
            let column = self.column(columns);
            let mut seen = BTreeSet::new();
            kept = matching()
                .filter(|stretch| seen.insert((stretch.task, column(stretch.range().start))))
                .collect();
            columns /= 2;
        }
        kept
    }

    /// Width of a column in units of the horizontal axis: at least 0.5, so that adjacent blocks are joined.
    pub(super) fn gap(&self, columns: i32) -> f64 {
        ((self.span.end - self.span.start) / f64::from(columns)).max(0.5)
    }
}

/// A task's name with its look.
pub(super) fn task_entry((task, name): (usize, &String)) -> Entry {
    Entry::new(name, Sample::Task(Look::of(task)))
}

/// The ranges of ordered stretches; ranges at most `gap` apart are joined.
pub(super) fn joined<'a, 'b: 'a>(stretches: impl Iterator<Item = &'a Stretch<'b>>, gap: f64) -> Vec<Range<f64>> {
    let mut ranges: Vec<Range<f64>> = Vec::new();
    for range in stretches.map(Stretch::range) {
        match ranges.last_mut() {
            Some(last) if range.start <= last.end + gap => last.end = last.end.max(range.end),
            _ => ranges.push(range),
        }
    }
    ranges
}

/// Positions of a regime's rows on the horizontal axis.
fn positions(lifetime: &Lifetime, regime: &Regime, unit: Unit) -> Result<Vec<f64>, ReportError> {
    match unit {
        Unit::Experiences => Ok(regime.exp_nums.iter().map(|number| *number as f64).collect()),
        Unit::Steps => regime.steps.clone().ok_or_else(|| ReportError::NoSteps {
            run_id: lifetime.run_id().to_owned(),
        }),
    }
}

/// A range with some padding at both ends; never empty, even if all values are equal.
pub(super) fn roomy(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (low, high) = extent(values);
    match high - low {
        span if span > 0.0 => low - span * 0.04..high + span * 0.04,
        0.0 => low - low.abs().max(1.0) * 0.5..high + high.abs().max(1.0) * 0.5,
        _ => 0.0..1.0,
    }
}
