//! Measures distances between two variants or worlds, and all distances among variants of one task or of several.

mod matrix;
mod pairs;

use driftworld_env::{Catalogue, EnvError};
use driftworld_generator::{GeneratorError, Sampler};
use driftworld_similarity::{
    Distance, Placements, SimilarityError, VariantMeasure, Weights, world_sets_distance, world_sets_measure_distance,
};
pub use driftworld_spec::By;
use driftworld_spec::{Element, Variant, World};
use driftworld_text::counted;
use strum::VariantNames as _;

use crate::behavior::MAX_BEHAVIOR_WORLDS;
pub use matrix::{labelled_matrix, variant_matrix, variant_matrix_while};
use pairs::{Means, Pairs};

/// Default number of worlds compared per variant by fast measures.
pub const NUM_WORLDS: u64 = 16;

/// Default number of worlds compared per variant by pictures and by dynamics, which are slower.
pub const NUM_SLOW_WORLDS: u64 = 4;

/// Default number of worlds compared per variant by placements. Small samples overestimate the distance between distributions of
/// positions.
pub const NUM_PLACED_WORLDS: u64 = 64;

/// Errors raised while comparing variants or worlds.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DistancesError {
    /// A world of a variant cannot be drawn.
    #[error(transparent)]
    Generator(#[from] GeneratorError),
    /// Too many variants, or an invalid weight.
    #[error(transparent)]
    Similarity(#[from] SimilarityError),
    /// A world cannot be run.
    #[error(transparent)]
    Env(#[from] EnvError),
    /// No position from which to compare pictures is free in every world.
    #[error(
        "pictures: found none of {tried} places free in all worlds, expected at least 1; if the worlds' walls are in different \
         places, as in mazes of different sizes, compare by worlds or by parameters"
    )]
    NoPlace {
        /// Number of positions tried.
        tried: u32,
    },
    /// The indices of the worlds to compare exceed the largest possible one.
    #[error("worlds: found index {index} and {worlds} worlds, expected a sum below 2^64; start at a smaller index")]
    TooFar {
        /// The index of the first world.
        index: u64,
        /// Number of worlds.
        worlds: u64,
    },
    /// The measure is not applicable, or none was given.
    #[error("by: found {found}, expected {expected}")]
    By {
        /// The request.
        found: String,
        /// The applicable measures.
        expected: &'static str,
    },
    /// The caller cancelled the measurement.
    #[error("measuring was interrupted")]
    Interrupted,
}

const OTHER_MEASURES: &str = "worlds, pictures, occupancy, placements, objects, colors, rewards, dynamics or behavior";

const MEASURE_REQUIRED: &str = "a measure to compare them by: worlds, pictures, occupancy, placements, objects, colors, rewards, \
     dynamics or behavior; parameters compare variants of one task";

/// The default measure for some variants: the measure declared by their common task, or worlds if they belong to several tasks.
pub fn fitting<'a>(variants: impl IntoIterator<Item = &'a Variant>) -> By {
    let mut variants = variants.into_iter();
    let Some(first) = variants.next() else {
        return By::Parameters;
    };
    if variants.all(|variant| variant.task().is_same_as(first.task())) {
        first.task().compare_by()
    } else {
        By::Worlds
    }
}

/// One of the two sides of a comparison.
#[derive(Clone, Debug)]
pub enum Side {
    /// A world.
    World(Box<World>),
    /// A variant.
    Variant(Variant),
}

/// The measure, and the worlds drawn for it.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// The measure; by default the one declared by the variants' common task (parameters if it declares none), else worlds.
    pub by: Option<By>,
    /// Worlds per side, from 1; by default [`NUM_WORLDS`], [`NUM_SLOW_WORLDS`] by pictures and dynamics,
    /// [`NUM_PLACED_WORLDS`] by placements. If given, the default is never parameters.
    pub worlds: Option<u64>,
    /// The seed; default 0.
    pub seed: u64,
    /// The index of the first world; default 0.
    pub index: u64,
    /// The unit; [`Scale::Share`] is possible for parameters only.
    pub scale: Scale,
    /// The worlds' assets, which pictures, dynamics and behavior depend on; by default the built-in ones.
    pub catalogue: Catalogue,
}

