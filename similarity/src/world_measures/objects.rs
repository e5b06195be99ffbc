//! [`ObjectsMeasure`]: how far apart two worlds are by which objects there are. Where cells matter, not objects, see
//! `occupancy.rs`.

use std::collections::BTreeMap;

use driftworld_spec::World;
use strum::VariantArray;

use crate::scalar::counts_distance;
use crate::{MetricProperties, SimilarityError, ospa};

/// Metres that a missing object counts: what distances of worlds set against one object, too.
const CUT_OFF: f64 = 10.0;

/// A way to say how far apart two worlds are by their objects, each a class and a place. The case of a class does not
/// matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::EnumString, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
pub enum ObjectsMeasure {
    /// [`ospa`] with a cut-off of 10 m: the mean way, in metres in `0..=10`, from an object to its
    /// counterpart of the same class. An object without one counts 10 m, as does one that is farther away. Of an empty
    /// world and any other it is 10.
    #[default]
    Ospa,
    /// [`counts_distance`]: the share of objects without a counterpart of their class, wherever they stand, in `0..=1`.
    /// Of an empty world and any other it is 1.
    Counts,
}

impl ObjectsMeasure {
    /// All of them.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Its name in documents and on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The measure of this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// What its number is in.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Ospa => "metres",
            Self::Counts => "share of objects",
        }
    }

    /// Which laws it keeps: worlds that differ in anything but the classes and places of objects are 0 apart.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::Ospa | Self::Counts => MetricProperties::Pseudometric,
        }
    }

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Ospa => "ospa in metres",
            Self::Counts => "counts in shares of objects",
        }
    }

    pub(super) fn between(self, a: &World, b: &World) -> Result<f64, SimilarityError> {
        match self {
            Self::Ospa => {
                let (a, b) = (places(a), places(b));
                // One of both ways, so that it is as far there as back to the last bit.
                let (a, b) = if a > b { (b, a) } else { (a, b) };
                ospa(&a, &b, CUT_OFF)
            }
            Self::Counts => Ok(counts_distance(&counts(a), &counts(b))),
        }
    }
}

/// Class and place of each object, in an order of their own.
fn places(world: &World) -> Vec<(String, [f64; 2])> {
    let objects = world.objects.iter();
    let mut places: Vec<_> = objects
        .map(|object| (object.class.to_lowercase(), object.coordinates))
        .collect();
    places.sort_by(|a, b| a.partial_cmp(b).expect("places are numbers"));
    places
}

fn counts(world: &World) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    for object in &world.objects {
        *counts.entry(object.class.to_lowercase()).or_default() += 1;
    }
    counts
}
