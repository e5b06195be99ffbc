//! [`Space`]: the numbers that may move, and the changes that a point in their space represents.

use driftworld_spec::{Domain, ParameterType, Value, Variant};

use super::search::Changes;
use super::subject::Free;

/// One number that may move.
pub(super) struct Axis {
    /// Index of its parameter among the moving parameters.
    owner: usize,
    component: Option<usize>,
    pub(super) here: f64,
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) is_whole: bool,
}

impl Axis {
    /// The number `part` of `parts` steps from the low end to the high end.
    pub(super) fn at(&self, part: usize, parts: usize) -> f64 {
        if part == parts {
            return self.high;
        }
        self.low + (self.high - self.low) * part as f64 / parts as f64
    }
}

/// The numbers that may move, and the parameters to which they belong.
pub(super) struct Space<'a> {
    from: &'a Variant,
    owners: Vec<Free<'a>>,
    pub(super) axes: Vec<Axis>,
}

/// A number for each axis.
pub(super) type Point = Vec<f64>;

impl<'a> Space<'a> {
    pub(super) fn new(from: &'a Variant, smooth: &[Free<'a>]) -> Self {
        let mut axes = Vec::new();
        for (owner, (name, parameter)) in smooth.iter().enumerate() {
            let (Some(Domain::Range([low, high])), Some(value)) = (parameter.domain(), from.value(name)) else {
                continue;
            };
            let mut axis = |component, here, high| {
                axes.push(Axis {
                    owner,
                    component,
                    here,
                    low,
                    high,
                    is_whole: matches!(value, Value::Integer(_)),
                });
            };
            match value {
                Value::Vector(numbers) => {
                    for (component, here) in numbers.iter().enumerate() {
                        axis(Some(component), *here, high);
                    }
                }
                // An arc may cross north, so the position is measured along the arc, from its low end.
                Value::Number(here) if parameter.kind == ParameterType::Heading => {
                    let arc = (high - low).min(360.0);
                    axis(None, low + (here - low).rem_euclid(360.0).min(arc), low + arc);
                }
                other => axis(None, other.as_number().unwrap_or(low), high),
            }
        }
        Self {
            from,
            owners: smooth.to_vec(),
            axes,
        }
    }

    pub(super) fn here(&self) -> Point {
        self.axes.iter().map(|axis| axis.here).collect()
    }

    /// The changes that a point represents.
    pub(super) fn changes(&self, point: &[f64]) -> Changes {
        let mut changes = Changes::new();
        for (axis, number) in self.axes.iter().zip(point) {
            if *number == axis.here {
                continue;
            }
            let (name, parameter) = self.owners[axis.owner];
            if axis.component.is_some() && changes.last().is_none_or(|(last, _)| last != name) {
                changes.extend(self.from.value(name).map(|value| (name.to_owned(), value.clone())));
            }
            match (axis.component, changes.last_mut()) {
                (Some(component), Some((_, Value::Vector(numbers)))) => numbers[component] = *number,
                _ if axis.is_whole => changes.push((name.to_owned(), Value::Integer(number.round() as i64))),
                _ if parameter.kind == ParameterType::Heading => {
                    changes.push((name.to_owned(), Value::Number(number.rem_euclid(360.0))));
                }
                _ => changes.push((name.to_owned(), Value::Number(*number))),
            }
        }
        changes
    }

    /// Number of steps along an axis: at most `max`, and no more than the steps of a short integer range.
    pub(super) fn parts(&self, axis: usize, max: usize) -> usize {
        let Axis {
            low, high, is_whole, ..
        } = &self.axes[axis];
        if *is_whole {
            (((high - low) as usize).max(1)).min(max)
        } else {
            max
        }
    }

    pub(super) fn at(&self, axis: usize, part: usize, parts: usize) -> f64 {
        self.axes[axis].at(part, parts)
    }

    /// Points through which to draw lines along one axis: a grid over all other axes, coarser the more axes there are, with at
    /// most `max` parts per axis.
    pub(super) fn anchors(&self, along: usize, max: usize) -> Vec<Point> {
        let max = max.min(match self.axes.len() {
            0..=2 => 16,
            3 => 6,
            4 => 3,
            5 => 2,
            // Too many for a grid: lines through the middle and two opposite corners.
            _ => {
                let of = |part: usize| (0..self.axes.len()).map(|axis| self.at(axis, part, 2)).collect();
                return vec![of(0), of(1), of(2)];
            }
        });
        let mut anchors = vec![self.here()];
        for axis in (0..self.axes.len()).filter(|axis| *axis != along) {
            let parts = self.parts(axis, max);
            let moved = |anchor: Point| {
                (0..=parts).map(move |part| {
                    let mut moved = anchor.clone();
                    moved[axis] = self.at(axis, part, parts);
                    moved
                })
            };
            anchors = anchors.into_iter().flat_map(moved).collect();
        }
        anchors
    }
}
