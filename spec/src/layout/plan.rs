//! [`Plan`]: the walls, free cells and doorways of a layout, in metres. Each kind of layout computes its plan in its own file.

use std::collections::VecDeque;

/// The four sides of a cell, as bits of [`PlanCell::sides`].
pub(super) const EAST: u8 = 1;
pub(super) const NORTH: u8 = 2;
pub(super) const WEST: u8 = 4;
pub(super) const SOUTH: u8 = 8;

/// Marks a lattice position without a cell.
const NONE: u32 = u32::MAX;

/// The plan of a layout: where its walls are, and where objects can be.
///
/// Computed by [`Layout::plan`](crate::Layout::plan); a checked [`World`](crate::World) stores the plan of its layout.
/// Coordinates are in metres, x east, y north, with the origin in the middle of the arena.
///
/// # Example
/// ```
/// use driftworld_spec::World;
/// let world = World::from_json("w", r#"{ "environment_params": { "layout": { "maze": { "cells": [4, 3], "cell": 2, "seed": 1 } } } }"#)?;
/// let plan = world.plan().expect("the world has a layout");
/// assert_eq!((plan.size, plan.cells.len()), ([8.0, 6.0], 12));
/// let metres = plan.walking_distances(0);
/// assert!(metres.iter().all(|metres| metres.is_finite()));
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Side lengths of the arena along x and y in metres; `[0, 0]` for a list of walls, where the world sets the arena size.
    pub size: [f64; 2],
    /// The seed from which it was computed.
    pub seed: u64,
    /// The walls inside the arena, excluding its outer wall.
    pub walls: Vec<PlanWall>,
    /// The free cells, row by row from the south-west; empty for a predefined map and for a list of walls.
    pub cells: Vec<PlanCell>,
    /// Minimum width of corridors and doorways in metres; infinite if unknown.
    pub corridor: f64,
    /// Passages between rooms, in the order of their walls.
    pub doorways: Vec<Doorway>,
    /// Columns and rows of the lattice of cells; `[0, 0]` without cells.
    pub lattice: [usize; 2],
    /// Side lengths of a cell along x and y in metres.
    pub cell: [f64; 2],
    /// For each position of the lattice, row by row from the south-west, the index of its cell.
    index: Vec<u32>,
}

/// A wall of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanWall {
    /// Its corners in metres, in order; convex except for polygons from a list of walls.
    pub polygon: Vec<[f64; 2]>,
    /// Its height in metres; the arena's `wall_height` if absent.
    pub height: Option<f64>,
    /// Its colour; the arena's `bounding_wall_color` if absent.
    pub color: Option<crate::Color>,
}

/// A free cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanCell {
    /// Its centre in metres.
    pub center: [f64; 2],
    /// Index of its room, from 0; a maze is one room.
    pub room: u32,
    /// Its open sides, added up: 1 east, 2 north, 4 west, 8 south.
    pub sides: u8,
    /// Its letter in a text layout; `None` in other layouts, and for the plain letters of walls and floor.
    pub letter: Option<char>,
}

impl PlanCell {
    /// Number of open sides: 1 is a dead end, 2 a corridor or a corner, 3 and 4 a junction.
    pub fn open_sides(&self) -> u32 {
        self.sides.count_ones()
    }
}

/// A gap in a wall between two rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doorway {
    /// Its centre in metres.
    pub center: [f64; 2],
    /// The direction from the first room to the second, in degrees: 0 is north, 90 east.
    pub heading: f64,
    /// Its width in metres.
    pub width: f64,
    /// Its depth along its heading in metres: the thickness of its wall.
    pub depth: f64,
    /// Indices of its rooms: the southern or western one, then the northern or eastern one.
    pub rooms: [u32; 2],
}

impl Default for Plan {
    fn default() -> Self {
        Self::of_cells([0.0; 2], [0, 0], 0, |_, _| None)
    }
}

