//! Distances between two of variants and worlds, and every distance among variants, of one task or of several. The measures are
//! `similarity`'s, worlds are drawn by `generator`.

use driftworld_generator::{GeneratorError, Sampler};
use driftworld_similarity::{
    Distance, DistanceMatrix, SimilarityError, VariantMeasure, Weights, Worlds, world_rewards_distance,
    world_sets_distance, world_sets_rewards_distance,
};
use driftworld_spec::{Variant, World};
use strum::VariantNames as _;

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
    #[error("worlds: found index {index} and {worlds} worlds, expected a sum below 2^64; start at a smaller index")]
    TooFar {
        /// The number of the first world.
        index: u64,
        /// How many worlds.
        worlds: u64,
    },
    /// What two are to be compared by has no meaning for them, or nobody said by what.
    #[error("by: found {found}, expected {expected}")]
    By {
        /// What was asked for, and of what.
        found: String,
        /// What would do.
        expected: &'static str,
    },
    /// Whoever asked for the distances no longer wants them.
    #[error("measuring was interrupted")]
    Interrupted,
}

/// By what two are compared.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, strum::IntoStaticStr, strum::EnumString, strum::VariantNames,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum By {
    /// Variants of one task, by what it declares: 1 is one parameter moved over its whole range.
    Parameters,
    /// Anything, by what is in its worlds, in the units of `docs/reference/comparison.md`.
    Worlds,
    /// Anything, by what its worlds reward (EPIC), 0 to 1.
    Rewards,
}

impl By {
    /// The name that the command, Python and files have for it.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The one of this name.
    ///
    /// # Errors
    /// What was found, and the names there are.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let names = Self::VARIANTS.join(", ");
        name.parse()
            .map_err(|_| format!("found {name:?}, expected one of {names}"))
    }

    /// What variants can be compared by whatever they are: parameters if all are of one task, else worlds.
    pub fn fitting<'a>(variants: impl IntoIterator<Item = &'a Variant>) -> Self {
        let mut variants = variants.into_iter();
        let Some(first) = variants.next() else {
            return Self::Parameters;
        };
        if variants.all(|variant| variant.task().is_same_as(first.task())) {
            Self::Parameters
        } else {
            Self::Worlds
        }
    }
}

const NAME_IT: &str = "what they are compared by: worlds or rewards; parameters compare variants of one task";

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
    /// By what; by default what the two can be compared by: parameters for two variants of one task, else worlds.
    pub by: Option<By>,
    /// How many of each, from 1; by default [`NUM_WORLDS`], and variants of one task are compared by what they declare.
    pub worlds: Option<u64>,
    /// The seed; default 0.
    pub seed: u64,
    /// The number of the first; default 0.
    pub index: u64,
}

/// How far apart two are, and how they were compared.
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
/// let (distance, comparison) = between(&a, &b, &Sample::default(), Ok)?;
/// assert!(distance.total > 0.0);
/// assert_eq!(comparison, "parameter by parameter");
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
    let by = sample.by.unwrap_or(match (task, sample.worlds) {
        (Some(_), None) => By::Parameters,
        _ => By::Worlds,
    });
    if by == By::Parameters {
        let Some((a, b)) = task else {
            return Err(DistancesError::By {
                found: "parameters, for what are not two variants of one task".to_owned(),
                expected: "worlds or rewards",
            });
        };
        let distance = VariantMeasure::new(a.task(), weights).between(a, b)?;
        return Ok((distance, "parameter by parameter".to_owned()));
    }
    // Two worlds are one pair, however many are asked for.
    let are_worlds = matches!((a, b), (Side::World(_), Side::World(_)));
    let count = if are_worlds {
        1
    } else {
        sample.worlds.unwrap_or(NUM_WORLDS)
    };
    let (a, b) = (sample.of(a, count)?, sample.of(b, count)?);
    let (distance, what) = if by == By::Rewards {
        (world_sets_rewards_distance(&a, &b, &weights)?, "rewards")
    } else {
        (world_sets_distance(&a, &b, &weights)?, "worlds")
    };
    let comparison = match (are_worlds, what) {
        (true, "worlds") => "world to world".to_owned(),
        (true, _) => "by the rewards of both worlds".to_owned(),
        (false, _) => {
            let plural = if count == 1 { "" } else { "s" };
            let by = if what == "rewards" { " by their rewards" } else { "" };
            format!(
                "mean of {count} world{plural} of each{by}, drawn under seed {}",
                sample.seed
            )
        }
    };
    Ok((distance, comparison))
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

