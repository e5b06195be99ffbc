//! [`Maze`]: cells between walls, with one path between any two cells, or more if dead ends are opened.

use super::Maze;
use super::draws::{Draws, Purpose, share_of};
use super::grid::{Grid, Scale, Side, SideOf};
use super::plan::Plan;

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
