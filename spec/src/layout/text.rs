//! A layout drawn with letters: each letter is a cell, either wall or free.

use std::collections::BTreeMap;

use super::Legend;
use super::draws::{Draws, Purpose, share_of};
use super::plan::{Doorway, EAST, NORTH, Plan, PlanCell, PlanWall, SOUTH, WEST};

impl Legend {
    /// The default meaning of a letter: `#` and `*` a wall, a space, `.` and `_` floor, `A` and `P` a start, `D` a doorway.
    pub fn of_letter(letter: char) -> Option<Self> {
        match letter {
            '#' | '*' => Some(Self::Wall),
            ' ' | '.' | '_' => Some(Self::Floor),
            'A' | 'P' => Some(Self::Start),
            'D' => Some(Self::Doorway),
            _ => None,
        }
    }
}

/// A text with its legend.
pub(super) struct TextMap<'a> {
    pub(super) rows: &'a [String],
    pub(super) legend: &'a BTreeMap<String, Legend>,
    /// Side of a cell in metres.
    pub(super) cell: f64,
    pub(super) height: Option<f64>,
}

/// The content of a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Square {
    Wall,
    Floor,
    Doorway,
}

impl TextMap<'_> {
    /// Columns and rows; the first row sets the length of all.
    pub(super) fn lattice(&self) -> [usize; 2] {
        let columns = self.rows.first().map_or(0, |row| row.chars().count());
        [columns, self.rows.len()]
    }

    pub(super) fn size(&self) -> [f64; 2] {
        self.lattice().map(|count| count as f64 * self.cell)
    }

    /// The meaning of a letter.
    pub(super) fn meaning(&self, letter: char) -> Option<Legend> {
        let mut buffer = [0; 4];
        let own = self.legend.get(&*letter.encode_utf8(&mut buffer));
        own.cloned().or_else(|| Legend::of_letter(letter))
    }

    /// Whether a letter means more than plain floor; a floor letter named in the legend does.
    fn is_meaningful(&self, letter: char) -> bool {
        match self.meaning(letter) {
            Some(Legend::Wall) => false,
            Some(Legend::Floor) => self.legend.contains_key(&*letter.encode_utf8(&mut [0; 4])),
            _ => true,
        }
    }

    pub(super) fn plan(&self, standing: f64, seed: u64) -> Plan {
        let [columns, rows] = self.lattice();
        // The first line is the northernmost.
        let letters: Vec<char> = self.rows.iter().rev().flat_map(|row| row.chars()).collect();
        let mut squares: Vec<Square> = letters
            .iter()
            .map(|letter| match self.meaning(*letter) {
                Some(Legend::Wall) | None => Square::Wall,
                Some(Legend::Doorway) => Square::Doorway,
                Some(Legend::Floor | Legend::Start | Legend::Group(_)) => Square::Floor,
            })
            .collect();
        remove_walls(&mut squares, [columns, rows], standing, seed);
        let rooms = rooms(&squares, columns);
        let mut plan = Plan::of_cells(self.size(), [columns, rows], seed, |position, center| {
            (squares[position] != Square::Wall).then(|| PlanCell {
                center,
                room: rooms[position],
                sides: sides(&squares, columns, position),
                letter: self.is_meaningful(letters[position]).then_some(letters[position]),
            })
        });
        plan.corridor = self.cell;
        let half = plan.size.map(|side| side / 2.0);
        let at = |index: usize, axis: usize| index as f64 * self.cell - half[axis];
        plan.walls = rectangles(&squares, [columns, rows])
            .into_iter()
            .map(|[west, south, east, north]| {
                let ([x0, x1], [y0, y1]) = ([at(west, 0), at(east, 0)], [at(south, 1), at(north, 1)]);
                PlanWall {
                    polygon: vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]],
                    height: self.height,
                    color: None,
                }
            })
            .collect();
        plan.doorways = doorways(&squares, columns, &rooms, &plan, self.cell);
        plan
    }
}

/// The eastern, northern, western and southern neighbours of a position, if they are inside the text.
fn neighbours(position: usize, columns: usize, count: usize) -> [Option<usize>; 4] {
    let (column, row) = (position % columns, position / columns);
    [
        (column + 1 < columns).then(|| position + 1),
        (position + columns < count).then(|| position + columns),
        (column > 0).then(|| position - 1),
        (row > 0).then(|| position - columns),
    ]
}

