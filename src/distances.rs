//! Distances between two of variants and worlds, and every distance among variants, of one task or of several. The measures are
//! `similarity`'s, worlds are drawn by `generator`.

use driftworld_generator::{GeneratorError, Sampler};
use driftworld_similarity::{
    Distance, DistanceMatrix, SimilarityError, VariantMeasure, Weights, Worlds, world_distance, world_sets_distance,
};
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
    /// The numbers of the worlds to compare go beyond the largest there is.
    #[error(
        "worlds: found index {index} and {worlds} worlds, expected their sum to be below 2^64; begin at a smaller index"
    )]
    TooFar {
        /// The number of the first world.
        index: u64,
        /// How many worlds.
        worlds: u64,
    },
    /// Whoever asked for the distances no longer wants them.
    #[error("the measuring was interrupted")]
    Interrupted,
}

/// One of two that are compared.
#[derive(Clone, Debug)]
pub enum Side {
    /// A world.
    World(Box<World>),
    /// A variant.
    Variant(Variant),
}

/// Which worlds are drawn where variants are compared by worlds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// How many of each, from 1; by default [`NUM_WORLDS`], and variants of one task are compared by what they declare.
    pub worlds: Option<u64>,
    /// The seed; default 0.
    pub seed: u64,
    /// The number of the first; default 0.
    pub index: u64,
}

/// How far apart two are, and in words how that was found.
///
/// Two variants of one task are compared parameter by parameter, unless worlds are asked for; two worlds as they are; others by
/// worlds drawn under one seed, the first with the first and so on. `lay_over` is laid over the weights that the task declares.
///
/// # Errors
/// [`DistancesError::Generator`] for worlds that cannot be drawn, [`DistancesError::Similarity`] for what `lay_over` says,
/// [`DistancesError::TooFar`].
///
/// # Example
/// ```
/// use driftworld::distances::{Sample, Side, between};
/// use driftworld::tasks;
/// let side = |name: &str| Ok::<_, tasks::TaskError>(Side::Variant(tasks::variant(name)?));
/// let (a, b) = (side("find_objects#blue")?, side("find_objects#dusk")?);
/// let (distance, how) = between(&a, &b, &Sample::default(), Ok)?;
/// assert!(distance.total > 0.0);
/// assert_eq!(how, "parameter by parameter");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn between(
    a: &Side,
    b: &Side,
    sample: &Sample,
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<(Distance, String), DistancesError> {
    let task = match (a, b) {
        (Side::Variant(a), Side::Variant(b)) if a.task().is_same_as(b.task()) => Some((a, b)),
        _ => None,
    };
    let weights = lay_over(task.map_or_else(Weights::default, |(a, _)| Weights::of_task(a.task())))?;
    if let (Some((a, b)), None) = (task, sample.worlds) {
        let distance = VariantMeasure::new(a.task(), weights).between(a, b)?;
        return Ok((distance, "parameter by parameter".to_owned()));
    }
    if let (Side::World(a), Side::World(b)) = (a, b) {
        return Ok((world_distance(a, b, &weights), "world to world".to_owned()));
    }
    let count = sample.worlds.unwrap_or(NUM_WORLDS);
    let distance = world_sets_distance(&sample.of(a, count)?, &sample.of(b, count)?, &weights)?;
    let plural = if count == 1 { "" } else { "s" };
    let how = format!(
        "mean of {count} world{plural} of each, drawn under seed {}",
        sample.seed
    );
    Ok((distance, how))
}

impl Sample {
    /// Worlds of a variant; a world as often as there are of the other.
    fn of(&self, side: &Side, count: u64) -> Result<Vec<World>, DistancesError> {
        match side {
            Side::World(world) => Ok((0..count).map(|_| (**world).clone()).collect()),
            Side::Variant(variant) => {
                let sampler = Sampler::new(variant, self.seed);
                let end = self.index.checked_add(count).ok_or(DistancesError::TooFar {
                    index: self.index,
                    worlds: count,
                })?;
                let worlds = (self.index..end).map(|index| sampler.world(index));
                Ok(worlds.collect::<Result<_, _>>()?)
            }
        }
    }
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
/// assert!(matrix.get(0, 1) > 0.0 && matrix.properties().is_metric());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn variant_matrix(
    variants: &[(String, Variant)],
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    variant_matrix_while(variants, lay_over, || true)
}

