//! [`Rooms`]: rooms in rows and columns, with doorways in the walls between them.

use super::Rooms;
use super::draws::{Draws, Purpose, share_of};
use super::grid::{Grid, Scale, Side, SideOf};
use super::plan::Plan;

impl Rooms {
    pub(super) fn size(&self) -> [f64; 2] {
        [0, 1].map(|axis| f64::from(self.grid[axis]) * self.room[axis])
    }

    /// Number of cells of a room along x and y: each is wide enough for a doorway between two walls.
    fn cells_of_room(&self) -> [usize; 2] {
        self.room
            .map(|side| ((side / (self.doorway + self.wall) + 1e-9) as usize).max(1))
    }

    /// Columns and rows of cells in total.
    pub(super) fn lattice(&self) -> [usize; 2] {
        let cells = self.cells_of_room();
        [0, 1].map(|axis| self.grid[axis] as usize * cells[axis])
    }

    pub(super) fn plan(&self, standing: f64, seed: u64) -> Plan {
        let connected = self.connected(seed);
        let (cells, lattice) = (self.cells_of_room(), self.lattice());
        let mut grid = Grid::new(lattice, Side::Open);
        let mut draws = Draws::new(seed, Purpose::Doorways);
        // The position of a doorway in its wall does not depend on which walls have one.
        for (room, axis) in connected.between_cells() {
            let [column, row] = [room % connected.lattice[0], room / connected.lattice[0]];
            let has_doorway = connected.sides[axis][room] == Side::Doorway;
            let along = cells[1 - axis];
            let doorway = draws.below(along);
            for at in 0..along {
                let [x, y] = [[cells[0] - 1, at], [at, cells[1] - 1]][axis];
                let cell = (row * cells[1] + y) * lattice[0] + column * cells[0] + x;
                grid.sides[axis][cell] = if has_doorway && at == doorway {
                    Side::Doorway
                } else {
                    Side::Wall
                };
            }
        }
        grid.remove_walls(standing, seed);
        let scale = Scale {
            size: self.size(),
            wall: self.wall,
            doorway: self.doorway,
            height: self.height,
        };
        let columns = self.grid[0];
        grid.plan(&scale, seed, |[column, row]| {
            (row / cells[1]) as u32 * columns + (column / cells[0]) as u32
        })
    }

    /// The rooms as cells of a grid, with doorways between connected rooms.
    fn connected(&self, seed: u64) -> Grid {
        let mut connected = Grid::new(self.grid.map(|count| count as usize), Side::Wall);
        connected.open_tree(Side::Doorway, &mut Draws::new(seed, Purpose::Tree));
        let mut others: Vec<SideOf> = connected.between_cells().collect();
        others.retain(|(cell, axis)| connected.sides[*axis][*cell] == Side::Wall);
        Draws::new(seed, Purpose::Loops).shuffle(&mut others);
        for (cell, axis) in &others[..share_of(self.loops, others.len())] {
            connected.sides[*axis][*cell] = Side::Doorway;
        }
        connected
    }
}
