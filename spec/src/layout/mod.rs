//! [`Layout`]: rooms, mazes and walls of an arena, as documents write them. `kind.rs` computes the [`Plan`] of a layout.

mod check;
mod draws;
mod grid;
mod kind;
mod maze;
mod plan;
mod rooms;
mod text;
mod walls;

pub(crate) use check::POINTER;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use plan::{Doorway, Plan, PlanCell, PlanWall};

use crate::Color;
use crate::limits::MAX_SEED;
use crate::world::fields::{Place, fields, word};

/// Maximum number of cells in a layout, including wall cells.
pub const MAX_CELLS: usize = 10_000;

/// Maximum side of a layout in metres, the same as for an arena.
pub const MAX_LAYOUT_SIDE: f64 = 300.0;

fields! {
    /// The walls that divide the arena: exactly one of a maze, rooms, a text, a predefined map, or a list of walls.
    ///
    /// All but a list of walls set the size of the arena.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "maze": { "cells": [8, 8], "cell": 3, "braid": 0.2 } },
        { "rooms": { "grid": [2, 2], "room": [8, 8], "doorway": 1.5 } },
        { "text": ["########", "#A..D.G#", "########"], "cell": 2, "legend": { "G": { "group": "goal" } } },
        { "predefined": 3 },
        { "walls": [{ "from": [0, 0], "to": [5, 0], "thickness": 0.3, "height": 2 }] },
    ]))]
    pub struct Layout {
        /// A maze.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub maze: Option<Maze> = None => Field::ours(AsPart),
        /// Rooms with doorways between them.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub rooms: Option<Rooms> = None => Field::ours(AsPart),
        /// Lines of letters, the northernmost first, all of the same length: `#` and `*` are walls, a space, `.` and `_` are
        /// floor, the agent may start at `A` and `P`, `D` is a doorway; the legend defines other letters.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 1, max = 1000), inner(length(min = 1, max = 1000)))]
        pub text: Option<Vec<String>> = None
            => Field::ours(AsPart).fixed("its letters belong together; the layout as a whole can vary"),
        /// Number of a predefined map, as in `predefined_map`.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 1, max = 4))]
        pub predefined: Option<u8> = None => Field::ours(AsPart),
        /// Sides of the arena in metres, to which a predefined map is scaled; 200 × 200 if absent. Only with `predefined`.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(inner(range(min = 1.0, max = 300.0)))]
        pub size: Option<[f64; 2]> = None => Field::ours(AsPart).unit("m"),
        /// A list of walls, in an arena of `map_size`. They may overlap.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(max = 1000))]
        pub walls: Option<Vec<LayoutWall>> = None => Field::ours(AsPart),
        /// Side of a letter's cell in metres; 2 if absent. Only with `text`.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.1, max = 100.0))]
        pub cell: Option<f64> = None => Field::ours(AsPart).unit("m"),
        /// Height of a text's walls in metres; the arena's `wall_height` if absent. Only with `text`.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 50.0))]
        pub height: Option<f64> = None => Field::ours(AsPart).unit("m"),
        /// Meanings of letters of a text, overriding their default meanings. Only with `text`.
        #[serde(skip_serializing_if = "BTreeMap::is_empty")]
        #[schemars(extend("maxProperties" = 1000))]
        pub legend: BTreeMap<String, Legend> = BTreeMap::new()
            => Field::ours(AsPart).fixed("it belongs to the text; the layout as a whole can vary"),
        /// Share of the inner walls that are kept, 0..1. Each layout removes its walls in a fixed order, so the walls kept for
        /// a smaller share are a subset of those kept for a larger one, and every reachable place stays reachable.
        #[schemars(range(min = 0.0, max = 1.0))]
        pub standing: f64 = 1.0 => Field::ours(AsPart),
    }
}

impl Layout {
    /// Whether it is random and has no seed of its own.
    pub fn is_drawn(&self) -> bool {
        (self.maze.is_some() || self.rooms.is_some()) && self.seed().is_none()
    }

    /// Sets the seed if the layout is random and has none of its own.
    pub fn set_seed(&mut self, seed: u64) {
        if let Some(maze) = &mut self.maze {
            maze.seed.get_or_insert(seed);
        }
        if let Some(rooms) = &mut self.rooms {
            rooms.seed.get_or_insert(seed);
        }
    }

    /// Its own seed, if it has one.
    pub fn seed(&self) -> Option<u64> {
        self.maze
            .as_ref()
            .and_then(|maze| maze.seed)
            .or_else(|| self.rooms.as_ref().and_then(|rooms| rooms.seed))
    }
}

fields! {
    /// A maze of square cells, generated depth first: exactly one path connects any two cells.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "cells": [8, 8], "cell": 3, "braid": 0.2 }]))]
    pub struct Maze {
        /// Number of cells along x and y; at most 10,000 in total.
        #[schemars(inner(range(min = 1, max = 1000)))]
        pub cells: [u32; 2] = [8, 8] => Field::ours(AsPart),
        /// Side of a cell in metres, from the middle of one wall to the middle of the next.
        #[schemars(range(min = 0.1, max = 100.0))]
        pub cell: f64 = 3.0 => Field::ours(AsPart).unit("m"),
        /// Thickness of the walls in metres; less than the side of a cell.
        #[schemars(range(min = 0.01, max = 50.0))]
        pub wall: f64 = 0.3 => Field::ours(AsPart).unit("m"),
        /// Height of the walls in metres; the arena's `wall_height` if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 50.0))]
        pub height: Option<f64> = None => Field::ours(AsPart).unit("m"),
        /// Share of the dead ends that are opened, 0..1: 0 leaves exactly one path between any two cells, 1 leaves no dead end.
        #[schemars(range(min = 0.0, max = 1.0))]
        pub braid: f64 = 0.0 => Field::ours(AsPart),
        /// Seed of the maze. If absent, the world's `seed` is used, or 0 if that is absent too; a sampled world has its own
        /// seed.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = MAX_SEED))]
        pub seed: Option<u64> = None => Field::ours(AsPart),
    }
}