/// The same for variants with the names of their tasks, under labels such as `find_objects#red`.
///
/// # Errors
/// As [`variant_matrix`].
pub fn labelled_matrix(
    variants: &[(String, Variant)],
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    let label = |(task, variant): &(String, Variant)| (format!("{task}#{}", variant.name()), variant.clone());
    variant_matrix(&variants.iter().map(label).collect::<Vec<_>>(), lay_over)
}

/// The same, and given up as soon as `go_on`, which is asked before each pair, says no.
///
/// # Errors
/// As [`variant_matrix`]; [`DistancesError::Interrupted`] if it was given up.
pub fn variant_matrix_while(
    variants: &[(String, Variant)],
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
    go_on: impl Fn() -> bool + Sync,
) -> Result<DistanceMatrix, DistancesError> {
    let asked = || {
        if go_on() {
            Ok(())
        } else {
            Err(DistancesError::Interrupted)
        }
    };
    let labels = variants.iter().map(|(label, _)| label.clone()).collect();
    let comparison = match variants.first() {
        Some((_, first)) => {
            let task = first.task();
            let declared = VariantMeasure::new(task, Weights::default());
            if variants.iter().all(|(_, variant)| declared.takes(variant)) {
                let weights = lay_over(Weights::of_task(task))?;
                Comparison::Declared(Box::new(VariantMeasure::new(task, weights)))
            } else {
                Comparison::Drawn(Worlds::new(&draw(variants, &asked)?, lay_over(Weights::default())?))
            }
        }
        None => Comparison::Drawn(Worlds::new(&[], Weights::default())),
    };
    match comparison {
        Comparison::Declared(measure) => {
            let apart = |a: usize, b: usize| {
                asked()?;
                Ok::<_, DistancesError>(measure.between(&variants[a].1, &variants[b].1)?.total)
            };
            Ok(DistanceMatrix::measure(labels, apart)?.with_properties(measure.properties()))
        }
        Comparison::Drawn(worlds) => {
            let count = NUM_WORLDS as usize;
            let apart = |a: usize, b: usize| {
                asked()?;
                let each = (0..count).map(|k| worlds.distance(a * count + k, b * count + k));
                Ok::<_, DistancesError>(each.sum::<f64>() / count as f64)
            };
            DistanceMatrix::measure(labels, apart)
        }
    }
}

/// [`NUM_WORLDS`] worlds of each, one variant after the other.
fn draw(
    variants: &[(String, Variant)],
    asked: &impl Fn() -> Result<(), DistancesError>,
) -> Result<Vec<World>, DistancesError> {
    let mut worlds = Vec::with_capacity(variants.len() * NUM_WORLDS as usize);
    for (_, variant) in variants {
        asked()?;
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
        assert!(found.properties().is_metric());
        assert!(found.get(0, 1) > 0.0 && found.get(0, 2) > found.get(0, 1));
    }

    #[test]
    fn measuring_is_given_up_when_it_is_no_longer_wanted() {
        for names in [
            ["find_objects#blue", "find_objects#red"],
            ["find_objects#blue", "get_to_goal#plain"],
        ] {
            let variants = names.map(|name| (name.to_owned(), tasks::variant(name).expect("it is built in")));
            let found = variant_matrix_while(&variants, Ok, || false);
            assert!(matches!(found, Err(DistancesError::Interrupted)), "{names:?}");
        }
    }

    #[test]
    fn a_variant_is_compared_with_a_world_by_worlds() {
        let variant = tasks::variant("find_objects#blue").expect("it is built in");
        let world = Side::World(Box::new(Sampler::new(&variant, 0).world(0).expect("it can be drawn")));
        let (variant, sample) = (Side::Variant(variant), Sample::default());
        let (distance, how) = between(&variant, &world, &sample, Ok).expect("both can be measured");
        assert!(distance.total > 0.0 && how.starts_with("mean of 16 worlds"), "{how}");
        assert_eq!(
            between(&world, &world, &sample, Ok)
                .expect("both can be measured")
                .0
                .total,
            0.0
        );
        let last = Sample {
            index: u64::MAX,
            ..sample
        };
        assert!(matches!(
            between(&variant, &world, &last, Ok),
            Err(DistancesError::TooFar { .. })
        ));
    }

    #[test]
    fn variants_of_several_tasks_are_compared_by_their_worlds() {
        let found = matrix(&["find_objects#blue", "find_objects#red", "get_to_goal#plain"]);
        assert!(!found.properties().is_metric());
        assert!(found.get(0, 1) < found.get(0, 2));
        assert_eq!(matrix(&[]).len(), 0);
    }
}
