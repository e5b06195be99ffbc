//! Chooses the variants of a curriculum and their order: the named variants, those of a probe, or a sequence of steps.

use driftworld_curriculum::{Choice, Picked, Steps, arrange, distances, probe, probe_named, steps};
use driftworld_similarity::{DistanceMatrix, Method};
use driftworld_spec::{By, DEFAULT_VARIANT, Element, Variant, did_you_mean};

use super::DesignRequest;
use crate::distances::{Sample, fitting, labelled_matrix};
use crate::ordering::{DesignOrder, bare, position_of};
use crate::{Failure, argument, libraries, tasks};

/// Default tolerance of a step.
pub const DEFAULT_TOLERANCE: f64 = 0.001;

/// Default number of steps.
pub const DEFAULT_STEPS: u32 = 4;

/// Variants with their learning order.
#[derive(Debug)]
#[non_exhaustive]
pub struct Chosen {
    /// The variants.
    pub variants: Vec<Choice>,
    /// All distances among them.
    pub matrix: DistanceMatrix,
    /// The measure.
    pub by: By,
    /// Their indices in learning order.
    pub order: Vec<usize>,
    /// The evidence that the variants are as requested; `None` if they were chosen by name.
    pub evidence: Option<Evidence>,
}

/// The evidence that chosen variants are as requested.
#[derive(Debug)]
pub enum Evidence {
    /// Variants that differ from the first in one element only.
    Probe {
        /// The picked variants.
        picked: Vec<Picked>,
        /// The element.
        element: Element,
    },
    /// Variants, each one step from the previous one.
    Steps {
        /// The picked variants.
        picked: Vec<Picked>,
        /// The requested steps.
        wanted: Steps,
    },
}

impl Evidence {
    /// The picked variants, and the element that is measured if not all are.
    pub(super) fn parts(&self) -> (&[Picked], Option<Element>) {
        match self {
            Self::Probe { picked, element } => (picked, Some(*element)),
            Self::Steps { picked, wanted } => (picked, wanted.element),
        }
    }
}

impl Chosen {
    /// What the distances are, such as "by parameters" or, of a probe, "in reward".
    pub(crate) fn measure(&self) -> String {
        let element = self.evidence.as_ref().and_then(|evidence| evidence.parts().1);
        element.map_or_else(
            || format!("by {}", self.by.name()),
            |element| format!("in {}", element.name()),
        )
    }

    /// The variants in an order.
    pub(super) fn in_order(&self, order: &[usize]) -> Vec<Choice> {
        order.iter().map(|index| self.variants[*index].clone()).collect()
    }
}

impl DesignRequest {
    pub(super) fn choose(&self) -> Result<Chosen, Failure> {
        let named = self.learned()?;
        if let Some(distance) = self.step_distance {
            let wanted = Steps {
                distance,
                tolerance: self.tolerance.unwrap_or(DEFAULT_TOLERANCE),
                count: self.steps.unwrap_or(DEFAULT_STEPS),
                element: self.probe,
            };
            let (task, pool, anchor) = self.one_task(&named)?;
            let picked = steps(&task, &pool, &anchor, &wanted)?;
            let order = (0..picked.len()).collect();
            return chosen(Evidence::Steps { picked, wanted }, order);
        }
        if let Some(element) = self.probe {
            let (task, pool, anchor) = self.one_task(&named)?;
            let picked = if self.names_variants() && pool.len() > 1 {
                if let Some(wanted) = self.variants.filter(|wanted| *wanted < pool.len()) {
                    return Err(Failure::usage(format!(
                        "{}: found {wanted}, but {} variants are named, expected at least that many; name fewer, or \
                         leave it out",
                        argument("variants"),
                        pool.len()
                    )));
                }
                let anchor = if self.ordering.start.is_some() {
                    &anchor
                } else {
                    &pool[0]
                };
                probe_named(&task, &pool, anchor, element, self.variants)?
            } else {
                probe(&task, &pool, &anchor, element, self.variants)?
            };
            let matrix = distances(&picked, Some(element))?;
            // A requested method or end has priority, then the requested order, by default outward.
            let order = if self.ordering.own_method().is_some() || self.ordering.end.is_some() {
                self.ordering.order(&matrix, self.seed)?.1.indices
            } else {
                match self.ordering.purpose() {
                    Some(DesignOrder::NAMED) => (0..picked.len()).collect(),
                    order => arrange(&matrix, order.map_or(Some(Method::Outward), |order| order.0), 0)?,
                }
            };
            return chosen(Evidence::Probe { picked, element }, order);
        }
        let by = self
            .by
            .unwrap_or_else(|| fitting(named.iter().map(|(_, variant)| variant)));
        let sample = Sample {
            catalogue: libraries::catalogue(&self.libraries)?,
            ..Sample::by(by)
        };
        let matrix = labelled_matrix(&named, &sample, Ok)?;
        let order = match self.ordering.purpose() {
            Some(DesignOrder::NAMED) => {
                let all = 0..matrix.len();
                let first = self.ordering.options(&matrix, self.seed)?.first;
                first
                    .into_iter()
                    .chain(all.filter(|index| Some(*index) != first))
                    .collect()
            }
            Some(order) => {
                let first = self.ordering.options(&matrix, self.seed)?.first.unwrap_or(0);
                arrange(&matrix, order.0, first)?
            }
            None => self.ordering.order_from(&matrix, self.seed, &self.tasks)?.1.indices,
        };
        let variants = named
            .iter()
            .map(|(task, variant)| Choice::new(task, variant.name()))
            .collect();
        Ok(Chosen {
            variants,
            matrix,
            by,
            order,
            evidence: None,
        })
    }