/// The open sides of a position.
fn sides(squares: &[Square], columns: usize, position: usize) -> u8 {
    let near = neighbours(position, columns, squares.len());
    near.into_iter()
        .zip([EAST, NORTH, WEST, SOUTH])
        .filter(|(next, _)| next.is_some_and(|next| squares[next] != Square::Wall))
        .fold(0, |all, (_, side)| all | side)
}

/// Removes walls until a share of those inside the outermost ring is left.
fn remove_walls(squares: &mut [Square], [columns, rows]: [usize; 2], share: f64, seed: u64) {
    if share >= 1.0 {
        return;
    }
    let is_inner = |position: usize| {
        let (column, row) = (position % columns, position / columns);
        column > 0 && row > 0 && column + 1 < columns && row + 1 < rows
    };
    let mut walls: Vec<usize> = (0..squares.len())
        .filter(|position| squares[*position] == Square::Wall && is_inner(*position))
        .collect();
    Draws::new(seed, Purpose::Standing).shuffle(&mut walls);
    for position in walls.drain(share_of(share, walls.len())..) {
        squares[position] = Square::Floor;
    }
}

/// The room of each position: a connected part without doorways. A doorway belongs to the first adjacent room.
fn rooms(squares: &[Square], columns: usize) -> Vec<u32> {
    const NONE: u32 = u32::MAX;
    let mut rooms = vec![NONE; squares.len()];
    let mut count = 0;
    for first in 0..squares.len() {
        if squares[first] != Square::Floor || rooms[first] != NONE {
            continue;
        }
        rooms[first] = count;
        let mut open = vec![first];
        while let Some(position) = open.pop() {
            for next in neighbours(position, columns, squares.len()).into_iter().flatten() {
                if squares[next] == Square::Floor && rooms[next] == NONE {
                    rooms[next] = count;
                    open.push(next);
                }
            }
        }
        count += 1;
    }
    for position in (0..squares.len()).filter(|position| squares[*position] == Square::Doorway) {
        let near = neighbours(position, columns, squares.len()).into_iter().flatten();
        let near = near.filter(|next| squares[*next] == Square::Floor);
        rooms[position] = near.map(|next| rooms[next]).min().unwrap_or_else(|| {
            count += 1;
            count - 1
        });
    }
    rooms
}

fn doorways(squares: &[Square], columns: usize, rooms: &[u32], plan: &Plan, cell: f64) -> Vec<Doorway> {
    let positions = plan.cells.iter().enumerate().map(|(number, found)| {
        let [column, row] = plan.column_and_row(number);
        (row * columns + column, found.center)
    });
    positions
        .filter(|(position, _)| squares[*position] == Square::Doorway)
        .map(|(position, center)| {
            let [east, north, west, south] = neighbours(position, columns, squares.len());
            let is_floor = |next: &Option<usize>| next.is_some_and(|next| squares[next] != Square::Wall);
            // The doorway leads along the axis with more floor neighbours; northwards on a tie.
            let count = |pair: [Option<usize>; 2]| pair.iter().filter(|next| is_floor(next)).count();
            let along_x = count([west, east]) > count([south, north]);
            let [before, beyond] = if along_x { [west, east] } else { [south, north] };
            let room = |next: Option<usize>| {
                next.filter(|next| is_floor(&Some(*next)))
                    .map_or(rooms[position], |next| rooms[next])
            };
            Doorway {
                center,
                heading: if along_x { 90.0 } else { 0.0 },
                width: cell,
                depth: cell,
                rooms: [room(before), room(beyond)],
            }
        })
        .collect()
}

/// The walls as a few disjoint rectangles, `[west, south, east, north]` in cells: runs from west to east, with equal runs in
/// adjacent rows merged.
fn rectangles(squares: &[Square], [columns, rows]: [usize; 2]) -> Vec<[usize; 4]> {
    let mut done: Vec<[usize; 4]> = Vec::new();
    let mut open: Vec<[usize; 4]> = Vec::new();
    for row in 0..rows {
        let mut runs = Vec::new();
        let mut column = 0;
        while column < columns {
            let start = column;
            while column < columns && squares[row * columns + column] == Square::Wall {
                column += 1;
            }
            if column > start {
                runs.push([start, row, column, row + 1]);
            }
            column += 1;
        }
        for run in &mut runs {
            if let Some(below) = open.iter().position(|below| [below[0], below[2]] == [run[0], run[2]]) {
                run[1] = open.swap_remove(below)[1];
            }
        }
        done.append(&mut open);
        open = runs;
    }
    done.append(&mut open);
    done.sort_unstable_by_key(|[west, south, ..]| [*south, *west]);
    done
}
