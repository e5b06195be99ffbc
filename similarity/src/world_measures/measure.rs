//! [`WorldMeasure`]: single measures between two worlds, by name.

use driftworld_spec::{Element, World};

use super::colors;
use super::objects::{counts_of, ospa_between};
use super::occupancy::{between_taken_cells, earth_movers};
use crate::scalar::counts_distance;
use crate::{
    ColorMeasure, MetricProperties, Raster, SimilarityError, grid_chamfer_distance, grid_hausdorff_distance,
    grid_jaccard_distance,
};

/// A single measure of the distance between two worlds, while [`world_distance`](crate::world_distance) adds up all their
/// differences.
///
/// The number depends on the two worlds alone, not on the order of their objects, and is finite, at least 0, 0 between a world
/// and itself, and symmetric to the last bit. Two worlds without objects are 0 apart; each measure documents its value if only
/// one has objects.
///
/// Measures of *occupancy* compare the positions of objects, each class separately. Both worlds become grids of square cells
/// that cover both arenas, so the grids depend on the pair alone; objects outside both arenas are ignored. A cell is 1 m wide,
/// or 2, 4, 8 m and so on if all classes together would take more than [`MAX_CELLS`](crate::MAX_CELLS). The *diameter* is the
/// distance between the centres of opposite corner cells. Measures of *objects* use each object's class and position. The case
/// of a class is ignored.
///
/// # Example
/// ```
/// use driftworld_similarity::{ColorMeasure, WorldMeasure};
/// use driftworld_spec::{Color, Object, World};
/// let world = |x: f64, color: &str| {
///     let tree = Object { color: Color::from_name(color), ..Object::new("tree", [x, 0.0]) };
///     World::default().edit(|world| world.objects.push(tree))
/// };
/// let (a, b) = (world(0.2, "black")?, world(4.9, "white")?);
/// let between = |measure: WorldMeasure| measure.between(&a, &b);
/// // From the centre of one cell of 1 m to the centre of another.
/// assert_eq!(between(WorldMeasure::EarthMovers)?, 4.0);
/// assert_eq!(between(WorldMeasure::Ospa)?, 4.7);
/// assert!((between(WorldMeasure::Colors(ColorMeasure::Oklab))? - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WorldMeasure {
    /// Occupancy: [`grid_earth_movers_distance`](crate::grid_earth_movers_distance), the mean distance in metres by which a
    /// class must be moved, independent of its number of objects; exact. Classes are added up. A class that only one world has
    /// counts as the diameter, so a world without objects is one diameter per class from any other. In `0..=` diameter ·
    /// classes.
    EarthMovers,
    /// Occupancy: [`grid_jaccard_distance`], the share of taken cells that are not taken in both, in `0..=1`. 1 if only
    /// one world has objects.
    Jaccard,
    /// Occupancy: [`grid_hausdorff_distance`], the largest distance in metres from a taken cell to the nearest cell of the same
    /// class in the other world, in `0..=` diameter; the diameter if a class is in one world only.
    Hausdorff,
    /// Occupancy: [`grid_chamfer_distance`], the mean of these distances. The diameter if only one world has objects.
    Chamfer,
    /// Objects: [`ospa`](crate::ospa) with a cut-off of 10 m, the mean distance, in metres in `0..=10`, from an object to its
    /// counterpart of the same class. An object without one counts as 10 m, as does one that is farther away. 10 if only one
    /// world has objects.
    Ospa,
    /// Objects: [`counts_distance`], the share of objects without a counterpart of their class, ignoring positions, in
    /// `0..=1`. 1 if only one world has objects.
    Counts,
    /// The colours of objects that have one, ignoring positions: the mean distance of the best pairing, as a share of the
    /// distance between the two farthest colours, in `0..=1`. A colour without a counterpart counts as 1, so a world with
    /// colours and a world without any are 1 apart. Objects that look like their model are left out.
    Colors(ColorMeasure),
}

impl WorldMeasure {
    /// All measures, grouped by kind.
    pub fn all() -> impl Iterator<Item = Self> {
        use WorldMeasure::{Chamfer, Counts, EarthMovers, Hausdorff, Jaccard, Ospa};
        let others = [EarthMovers, Jaccard, Hausdorff, Chamfer, Ospa, Counts];
        others
            .into_iter()
            .chain(ColorMeasure::ALL.iter().map(|own| Self::Colors(*own)))
    }

