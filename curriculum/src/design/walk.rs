//! The search for a sequence of even steps: where it may go on, and back where that leads nowhere. What is asked of it is in
//! `steps.rs`.

use std::cell::Cell;

use driftworld_generator::{Drift, Subject, at_distance};
use driftworld_similarity::VariantMeasure;
use driftworld_spec::{Domain, Parameter, ParameterType, Role, Value, Variant};

use super::choice::changes;
use super::picked::{Picked, apart, farthest, in_element, is_alone, measure_of};
use super::steps::Steps;
use crate::CurriculumError;

/// The most variants that a sequence is tried to go on from.
const MOST_TRIES: u32 = 4000;

/// The most comparisons of two variants in a search for a sequence.
pub(super) const MOST_COMPARISONS: u64 = 4_000_000;

/// Halvings of a stretch before it is given up.
const HALVINGS: u32 = 60;

/// A path under construction, and what it may cost.
pub(super) struct Walk<'a> {
    task: &'a str,
    pool: &'a [Variant],
    anchor: &'a Variant,
    wanted: &'a Steps,
    pub(super) path: Vec<Picked>,
    pub(super) longest: usize,
    tries: u32,
    measure: VariantMeasure,
    /// How many were made so far.
    comparisons: Cell<u64>,
}

impl<'a> Walk<'a> {
    /// The path that holds only the anchor.
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

    /// Completes the path; false if it cannot be.
    pub(super) fn go_on(&mut self) -> Result<bool, CurriculumError> {
        self.longest = self.longest.max(self.path.len() - 1);
        if self.path.len() > self.wanted.count as usize {
            return Ok(true);
        }
        self.tries += 1;
        if self.tries > MOST_TRIES || self.is_tired() {
            return Ok(false);
        }
        for next in self.nexts()? {
            self.path.push(next);
            if self.go_on()? {
                return Ok(true);
            }
            self.path.pop();
            if self.tries > MOST_TRIES || self.is_tired() {
                break;
            }
        }
        Ok(false)
    }

    pub(super) fn is_tired(&self) -> bool {
        self.comparisons.get() >= MOST_COMPARISONS
    }

    fn apart(&self, a: &Variant, b: &Variant) -> Result<f64, CurriculumError> {
        self.comparisons.set(self.comparisons.get() + 1);
        apart(&self.measure, a, b, self.wanted.element)
    }

    /// The parameters that may change, and the subject that they are.
    fn free(&self) -> (Vec<(&String, &Parameter)>, Subject) {
        let belongs = |parameter: &Parameter| {
            parameter.role == Role::Variant
                && self
                    .wanted
                    .element
                    .is_none_or(|element| parameter.affects_only(element))
        };
        let parameters = self.anchor.task().parameters().iter();
        let free: Vec<(&String, &Parameter)> = parameters.filter(|(_, parameter)| belongs(parameter)).collect();
        let subject = match self.wanted.element {
            Some(element) => Subject::Element(element),
            None => Subject::Parameters(free.iter().map(|(name, _)| (*name).clone()).collect()),
        };
        (free, subject)
    }

    /// How far from the anchor anything is, whatever the search has met.
    pub(super) fn farthest(&self) -> Result<f64, CurriculumError> {
        // Where nothing can move there is still the pool.
        let mut all = farthest(&self.measure, self.anchor, &self.free().1, self.wanted.element).unwrap_or(0.0);
        for variant in self.pool {
            let (apart, alone) = self.measure(self.anchor, variant)?;
            if alone {
                all = all.max(apart);
            }
        }
        Ok(all)
    }

    /// Where the path may go on: what the task declares, then what can be made.
    fn nexts(&mut self) -> Result<Vec<Picked>, CurriculumError> {
        let here = self.path[self.path.len() - 1].variant.clone();
        let mut declared = Vec::new();
        for variant in self.pool {
            let (apart, alone) = self.measure(&here, variant)?;
            let miss = (apart - self.wanted.distance).abs();
            if alone && miss <= self.wanted.tolerance && self.nearest_met(variant)? > self.wanted.distance / 2.0 {
                declared.push((miss, Picked::declared(self.task, variant.clone())));
            }
        }
        declared.sort_by(|a, b| {
            a.0.total_cmp(&b.0)
                .then_with(|| a.1.choice.name().cmp(b.1.choice.name()))
        });
        let mut made: Vec<(f64, Picked)> = Vec::new();
        for target in self.targets(&here)? {
            if self.is_tired() {
                break;
            }
            let Some(variant) = self.on_the_way(&here, &target)? else {
                continue;
            };
            let met = self.nearest_met(&variant)?;
            if met > self.wanted.distance / 2.0 {
                made.push((met, Picked::made(self.task, self.anchor, variant)));
            }
        }
        // A stable sort: of equally new ones the first parameter's comes first.
        made.sort_by(|a, b| b.0.total_cmp(&a.0));
        Ok(declared.into_iter().chain(made).map(|(_, picked)| picked).collect())
    }

    /// How far two variants are apart, and whether in nothing but what may change.
    fn measure(&self, a: &Variant, b: &Variant) -> Result<(f64, bool), CurriculumError> {
        self.comparisons.set(self.comparisons.get() + 1);
        let apart = self.measure.between(a, b)?;
        let alone = self.wanted.element.is_none_or(|element| is_alone(&apart, element));
        Ok((in_element(&apart, self.wanted.element), alone))
    }

    /// The distance to the nearest variant of the path.
    fn nearest_met(&self, variant: &Variant) -> Result<f64, CurriculumError> {
        let mut nearest = f64::INFINITY;
        for met in &self.path {
            nearest = nearest.min(self.apart(&met.variant, variant)?);
        }
        Ok(nearest)
    }

    /// Variants in whose direction a step may go: the ends and choices of each parameter, both ends of all, those of the pool,
    /// and the one that the generator finds.
    fn targets(&self, here: &Variant) -> Result<Vec<Variant>, CurriculumError> {
        let (free, subject) = self.free();
        let mut changes: Vec<Vec<(String, Value)>> = Vec::new();
        let mut corners = [Vec::new(), Vec::new()];
        for (name, parameter) in &free {
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
        let measure = |other: &Variant| self.apart(here, other).unwrap_or(0.0);
        let found = at_distance(here, &subject, self.wanted.distance, self.wanted.tolerance, measure);
        targets.extend(found.ok().map(|found| found.variant));
        Ok(targets)
    }

    /// The variant at the wanted distance on the way to a target; `None` if there is none.
    fn on_the_way(&self, here: &Variant, target: &Variant) -> Result<Option<Variant>, CurriculumError> {
        let (wanted, tolerance) = (self.wanted.distance, self.wanted.tolerance);
        let whole = self.apart(here, target)?;
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
                let apart = self.apart(here, &variant)?;
                let miss = (apart - wanted).abs();
                if miss < best.0 {
                    best = (miss, variant);
                }
                if miss <= tolerance.min(1e-9) {
                    break;
                }
                if apart < wanted {
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

    /// What the next variant is called: `blue-step-3`.
    fn name(&self) -> String {
        let declared = self.anchor.task().variant_names();
        let mut name = format!("{}-step-{}", self.anchor.name(), self.path.len());
        while declared.contains(&name.as_str()) {
            name.push('x');
        }
        name
    }
}

/// The values that a parameter could go to: low and high end of a range, a heading's opposite too, or its other choices.
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
