//! [`ValueMeasure`]: how two values of a parameter are compared, and what the number is divided by. Distributions are in `drawn.rs`.

use driftworld_spec::{Domain, MeasureName, Parameter, ParameterType, Value};

use crate::ColorMeasure;
use crate::scalar::{CostTable, choice_mismatch, circular_difference};

/// How two values of one parameter are compared.
#[derive(Clone, Debug)]
pub(super) enum ValueMeasure {
    /// Difference over the width of the range; for points and vectors its Euclidean length.
    Difference { measure: &'static str, width: f64 },
    /// |ln a − ln b| over that of the range.
    LogRatio { width: f64 },
    /// Turn over half a circle.
    Turn,
    /// A distance of colours over the largest there is.
    Color { measure: &'static str, of: ColorMeasure },
    /// A table of costs, by the words for the choices, over the largest of them.
    Costs(CostTable),
    /// 0 or 1.
    SameOrNot,
}

impl ValueMeasure {
    /// What the parameter asks for, or what its type has.
    pub(super) fn of(parameter: &Parameter) -> Self {
        let compare = parameter.compare.as_ref();
        if let (Some(costs), Some(choices)) = (compare.and_then(|compare| compare.costs.as_ref()), &parameter.choices) {
            let names = choices.iter().filter_map(|choice| choice.cast(parameter.kind));
            let table = CostTable::new(names.map(|choice| choice.to_string()).collect(), &costs.concat());
            // Loading the task checked the table.
            return table.map_or(Self::SameOrNot, Self::Costs);
        }
        let color = |measure, of| Self::Color { measure, of };
        match compare.and_then(|compare| compare.measure) {
            Some(MeasureName::SameOrNot) => Self::SameOrNot,
            Some(MeasureName::LogRatio) => Self::LogRatio {
                width: range(parameter, libm::log),
            },
            Some(MeasureName::Srgb) => color("srgb / largest", ColorMeasure::Srgb),
            Some(MeasureName::Cie76) => color("cie76 / largest", ColorMeasure::Cie76),
            Some(MeasureName::Ciede2000) => color("ciede2000 / largest", ColorMeasure::Ciede2000),
            _ => Self::of_type(parameter),
        }
    }

    fn of_type(parameter: &Parameter) -> Self {
        match parameter.kind {
            ParameterType::Number | ParameterType::Integer => Self::Difference {
                measure: "difference / range",
                width: range(parameter, |x| x),
            },
            ParameterType::Vector => Self::Difference {
                measure: "euclidean / range",
                width: range(parameter, |x| x) * (parameter.vector_length().unwrap_or(1) as f64).sqrt(),
            },
            ParameterType::Point => Self::Difference {
                measure: "euclidean / widest choice",
                width: widest_choice(parameter),
            },
            ParameterType::Heading => Self::Turn,
            ParameterType::Color => Self::Color {
                measure: "oklab",
                of: ColorMeasure::Oklab,
            },
            ParameterType::Boolean | ParameterType::String | ParameterType::Distribution => Self::SameOrNot,
        }
    }

    /// The measure's name.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Difference { measure, .. } | Self::Color { measure, .. } => measure,
            Self::LogRatio { .. } => "log ratio / range",
            Self::Turn => "turn / 180 degrees",
            Self::Costs(_) => "cost / largest",
            Self::SameOrNot => "same or not",
        }
    }

    /// Whether the triangle inequality holds.
    pub(super) fn is_metric(&self) -> bool {
        match self {
            Self::Color { of, .. } => of.properties().is_metric(),
            Self::Costs(table) => table.properties().is_metric(),
            _ => true,
        }
    }

    /// The measure's own number, and the one that counts; the second may be above 1.
    pub(super) fn between(&self, a: &Value, b: &Value) -> (f64, f64) {
        let same_or_not = || {
            let raw = choice_mismatch(a, b);
            (raw, raw)
        };
        match self {
            Self::Difference { width, .. } => numbers(a).zip(numbers(b)).map_or_else(same_or_not, |(a, b)| {
                let raw = a.iter().zip(&b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
                (raw, share(raw, *width))
            }),
            Self::LogRatio { width } => a.as_number().zip(b.as_number()).map_or_else(same_or_not, |(a, b)| {
                let raw = (libm::log(a) - libm::log(b)).abs();
                (raw, share(raw, *width))
            }),
            Self::Turn => a.as_number().zip(b.as_number()).map_or_else(same_or_not, |(a, b)| {
                let raw = circular_difference(a, b);
                (raw, raw / 180.0)
            }),
            Self::Color { of, .. } => match (a, b) {
                (Value::Color(a), Value::Color(b)) => (of.between(*a, *b), of.normalised(*a, *b)),
                _ => same_or_not(),
            },
            // What lies between the choices, as on the way of a drift, is the same or not.
            Self::Costs(table) => table
                .between(&a.to_string(), &b.to_string())
                .map_or_else(|_| same_or_not(), |cost| (cost, share(cost, table.largest()))),
            Self::SameOrNot => same_or_not(),
        }
    }
}

/// The numbers that a value consists of.
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

/// Width of what a number may be, on a scale.
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

fn widest_choice(parameter: &Parameter) -> f64 {
    let Some(Domain::Choices(choices)) = parameter.domain() else {
        return 0.0;
    };
    let points: Vec<[f64; 2]> = choices
        .iter()
        .filter_map(|choice| {
            let Value::Point(point) = choice else { return None };
            Some(*point)
        })
        .collect();
    let from = |a: &[f64; 2]| {
        let apart = points.iter().map(|b| libm::hypot(a[0] - b[0], a[1] - b[1]));
        apart.fold(0.0, f64::max)
    };
    points.iter().map(from).fold(0.0, f64::max)
}
