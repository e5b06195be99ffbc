//! Depth-first search, with backtracking, for a sequence of evenly spaced variants.

use std::cell::Cell;

use driftworld_generator::{Drift, Subject, at_distance};
use driftworld_similarity::VariantMeasure;
use driftworld_spec::{Domain, Parameter, ParameterType, Role, Value, Variant};

use super::choice::changes;
use super::picked::{Picked, distance_between, farthest, is_only_in, measure_of};
use super::wanted::Steps;
use crate::CurriculumError;

/// Maximum number of variants from which the search tries to extend the path.
const MAX_TRIES: u32 = 4000;

/// Maximum number of comparisons of two variants per search.
pub(super) const MAX_COMPARISONS: u64 = 4_000_000;

/// Bisection steps on the line to one target.
const HALVINGS: u32 = 60;

/// The path found so far, and the budget that the search has used.
pub(super) struct Walk<'a> {
    task: &'a str,
    pool: &'a [Variant],
    anchor: &'a Variant,
    wanted: &'a Steps,
    pub(super) path: Vec<Picked>,
    pub(super) longest: usize,
    tries: u32,
    measure: VariantMeasure,
    /// Comparisons made so far.
    comparisons: Cell<u64>,
}

impl<'a> Walk<'a> {
    /// Starts with a path that holds only the anchor.
    pub(super) fn new(task: &'a str, pool: &'a [Variant], anchor: &'a Variant, wanted: &'a Steps) -> Self {
        Self {
            task,
            pool,
            anchor,
            wanted,
            path: vec![Picked::declared(task, anchor.clone())],
            longest: 0,
            tries: 0,
            measure: measure_of(anchor),
            comparisons: Cell::new(0),
        }
    }

    /// Extends the path to the wanted length; false if that fails.
    pub(super) fn extend(&mut self) -> Result<bool, CurriculumError> {
        self.longest = self.longest.max(self.path.len() - 1);
        if self.path.len() > self.wanted.count as usize {
            return Ok(true);
        }
        self.tries += 1;
        if self.tries > MAX_TRIES || self.budget_exhausted() {
            return Ok(false);
        }
        for next in self.candidates()? {
            self.path.push(next);
            if self.extend()? {
                return Ok(true);
            }
            self.path.pop();
            if self.tries > MAX_TRIES || self.budget_exhausted() {
                break;
            }
        }
        Ok(false)
    }

    pub(super) fn budget_exhausted(&self) -> bool {
        self.comparisons.get() >= MAX_COMPARISONS
    }

    fn distance(&self, a: &Variant, b: &Variant) -> Result<f64, CurriculumError> {
        self.comparisons.set(self.comparisons.get() + 1);
        distance_between(&self.measure, a, b, self.wanted.element)
    }

    /// The parameters that may change, and the matching [`Subject`].
    fn free_params(&self) -> (Vec<(&String, &Parameter)>, Subject) {
        let belongs = |parameter: &Parameter| {
            parameter.role == Role::Variant
                && self
                    .wanted
                    .element
                    .is_none_or(|element| parameter.affects_only(element))
        };
        let parameters = self.anchor.task().parameters().iter();
        let free_params: Vec<(&String, &Parameter)> = parameters.filter(|(_, parameter)| belongs(parameter)).collect();
        let subject = match self.wanted.element {
            Some(element) => Subject::Element(element),
            None => Subject::Parameters(free_params.iter().map(|(name, _)| (*name).clone()).collect()),
        };
        (free_params, subject)
    }

    /// The largest distance of any variant from the anchor, whether the search reached it or not.
    pub(super) fn farthest(&self) -> Result<f64, CurriculumError> {
        // Without parameters to change, the pool may still hold variants.
        let mut largest =
            farthest(&self.measure, self.anchor, &self.free_params().1, self.wanted.element).unwrap_or(0.0);
        for variant in self.pool {
            let (distance, valid) = self.measure(self.anchor, variant)?;
            if valid {
                largest = largest.max(distance);
            }
        }
        Ok(largest)
    }

    /// Candidates for the next step: declared variants, then generated ones.
    fn candidates(&mut self) -> Result<Vec<Picked>, CurriculumError> {
        let here = self.path[self.path.len() - 1].variant.clone();
        let mut declared = Vec::new();
        for variant in self.pool {
            let (distance, valid) = self.measure(&here, variant)?;
            let miss = (distance - self.wanted.distance).abs();
            if valid && miss <= self.wanted.tolerance && self.distance_to_path(variant)? > self.wanted.distance / 2.0 {
                declared.push((miss, Picked::declared(self.task, variant.clone())));
            }
        }
        declared.sort_by(|a, b| {
            a.0.total_cmp(&b.0)
                .then_with(|| a.1.choice.name().cmp(b.1.choice.name()))
        });
        let mut generated: Vec<(f64, Picked)> = Vec::new();
        for target in self.targets(&here)? {
            if self.budget_exhausted() {
                break;
            }
            let Some(variant) = self.towards(&here, &target)? else {
                continue;
            };
            let clearance = self.distance_to_path(&variant)?;
            if clearance > self.wanted.distance / 2.0 {
                generated.push((clearance, Picked::generated(self.task, self.anchor, variant)));
            }
        }
        // The sort is stable: ties keep the order of the parameters.
        generated.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(declared.into_iter().chain(generated).map(|(_, one)| one).collect())
    }

