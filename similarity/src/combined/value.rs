//! [`ValueMeasure`]: compares two values of one parameter, and normalises the result.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use driftworld_spec::{Domain, Layout, MeasureName, Parameter, ParameterType, Value};

use rayon::prelude::*;

use crate::combined::arena::Arena;
use crate::combined::sketch::doors;
use crate::layout_shape::LayoutShape;
use crate::scalar::{CostTable, choice_mismatch, circular_difference, relative_difference};
use crate::{ColorMeasure, MetricProperties};

/// The measure for two values of one parameter.
#[derive(Clone, Debug)]
pub(super) enum ValueMeasure {
    /// Difference over the width of the range; Euclidean length for points and vectors.
    Difference { measure: &'static str, width: f64 },
    /// |ln a − ln b| over the same for the ends of the range.
    LogRatio { width: f64 },
    /// Difference over the larger of the two, divided by the largest such ratio that the range or the choices allow.
    Relative { widest: f64 },
    /// Turn over the widest turn that the range or the choices allow, at most half a circle.
    Turn { widest: f64 },
    /// A distance between colours over the distance of the widest pair of choices.
    Color {
        measure: &'static str,
        of: ColorMeasure,
        widest: f64,
    },
    /// The difference between two layouts over the difference of the widest pair of choices.
    Layout {
        of: LayoutMeasure,
        arena: Arena,
        widest: f64,
    },
    /// A table of costs between named choices, over the largest of them.
    Costs(CostTable),
    /// 0 or 1.
    SameOrNot,
}

impl ValueMeasure {
    /// The measure that the parameter requests, or its type's default. Layouts are placed in an arena.
    pub(super) fn of(parameter: &Parameter, arena: Arena) -> Self {
        let compare = parameter.compare.as_ref();
        if let (Some(costs), Some(choices)) = (compare.and_then(|compare| compare.costs.as_ref()), &parameter.choices) {
            let names = choices.iter().filter_map(|choice| choice.cast(parameter.kind));
            let table = CostTable::new(names.map(|choice| choice.to_string()).collect(), &costs.concat());
            // The table was checked when the task was loaded.
            return table.map_or(Self::SameOrNot, Self::Costs);
        }
        let color = |measure, of| color(parameter, measure, of);
        match compare.and_then(|compare| compare.measure) {
            Some(MeasureName::SameOrNot) => Self::SameOrNot,
            Some(MeasureName::LogRatio) => Self::LogRatio {
                width: range(parameter, libm::log),
            },
            Some(MeasureName::RelativeDifference) => Self::Relative {
                widest: widest_relative(parameter),
            },
            Some(MeasureName::Srgb) => color("srgb / widest choice", ColorMeasure::Srgb),
            Some(MeasureName::Cie76) => color("cie76 / widest choice", ColorMeasure::Cie76),
            Some(MeasureName::Ciede2000) => color("ciede2000 / widest choice", ColorMeasure::Ciede2000),
            Some(MeasureName::Hyab) => color("hyab / widest choice", ColorMeasure::Hyab),
            Some(MeasureName::WallJaccard) => layout(parameter, LayoutMeasure::Walls, arena),
            Some(MeasureName::WalkingDistance) => layout(parameter, LayoutMeasure::Paths, arena),
            Some(MeasureName::WallTransport) => layout(parameter, LayoutMeasure::Transport, arena),
            _ => Self::of_type(parameter, arena),
        }
    }

    fn of_type(parameter: &Parameter, arena: Arena) -> Self {
        match parameter.kind {
            ParameterType::Number | ParameterType::Integer => Self::Difference {
                measure: "difference / range",
                width: range(parameter, |x| x),
            },
            ParameterType::Vector if parameter.choices.is_some() => Self::Difference {
                measure: "euclidean / widest choice",
                width: widest_choice(parameter),
            },
            ParameterType::Vector => Self::Difference {
                measure: "euclidean / range",
                width: range(parameter, |x| x) * (parameter.vector_length().unwrap_or(1) as f64).sqrt(),
            },
            ParameterType::Point => Self::Difference {
                measure: "euclidean / widest choice",
                width: widest_choice(parameter),
            },
            ParameterType::Heading => Self::Turn {
                widest: widest_turn(parameter),
            },
            ParameterType::Color => color(parameter, "oklab / widest choice", ColorMeasure::Oklab),
            ParameterType::Layout => layout(parameter, LayoutMeasure::Whole, arena),
            ParameterType::Boolean | ParameterType::String | ParameterType::Distribution | ParameterType::Json => {
                Self::SameOrNot
            }
        }
    }

