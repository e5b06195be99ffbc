//! [`Layout`]: rooms, mazes and walls of an arena as a value, and the [`Plan`] computed from it.

mod check;
mod draws;
mod grid;
mod maze;
mod plan;
mod rooms;
mod text;
mod walls;

pub(crate) use check::POINTER;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use maze::Maze;
pub use plan::{Doorway, Plan, PlanCell, PlanWall};
pub use rooms::{RoomDoors, Rooms};
pub use text::Legend;
pub use walls::{Circle, LayoutWall};

use crate::maps;
use crate::world::Region;
use crate::world::fields::{Place, fields};
use text::TextMap;

/// Maximum number of cells in a layout, including wall cells.
pub const MAX_CELLS: usize = 10_000;

/// Maximum side of a layout in metres, the same as for an arena.
pub const MAX_LAYOUT_SIDE: f64 = 300.0;

/// Side of a predefined map in metres.
const MAP_SIDE: f64 = 200.0;

/// Default side of a cell of a text layout, in metres.
const TEXT_CELL: f64 = 2.0;

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

impl Place for BTreeMap<String, Legend> {}

/// The kind of a layout.
enum Kind<'a> {
    Maze(&'a Maze),
    Rooms(&'a Rooms),
    Text(TextMap<'a>),
    Predefined,
    Walls(&'a [LayoutWall]),
}

impl Layout {
    /// The kind: the first one present.
    fn kind(&self) -> Option<Kind<'_>> {
        if let Some(maze) = &self.maze {
            return Some(Kind::Maze(maze));
        }
        if let Some(rooms) = &self.rooms {
            return Some(Kind::Rooms(rooms));
        }
        if let Some(rows) = &self.text {
            return Some(Kind::Text(TextMap {
                rows,
                legend: &self.legend,
                cell: self.cell.unwrap_or(TEXT_CELL),
                height: self.height,
            }));
        }
        if self.predefined.is_some() {
            return Some(Kind::Predefined);
        }
        self.walls.as_deref().map(Kind::Walls)
    }

    /// Side lengths of the arena in metres; `None` for a list of walls, where the world sets the arena size.
    pub fn size(&self) -> Option<[f64; 2]> {
        match self.kind()? {
            Kind::Maze(maze) => Some(maze.size()),
            Kind::Rooms(rooms) => Some(rooms.size()),
            Kind::Text(text) => Some(text.size()),
            Kind::Predefined => Some(self.size.unwrap_or([MAP_SIDE; 2])),
            Kind::Walls(_) => None,
        }
    }

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

    /// The regions of a predefined map as walls, scaled to the arena; with `standing` below 1, only the first ones.
    fn map_plan(&self, regions: &[Region]) -> Plan {
        let size = self.size.unwrap_or([MAP_SIDE; 2]);
        let factor = size.map(|side| side / MAP_SIDE);
        let mut plan = Plan::of_cells(size, [0, 0], 0, |_, _| None);
        let standing = &regions[..draws::share_of(self.standing, regions.len())];
        plan.walls.extend(standing.iter().map(|corners| {
            let corners = corners.0.iter();
            PlanWall {
                polygon: corners.map(|[x, y]| [x * factor[0], y * factor[1]]).collect(),
                height: None,
                color: None,
            }
        }));
        plan
    }

    /// The meaning of a letter of its text; `None` for an unknown letter, and for a layout without text.
    pub fn meaning(&self, letter: char) -> Option<Legend> {
        match self.kind()? {
            Kind::Text(text) => text.meaning(letter),
            _ => None,
        }
    }

    /// Computes the plan. `seed` is the world's, used if the layout has no seed of its own.
    ///
    /// The same layout and seed give the same plan, bit for bit, on every machine.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Layout, Maze};
    /// let layout = Layout { maze: Some(Maze::default()), ..Layout::default() };
    /// let plan = layout.plan(7);
    /// assert_eq!(plan, layout.plan(7));
    /// assert_eq!((plan.size, plan.cells.len()), ([24.0, 24.0], 64));
    /// ```
    pub fn plan(&self, seed: u64) -> Plan {
        self.plan_with(seed, maps::excluded_regions(self.predefined.unwrap_or(0)))
    }

    /// Like [`Layout::plan`], with these regions replacing those of its predefined map.
    pub(crate) fn plan_with(&self, seed: u64, regions: &[Region]) -> Plan {
        let seed = self.seed().unwrap_or(seed);
        match self.kind() {
            Some(Kind::Maze(maze)) => maze.plan(self.standing, seed),
            Some(Kind::Rooms(rooms)) => rooms.plan(self.standing, seed),
            // A text is not random: its walls are always removed in the same order.
            Some(Kind::Text(text)) => text.plan(self.standing, 0),
            Some(Kind::Walls(walls)) => walls::plan(walls, self.standing, 0),
            Some(Kind::Predefined) => self.map_plan(regions),
            None => Plan::default(),
        }
    }
}
