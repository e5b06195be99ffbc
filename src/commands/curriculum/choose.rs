//! The variants of a curriculum and their order: all that are named, those of a probe, or a sequence of steps.

use crate::curriculum::{Choice, Hypothesis, Picked, Steps, arrange, distances, probe, probe_named, steps};
use crate::similarity::{DistanceMatrix, Method};
use crate::spec::{DEFAULT_VARIANT, Element, Variant};
use crate::tasks;

use super::{Curriculum, Order, tables};
use crate::commands::order::matrix;
use crate::commands::weights::WeightArgs;
use crate::commands::{Failure, input};

/// Variants and the order in which they are met.
pub(super) struct Chosen {
    pub(super) variants: Vec<Choice>,
    pub(super) matrix: DistanceMatrix,
    pub(super) order: Vec<usize>,
    /// A table that proves of the variants what was asked for.
    pub(super) proof: Option<String>,
}

impl Chosen {
    /// The variants in an order.
    pub(super) fn in_order(&self, order: &[usize]) -> Vec<Choice> {
        order.iter().map(|index| self.variants[*index].clone()).collect()
    }
}

impl Curriculum {
    pub(super) fn choose(&self) -> Result<Chosen, Failure> {
        let named = input::variants(&self.tasks)?;
        if let Some(distance) = self.step_distance {
            let wanted = Steps {
                distance,
                tolerance: self.tolerance,
                count: self.steps,
                element: self.probe,
            };
            let (task, pool, anchor) = self.one_task(&named)?;
            let picked = steps(&task, &pool, &anchor, &wanted)?;
            let order = (0..picked.len()).collect();
            let proof = tables::steps(&picked, &wanted)?;
            return chosen(&picked, self.probe, order, Some(proof));
        }
        if let Some(element) = self.probe {
            let (task, pool, anchor) = self.one_task(&named)?;
            let picked = if self.names_variants() && pool.len() > 1 {
                if let Some(wanted) = self.variants.filter(|wanted| *wanted < pool.len()) {
                    return Err(Failure::usage(format!(
                        "--variants: found {wanted} and {} variants named, expected at least as many as are named; name fewer, or \
                         leave it out",
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
            // A method or an end that was asked for, or the order of a hypothesis: by default the gradual one.
            let order = if self.ordering.method.is_some() || self.ordering.end.is_some() {
                self.ordering.order(&matrix, self.seed)?.1.indices
            } else {
                match self.order {
                    Some(Order::Named) => (0..picked.len()).collect(),
                    order => arrange(&matrix, order.map_or(Hypothesis::Gradual, Order::hypothesis), 0)?,
                }
            };
            let shown: Vec<&Picked> = order.iter().map(|index| &picked[*index]).collect();
            let proof = tables::probe(&shown, &picked[0], element)?;
            return chosen(&picked, Some(element), order, Some(proof));
        }
        let matrix = matrix(&named, &WeightArgs::default())?;
        let order = match self.order {
            Some(Order::Named) => {
                let all = 0..matrix.len();
                let first = self.ordering.options(&matrix, self.seed)?.first;
                first
                    .into_iter()
                    .chain(all.filter(|index| Some(*index) != first))
                    .collect()
            }
            Some(order) => {
                let first = self.ordering.options(&matrix, self.seed)?.first.unwrap_or(0);
                arrange(&matrix, order.hypothesis(), first)?
            }
            None => {
                self.ordering
                    .order_from(&matrix, self.seed, &self.firsts(&named))?
                    .1
                    .indices
            }
        };
        let variants = named
            .iter()
            .map(|(task, variant)| Choice::new(task, variant.name()))
            .collect();
        Ok(Chosen {
            variants,
            matrix,
            order,
            proof: None,
        })
    }

    /// Whether every argument names a variant or a family, not a whole task.
    fn names_variants(&self) -> bool {
        self.tasks.iter().all(|name| tasks::split(name).1.is_some())
    }

    /// The variants that may come first where nobody says which: those of the first argument, if there are others.
    fn firsts(&self, named: &[(String, Variant)]) -> Vec<usize> {
        let (Some(first), true) = (self.tasks.first(), self.ordering.method != Some(Method::Random)) else {
            return Vec::new();
        };
        let many = tasks::variants(first).map_or(0, |variants| variants.len());
        // Arguments are unfolded in their order, each variant once.
        (0..many.min(named.len())).collect()
    }

    /// The task that all variants are of, by the name that it was called by; its variants; and the one to begin with.
    fn one_task(&self, named: &[(String, Variant)]) -> Result<(String, Vec<Variant>, Variant), Failure> {
        let (task, first) = &named[0];
        if let Some((other, _)) = named.iter().find(|(other, _)| other != task) {
            return Err(Failure::input(format!(
                "found variants of {task} and of {other}, expected those of one task: --probe and --step-distance measure within a task"
            )));
        }
        let pool: Vec<Variant> = named.iter().map(|(_, variant)| variant.clone()).collect();
        let anchor = match &self.ordering.start {
            Some(start) => {
                let own = pool
                    .iter()
                    .find(|variant| format!("{task}#{}", variant.name()) == *start);
                let names = || pool.iter().map(|variant| format!("{task}#{}", variant.name()));
                own.cloned().ok_or_else(|| {
                    let names: Vec<String> = names().collect();
                    Failure::input(format!(
                        "--start: found {start:?}, expected one of {}",
                        names.join(", ")
                    ))
                })?
            }
            None if pool.len() == 1 => first.clone(),
            // The variant in which everything has its default, by the name that the task gives it if it does.
            None => {
                let default = first.task().variant(DEFAULT_VARIANT)?;
                let declared = pool.iter().find(|variant| variant.values() == default.values());
                declared.cloned().unwrap_or(default)
            }
        };
        Ok((task.clone(), pool, anchor))
    }
}

fn chosen(
    picked: &[Picked],
    element: Option<Element>,
    order: Vec<usize>,
    proof: Option<String>,
) -> Result<Chosen, Failure> {
    Ok(Chosen {
        variants: picked.iter().map(|picked| picked.choice.clone()).collect(),
        matrix: distances(picked, element)?,
        order,
        proof,
    })
}
