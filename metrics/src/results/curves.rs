//! Measures of each task's evaluation curve alone, independent of boundaries between tasks.

use std::collections::HashMap;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::Reached;
use crate::BlockType;
use crate::lifetime::{Lifetime, task_learned};
use crate::statistics::mean;

/// A point of an evaluation curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Learning experiences (rows) of any task before it.
    pub learned: usize,
    /// Mean of the evaluation; the mean of means for several evaluations without learning between them.
    pub mean: f64,
    /// Standard error of the mean over worlds; `None` for one world.
    pub standard_error: Option<f64>,
}

/// Measures of a task's evaluation curve. Performance is in the log's unit; if the task has a floor and a ceiling, it is the
/// position between floor and ceiling, usually 0..=1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvaluationCurve {
    /// Whether performance is the position between floor and ceiling.
    pub is_scaled: bool,
    /// The points of the curve, by learning experiences; linear between them; at least one.
    pub points: Vec<CurvePoint>,
    /// Area under the curve divided by its width: the mean performance over the learning experiences that it spans. For a
    /// single point, its mean.
    pub area: f64,
    /// The highest point minus the last: at least 0, and 0 for a curve that never falls.
    pub forgetting: f64,
    /// Standard error of `forgetting`, with its two points taken as independent; `None` if they are the same, or an error is
    /// unknown.
    pub forgetting_error: Option<f64>,
    /// Learning experiences from the start of the task's first learning, or else from the first point, until the curve is
    /// half-way from its height there to the highest later point; at least 0. `None` if it never rises.
    pub lag: Option<f64>,
    /// The expert's level minus the curve, averaged over the learning experiences in which the task was present: its own, and
    /// those of a drift in which it was the nearer end. Beyond its points the curve is constant. `None` without an expert,
    /// or if the task was never present.
    pub regret: Option<f64>,
    /// Learning experiences in which the task was present.
    pub num_present: usize,
}

/// The curve of each evaluated task, in the lifetime's order; `reached` must be from the same lifetime.
pub(crate) fn curves(lifetime: &Lifetime, reached: &IndexMap<String, Reached>) -> IndexMap<String, EvaluationCurve> {
    let histories = histories(lifetime);
    let of_task = |(task, reached): (&String, &Reached)| {
        let history = histories.get(task.as_str())?;
        let curve = Curve::new(&history.evaluated, reached)?;
        Some((task.clone(), curve.measures(history, reached)))
    };
    reached.iter().filter_map(of_task).collect()
}

/// The evaluations and the learning of a task, each by the number of learning experiences before it.
#[derive(Default)]
struct History {
    evaluated: Vec<usize>,
    /// The learning experiences in which it is present.
    present: Vec<usize>,
    /// Start of its first learning.
    first_learning: Option<usize>,
}

fn histories(lifetime: &Lifetime) -> HashMap<&str, History> {
    let mut found: HashMap<&str, History> = HashMap::new();
    let mut learned = 0;
    for regime in lifetime.regimes() {
        match regime.block_type {
            BlockType::Test if lifetime.is_assessed(regime) => {
                found.entry(&regime.task_name).or_default().evaluated.push(learned);
            }
            BlockType::Test => {}
            BlockType::Train => {
                for row in 0..regime.len() {
                    let history = found.entry(task_learned(regime, row)).or_default();
                    history.present.push(learned + row);
                }
                for task in &regime.learns {
                    found.entry(task).or_default().first_learning.get_or_insert(learned);
                }
                learned += regime.len();
            }
        }
    }
    found
}

/// Points in ascending order, at least one, with distinct positions.
struct Curve(Vec<CurvePoint>);

