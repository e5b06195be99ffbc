//! [`Grid`]: cells between thin walls, as mazes and rooms have them: which sides are open, and how the walls become
//! polygons. Which sides are opened is said in `maze.rs` and `rooms.rs`; walls as thick as cells are in `text.rs`.

use super::draws::{Draws, Purpose, share_of};
use super::plan::{Doorway, EAST, NORTH, Plan, PlanCell, PlanWall, SOUTH, WEST};

/// What is between two cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Open,
    Wall,
    /// A wall with a gap in its middle.
    Doorway,
}

/// What is between each cell and those to its east and north.
pub(super) struct Grid {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// For each cell, row by row from the south-west.
    pub(super) east: Vec<Side>,
    pub(super) north: Vec<Side>,
}

/// How a grid stands in the arena.
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

/// A side between two cells: that to the east or to the north of a cell.
pub(super) type SideOf = (usize, bool);

impl Grid {
    /// All sides are of one kind.
    pub(super) fn new([columns, rows]: [usize; 2], side: Side) -> Self {
        Self {
            columns,
            rows,
            east: vec![side; columns * rows],
            north: vec![side; columns * rows],
        }
    }

    pub(super) fn side(&mut self, (cell, to_the_north): SideOf) -> &mut Side {
        if to_the_north {
            &mut self.north[cell]
        } else {
            &mut self.east[cell]
        }
    }

    /// The cells beside a cell, each with the side between.
    pub(super) fn beside(&self, cell: usize) -> impl Iterator<Item = (usize, SideOf)> + use<> {
        let (columns, rows) = (self.columns, self.rows);
        let (column, row) = (cell % columns, cell / columns);
        let east = (column + 1 < columns).then(|| (cell + 1, (cell, false)));
        let north = (row + 1 < rows).then(|| (cell + columns, (cell, true)));
        let west = (column > 0).then(|| (cell - 1, (cell - 1, false)));
        let south = (row > 0).then(|| (cell - columns, (cell - columns, true)));
        [east, north, west, south].into_iter().flatten()
    }

    /// Every side between two cells.
    pub(super) fn sides(&self) -> impl Iterator<Item = SideOf> + use<> {
        let (columns, rows) = (self.columns, self.rows);
        (0..columns * rows).flat_map(move |cell| {
            let east = (cell % columns + 1 < columns).then_some((cell, false));
            let north = (cell / columns + 1 < rows).then_some((cell, true));
            east.into_iter().chain(north)
        })
    }

    /// Opens sides so that all cells hang together by one way each (a spanning tree, depth first). Each opened side
    /// becomes `as_what`; hands back the sides in the order of opening.
    pub(super) fn open_tree(&mut self, as_what: Side, draws: &mut Draws) -> Vec<SideOf> {
        let count = self.columns * self.rows;
        let mut seen = vec![false; count];
        let mut opened = Vec::with_capacity(count - 1);
        let mut stack = Vec::with_capacity(count);
        let first = draws.below(count);
        seen[first] = true;
        stack.push(first);
        while let Some(&cell) = stack.last() {
            let mut fresh = [(0, (0, false)); 4];
            let mut number = 0;
            for found in self.beside(cell).filter(|(next, _)| !seen[*next]) {
                fresh[number] = found;
                number += 1;
            }
            if number == 0 {
                stack.pop();
                continue;
            }
            let (next, side) = fresh[if number == 1 { 0 } else { draws.below(number) }];
            *self.side(side) = as_what;
            opened.push(side);
            seen[next] = true;
            stack.push(next);
        }
        opened
    }

    /// Takes walls away so that a share of them stands; those of a smaller share are among those of a larger one.
    pub(super) fn let_stand(&mut self, share: f64, seed: u64) {
        if share >= 1.0 {
            return;
        }
        let mut sides: Vec<SideOf> = self.sides().collect();
        sides.retain(|side| *self.side(*side) != Side::Open);
        Draws::new(seed, Purpose::Standing).shuffle(&mut sides);
        let stand = share_of(share, sides.len());
        for side in sides.drain(stand..) {
            *self.side(side) = Side::Open;
        }
    }

