//! [`Grid`]: cells between thin walls, for mazes and rooms; turns the walls into polygons. Layouts with walls as thick as cells
//! are in `text.rs`.

use super::draws::{Draws, Purpose, share_of};
use super::plan::{Doorway, EAST, NORTH, Plan, PlanCell, PlanWall, SOUTH, WEST};

/// The boundary between two cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Open,
    Wall,
    /// A wall with a gap in its middle.
    Doorway,
}

/// The boundaries of each cell with its eastern and northern neighbours.
pub(super) struct Grid {
    /// Columns and rows.
    pub(super) lattice: [usize; 2],
    /// The eastern and northern sides of each cell, row by row from the south-west.
    pub(super) sides: [Vec<Side>; 2],
}

/// The dimensions of a grid in the arena.
pub(super) struct Scale {
    /// Sides of the arena in metres.
    pub(super) size: [f64; 2],
    /// Thickness of the walls in metres.
    pub(super) wall: f64,
    /// Width of the doorways in metres.
    pub(super) doorway: f64,
    /// Height of the walls in metres, if not the arena's.
    pub(super) height: Option<f64>,
}

/// A side between two cells: the eastern (0) or northern (1) side of a cell.
pub(super) type SideOf = (usize, usize);

impl Grid {
    /// A grid with all sides of one kind.
    pub(super) fn new(lattice: [usize; 2], side: Side) -> Self {
        let sides = vec![side; lattice[0] * lattice[1]];
        Self {
            lattice,
            sides: [sides.clone(), sides],
        }
    }

    /// The neighbours of a cell, each with the side in between.
    pub(super) fn neighbours(&self, cell: usize) -> impl Iterator<Item = (usize, SideOf)> + use<> {
        let [columns, rows] = self.lattice;
        let (column, row) = (cell % columns, cell / columns);
        let east = (column + 1 < columns).then(|| (cell + 1, (cell, 0)));
        let north = (row + 1 < rows).then(|| (cell + columns, (cell, 1)));
        let west = (column > 0).then(|| (cell - 1, (cell - 1, 0)));
        let south = (row > 0).then(|| (cell - columns, (cell - columns, 1)));
        [east, north, west, south].into_iter().flatten()
    }

    /// All sides between two cells.
    pub(super) fn between_cells(&self) -> impl Iterator<Item = SideOf> + use<> {
        let [columns, rows] = self.lattice;
        (0..columns * rows).flat_map(move |cell| {
            let east = (cell % columns + 1 < columns).then_some((cell, 0));
            let north = (cell / columns + 1 < rows).then_some((cell, 1));
            east.into_iter().chain(north)
        })
    }

    /// Opens sides so that exactly one path connects any two cells (a spanning tree, depth first). Each opened side
    /// becomes `opened`.
    pub(super) fn open_tree(&mut self, opened: Side, draws: &mut Draws) {
        let count = self.sides[0].len();
        let mut seen = vec![false; count];
        let mut stack = Vec::with_capacity(count);
        let first = draws.below(count);
        seen[first] = true;
        stack.push(first);
        while let Some(&cell) = stack.last() {
            let mut unvisited = [(0, (0, 0)); 4];
            let mut count = 0;
            for neighbour in self.neighbours(cell).filter(|(next, _)| !seen[*next]) {
                unvisited[count] = neighbour;
                count += 1;
            }
            if count == 0 {
                stack.pop();
                continue;
            }
            let index = if count == 1 { 0 } else { draws.below(count) };
            let (next, (cell, axis)) = unvisited[index];
            self.sides[axis][cell] = opened;
            seen[next] = true;
            stack.push(next);
        }
    }

    /// Removes walls until a share of them is left; the walls left for a smaller share are a subset of the walls left for a
    /// larger one.
    pub(super) fn remove_walls(&mut self, share: f64, seed: u64) {
        if share >= 1.0 {
            return;
        }
        let mut sides: Vec<SideOf> = self.between_cells().collect();
        sides.retain(|(cell, axis)| self.sides[*axis][*cell] != Side::Open);
        Draws::new(seed, Purpose::Standing).shuffle(&mut sides);
        let num_standing = share_of(share, sides.len());
        for (cell, axis) in sides.drain(num_standing..) {
            self.sides[axis][cell] = Side::Open;
        }
    }