/// The unit of distances by parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::EnumString, strum::VariantNames, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Scale {
    /// 1 is one parameter moved over its whole range.
    #[default]
    Units,
    /// 1 is the diameter of the task: all parameters moved over their whole ranges. In `0..=1`, except for random parameters,
    /// whose joint distance may be larger than the sum of their separate distances.
    Share,
}

impl Scale {
    /// The scale with this name.
    ///
    /// # Errors
    /// If no scale has this name; the message lists the expected names.
    pub fn from_name(name: &str) -> Result<Self, String> {
        let names = Self::VARIANTS.join(" or ");
        name.parse().map_err(|_| format!("found {name:?}, expected {names}"))
    }
}

impl Sample {
    /// All defaults, with this measure.
    pub fn by(by: By) -> Self {
        Self {
            by: Some(by),
            ..Self::default()
        }
    }

    /// The measure: the requested one, or else the `usual` one, but never parameters if a number of worlds is given.
    pub(crate) fn measure(&self, usual: By) -> By {
        self.by.unwrap_or(match usual {
            By::Parameters if self.worlds.is_some() => By::Worlds,
            usual => usual,
        })
    }

    /// Refuses [`Scale::Share`] for a measure without a diameter.
    fn check_scale(&self, by: By) -> Result<(), DistancesError> {
        if self.scale == Scale::Units || by == By::Parameters {
            return Ok(());
        }
        Err(DistancesError::By {
            found: format!("{}, as a share", by.name()),
            expected: "parameters: a task has a diameter, worlds have none; or leave out the scale",
        })
    }

    /// Number of worlds compared by this measure.
    fn count(&self, by: By) -> u64 {
        let default = match by.subject() {
            "pictures" | "dynamics" => NUM_SLOW_WORLDS,
            "placements" => NUM_PLACED_WORLDS,
            _ => NUM_WORLDS,
        };
        self.worlds.unwrap_or(default)
    }

    /// Refuses more worlds than a slow measure can compare in a reasonable time.
    fn check_count(by: By, count: u64) -> Result<(), DistancesError> {
        let is_slow = matches!(by.subject(), "behavior" | "dynamics" | "pictures");
        if !is_slow || count <= MAX_BEHAVIOR_WORLDS {
            return Ok(());
        }
        Err(DistancesError::By {
            found: format!("{count} worlds by {}", by.name()),
            expected: "at most 1000 worlds",
        })
    }

    /// Worlds of a variant.
    fn draw(&self, variant: &Variant, count: u64) -> Result<Vec<World>, DistancesError> {
        let sampler = Sampler::new(variant, self.seed);
        let end = self.index.checked_add(count).ok_or(DistancesError::TooFar {
            index: self.index,
            worlds: count,
        })?;
        let worlds = (self.index..end).map(|index| sampler.world(index));
        Ok(worlds.collect::<Result<_, _>>()?)
    }

    /// Worlds of a variant; a single world is repeated `count` times.
    fn of(&self, side: &Side, count: u64) -> Result<Vec<World>, DistancesError> {
        match side {
            Side::World(world) => Ok((0..count).map(|_| (**world).clone()).collect()),
            Side::Variant(variant) => self.draw(variant, count),
        }
    }
}

/// The distance between two variants or worlds, and how they were compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// The distance.
    pub distance: Distance,
    /// The measure.
    pub by: By,
    /// The measure, the number of worlds, and further notes on the distance, as text.
    pub description: String,
}

