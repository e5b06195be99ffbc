//! Distance between two variants of one task, parameter by parameter.

use std::sync::Arc;

use driftworld_spec::{Element, ParameterType, Role, TaskSpec, Variant};

use crate::combined::arena::Arena;
use crate::combined::drawn::DrawnMeasure;
use crate::combined::value::ValueMeasure;
use crate::combined::weighted_distance::{Distance, Part};
use crate::combined::weights::Weights;
use crate::{MetricProperties, SimilarityError};

/// The distance between two variants of one task: a sum over its parameters, where 1 is one parameter moved over its whole
/// declared range.
///
/// Every parameter uses the measure and weight that the task gives it under `compare`, by default weight 1 and its
/// type's measure: the difference of numbers, the turn between headings, the distance of colours in Oklab, the
/// Euclidean length for points and vectors, the difference in shape of layouts in the task's arena. Each is divided by
/// the maximum that the declared range or the choices allow. Values of other types are only compared for equality. Randomized
/// parameters are compared by their distributions: Wasserstein-1 for numbers, on the circle for headings, in Oklab for
/// colours from a continuum, share by share for shares, Wasserstein-2 for points, total variation for words and for
/// colours from lists. Each is divided by the distance of the widest pair of distributions that the declared ranges
/// and choices allow. Parameters that are read only by such distributions count through them, and not a second time. A
/// parameter that nothing reads in a variant (`read_if`) counts with its default. Fixed parameters cannot differ and
/// are left out.
///
/// Equal values contribute exactly 0, so variants that differ only in pay are 0 apart in all elements but the reward, and
/// adding a parameter that is the same in both changes no number. Normalisation depends only on what the task declares, not on
/// other variants. [`VariantMeasure::properties`] says whether the whole is a metric. To compare many variants, make a
/// [`VariantMeasure`] once.
///
/// # Errors
/// As [`VariantMeasure::between`].
pub fn variant_distance(a: &Variant, b: &Variant, weights: &Weights) -> Result<Distance, SimilarityError> {
    VariantMeasure::new(a.task(), weights.clone()).between(a, b)
}

/// Measures distances between the variants of one task, prepared for many comparisons.
///
/// # Example
/// ```
/// use driftworld_similarity::{MetricProperties, VariantMeasure, Weights};
/// use driftworld_spec::{Element, TaskSpec};
/// let task = TaskSpec::from_json("inline", r#"{ "name": "t", "parameters": {
///     "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 } },
///   "variants": { "day": {}, "dusk": { "light": 1 } } }"#)?;
/// let measure = VariantMeasure::new(&task, Weights::of_task(&task));
/// let distance = measure.between(&task.variant("day")?, &task.variant("dusk")?)?;
/// assert_eq!((distance.element(Element::O), measure.properties()), (Some(0.25), MetricProperties::Metric));
/// assert_eq!(measure.diameter(), 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct VariantMeasure {
    task: Arc<TaskSpec>,
    weights: Weights,
    parameters: Vec<Compared>,
}

/// A parameter and its measure.
#[derive(Clone, Debug)]
struct Compared {
    name: String,
    affects: Vec<Element>,
    weight: f64,
    /// Whether two variants of the task can differ in it.
    can_differ: bool,
    by: ParameterMeasure,
}

/// The coarse elements that a parameter counts for. A coarse element that is listed along with a finer element of it counts once.
fn counts_for(affects: &[Element]) -> Vec<Element> {
    let counts = |element: &&Element| **element == element.coarse() || !affects.contains(&element.coarse());
    affects.iter().filter(counts).map(|element| element.coarse()).collect()
}

#[derive(Clone, Debug)]
enum ParameterMeasure {
    Value(ValueMeasure),
    Drawn(DrawnMeasure),
}

impl VariantMeasure {
    /// Prepares to compare variants of this task, with these weights of elements.
    pub fn new(task: &Arc<TaskSpec>, weights: Weights) -> Self {
        let arena = Arena::of(task);
        let parameters = task.parameters().iter().filter_map(|(name, parameter)| {
            let by = match parameter.role {
                Role::Fixed => return None,
                Role::Variant if parameter.kind != ParameterType::Distribution => {
                    ParameterMeasure::Value(ValueMeasure::of(parameter, arena))
                }
                Role::Variant | Role::Randomized => {
                    ParameterMeasure::Drawn(DrawnMeasure::of(parameter, &task.distributions_at_ends(name)))
                }
            };
            if parameter.role == Role::Variant && task.readers(name).are_draws_alone() {
                return None;
            }
            Some(Compared {
                name: name.clone(),
                affects: counts_for(&parameter.affects),
                weight: parameter.compare.as_ref().map_or(1.0, |compare| compare.weight),
                can_differ: match &by {
                    ParameterMeasure::Value(_) => true,
                    ParameterMeasure::Drawn(measure) => measure.can_differ(),
                },
                by,
            })
        });
        Self {
            task: Arc::clone(task),
            weights,
            parameters: parameters.collect(),
        }
    }

