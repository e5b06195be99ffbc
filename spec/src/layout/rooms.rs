//! [`Rooms`]: rooms in rows and columns, with doorways in the walls between them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::draws::{Draws, Purpose, share_of};
use super::grid::{Grid, Scale, Side, SideOf};
use super::plan::Plan;
use crate::world::MAX_SEED;
use crate::world::fields::{fields, word};

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