/// Measures the distance between two variants or worlds.
///
/// Two variants of one task are compared by the measure that their task declares, by default parameters, unless
/// `sample` requests another; two worlds directly; anything else by worlds drawn under one seed and paired by index.
/// `reweigh` overrides the weights that the task declares. `behavior` and `dynamics:bisimulation` compare the whole
/// decision process: they have no elements and no weights.
///
/// # Errors
/// [`DistancesError::Generator`] for worlds that cannot be drawn, [`DistancesError::Similarity`] from `reweigh`,
/// [`DistancesError::TooFar`], [`DistancesError::By`] for parameters of different tasks, [`DistancesError::Env`] for
/// worlds that cannot be run or rendered, [`DistancesError::NoPlace`] for worlds without a common position by pictures.
///
/// # Example
/// ```
/// use driftworld::distances::{By, Sample, Side, between};
/// use driftworld::tasks;
/// let side = |name: &str| Ok::<_, tasks::TaskError>(Side::Variant(tasks::variant(name)?));
/// let (a, b) = (side("find_objects#blue")?, side("find_objects#dusk")?);
/// let found = between(&a, &b, &Sample::default(), Ok)?;
/// assert!(found.distance.total > 0.0);
/// assert_eq!(found.description, "by parameters");
/// let found = between(&a, &b, &Sample::by(By::Rewards), Ok)?;
/// assert_eq!(found.description, "by rewards, mean of 16 worlds of each drawn under seed 0");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn between(
    a: &Side,
    b: &Side,
    sample: &Sample,
    reweigh: impl FnOnce(Weights) -> Result<Weights, SimilarityError>,
) -> Result<Compared, DistancesError> {
    let task = match (a, b) {
        (Side::Variant(a), Side::Variant(b)) if a.task().is_same_as(b.task()) => Some((a, b)),
        _ => None,
    };
    let weights = reweigh(task.map_or_else(Weights::default, |(a, _)| Weights::of_task(a.task())))?;
    let weights_text = weights_note(&weights);
    let by = sample.measure(task.map_or(By::Worlds, |(a, _)| a.task().compare_by()));
    if by == By::Parameters {
        let Some((a, b)) = task else {
            return Err(DistancesError::By {
                found: "parameters, although the two are not variants of one task".to_owned(),
                expected: OTHER_MEASURES,
            });
        };
        let measure = VariantMeasure::new(a.task(), weights);
        let distance = measure.between(a, b)?;
        let diameter = measure.diameter();
        return Ok(match sample.scale {
            Scale::Share if measure.has_diameter() => Compared {
                distance: distance.in_shares_of(diameter),
                by,
                description: format!("by parameters, as a share of the task's diameter of {diameter}{weights_text}"),
            },
            _ => Compared {
                distance,
                by,
                description: format!("by parameters{weights_text}"),
            },
        });
    }
    sample.check_scale(by)?;
    // Two worlds form a single pair, whatever number was requested.
    let are_worlds = matches!((a, b), (Side::World(_), Side::World(_)));
    let are_variants = matches!((a, b), (Side::Variant(_), Side::Variant(_)));
    let count = if are_worlds { 1 } else { sample.count(by) };
    Sample::check_count(by, count)?;
    let (a, b) = (sample.of(a, count)?, sample.of(b, count)?);
    let mut description = format!("by {}", by.name());
    if are_variants && task.is_none() && sample.by.is_none() {
        description += " (two tasks have no parameters in common; the unit differs)";
    }
    if !are_worlds {
        let mean = if by == By::Placements {
            "all places in"
        } else {
            "mean of"
        };
        description = format!(
            "{description}, {mean} {} of each drawn under seed {}",
            counted(count as usize, "world"),
            sample.seed
        );
    }
    let distance = if by == By::Worlds {
        world_sets_distance(&a, &b, &weights)?
    } else if by == By::Placements {
        Placements::of(&a).distance(&Placements::of(&b), &weights)?
    } else if let Some(measure) = pairs::world_measure(by) {
        world_sets_measure_distance(&a, &b, measure, &weights)?
    } else {
        let mut means = Means::new(by);
        for (a, b) in a.into_iter().zip(b) {
            let worlds = [a, b];
            means.add(&Pairs::new(by, &worlds, &sample.catalogue)?.between(0, 1)?);
        }
        description += &means.remark();
        means.distance(&weights)
    };
    if !distance.parts.is_empty() {
        description += &weights_text;
    }
    Ok(Compared {
        distance,
        by,
        description,
    })
}

/// The weights of elements in the total, if not all are 1.
fn weights_note(weights: &Weights) -> String {
    let other = Element::ALL.into_iter().filter(|element| weights.of(*element) != 1.0);
    let other: Vec<String> = other
        .map(|element| format!("{} {}", element.letter(), weights.of(element)))
        .collect();
    if other.is_empty() {
        return String::new();
    }
    format!("; weights of elements in the total: {}", other.join(", "))
}

#[cfg(test)]
mod tests;