impl Curve {
    /// Builds a curve from evaluations after these numbers of learning experiences; `None` if there are none.
    fn new(learned: &[usize], reached: &Reached) -> Option<Self> {
        let scaled = |value: f64| reached.score(value).unwrap_or(value);
        let of_error = |error: f64| scaled(error) - scaled(0.0);
        let evaluations: Vec<_> = learned.iter().zip(&reached.evaluations).collect();
        let points = evaluations.chunk_by(|a, b| a.0 == b.0).filter_map(|same| {
            let means: Vec<f64> = same.iter().map(|(_, cell)| scaled(cell.mean)).collect();
            let errors: Option<Vec<f64>> = same.iter().map(|(_, cell)| cell.standard_error.map(of_error)).collect();
            let squares = |errors: Vec<f64>| errors.iter().map(|error| error * error).sum::<f64>();
            Some(CurvePoint {
                learned: *same.first()?.0,
                mean: mean(&means)?,
                standard_error: errors.map(|errors| squares(errors).sqrt() / means.len() as f64),
            })
        });
        let points: Vec<CurvePoint> = points.collect();
        (!points.is_empty()).then_some(Self(points))
    }

    fn measures(self, history: &History, reached: &Reached) -> EvaluationCurve {
        let regrets: Option<Vec<f64>> = reached.expert.map(|expert| {
            let expert = reached.score(expert).unwrap_or(expert);
            // Takes the curve's height in the middle of each experience.
            let rows = history.present.iter();
            rows.map(|row| expert - self.at(*row as f64 + 0.5)).collect()
        });
        let (forgetting, forgetting_error) = self.forgetting();
        EvaluationCurve {
            is_scaled: reached.is_scaled(),
            area: self.area(),
            forgetting,
            forgetting_error,
            lag: self.lag(history.first_learning),
            regret: regrets.and_then(|regrets| mean(&regrets)),
            num_present: history.present.len(),
            points: self.0,
        }
    }

    /// The curve's height: linear between points, constant beyond them.
    fn at(&self, learned: f64) -> f64 {
        let after = self.0.partition_point(|point| point.learned as f64 <= learned);
        match (after.checked_sub(1).map(|before| self.0[before]), self.0.get(after)) {
            (Some(a), Some(b)) => {
                let share = (learned - a.learned as f64) / (b.learned - a.learned) as f64;
                a.mean + (b.mean - a.mean) * share
            }
            (Some(last), None) => last.mean,
            (None, first) => first.map_or(0.0, |first| first.mean),
        }
    }

    fn area(&self) -> f64 {
        let (first, last) = (self.0[0], self.0[self.0.len() - 1]);
        let of_pair = |pair: &[CurvePoint]| {
            (pair[1].learned - pair[0].learned) as f64 * f64::midpoint(pair[0].mean, pair[1].mean)
        };
        let width = (last.learned - first.learned) as f64;
        if self.0.len() == 1 {
            return first.mean;
        }
        self.0.windows(2).map(of_pair).sum::<f64>() / width
    }

    fn forgetting(&self) -> (f64, Option<f64>) {
        let last = self.0[self.0.len() - 1];
        let best = self
            .0
            .iter()
            .fold(last, |best, point| if point.mean > best.mean { *point } else { best });
        let error = (best.standard_error.zip(last.standard_error)).map(|(a, b)| libm::hypot(a, b));
        (best.mean - last.mean, error.filter(|_| best.learned != last.learned))
    }

    fn lag(&self, first_learning: Option<usize>) -> Option<f64> {
        let first_learning = first_learning.unwrap_or(self.0[0].learned);
        // The level when learning began: the evaluation before it, or else the first.
        let start = self
            .0
            .iter()
            .take_while(|point| point.learned <= first_learning)
            .last()
            .unwrap_or(&self.0[0])
            .mean;
        let after = || self.0.iter().filter(|point| point.learned > first_learning);
        let best = after().map(|point| point.mean).fold(start, f64::max);
        let half = f64::midpoint(start, best);
        let mut before = (first_learning, start);
        for point in after() {
            if best > start && point.mean >= half {
                let width = (point.learned - before.0) as f64;
                let share = (half - before.1) / (point.mean - before.1);
                return Some((before.0 - first_learning) as f64 + width * share);
            }
            before = (point.learned, point.mean);
        }
        None
    }
}