    /// The measure's name.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Difference { measure, .. } | Self::Color { measure, .. } => measure,
            Self::LogRatio { .. } => "log ratio / range",
            Self::Relative { .. } => "relative difference / widest",
            Self::Turn { .. } => "turn / widest",
            Self::Layout { of, .. } => of.name(),
            Self::Costs(_) => "cost / largest",
            Self::SameOrNot => "same or not",
        }
    }

    /// The metric properties of the measure.
    pub(super) fn properties(&self) -> MetricProperties {
        match self {
            Self::Color { of, .. } => of.properties(),
            Self::Costs(table) => table.properties(),
            Self::Layout { of, .. } => of.properties(),
            _ => MetricProperties::Metric,
        }
    }

    /// The raw number and the normalised one, which may be above 1.
    pub(super) fn between(&self, a: &Value, b: &Value) -> (f64, f64) {
        let both = || a.as_number().zip(b.as_number());
        let found = match self {
            Self::Difference { width, .. } => numbers(a).zip(numbers(b)).map(|(a, b)| (euclidean(&a, &b), *width)),
            Self::LogRatio { width } => both().map(|(a, b)| ((libm::log(a) - libm::log(b)).abs(), *width)),
            Self::Relative { widest } => both().map(|(a, b)| (relative_difference(a, b), *widest)),
            Self::Turn { widest } => both().map(|(a, b)| (circular_difference(a, b), *widest)),
            Self::Color { of, widest, .. } => match (a, b) {
                (Value::Color(a), Value::Color(b)) => Some((of.between(*a, *b), *widest)),
                _ => None,
            },
            Self::Layout { of, arena, widest } => Some((of.between(a, b, *arena), *widest)),
            // Values between the choices, as during a drift, are only compared for equality.
            Self::Costs(table) => {
                let cost = table.between(&a.to_string(), &b.to_string());
                cost.ok().map(|cost| (cost, table.largest()))
            }
            Self::SameOrNot => None,
        };
        match found {
            Some((raw, whole)) => (raw, share(raw, whole)),
            None => (choice_mismatch(a, b), choice_mismatch(a, b)),
        }
    }
}

/// The aspect of two layouts that is compared. Layouts without a seed are drawn with seed 0.
#[derive(Clone, Copy, Debug)]
pub(super) enum LayoutMeasure {
    /// Everything: shapes, the sides of their arenas (difference as a share of the larger value), and 1 for different doors.
    Whole,
    /// Which cells have walls.
    Walls,
    /// Path lengths.
    Paths,
    /// The distance by which walls must be moved.
    Transport,
}

impl LayoutMeasure {
    fn name(self) -> &'static str {
        match self {
            Self::Whole => "layout / widest choice",
            Self::Walls => "wall jaccard / widest choice",
            Self::Paths => "walking distance / widest choice",
            Self::Transport => "wall transport / widest choice",
        }
    }

    fn properties(self) -> MetricProperties {
        match self {
            Self::Whole => MetricProperties::Metric,
            Self::Walls | Self::Paths | Self::Transport => MetricProperties::Pseudometric,
        }
    }

    fn between(self, a: &Value, b: &Value, arena: Arena) -> f64 {
        let (Value::Layout(a), Value::Layout(b)) = (a, b) else {
            return choice_mismatch(a, b);
        };
        let [one, other] = [shape(a, arena), shape(b, arena)];
        match self {
            Self::Whole => {
                let sides = |layout: &Layout| layout.size().unwrap_or(arena.size);
                let doors = f64::from(u8::from(doors(Some(a)) != doors(Some(b))));
                let sides = sides(a).into_iter().zip(sides(b));
                one.distance(&other) + doors + sides.map(|(a, b)| relative_difference(a, b)).sum::<f64>()
            }
            Self::Walls => one.walls_distance(&other),
            Self::Paths => one.ways_distance(&other),
            // Shapes of layouts have finite heights.
            Self::Transport => one.transport_distance(&other).unwrap_or(f64::NAN),
        }
    }
}