    /// The distance between two variants, and whether they differ only in elements that may change.
    fn measure(&self, a: &Variant, b: &Variant) -> Result<(f64, bool), CurriculumError> {
        self.comparisons.set(self.comparisons.get() + 1);
        let breakdown = self.measure.between(a, b)?;
        let valid = self
            .wanted
            .element
            .is_none_or(|element| is_only_in(&breakdown, element));
        Ok((breakdown.within(self.wanted.element), valid))
    }

    /// The distance to the nearest variant on the path.
    fn distance_to_path(&self, variant: &Variant) -> Result<f64, CurriculumError> {
        let mut nearest = f64::INFINITY;
        for visited in &self.path {
            nearest = nearest.min(self.distance(&visited.variant, variant)?);
        }
        Ok(nearest)
    }

    /// Variants to step towards: the ends and choices of each parameter, all ranges at their low or high end, the pool's
    /// variants, and the one that the generator finds.
    fn targets(&self, here: &Variant) -> Result<Vec<Variant>, CurriculumError> {
        let (free_params, subject) = self.free_params();
        let mut changes: Vec<Vec<(String, Value)>> = Vec::new();
        let mut corners = [Vec::new(), Vec::new()];
        for (name, parameter) in &free_params {
            let Some(value) = here.value(name) else { continue };
            let values = ends(parameter, value);
            for (corner, end) in corners.iter_mut().zip(&values) {
                if matches!(parameter.domain(), Some(Domain::Range(_))) {
                    corner.push(((*name).clone(), end.clone()));
                }
            }
            changes.extend(values.into_iter().map(|value| vec![((*name).clone(), value)]));
        }
        changes.extend(corners);
        let changed = changes.into_iter().filter_map(|change| here.with("end", change).ok());
        let mut targets: Vec<Variant> = changed.collect();
        for variant in self.pool {
            if self.measure(here, variant)?.1 {
                targets.push(variant.clone());
            }
        }
        let measure = |other: &Variant| self.distance(here, other).unwrap_or(0.0);
        let found = at_distance(here, &subject, self.wanted.distance, self.wanted.tolerance, measure);
        targets.extend(found.ok().map(|found| found.variant));
        Ok(targets)
    }

    /// The variant at the wanted distance from `here` towards a target; `None` if there is none.
    fn towards(&self, here: &Variant, target: &Variant) -> Result<Option<Variant>, CurriculumError> {
        let (wanted, tolerance) = (self.wanted.distance, self.wanted.tolerance);
        let whole = self.distance(here, target)?;
        if whole < wanted - tolerance {
            return Ok(None);
        }
        let mut best = (f64::INFINITY, target.clone());
        if whole <= wanted {
            best.0 = wanted - whole;
        } else {
            let drift = Drift::new(here.clone(), target.clone())?;
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(low, high);
                let Ok(variant) = drift.at(middle, 0) else {
                    return Ok(None);
                };
                let distance = self.distance(here, &variant)?;
                let miss = (distance - wanted).abs();
                if miss < best.0 {
                    best = (miss, variant);
                }
                if miss <= tolerance.min(1e-9) {
                    break;
                }
                if distance < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            if (whole - wanted).abs() < best.0 {
                best = (whole - wanted, target.clone());
            }
        }
        if best.0 > tolerance {
            return Ok(None);
        }
        let changed = changes(self.anchor, &best.1);
        Ok(self.anchor.with(&self.name(), changed).ok())
    }

    /// Name of the next generated variant: `blue-step-3`.
    fn name(&self) -> String {
        let declared = self.anchor.task().variant_names();
        let mut name = format!("{}-step-{}", self.anchor.name(), self.path.len());
        while declared.contains(&name.as_str()) {
            name.push('x');
        }
        name
    }
}

/// Values to move a parameter to: both ends of a range (for a heading, also the opposite direction), or the other choices.
fn ends(parameter: &Parameter, value: &Value) -> Vec<Value> {
    match parameter.domain() {
        Some(Domain::Choices(choices)) => choices.into_iter().filter(|choice| choice != value).collect(),
        Some(Domain::Range([low, high])) => {
            let at = |end: f64| match value {
                Value::Integer(_) => Value::Integer(end.round() as i64),
                Value::Vector(numbers) => Value::Vector(vec![end; numbers.len()]),
                _ => Value::Number(end),
            };
            let turned = value.as_number().filter(|_| parameter.kind == ParameterType::Heading);
            let opposite = turned.map(|degrees| Value::Number((degrees + 180.0).rem_euclid(360.0)));
            [at(low), at(high)].into_iter().chain(opposite).collect()
        }
        None => Vec::new(),
    }
}
