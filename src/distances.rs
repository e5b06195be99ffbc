//! Every distance among variants, of one task or of several. The measures are `similarity`'s, worlds are drawn by `generator`.

use driftworld_generator::{GeneratorError, Sampler};
use driftworld_similarity::{DistanceMatrix, SimilarityError, VariantMeasure, Weights, Worlds};
use driftworld_spec::{Variant, World};

/// How many worlds of each variant are compared where variants of different tasks meet.
pub const NUM_WORLDS: u64 = 16;

/// What keeps a matrix from being measured.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DistancesError {
    /// A world of a variant cannot be drawn.
    #[error(transparent)]
    Generator(#[from] GeneratorError),
    /// Too many variants, or a weight that is none.
    #[error(transparent)]
    Similarity(#[from] SimilarityError),
}

/// How variants are compared.
enum Comparison {
    /// All are of one task: by what it declares.
    Declared(Box<VariantMeasure>),
    /// By [`NUM_WORLDS`] worlds of each, drawn under seed 0.
    Drawn(Worlds),
}

/// Every distance among variants, each under the name it is called by; in parallel.
///
/// Variants of one task are compared parameter by parameter, at the weights that the task declares and with `lay_over` laid
/// over them; the matrix is a metric where the task's measures are. Variants of several tasks are compared by 16 worlds of each,
/// drawn under seed 0, the first with the first and so on.
///
/// # Errors
/// [`DistancesError::Generator`] for worlds that cannot be drawn, [`DistancesError::Similarity`] for too many variants or what
/// `lay_over` says.
///
/// # Example
/// ```
/// use driftworld::{distances, tasks};
/// let named = |name: &str| Ok::<_, tasks::TaskError>((name.to_owned(), tasks::variant(name)?));
/// let variants = [named("find_objects#blue")?, named("find_objects#dusk")?];
/// let matrix = distances::variant_matrix(&variants, Ok)?;
/// assert!(matrix.get(0, 1) > 0.0 && matrix.nature().is_metric());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn variant_matrix(
    variants: &[(String, Variant)],
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    let labels = variants.iter().map(|(label, _)| label.clone()).collect();
    let comparison = match variants.first() {
        Some((_, first)) => {
            let task = first.task();
            let declared = VariantMeasure::new(task, Weights::default());
            if variants.iter().all(|(_, variant)| declared.takes(variant)) {
                let weights = lay_over(Weights::of_task(task))?;
                Comparison::Declared(Box::new(VariantMeasure::new(task, weights)))
            } else {
                Comparison::Drawn(Worlds::new(&draw(variants)?, lay_over(Weights::default())?))
            }
        }
        None => Comparison::Drawn(Worlds::new(&[], Weights::default())),
    };
    match comparison {
        Comparison::Declared(measure) => {
            let apart = |a: usize, b: usize| Ok(measure.between(&variants[a].1, &variants[b].1)?.total);
            Ok(DistanceMatrix::measure(labels, apart)
                .map_err(|error: SimilarityError| error)?
                .with_nature(measure.nature()))
        }
        Comparison::Drawn(worlds) => {
            let count = NUM_WORLDS as usize;
            let apart = |a: usize, b: usize| {
                let each = (0..count).map(|k| worlds.distance(a * count + k, b * count + k));
                Ok::<_, SimilarityError>(each.sum::<f64>() / count as f64)
            };
            Ok(DistanceMatrix::measure(labels, apart)?)
        }
    }
}

/// [`NUM_WORLDS`] worlds of each, one variant after the other.
fn draw(variants: &[(String, Variant)]) -> Result<Vec<World>, GeneratorError> {
    let mut worlds = Vec::with_capacity(variants.len() * NUM_WORLDS as usize);
    for (_, variant) in variants {
        let sampler = Sampler::new(variant, 0);
        for index in 0..NUM_WORLDS {
            worlds.push(sampler.world(index)?);
        }
    }
    Ok(worlds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tasks;

    fn matrix(names: &[&str]) -> DistanceMatrix {
        let variants: Vec<(String, Variant)> = names
            .iter()
            .map(|name| ((*name).to_owned(), tasks::variant(name).expect("it is built in")))
            .collect();
        variant_matrix(&variants, Ok).expect("all can be drawn")
    }

    #[test]
    fn variants_of_one_task_are_compared_by_what_it_declares() {
        let found = matrix(&["find_objects#blue", "find_objects#red", "find_objects#penalty"]);
        assert!(found.nature().is_metric());
        assert!(found.get(0, 1) > 0.0 && found.get(0, 2) > found.get(0, 1));
    }

    #[test]
    fn variants_of_several_tasks_are_compared_by_their_worlds() {
        let found = matrix(&["find_objects#blue", "find_objects#red", "get_to_goal#plain"]);
        assert!(!found.nature().is_metric());
        assert!(found.get(0, 1) < found.get(0, 2));
        assert_eq!(matrix(&[]).len(), 0);
    }
}