    /// The distance between two variants of the task.
    ///
    /// # Errors
    /// [`SimilarityError::DifferentTasks`] if one is not a variant of this task, [`SimilarityError::NotADistance`] for
    /// distributions of numbers so large that their distance is not finite.
    pub fn between(&self, a: &Variant, b: &Variant) -> Result<Distance, SimilarityError> {
        for variant in [a, b] {
            if !self.takes(variant) {
                let (a, b) = (a.task().name().to_owned(), b.task().name().to_owned());
                return Err(SimilarityError::DifferentTasks { a, b });
            }
        }
        let mut parts = Vec::new();
        let (a, b) = (a.as_read(), b.as_read());
        for compared in &self.parameters {
            let name = &compared.name;
            let found = match &compared.by {
                ParameterMeasure::Value(measure) => a.value(name).zip(b.value(name)).map(|(a, b)| {
                    let (raw, normalised) = measure.between(a, b);
                    (measure.name(), None, raw, normalised)
                }),
                ParameterMeasure::Drawn(measure) => a
                    .distribution(name)
                    .zip(b.distribution(name))
                    .map(|(a, b)| measure.between(&a, &b)),
            };
            let Some((measure, method, raw, normalised)) = found else {
                continue;
            };
            if !raw.is_finite() || !normalised.is_finite() {
                let [a, b] = [&a, &b].map(|variant| format!("{} ({name})", variant.id()));
                return Err(SimilarityError::NotADistance { a, b, found: raw });
            }
            parts.extend(compared.affects.iter().map(|element| Part {
                method,
                normalised,
                weight: compared.weight,
                ..Part::of(name, *element, measure, raw)
            }));
        }
        Ok(Distance::new(parts, &self.weights))
    }

    /// Whether it is a variant of exactly this task document.
    pub fn takes(&self, variant: &Variant) -> bool {
        self.task.is_same_as(variant.task())
    }

    /// Upper bound on the distance between two variants of the task: all parameters moved over their whole declared
    /// ranges. 0 for a task without parameters that count, infinite if the distance in one of them has no finite bound.
    pub fn diameter(&self) -> f64 {
        let counts = |compared: &Compared| {
            let weights = compared.affects.iter().map(|element| self.weights.of(*element));
            let weight = compared.weight * weights.fold(0.0, f64::max);
            match &compared.by {
                ParameterMeasure::Drawn(measure) if weight > 0.0 && !measure.is_bounded() => f64::INFINITY,
                _ => weight,
            }
        };
        self.parameters
            .iter()
            .filter(|compared| compared.can_differ)
            .map(counts)
            .sum()
    }

    /// Whether the diameter is above 0 and finite, so that distances can be divided by it.
    pub fn has_diameter(&self) -> bool {
        let diameter = self.diameter();
        diameter > 0.0 && diameter.is_finite()
    }

    /// The metric properties of the whole: a metric if all measures that count are metrics; a pseudometric if one of them is
    /// only a pseudometric, or if a parameter that can differ has weight 0.
    pub fn properties(&self) -> MetricProperties {
        let counts = |compared: &&Compared| {
            let is_seen = compared.affects.iter().any(|element| self.weights.of(*element) > 0.0);
            compared.weight > 0.0 && is_seen
        };
        let own = |compared: &Compared| match &compared.by {
            ParameterMeasure::Value(measure) => measure.properties(),
            ParameterMeasure::Drawn(measure) => measure.properties(),
        };
        let each: Vec<MetricProperties> = self.parameters.iter().filter(counts).map(own).collect();
        let mut differing = self.parameters.iter().filter(|compared| compared.can_differ);
        if !each.iter().all(|own| own.keeps_triangles()) {
            MetricProperties::Distance
        } else if each.iter().all(|own| own.is_metric()) && differing.all(|compared| counts(&compared)) {
            MetricProperties::Metric
        } else {
            MetricProperties::Pseudometric
        }
    }
}

#[cfg(test)]
mod tests;
