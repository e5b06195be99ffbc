//! [`WorldMeasure`]: one measure between two worlds, by name. What each does is in the files of its kind.

use driftworld_spec::{Element, World};

use super::colors;
use super::objects::ObjectsMeasure;
use super::occupancy::{OccupancyMeasure, raster};
use crate::{ColorMeasure, MetricProperties, Raster, SimilarityError};

/// One measure of how far apart two worlds are, where [`world_distance`](crate::world_distance) adds up all that they
/// differ in.
///
/// The number depends on the two worlds alone, not on the order of their objects, and is finite, at least 0, 0 for a
/// world and itself, and as far there as back, to the last bit. Two worlds without objects are 0 apart; what one
/// without and one with objects are stands with each measure.
///
/// # Example
/// ```
/// use driftworld_similarity::{ColorMeasure, ObjectsMeasure, OccupancyMeasure, WorldMeasure};
/// use driftworld_spec::{Color, Object, World};
/// let world = |x: f64, color: &str| {
///     let tree = Object { color: Color::from_name(color), ..Object::new("tree", [x, 0.0]) };
///     World::default().edit(|world| world.objects.push(tree))
/// };
/// let (a, b) = (world(0.2, "black")?, world(4.9, "white")?);
/// let between = |measure: WorldMeasure| measure.between(&a, &b);
/// // From the centre of a cell of 1 m to that of another.
/// assert_eq!(between(WorldMeasure::Occupancy(OccupancyMeasure::EarthMovers))?, 4.0);
/// assert_eq!(between(WorldMeasure::Objects(ObjectsMeasure::Ospa))?, 4.7);
/// assert!((between(WorldMeasure::Colors(ColorMeasure::Oklab))? - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorldMeasure {
    /// By the cells that objects stand in.
    Occupancy(OccupancyMeasure),
    /// By which objects there are.
    Objects(ObjectsMeasure),
    /// By the colours of the objects that have one, wherever they stand: the mean way of those that go together best,
    /// as a share of the way between the two colours that are farthest apart, in `0..=1`. A colour without a
    /// counterpart counts 1, so worlds without and with colours are 1 apart. Objects that look as their model does are
    /// left out.
    Colors(ColorMeasure),
}

impl WorldMeasure {
    /// All of them, those of a kind together, with its default among them.
    pub fn all() -> impl Iterator<Item = Self> {
        let occupancy = OccupancyMeasure::ALL.iter().map(|own| Self::Occupancy(*own));
        let objects = ObjectsMeasure::ALL.iter().map(|own| Self::Objects(*own));
        let colors = ColorMeasure::ALL.iter().map(|own| Self::Colors(*own));
        occupancy.chain(objects).chain(colors)
    }

    /// What it looks at: "occupancy", "objects" or "colors".
    pub fn kind(self) -> &'static str {
        match self {
            Self::Occupancy(_) => "occupancy",
            Self::Objects(_) => "objects",
            Self::Colors(_) => "colors",
        }
    }

    /// Its name among those of its kind, in documents and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Occupancy(own) => own.name(),
            Self::Objects(own) => own.name(),
            Self::Colors(own) => own.name(),
        }
    }

    /// What its number is in.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Occupancy(own) => own.unit(),
            Self::Objects(own) => own.unit(),
            Self::Colors(_) => "share of the farthest colours",
        }
    }

    /// The element of the decision process that it is about: the state, or the observation for colours.
    pub fn element(self) -> Element {
        match self {
            Self::Occupancy(_) | Self::Objects(_) => Element::S,
            Self::Colors(_) => Element::O,
        }
    }

    /// Which laws it keeps: of occupancy among worlds of one arena, see [`WorldMeasure::properties_among`]. None is a
    /// metric, for each sees but a part of a world.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::Occupancy(own) => own.properties(),
            Self::Objects(own) => own.properties(),
            Self::Colors(own) if own.properties().keeps_triangles() => MetricProperties::Pseudometric,
            Self::Colors(_) => MetricProperties::Distance,
        }
    }

    /// Which laws it keeps among these worlds. Where arenas differ, or the classes of all are so many that cells are
    /// larger for some pairs than for others, occupancy has other cells and another diameter for each pair, and a
    /// detour may be shorter.
    pub fn properties_among<'a>(self, worlds: impl IntoIterator<Item = &'a World>) -> MetricProperties {
        let worlds: Vec<&World> = worlds.into_iter().collect();
        let (Self::Occupancy(_), Some(first)) = (self, worlds.first()) else {
            return self.properties();
        };
        let arena = |world: &World| world.environment_params.arena_size();
        let cell = |raster: Result<Raster, SimilarityError>| raster.map(|raster| raster.shape().cell());
        let has_one_arena = worlds.iter().all(|other| arena(other) == arena(first));
        if has_one_arena && cell(raster(&[*first])) == cell(raster(&worlds)) {
            self.properties()
        } else {
            MetricProperties::Distance
        }
    }

    /// How far apart two worlds are, in [`WorldMeasure::unit`]. Some microseconds to some milliseconds.
    ///
    /// # Errors
    /// [`SimilarityError::TooMany`] for more than [`MAX_ASSIGNED`](crate::MAX_ASSIGNED) objects (`ospa`, colours), or
    /// for more than [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) cells of a class that have to give or take (the earth
    /// mover's distance).
    pub fn between(self, a: &World, b: &World) -> Result<f64, SimilarityError> {
        match self {
            Self::Occupancy(own) => own.between(a, b),
            Self::Objects(own) => own.between(a, b),
            Self::Colors(own) => colors::between(a, b, own),
        }
    }

    /// The name and the unit, for a part of a distance.
    pub fn label(self) -> &'static str {
        match self {
            Self::Occupancy(own) => own.label(),
            Self::Objects(own) => own.label(),
            Self::Colors(ColorMeasure::Srgb) => "srgb / farthest colours",
            Self::Colors(ColorMeasure::Cie76) => "cie76 / farthest colours",
            Self::Colors(ColorMeasure::Ciede2000) => "ciede2000 / farthest colours",
            Self::Colors(ColorMeasure::Oklab) => "oklab / farthest colours",
            Self::Colors(ColorMeasure::Hyab) => "hyab / farthest colours",
        }
    }
}
