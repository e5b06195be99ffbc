//! The agent's surroundings: the arena, its walls and the light.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::fields;
use super::looks::LooksForm;
use super::region::{Region, encloses};
use super::{Looks, Zone};
use crate::layout::{Layout, Plan};
use crate::serde_defaults::is_default;
use crate::{Color, maps};

fields! {
    /// The arena and its light.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "map_size": [60, 60], "light_intensity": 2.3, "bounding_wall_color": [0.7, 0.7, 0.6] },
    ]))]
    pub struct EnvironmentParams {
        /// Colour of the walls around the arena and of the regions that cannot be entered.
        pub bounding_wall_color: Color = Color([0.72, 0.68, 0.60])
            => Field::original(Measured(&[ColorsOfSurroundings])),
        /// Brightness of the sun: 2.3 to 3.5 reads as day, 0.2 as dusk.
        #[schemars(range(min = 0.0, max = 100.0))]
        pub light_intensity: f64 = 2.3 => Field::original(Measured(&[Light])),
        /// Number of the arena: 0 is empty, of size `map_size`; 1 backslash, 2 village, 3 craters and 4 bisected are 200 × 200
        /// m.
        #[schemars(range(min = 0, max = 4))]
        pub predefined_map: u8 = 0 => Field::original(Measured(&[MapAndWalls, ArenaSize])),
        /// Regions of the predefined map that cannot be entered, from a maps file, replacing the built-in layout with that
        /// number: polygons in metres, with corners in order; the last corner connects to the first.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(max = 1000))]
        pub map_regions: Option<Vec<Region>> = None => Field::ours(Leaves(MapAndWalls)).unit("m"),
        /// Side lengths of the arena along x and y in metres, centred on the origin; ignored when a map is chosen.
        #[schemars(inner(range(min = 0.0, max = 300.0)))]
        pub map_size: [f64; 2] = [100.0, 100.0] => Field::original(Measured(&[ArenaSize])).unit("m"),
        /// Height of the walls in metres.
        #[schemars(range(min = 0.0, max = 50.0))]
        pub wall_height: f64 = 4.0 => Field::ours(Leaves(CameraAndWeather)).unit("m"),
        /// Regions that cannot be entered, in addition to those of the map.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 1000))]
        pub walls: Vec<Wall> = Vec::new() => Field::ours(Leaves(MapAndWalls)),
        /// Direction towards the sun (x east, y north, z up), of any length except 0.
        #[schemars(inner(range(min = -1e6, max = 1e6)))]
        pub sun_direction: [f64; 3] = [0.45, -0.35, 0.82] => Field::ours(Leaves(CameraAndWeather)),
        /// Colour of the sunlight.
        pub light_color: Color = Color([1.0, 0.97, 0.9]) => Field::ours(Measured(&[ColorsOfSurroundings])),
        /// Share of the light that is ambient and reaches all surfaces equally, 0..1.
        #[schemars(range(min = 0.0, max = 1.0))]
        pub ambient_light: f64 = 0.35 => Field::ours(Leaves(CameraAndWeather)),
        /// Colour of the sky at the zenith; it pales towards the horizon.
        pub sky_color: Color = Color([0.36, 0.62, 0.9]) => Field::ours(Measured(&[ColorsOfSurroundings])),
        /// Colour of the ground.
        pub ground_color: Color = Color([0.45, 0.56, 0.34]) => Field::ours(Measured(&[ColorsOfSurroundings])),
        /// Distance in metres at which fog, in the colour of the horizon, hides half of the view; no fog if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.1, max = 10_000.0))]
        pub fog_distance: Option<f64> = None => Field::ours(Leaves(CameraAndWeather)).unit("m"),
        /// Parts of the ground that affect the agent inside them: they pay, change its speed, end the episode or teleport it.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        #[schemars(length(max = 1000))]
        pub zones: Vec<Zone> = Vec::new() => Field::ours(Measured(&[Zones, ZonePay, ZoneLooks])),
        /// The walls that divide the arena: a maze, rooms, a map drawn with letters, a predefined map, or a list of walls. All
        /// but a list of walls set the size of the arena, overriding `map_size`. Not together with a `predefined_map`.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub layout: Option<Layout> = None => Field::ours(Measured(&[Layouts])).layout(),
        /// The style in which the world is drawn: `"plain"`, `"natural"`, or an object that also sets the surfaces of the
        /// ground and walls, shadows and a ceiling.
        #[serde(skip_serializing_if = "is_default")]
        #[schemars(with = "LooksForm")]
        pub looks: Looks = Looks::default() => Field::ours(Measured(&[CameraAndWeather, ColorsOfSurroundings])),
    }
}

impl EnvironmentParams {
    /// Side lengths of the arena in metres: the layout's if it sets them, otherwise `map_size`, or 200 × 200 for a predefined
    /// map.
    pub fn arena_size(&self) -> [f64; 2] {
        if let Some(size) = self.layout.as_ref().and_then(Layout::size) {
            size
        } else if self.predefined_map == 0 {
            self.map_size
        } else {
            [200.0, 200.0]
        }
    }