/// Every distance among variants, each under the name it is called by; in parallel.
///
/// By parameters at the weights that the task declares and with `lay_over` laid over them; the matrix is a metric where the
/// task's measures are. By worlds or rewards, [`NUM_WORLDS`] of each are drawn under seed 0, and the first is compared with
/// the first and so on. So the distance of two depends on them and on `by`, and on nothing else in the list.
///
/// # Errors
/// [`DistancesError::By`] for parameters of variants of several tasks, [`DistancesError::Generator`] for worlds that cannot be
/// drawn, [`DistancesError::Similarity`] for too many variants or what `lay_over` says.
///
/// # Example
/// ```
/// use driftworld::distances::{By, variant_matrix};
/// use driftworld::tasks;
/// let named = |name: &str| Ok::<_, tasks::TaskError>((name.to_owned(), tasks::variant(name)?));
/// let variants = [named("find_objects#blue")?, named("find_objects#dusk")?];
/// let matrix = variant_matrix(&variants, Some(By::Parameters), Ok)?;
/// assert!(matrix.get(0, 1) > 0.0 && matrix.properties().is_metric());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn variant_matrix(
    variants: &[(String, Variant)],
    by: Option<By>,
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    variant_matrix_while(variants, by, lay_over, || true)
}

/// The same for variants with the names of their tasks, under labels such as `find_objects#red`.
///
/// # Errors
/// As [`variant_matrix`].
pub fn labelled_matrix(
    variants: &[(String, Variant)],
    by: Option<By>,
    lay_over: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<DistanceMatrix, DistancesError> {
    let label = |(task, variant): &(String, Variant)| (format!("{task}#{}", variant.name()), variant.clone());
    variant_matrix(&variants.iter().map(label).collect::<Vec<_>>(), by, lay_over)
}

/// The same, and given up as soon as `go_on`, which is asked before each pair, says no. `by`: parameters if absent.
///
/// # Errors
/// As [`variant_matrix`]; [`DistancesError::Interrupted`] if it was given up.
pub fn variant_matrix_while(
    variants: &[(String, Variant)],
    by: Option<By>,
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
    let labels: Vec<String> = variants.iter().map(|(label, _)| label.clone()).collect();
    let of_one_task = By::fitting(variants.iter().map(|(_, variant)| variant)) == By::Parameters;
    let by = by.unwrap_or(By::Parameters);
    if by == By::Parameters && !of_one_task {
        return Err(DistancesError::By {
            found: "variants of several tasks".to_owned(),
            expected: NAME_IT,
        });
    }
    let task = variants.first().filter(|_| of_one_task).map(|(_, first)| first.task());
    let weights = lay_over(task.map_or_else(Weights::default, |task| Weights::of_task(task)))?;
    if let (By::Parameters, Some(task)) = (by, task) {
        let measure = VariantMeasure::new(task, weights);
        let apart = |a: usize, b: usize| {
            asked()?;
            Ok::<_, DistancesError>(measure.between(&variants[a].1, &variants[b].1)?.total)
        };
        return Ok(DistanceMatrix::measure(labels, apart)?.with_properties(measure.properties()));
    }
    let drawn = draw(variants, &asked)?;
    let count = NUM_WORLDS as usize;
    let pairs = |a: usize, b: usize| (0..count).map(move |k| (a * count + k, b * count + k));
    if by == By::Rewards {
        let weight = weights.of(driftworld_spec::Element::R);
        let apart = |a: usize, b: usize| {
            let mut sum = 0.0;
            for (a, b) in pairs(a, b) {
                asked()?;
                sum += weight * world_rewards_distance(&drawn[a], &drawn[b], None)?;
            }
            Ok::<_, DistancesError>(sum / count as f64)
        };
        return DistanceMatrix::measure(labels, apart);
    }
    let worlds = Worlds::new(&drawn, weights);
    let apart = |a: usize, b: usize| {
        asked()?;
        Ok::<_, DistancesError>(pairs(a, b).map(|(a, b)| worlds.distance(a, b)).sum::<f64>() / count as f64)
    };
    DistanceMatrix::measure(labels, apart)
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
mod tests;
