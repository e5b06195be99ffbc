//! [`Plan`]: what a layout comes to: walls, free cells and doorways, in metres. How it is drawn is said in the files
//! beside this one, one for each kind of layout.

use std::collections::VecDeque;

/// The four sides of a cell, as bits of [`PlanCell::sides`].
pub(super) const EAST: u8 = 1;
pub(super) const NORTH: u8 = 2;
pub(super) const WEST: u8 = 4;
pub(super) const SOUTH: u8 = 8;

/// No cell of the lattice.
const NONE: u32 = u32::MAX;

/// A layout drawn out: where its walls stand, and where one can be.
///
/// Made by [`Layout::plan`](crate::Layout::plan); a checked [`World`](crate::World) keeps that of its layout. Places are in
/// metres, x east, y north, the middle of the arena at the origin.
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
    /// Side lengths of the arena along x and y in metres; `[0, 0]` for a layout that leaves them to the world: one of walls.
    pub size: [f64; 2],
    /// The seed that it was drawn with.
    pub seed: u64,
    /// The walls within the arena, without the one around it.
    pub walls: Vec<PlanWall>,
    /// The cells that one can be in, row by row from the south-west; none for a predefined map and for walls.
    pub cells: Vec<PlanCell>,
    /// The least width between two of its walls in metres: of corridors and doorways; infinite where that is not known.
    pub corridor: f64,
    /// Where one passes from room to room, in the order of their walls.
    pub doorways: Vec<Doorway>,
    /// Columns and rows of the lattice that the cells lie in; `[0, 0]` without cells.
    pub lattice: [usize; 2],
    /// Side lengths of a cell along x and y in metres.
    pub cell: [f64; 2],
    /// For each place of the lattice, row by row from the south-west, the number of its cell.
    index: Vec<u32>,
}

/// A wall of a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanWall {
    /// Its corners in metres, in order; convex but for the polygons of a layout of walls.
    pub polygon: Vec<[f64; 2]>,
    /// Its height in metres; the arena's `wall_height` if absent.
    pub height: Option<f64>,
    /// Its colour; the arena's `bounding_wall_color` if absent.
    pub color: Option<crate::Color>,
}

/// A cell that one can be in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanCell {
    /// Its middle in metres.
    pub center: [f64; 2],
    /// The number of its room, from 0; a maze is one room.
    pub room: u32,
    /// The sides by which it can be left: 1 east, 2 north, 4 west, 8 south, added up.
    pub sides: u8,
    /// What stands for it in a text; none in other layouts, and for the plain letters of walls and floor.
    pub letter: Option<char>,
}

impl PlanCell {
    /// By how many sides it can be left: 1 is a dead end, 2 a corridor or a corner, 3 and 4 a junction.
    pub fn open_sides(&self) -> u32 {
        self.sides.count_ones()
    }
}

/// A gap in a wall between two rooms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doorway {
    /// Its middle in metres.
    pub center: [f64; 2],
    /// The direction in which it is passed, from the first room to the second, in degrees: 0 is north, 90 east.
    pub heading: f64,
    /// Its width in metres.
    pub width: f64,
    /// How deep it is along its heading in metres: the thickness of its wall.
    pub depth: f64,
    /// The numbers of its rooms: the one to the south or west, and the one to the north or east.
    pub rooms: [u32; 2],
}

impl Default for Plan {
    fn default() -> Self {
        Self::of_cells([0.0; 2], [0, 0], 0, |_, _| None)
    }
}

impl Plan {
    /// A plan without walls of an arena of these sides whose cells lie in a lattice: `cell_at` says of each place of it,
    /// row by row from the south-west, what is there.
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

    /// The cell that a point in metres lies in.
    pub fn cell_at(&self, point: [f64; 2]) -> Option<usize> {
        let [column, row] = [0, 1].map(|axis| {
            let along = (point[axis] + self.size[axis] / 2.0) / self.cell[axis];
            (along >= 0.0 && along < self.lattice[axis] as f64).then_some(along as usize)
        });
        self.at(row? * self.lattice[0] + column?)
    }

    /// The cell at a place of the lattice.
    fn at(&self, place: usize) -> Option<usize> {
        self.index
            .get(place)
            .filter(|number| **number != NONE)
            .map(|number| *number as usize)
    }

    /// The place of a cell in the lattice: its column from the west and its row from the south.
    pub fn column_and_row(&self, cell: usize) -> [usize; 2] {
        let center = self.cells[cell].center;
        [0, 1].map(|axis| ((center[axis] + self.size[axis] / 2.0) / self.cell[axis]) as usize)
    }

    /// The cells that are reached from a cell in one step.
    ///
    /// # Panics
    /// Where there is no such cell.
    pub fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> {
        let [column, row] = self.column_and_row(cell);
        let columns = self.lattice[0];
        let (place, sides) = (row * columns + column, self.cells[cell].sides);
        let beside = [
            (EAST, place + 1),
            (NORTH, place + columns),
            (WEST, place.wrapping_sub(1)),
            (SOUTH, place.wrapping_sub(columns)),
        ];
        beside
            .into_iter()
            .filter(move |(side, _)| sides & side != 0)
            .filter_map(|(_, place)| self.at(place))
    }

    /// The metres that one walks from the middle of a cell to that of each, from middle to middle; infinite where no way is.
    ///
    /// # Panics
    /// Where there is no such cell.
    pub fn walking_distances(&self, from: usize) -> Vec<f64> {
        let mut metres = vec![f64::INFINITY; self.cells.len()];
        metres[from] = 0.0;
        let mut open = VecDeque::from([from]);
        // Cells need not be square, so that a way of fewer steps may be the longer one: whoever gets nearer goes on again.
        while let Some(cell) = open.pop_front() {
            let here = self.cells[cell].center;
            for next in self.neighbours(cell) {
                let there = self.cells[next].center;
                let way = metres[cell] + (here[0] - there[0]).abs() + (here[1] - there[1]).abs();
                if way < metres[next] - 1e-9 {
                    metres[next] = way;
                    open.push_back(next);
                }
            }
        }
        metres
    }

    /// How many cells cannot be reached from the others: those outside the largest part that hangs together.
    pub fn cut_off(&self) -> usize {
        let mut seen = vec![false; self.cells.len()];
        let parts = (0..self.cells.len()).map(|first| self.reach(first, &mut seen, |_, _| true));
        self.cells.len() - parts.max().unwrap_or(0)
    }

    /// Marks the cells that are reached from one, itself included, by steps that may be taken; says how many are new.
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