    /// The number of the predefined map, from the layout if it is one, otherwise `predefined_map`.
    pub fn map(&self) -> u8 {
        let own = self.layout.as_ref().and_then(|layout| layout.predefined);
        own.unwrap_or(self.predefined_map)
    }

    /// The regions of the map that cannot be entered: from a maps file, otherwise from the built-in map. They include neither
    /// `walls` nor the walls of the layout, which are in the plan of a checked [`World`](crate::World).
    pub fn regions(&self) -> Vec<&[[f64; 2]]> {
        let regions = match &self.map_regions {
            // The plan of a layout that is a predefined map already contains them.
            _ if self.layout.as_ref().is_some_and(|layout| layout.predefined.is_some()) => &[],
            Some(regions) => regions.as_slice(),
            None => maps::excluded_regions(self.predefined_map),
        };
        regions.iter().map(|region| region.0.as_slice()).collect()
    }

    /// Whether a point is inside the outer walls.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let [width, depth] = self.arena_size();
        x.abs() <= width / 2.0 && y.abs() <= depth / 2.0
    }

    /// The wall or region of the map that contains a point in metres, by the even-odd rule; `None` on free ground. `plan` is the
    /// layout's, if there is one; [`World::enclosure`](crate::World::enclosure) passes it.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::EnvironmentParams;
    /// let village = EnvironmentParams { predefined_map: 2, ..EnvironmentParams::default() };
    /// let house = village.enclosure([-70.0, 60.0], None).expect("a house stands there");
    /// assert_eq!(house.to_string(), "region 1 of 12 of map 2 (village)");
    /// assert!(village.enclosure([0.0, 0.0], None).is_none());
    /// ```
    pub fn enclosure(&self, point: [f64; 2], plan: Option<&Plan>) -> Option<Enclosure> {
        let regions = self.regions();
        if let Some(index) = regions.iter().position(|corners| encloses(corners, point)) {
            return Some(match &self.map_regions {
                Some(_) => Enclosure::OwnRegion { index },
                None => Enclosure::Region {
                    index,
                    count: regions.len(),
                    map: self.map(),
                },
            });
        }
        if let Some(index) = self.walls.iter().position(|wall| encloses(&wall.polygon, point)) {
            return Some(Enclosure::Wall { index });
        }
        let walls = plan.map_or(&[][..], |plan| plan.walls.as_slice());
        let index = walls.iter().position(|wall| encloses(&wall.polygon, point))?;
        Some(Enclosure::LayoutWall {
            index,
            count: walls.len(),
        })
    }

    /// Why a point cannot be reached: it is outside the arena, or inside a wall; `None` on free ground.
    pub(super) fn out_of_reach(&self, at: [f64; 2], plan: Option<&Plan>) -> Option<String> {
        if self.contains(at) {
            return Some(format!("inside {}", self.enclosure(at, plan)?));
        }
        let [width, depth] = self.arena_size();
        Some(format!("outside the {width} × {depth} m arena"))
    }
}

/// Ground that cannot be entered, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enclosure {
    /// A region of a built-in layout.
    Region {
        /// Its index, from 0.
        index: usize,
        /// The layout's number of regions.
        count: usize,
        /// The layout's number.
        map: u8,
    },
    /// A region of the layout in the world's document.
    OwnRegion {
        /// Its index in `map_regions`.
        index: usize,
    },
    /// A wall of the world.
    Wall {
        /// Its index in `walls`.
        index: usize,
    },
    /// A wall of the layout.
    LayoutWall {
        /// Its index in the walls of the plan.
        index: usize,
        /// The plan's number of walls.
        count: usize,
    },
}

impl fmt::Display for Enclosure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self::Region { index, count, map } => {
                write!(f, "region {} of {count} of map {map} ({})", index + 1, maps::name(map))
            }
            Self::OwnRegion { index } => write!(f, "the region /environment_params/map_regions/{index}"),
            Self::Wall { index } => write!(f, "the wall /environment_params/walls/{index}"),
            Self::LayoutWall { index, count } => write!(f, "wall {} of {count} of the layout", index + 1),
        }
    }
}

fields! {
    /// A region that cannot be entered: a polygon on the ground, raised to a wall.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "polygon": [[0, 0], [8, 0], [8, 1], [0, 1]], "height": 2 }]))]
    pub struct Wall {
        /// Corners in metres, in order; the last corner connects to the first.
        #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e4, max = 1e4))))]
        pub polygon: Vec<[f64; 2]> => Field::ours(AsPart).unit("m"),
        /// Height in metres; the arena's `wall_height` if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 50.0))]
        pub height: Option<f64> => Field::ours(AsPart).unit("m"),
        /// Colour; the arena's `bounding_wall_color` if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub color: Option<Color> => Field::ours(AsPart),
    }
}