    /// The variants to learn: all named variants except held-out ones.
    fn learned(&self) -> Result<Vec<(String, Variant)>, Failure> {
        let mut named = tasks::variants_of(&self.tasks)?;
        let held_out = self.held_out()?;
        named.retain(|(task, variant)| !is_among(&held_out, task, variant.name()));
        if named.is_empty() {
            return Err(Failure::input(format!(
                "{}: found every variant held out, expected at least one to learn",
                argument("hold_out")
            )));
        }
        Ok(named)
    }

    /// Whether every argument names a variant or a family, not a whole task.
    fn names_variants(&self) -> bool {
        let named = tasks::with_tasks(&self.tasks);
        named.iter().all(|name| tasks::split(name).1.is_some())
    }

    /// The common task of all variants, as it was named; the variants; and the variant to start from.
    fn one_task(&self, named: &[(String, Variant)]) -> Result<(String, Vec<Variant>, Variant), Failure> {
        let (task, first) = &named[0];
        if let Some((other, _)) = named.iter().find(|(other, _)| other != task) {
            return Err(Failure::input(format!(
                "found variants of {task} and of {other}, expected variants of one task; {} and {} measure within a \
                 task",
                argument("probe"),
                argument("step_distance")
            )));
        }
        let pool: Vec<Variant> = named.iter().map(|(_, variant)| variant.clone()).collect();
        let anchor = match &self.ordering.start {
            Some(start) => {
                let names: Vec<String> = pool
                    .iter()
                    .map(|variant| format!("{task}#{}", variant.name()))
                    .collect();
                let own = position_of(&names, start).map_err(|_| {
                    let near = did_you_mean(start, names.iter().map(|name| bare(name)));
                    Failure::input(format!(
                        "{}: found {start:?}, expected one of {}{near}",
                        argument("start"),
                        names.join(", ")
                    ))
                })?;
                pool[own].clone()
            }
            None if pool.len() == 1 => first.clone(),
            // Start from the variant with all defaults; prefer a declared variant with the same values.
            None => {
                let default = first.task().variant(DEFAULT_VARIANT)?;
                let declared = pool.iter().find(|variant| variant.values() == default.values());
                declared.cloned().unwrap_or(default)
            }
        };
        Ok((task.clone(), pool, anchor))
    }
}

/// Whether one of the variants of tasks has this name.
pub(super) fn is_among(variants: &[(String, Variant)], task: &str, name: &str) -> bool {
    variants
        .iter()
        .any(|(other, variant)| other == task && variant.name() == name)
}

fn chosen(evidence: Evidence, order: Vec<usize>) -> Result<Chosen, Failure> {
    let (picked, element) = evidence.parts();
    Ok(Chosen {
        variants: picked.iter().map(|picked| picked.choice.clone()).collect(),
        matrix: distances(picked, element)?,
        by: By::Parameters,
        order,
        evidence: Some(evidence),
    })
}