fn layout(parameter: &Parameter, of: LayoutMeasure, arena: Arena) -> ValueMeasure {
    let read = |value: &Value| Some(value.clone());
    ValueMeasure::Layout {
        of,
        arena,
        widest: widest_pair(parameter, read, |a, b| of.between(a, b, arena)),
    }
}

/// The shape of a layout, with a small cache: the same few choices are compared repeatedly.
fn shape(layout: &Layout, arena: Arena) -> Arc<LayoutShape> {
    const MAX_CACHED: usize = 256;
    static CACHE: Mutex<BTreeMap<String, Arc<LayoutShape>>> = Mutex::new(BTreeMap::new());
    let size = layout.size().unwrap_or(arena.size);
    let key = serde_json::to_string(&(layout, size, arena.wall_height)).unwrap_or_default();
    let cache = || CACHE.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(shape) = cache().get(&key) {
        return Arc::clone(shape);
    }
    let shape = Arc::new(LayoutShape::of(&layout.plan(0), size, arena.wall_height));
    let mut cache = cache();
    if cache.len() >= MAX_CACHED {
        cache.clear();
    }
    cache.insert(key, Arc::clone(&shape));
    shape
}

/// The numbers in a value.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Point(point) => Some(point.to_vec()),
        Value::Vector(numbers) => Some(numbers.clone()),
        other => other.as_number().map(|number| vec![number]),
    }
}

pub(super) fn share(raw: f64, whole: f64) -> f64 {
    if raw == 0.0 {
        0.0
    } else {
        raw / whole.max(f64::MIN_POSITIVE)
    }
}

/// Width of a numeric parameter's range, on a scale.
fn range(parameter: &Parameter, scale: impl Fn(f64) -> f64) -> f64 {
    match parameter.domain() {
        Some(Domain::Range([low, high])) => scale(high) - scale(low),
        Some(Domain::Choices(choices)) => {
            let all = choices.iter().filter_map(numbers).flatten().map(scale);
            let ends = all.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
                (least.min(x), most.max(x))
            });
            ends.1 - ends.0
        }
        None => 0.0,
    }
}

/// Minimum number of choices for which pairs are compared on all cores.
const MIN_PARALLEL_CHOICES: usize = 500;

/// The distance of the widest pair of choices, by `distance`. 1 if there are fewer than two.
fn widest_pair<T: Sync>(
    parameter: &Parameter,
    read: impl Fn(&Value) -> Option<T>,
    distance: impl Fn(&T, &T) -> f64 + Sync,
) -> f64 {
    let Some(Domain::Choices(choices)) = parameter.domain() else {
        return 1.0;
    };
    let choices: Vec<T> = choices.iter().filter_map(read).collect();
    let farthest = |(index, a): (usize, &T)| choices[..index].iter().map(|b| distance(a, b)).fold(0.0, f64::max);
    // The maximum does not depend on the order of comparison.
    let widest = if choices.len() < MIN_PARALLEL_CHOICES {
        choices.iter().enumerate().map(farthest).fold(0.0, f64::max)
    } else {
        choices.par_iter().enumerate().map(farthest).reduce(|| 0.0, f64::max)
    };
    if widest == 0.0 { 1.0 } else { widest }
}

fn widest_choice(parameter: &Parameter) -> f64 {
    widest_pair(parameter, numbers, |a, b| euclidean(a, b))
}

fn euclidean(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn widest_turn(parameter: &Parameter) -> f64 {
    match parameter.domain() {
        Some(Domain::Range([low, high])) => (high - low).min(180.0),
        _ => widest_pair(parameter, Value::as_number, |a, b| circular_difference(*a, *b)),
    }
}

/// The largest relative difference between two numbers: at most 1 if they cannot have different signs, 2 across 0.
fn widest_relative(parameter: &Parameter) -> f64 {
    match parameter.domain() {
        Some(Domain::Range([low, high])) if low < 0.0 && 0.0 < high => 2.0,
        Some(Domain::Range([low, high])) => relative_difference(low, high),
        _ => widest_pair(parameter, Value::as_number, |a, b| relative_difference(*a, *b)),
    }
}

fn color(parameter: &Parameter, measure: &'static str, of: ColorMeasure) -> ValueMeasure {
    let read = |value: &Value| match value {
        Value::Color(color) => Some(of.prepare(*color)),
        _ => None,
    };
    ValueMeasure::Color {
        measure,
        of,
        widest: widest_pair(parameter, read, |a, b| of.between_prepared(*a, *b)),
    }
}