    /// The measure with this kind and name, or the kind's default without a name, if there is one.
    pub fn from_name(kind: &str, name: Option<&str>) -> Option<Self> {
        let defaults = [Self::EarthMovers, Self::Ospa, Self::Colors(ColorMeasure::Oklab)];
        let matches = |own: &Self| name.map_or(defaults.contains(own), |name| own.name() == name);
        Self::all().find(|own| own.kind() == kind && matches(own))
    }

    /// The kind of things compared: "occupancy", "objects" or "colors".
    pub fn kind(self) -> &'static str {
        match self {
            Self::EarthMovers | Self::Jaccard | Self::Hausdorff | Self::Chamfer => "occupancy",
            Self::Ospa | Self::Counts => "objects",
            Self::Colors(_) => "colors",
        }
    }

    /// Its name within its kind, in documents and on the command line: the first word of its label.
    pub fn name(self) -> &'static str {
        self.label().split(' ').next().unwrap_or_default()
    }

    /// The element of the decision process that it belongs to: the state, or the observation for colours.
    pub fn element(self) -> Element {
        match self {
            Self::Colors(_) => Element::O,
            _ => Element::S,
        }
    }

    /// The metric properties of the measure; for occupancy, only among worlds of the same arena, see
    /// [`WorldMeasure::properties_among`]. None is a metric, because each considers only part of a world.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::Chamfer => MetricProperties::Distance,
            Self::Colors(own) if !own.properties().keeps_triangles() => MetricProperties::Distance,
            _ => MetricProperties::Pseudometric,
        }
    }

    /// The metric properties of the measure among these worlds. If arenas differ, or there are so many classes that some pairs
    /// need larger cells than others, occupancy has different cells and diameters for each pair, and the triangle inequality
    /// may fail.
    pub fn properties_among<'a>(self, worlds: impl IntoIterator<Item = &'a World>) -> MetricProperties {
        let worlds: Vec<&World> = worlds.into_iter().collect();
        let Some(first) = worlds.first().filter(|_| self.kind() == "occupancy") else {
            return self.properties();
        };
        let arena = |world: &World| world.environment_params.arena_size();
        let cell = |raster: Result<Raster, SimilarityError>| raster.map(|raster| raster.shape().cell());
        let has_one_arena = worlds.iter().all(|other| arena(other) == arena(first));
        if has_one_arena && cell(Raster::fitting(&[*first])) == cell(Raster::fitting(&worlds)) {
            self.properties()
        } else {
            MetricProperties::Distance
        }
    }

    /// The distance between two worlds, in the unit of [`WorldMeasure::label`]. Takes microseconds to milliseconds.
    ///
    /// # Errors
    /// [`SimilarityError::TooMany`] for more than [`MAX_ASSIGNED`](crate::MAX_ASSIGNED) objects (`ospa`, colours), or
    /// for more than [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) cells of a class that must send or receive mass (the earth
    /// mover's distance).
    pub fn between(self, a: &World, b: &World) -> Result<f64, SimilarityError> {
        match self {
            Self::EarthMovers => earth_movers(a, b),
            Self::Jaccard => between_taken_cells(a, b, grid_jaccard_distance),
            Self::Hausdorff => between_taken_cells(a, b, grid_hausdorff_distance),
            Self::Chamfer => between_taken_cells(a, b, grid_chamfer_distance),
            Self::Ospa => ospa_between(a, b),
            Self::Counts => Ok(counts_distance(&counts_of(a), &counts_of(b))),
            Self::Colors(own) => colors::between(a, b, own),
        }
    }

    /// The name and the unit, for a part of a distance.
    pub fn label(self) -> &'static str {
        match self {
            Self::EarthMovers => "earth_movers in metres",
            Self::Jaccard => "jaccard in shares of taken cells",
            Self::Hausdorff => "hausdorff in metres",
            Self::Chamfer => "chamfer in metres",
            Self::Ospa => "ospa in metres",
            Self::Counts => "counts in shares of objects",
            Self::Colors(ColorMeasure::Srgb) => "srgb / farthest colours",
            Self::Colors(ColorMeasure::Cie76) => "cie76 / farthest colours",
            Self::Colors(ColorMeasure::Ciede2000) => "ciede2000 / farthest colours",
            Self::Colors(ColorMeasure::Oklab) => "oklab / farthest colours",
            Self::Colors(ColorMeasure::Hyab) => "hyab / farthest colours",
        }
    }
}