    /// The bits of the sides by which each cell can be left.
    fn ways_out(&self) -> Vec<u8> {
        let mut ways = vec![0; self.columns * self.rows];
        for row in 0..self.rows {
            for column in 0..self.columns {
                let cell = row * self.columns + column;
                if column + 1 < self.columns && self.east[cell] != Side::Wall {
                    ways[cell] |= EAST;
                    ways[cell + 1] |= WEST;
                }
                if row + 1 < self.rows && self.north[cell] != Side::Wall {
                    ways[cell] |= NORTH;
                    ways[cell + self.columns] |= SOUTH;
                }
            }
        }
        ways
    }

    /// The plan of the grid; `room_of` says which room a cell, by column and row, belongs to.
    pub(super) fn plan(&self, scale: &Scale, seed: u64, room_of: impl Fn([usize; 2]) -> u32) -> Plan {
        let ways = self.ways_out();
        let place = |cell: usize| [cell % self.columns, cell / self.columns];
        let mut plan = Plan::of_cells(scale.size, [self.columns, self.rows], seed, |cell, center| {
            Some(PlanCell {
                center,
                room: room_of(place(cell)),
                sides: ways[cell],
                letter: None,
            })
        });
        plan.corridor = plan.cell[0].min(plan.cell[1]) - scale.wall;
        if self.east.iter().chain(&self.north).any(|side| *side == Side::Doorway) {
            plan.corridor = plan.corridor.min(scale.doorway);
        }
        let (half, side) = (plan.size.map(|side| side / 2.0), plan.cell);
        // Lines from south to north, then from west to east.
        for (across, along) in [(0, 1), (1, 0)] {
            let to_the_north = across == 1;
            let [lines, length] = [[self.columns, self.rows][across] - 1, [self.columns, self.rows][along]];
            let cell_of = |line: usize, at: usize| {
                if to_the_north {
                    line * self.columns + at
                } else {
                    at * self.columns + line
                }
            };
            for line in 0..lines {
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
                for at in 0..length {
                    let cell = cell_of(line, at);
                    match if to_the_north {
                        self.north[cell]
                    } else {
                        self.east[cell]
                    } {
                        Side::Open => run.stop(metres(at) + scale.wall / 2.0),
                        Side::Wall => run.go(metres(at) - scale.wall / 2.0),
                        Side::Doorway => {
                            let center = metres(at) + side[along] / 2.0;
                            run.go(metres(at) - scale.wall / 2.0);
                            run.stop(center - scale.doorway / 2.0);
                            run.go(center + scale.doorway / 2.0);
                            let beyond = if to_the_north { cell + self.columns } else { cell + 1 };
                            plan.doorways.push(Doorway {
                                center: if to_the_north {
                                    [center, middle]
                                } else {
                                    [middle, center]
                                },
                                heading: if to_the_north { 0.0 } else { 90.0 },
                                width: scale.doorway,
                                depth: scale.wall,
                                rooms: [cell, beyond].map(|cell| room_of(place(cell))),
                            });
                        }
                    }
                }
                run.stop(half[along]);
            }
        }
        plan
    }
}

/// A straight wall that is being drawn out along a line.
struct Run<'a> {
    scale: &'a Scale,
    /// The axis across the line, and the line's place on it.
    across: usize,
    middle: f64,
    /// Half the arena along the line: no wall goes beyond.
    end: f64,
    start: Option<f64>,
    walls: &'a mut Vec<PlanWall>,
}

impl Run<'_> {
    fn go(&mut self, from: f64) {
        self.start.get_or_insert(from.max(-self.end));
    }

    fn stop(&mut self, to: f64) {
        let Some(from) = self.start.take() else { return };
        let (to, half) = (to.min(self.end), self.scale.wall / 2.0);
        let corner = |along: f64, across: f64| {
            if self.across == 0 {
                [self.middle + across, along]
            } else {
                [along, self.middle + across]
            }
        };
        let mut polygon = vec![
            corner(from, -half),
            corner(to, -half),
            corner(to, half),
            corner(from, half),
        ];
        if self.across == 0 {
            // Counterclockwise, as the others.
            polygon.reverse();
        }
        self.walls.push(PlanWall {
            polygon,
            height: self.scale.height,
            color: None,
        });
    }
}
