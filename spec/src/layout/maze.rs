//! [`Maze`]: cells between walls, with one path between any two cells, or more if dead ends are opened.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::draws::{Draws, Purpose, share_of};
use super::grid::{Grid, Scale, Side, SideOf};
use super::plan::Plan;
use crate::world::MAX_SEED;
use crate::world::fields::fields;

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

impl Maze {
    pub(super) fn size(&self) -> [f64; 2] {
        self.cells.map(|count| f64::from(count) * self.cell)
    }

    pub(super) fn plan(&self, standing: f64, seed: u64) -> Plan {
        let mut grid = Grid::new(self.cells.map(|count| count as usize), Side::Wall);
        grid.open_tree(Side::Open, &mut Draws::new(seed, Purpose::Tree));
        self.open_dead_ends(&mut grid, seed);
        grid.remove_walls(standing, seed);
        let scale = Scale {
            size: self.size(),
            wall: self.wall,
            doorway: 0.0,
            height: self.height,
        };
        grid.plan(&scale, seed, |_| 0)
    }

    fn open_dead_ends(&self, grid: &mut Grid, seed: u64) {
        if self.braid <= 0.0 {
            return;
        }
        let walls_of = |grid: &Grid, cell: usize| -> ([SideOf; 4], usize, usize) {
            let (mut walls_of, mut num_closed, mut open) = ([(0, 0); 4], 0, 0);
            for (_, (cell, axis)) in grid.neighbours(cell) {
                if grid.sides[axis][cell] == Side::Wall {
                    walls_of[num_closed] = (cell, axis);
                    num_closed += 1;
                } else {
                    open += 1;
                }
            }
            (walls_of, num_closed, open)
        };
        let mut draws = Draws::new(seed, Purpose::Loops);
        let mut ends: Vec<usize> = (0..grid.sides[0].len())
            .filter(|cell| walls_of(grid, *cell).2 == 1)
            .collect();
        draws.shuffle(&mut ends);
        for cell in &ends[..share_of(self.braid, ends.len())] {
            let (sides, num_closed, open) = walls_of(grid, *cell);
            // Drawn for every dead end, so that the choice of walls does not depend on the share.
            let choice = draws.below(num_closed.max(1));
            if open == 1 && num_closed > 0 {
                let (cell, axis) = sides[choice];
                grid.sides[axis][cell] = Side::Open;
            }
        }
    }
}