    /// The open sides of each cell, as bits.
    fn open_sides(&self) -> Vec<u8> {
        let mut open_sides = vec![0; self.sides[0].len()];
        for (cell, axis) in self
            .between_cells()
            .filter(|(cell, axis)| self.sides[*axis][*cell] != Side::Wall)
        {
            open_sides[cell] |= [EAST, NORTH][axis];
            open_sides[cell + self.strides()[axis]] |= [WEST, SOUTH][axis];
        }
        open_sides
    }

    /// The steps in a cell's index to its eastern and northern neighbours.
    fn strides(&self) -> [usize; 2] {
        [1, self.lattice[0]]
    }

    /// The plan of the grid; `room_of` returns the room of a cell, given its column and row.
    pub(super) fn plan(&self, scale: &Scale, seed: u64, room_of: impl Fn([usize; 2]) -> u32) -> Plan {
        let open_sides = self.open_sides();
        let column_and_row = |cell: usize| [cell % self.lattice[0], cell / self.lattice[0]];
        let mut plan = Plan::of_cells(scale.size, self.lattice, seed, |cell, center| {
            Some(PlanCell {
                center,
                room: room_of(column_and_row(cell)),
                sides: open_sides[cell],
                letter: None,
            })
        });
        plan.corridor = plan.cell[0].min(plan.cell[1]) - scale.wall;
        if self.sides.iter().flatten().any(|side| *side == Side::Doorway) {
            plan.corridor = plan.corridor.min(scale.doorway);
        }
        let (half, side, strides) = (plan.size.map(|side| side / 2.0), plan.cell, self.strides());
        // Lines from south to north, then from west to east.
        for (across, along) in [(0, 1), (1, 0)] {
            for line in 0..self.lattice[across] - 1 {
                let middle = (line + 1) as f64 * side[across] - half[across];
                let metres = |at: usize| at as f64 * side[along] - half[along];
                let mut run = Run {
                    scale,
                    across,
                    middle,
                    end: half[along],
                    start: None,
                    walls: &mut plan.walls,
                };
                for at in 0..self.lattice[along] {
                    let cell = line * strides[across] + at * strides[along];
                    match self.sides[across][cell] {
                        Side::Open => run.end_at(metres(at) + scale.wall / 2.0),
                        Side::Wall => run.begin(metres(at) - scale.wall / 2.0),
                        Side::Doorway => {
                            let center = metres(at) + side[along] / 2.0;
                            run.begin(metres(at) - scale.wall / 2.0);
                            run.end_at(center - scale.doorway / 2.0);
                            run.begin(center + scale.doorway / 2.0);
                            let beyond = cell + strides[across];
                            plan.doorways.push(Doorway {
                                center: point(across, middle, center),
                                heading: [90.0, 0.0][across],
                                width: scale.doorway,
                                depth: scale.wall,
                                rooms: [cell, beyond].map(|cell| room_of(column_and_row(cell))),
                            });
                        }
                    }
                }
                run.end_at(half[along]);
            }
        }
        plan
    }
}

/// The point with these coordinates across and along a line; `across` is the axis perpendicular to the line.
fn point(across: usize, offset: f64, along: f64) -> [f64; 2] {
    if across == 0 { [offset, along] } else { [along, offset] }
}

/// A straight wall under construction along a line.
struct Run<'a> {
    scale: &'a Scale,
    /// The axis perpendicular to the line, and the line's coordinate on that axis.
    across: usize,
    middle: f64,
    /// Half the arena's length along the line, where every wall ends.
    end: f64,
    start: Option<f64>,
    walls: &'a mut Vec<PlanWall>,
}

impl Run<'_> {
    fn begin(&mut self, from: f64) {
        self.start.get_or_insert(from.max(-self.end));
    }

    fn end_at(&mut self, to: f64) {
        let Some(from) = self.start.take() else { return };
        let (to, half) = (to.min(self.end), self.scale.wall / 2.0);
        let corner = |along: f64, across: f64| point(self.across, self.middle + across, along);
        let mut polygon = vec![
            corner(from, -half),
            corner(to, -half),
            corner(to, half),
            corner(from, half),
        ];
        if self.across == 0 {
            // Counterclockwise, like the others.
            polygon.reverse();
        }
        self.walls.push(PlanWall {
            polygon,
            height: self.scale.height,
            color: None,
        });
    }
}