impl Plan {
    /// A plan without walls, with cells in a lattice over an arena of the given size: `cell_at` returns the cell at each
    /// position, row by row from the south-west, or `None`.
    pub(super) fn of_cells(
        size: [f64; 2],
        lattice: [usize; 2],
        seed: u64,
        mut cell_at: impl FnMut(usize, [f64; 2]) -> Option<PlanCell>,
    ) -> Self {
        let [columns, rows] = lattice;
        let cell = [0, 1].map(|axis| size[axis] / lattice[axis].max(1) as f64);
        let mut cells = Vec::with_capacity(columns * rows);
        let mut index = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            let y = (row as f64 + 0.5) * cell[1] - size[1] / 2.0;
            for column in 0..columns {
                let x = (column as f64 + 0.5) * cell[0] - size[0] / 2.0;
                match cell_at(row * columns + column, [x, y]) {
                    Some(found) => {
                        index.push(cells.len() as u32);
                        cells.push(found);
                    }
                    None => index.push(NONE),
                }
            }
        }
        Self {
            size,
            seed,
            cells,
            lattice,
            cell,
            index,
            walls: Vec::new(),
            doorways: Vec::new(),
            corridor: f64::INFINITY,
        }
    }

    /// The cell that contains a point in metres.
    pub fn cell_at(&self, point: [f64; 2]) -> Option<usize> {
        let [column, row] = [0, 1].map(|axis| {
            let along = (point[axis] + self.size[axis] / 2.0) / self.cell[axis];
            (along >= 0.0 && along < self.lattice[axis] as f64).then_some(along as usize)
        });
        self.at(row? * self.lattice[0] + column?)
    }

    /// The cell at a position of the lattice.
    fn at(&self, position: usize) -> Option<usize> {
        self.index
            .get(position)
            .filter(|number| **number != NONE)
            .map(|number| *number as usize)
    }

    /// A cell's column from the west and row from the south.
    pub fn column_and_row(&self, cell: usize) -> [usize; 2] {
        let center = self.cells[cell].center;
        [0, 1].map(|axis| ((center[axis] + self.size[axis] / 2.0) / self.cell[axis]) as usize)
    }

    /// The cells one step away from a cell.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> {
        let [column, row] = self.column_and_row(cell);
        let columns = self.lattice[0];
        let (position, sides) = (row * columns + column, self.cells[cell].sides);
        let adjacent = [
            (EAST, position + 1),
            (NORTH, position + columns),
            (WEST, position.wrapping_sub(1)),
            (SOUTH, position.wrapping_sub(columns)),
        ];
        adjacent
            .into_iter()
            .filter(move |(side, _)| sides & side != 0)
            .filter_map(|(_, position)| self.at(position))
    }

    /// Walking distances in metres from the centre of a cell to the centre of every cell, through centres of neighbours; infinite
    /// if there is no path.
    ///
    /// # Panics
    /// If the cell does not exist.
    pub fn walking_distances(&self, from: usize) -> Vec<f64> {
        let mut metres = vec![f64::INFINITY; self.cells.len()];
        metres[from] = 0.0;
        let mut open = VecDeque::from([from]);
        // Cells need not be square, so a path with fewer steps may be longer: a cell whose distance shrinks is visited again.
        while let Some(cell) = open.pop_front() {
            let here = self.cells[cell].center;
            for next in self.neighbours(cell) {
                let there = self.cells[next].center;
                let length = metres[cell] + (here[0] - there[0]).abs() + (here[1] - there[1]).abs();
                if length < metres[next] - 1e-9 {
                    metres[next] = length;
                    open.push_back(next);
                }
            }
        }
        metres
    }

    /// Number of cells outside the largest connected part.
    pub fn num_cut_off_cells(&self) -> usize {
        let mut seen = vec![false; self.cells.len()];
        let parts = (0..self.cells.len()).map(|first| self.reach(first, &mut seen, |_, _| true));
        self.cells.len() - parts.max().unwrap_or(0)
    }

    /// Marks the cells reachable from a cell, including itself, by steps that `may_step` allows; returns how many are new.
    pub(crate) fn reach(&self, from: usize, seen: &mut [bool], may_step: impl Fn(usize, usize) -> bool) -> usize {
        if std::mem::replace(&mut seen[from], true) {
            return 0;
        }
        let (mut open, mut count) = (vec![from], 0);
        while let Some(cell) = open.pop() {
            count += 1;
            let steps = self.neighbours(cell).filter(|next| may_step(cell, *next));
            open.extend(steps.filter(|next| !std::mem::replace(&mut seen[*next], true)));
        }
        count
    }
}
