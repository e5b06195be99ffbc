//! Searches straight lines from a variant to ends of its ranges, along which all numbers move together.

use driftworld_spec::{Domain, Parameter, ParameterType, Value, Variant};

use super::search::{Changes, Found, Search, with};
use super::subject::Free;
use crate::interpolation::interpolate;

/// Maximum number of corners of the ranges to try if distances do not add up.
const MAX_CORNERS: usize = 81;

/// Bisection steps towards the border of the allowed region.
const MAX_BISECTIONS_TO_BORDER: u32 = 24;

/// Bisection steps per interval.
const MAX_BISECTIONS: u32 = 80;

impl<D: FnMut(&Variant) -> f64> Search<'_, D> {
    /// Moves straight from a combination of choices to the ends; true if it meets the target.
    pub(super) fn straight(&mut self, combination: &Changes, smooth: &[Free]) -> bool {
        let Some(base) = self.look(combination.clone()) else {
            return false;
        };
        if self.meets(&base) {
            return true;
        }
        let ends = self.farthest_ends(combination, smooth);
        if ends.is_empty() {
            return false;
        }
        self.straight_to(combination, &base, &ends)
    }

    /// Like [`Self::straight`], but to one corner after another, the farthest first: for numbers with a joint reach that is not
    /// the sum of their reaches.
    pub(super) fn straight_to_corners(&mut self, combination: &Changes, smooth: &[Free]) -> bool {
        let Some(base) = self.look(combination.clone()) else {
            return false;
        };
        let mut corners = vec![Changes::new()];
        for (name, parameter) in smooth {
            let ends = ends_of(self.from, name, parameter);
            let to = |corner: &Changes| {
                let moved = ends
                    .iter()
                    .map(|end| with(corner, &vec![((*name).to_owned(), end.clone())]));
                moved.chain([corner.clone()]).collect::<Vec<_>>()
            };
            corners = corners.iter().flat_map(to).take(MAX_CORNERS).collect();
        }
        let mut reached: Vec<(f64, Changes)> = Vec::new();
        for corner in corners {
            let looked = self.towards(combination, corner, |search, changes| {
                search.look(changes).map(|found| found.distance)
            });
            if let Some((distance, corner)) = looked {
                if (distance - self.target).abs() <= self.tolerance {
                    return true;
                }
                reached.push((distance, corner));
            }
        }
        reached.sort_by(|a, b| b.0.total_cmp(&a.0));
        reached.into_iter().any(|(distance, corner)| {
            (base.distance - self.target) * (distance - self.target) <= 0.0
                && self.straight_to(combination, &base, &corner)
        })
    }

    /// The distance at the given ends together with a combination of choices or, if that is not allowed, as near to the ends as
    /// possible.
    pub(super) fn towards(
        &mut self,
        combination: &Changes,
        ends: Changes,
        mut measure: impl FnMut(&mut Self, Changes) -> Option<f64>,
    ) -> Option<(f64, Changes)> {
        if let Some(distance) = measure(self, with(combination, &ends)) {
            return Some((distance, ends));
        }
        let (mut low, mut high, mut last) = (0.0, 1.0, None);
        for _ in 0..MAX_BISECTIONS_TO_BORDER {
            let t = f64::midpoint(low, high);
            let between = self.point_towards(&ends, t);
            match measure(self, with(combination, &between)) {
                Some(distance) => (low, last) = (t, Some((distance, between))),
                None => high = t,
            }
        }
        last
    }

    /// The point at fraction `t` of the line from the variant to the given ends.
    fn point_towards(&self, ends: &Changes, t: f64) -> Changes {
        let between = ends.iter().map(|(name, end)| {
            let parameter = &self.from.task().parameters()[name];
            let value = self.from.value(name).expect("variant parameters have values");
            let between = interpolate(parameter, false, value, end, t, (self.from, self.from));
            (name.clone(), between.unwrap_or_else(|| end.clone()))
        });
        between.collect()
    }

    fn straight_to(&mut self, combination: &Changes, base: &Found, ends: &Changes) -> bool {
        let Some(end) = self.look(with(combination, ends)) else {
            return false;
        };
        let crosses = (base.distance - self.target) * (end.distance - self.target) <= 0.0;
        self.meets(&end) || (crosses && self.bisect(combination, ends))
    }

    /// The farthest ends of the ranges together with a combination of choices, chosen one parameter at a time.
    fn farthest_ends(&mut self, combination: &Changes, smooth: &[Free]) -> Changes {
        let mut ends = Changes::new();
        for (name, parameter) in smooth {
            let options = ends_of(self.from, name, parameter);
            let mut best: Option<(f64, Value)> = None;
            for value in options {
                let change = vec![((*name).to_owned(), value.clone())];
                let Some(found) = self.look(with(combination, &with(&ends, &change))) else {
                    continue;
                };
                if best.as_ref().is_none_or(|best| found.distance > best.0) {
                    best = Some((found.distance, value));
                }
            }
            ends.extend(best.map(|(_, value)| ((*name).to_owned(), value)));
        }
        ends
    }

    /// Bisects the line to the ends until it meets the target; false if it cannot.
    fn bisect(&mut self, combination: &Changes, ends: &Changes) -> bool {
        let (mut low, mut high) = (0.0, 1.0);
        let Some(start) = self.look(combination.clone()) else {
            return false;
        };
        for _ in 0..MAX_BISECTIONS {
            let t = f64::midpoint(low, high);
            let changes = with(combination, &self.point_towards(ends, t));
            let Some(found) = self.look(changes) else { return false };
            if self.meets(&found) {
                return true;
            }
            if (found.distance < self.target) == (start.distance < self.target) {
                low = t;
            } else {
                high = t;
            }
        }
        false
    }
}

/// Extreme values of a number: the ends of its range; for a heading also the opposite direction, for a vector the
/// farthest corner.
pub(super) fn ends_of(from: &Variant, name: &str, parameter: &Parameter) -> Vec<Value> {
    let Some(Domain::Range([low, high])) = parameter.domain() else {
        return Vec::new();
    };
    let here = from.value(name);
    let at = |end: f64| match here {
        Some(Value::Integer(_)) => Value::Integer(end.round() as i64),
        Some(Value::Vector(numbers)) => Value::Vector(vec![end; numbers.len()]),
        _ => Value::Number(end),
    };
    let mut ends = vec![at(low), at(high)];
    match here {
        Some(Value::Vector(numbers)) => {
            let farther = |number: &f64| if number - low > high - number { low } else { high };
            ends.insert(0, Value::Vector(numbers.iter().map(farther).collect()));
        }
        Some(Value::Number(here)) if parameter.kind == ParameterType::Heading => {
            let opposite = here + 180.0;
            if (opposite - low).rem_euclid(360.0) <= high - low {
                ends.insert(0, Value::Number(opposite.rem_euclid(360.0)));
            }
        }
        _ => {}
    }
    ends
}
