//! The kind of a layout, and what follows from it: the size of the arena, and the [`Plan`].

use super::plan::{Plan, PlanWall};
use super::text::TextMap;
use super::{Layout, LayoutWall, Legend, Maze, Rooms, draws, walls};
use crate::maps;
use crate::world::Region;

/// Side of a predefined map in metres.
const MAP_SIDE: f64 = 200.0;

/// Default side of a cell of a text layout, in metres.
const TEXT_CELL: f64 = 2.0;

/// The kind of a layout.
pub(super) enum Kind<'a> {
    Maze(&'a Maze),
    Rooms(&'a Rooms),
    Text(TextMap<'a>),
    Predefined,
    Walls(&'a [LayoutWall]),
}

impl Layout {
    /// The kind: the first one present.
    pub(super) fn kind(&self) -> Option<Kind<'_>> {
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