fields! {
    /// Rooms in rows and columns. A wall between two rooms has at most one doorway, at a random position; every room can be
    /// reached from every other.
    #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "grid": [2, 2], "room": [8, 8], "doorway": 1.5 }]))]
    pub struct Rooms {
        /// Number of rooms along x and y.
        #[schemars(inner(range(min = 1, max = 100)))]
        pub grid: [u32; 2] = [2, 2] => Field::ours(AsPart),
        /// Sides of a room along x and y in metres, from the middle of one wall to the middle of the next.
        #[schemars(inner(range(min = 0.1, max = 300.0)))]
        pub room: [f64; 2] = [8.0, 8.0] => Field::ours(AsPart).unit("m"),
        /// Width of the doorways in metres; together with a wall's thickness, at most the side of a room.
        #[schemars(range(min = 0.1, max = 100.0))]
        pub doorway: f64 = 1.5 => Field::ours(AsPart).unit("m"),
        /// Thickness of the walls in metres.
        #[schemars(range(min = 0.01, max = 50.0))]
        pub wall: f64 = 0.3 => Field::ours(AsPart).unit("m"),
        /// Height of the walls in metres; the arena's `wall_height` if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 50.0))]
        pub height: Option<f64> = None => Field::ours(AsPart).unit("m"),
        /// Share of the remaining walls between rooms that get a doorway too, 0..1: 0 leaves exactly one path between any two
        /// rooms, 1 puts a doorway into every wall between two rooms.
        #[schemars(range(min = 0.0, max = 1.0))]
        pub loops: f64 = 1.0 => Field::ours(AsPart),
        /// Doors in the doorways. Sampling adds the doors and keys to the world as objects; in a world that is not sampled,
        /// this key adds none.
        pub doors: RoomDoors = RoomDoors::None => Field::ours(AsPart),
        /// Seed of the rooms. If absent, the world's `seed` is used, or 0 if that is absent too; a sampled world has its own
        /// seed.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0, max = MAX_SEED))]
        pub seed: Option<u64> = None => Field::ours(AsPart),
    }
}

/// Doors in the doorways of rooms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoomDoors {
    /// No doors.
    #[default]
    None,
    /// Open doors.
    Open,
    /// Closed doors, opened by interaction.
    Closed,
    /// Closed doors, each opened with the key of its colour, which lies in a free cell.
    Keyed,
}

word!(RoomDoors);

fields! {
    /// One wall: a segment (`from` and `to`), a `circle`, or a `polygon`.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "from": [0, 0], "to": [5, 0], "thickness": 0.3, "height": 2 },
        { "circle": { "center": [0, 0], "radius": 2 } },
        { "polygon": [[0, 0], [2, 0], [1, 2]] },
    ]))]
    pub struct LayoutWall {
        /// One end of a segment in metres.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(inner(range(min = -1e4, max = 1e4)))]
        pub from: Option<[f64; 2]> => Field::ours(AsPart).unit("m"),
        /// The other end of the segment in metres.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(inner(range(min = -1e4, max = 1e4)))]
        pub to: Option<[f64; 2]> => Field::ours(AsPart).unit("m"),
        /// Thickness of a segment in metres; 0.3 if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.01, max = 50.0))]
        pub thickness: Option<f64> => Field::ours(AsPart).unit("m"),
        /// A round wall; built as a polygon with 24 corners on the circle.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub circle: Option<Circle> => Field::ours(AsPart),
        /// Corners in metres, in order; the last joins the first.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e4, max = 1e4))))]
        pub polygon: Option<Vec<[f64; 2]>> => Field::ours(AsPart).unit("m"),
        /// Height in metres; the arena's `wall_height` if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0, max = 50.0))]
        pub height: Option<f64> => Field::ours(AsPart).unit("m"),
        /// Colour; the arena's `bounding_wall_color` if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub color: Option<Color> => Field::ours(AsPart),
    }
}

fields! {
    /// A circle on the ground.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "center": [0, 0], "radius": 2 }]))]
    pub struct Circle {
        /// Its centre in metres.
        #[schemars(inner(range(min = -1e4, max = 1e4)))]
        pub center: [f64; 2] => Field::ours(AsPart).unit("m"),
        /// Its radius in metres.
        #[schemars(range(min = 0.01, max = 300.0))]
        pub radius: f64 => Field::ours(AsPart).unit("m"),
    }
}

/// The meaning of a letter of a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(extend("examples" = ["wall", "floor", { "group": "goal" }]))]
pub enum Legend {
    /// A wall that fills the cell.
    Wall,
    /// Empty floor.
    Floor,
    /// Floor on which the agent may start.
    Start,
    /// Floor in a gap between two walls, with a different room on either side.
    Doorway,
    /// Floor on which objects of the group with this name are placed.
    Group(#[schemars(length(min = 1, max = 100))] String),
}

impl Place for BTreeMap<String, Legend> {}
