//! Which cells belong to which goals, while the best of many goals is found in `nearest.rs`.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::grid::Grid;

/// The most cells that are gone over around goals in one choice; then ways are as long as they are known to be.
const MOST_LOOKS: usize = 4_000_000;

/// Which goals a cell belongs to, as lists within one list, and room to look around a goal.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    /// For each cell the place of its first mark, from 1.
    first: Vec<u32>,
    /// Number of a goal, and the place of the next mark of the cell.
    links: Vec<(u32, u32)>,
    marked: Vec<usize>,
    /// For each cell the way from it to a goal, while that is being found.
    pub(super) back: Vec<u32>,
    pub(super) touched: Vec<usize>,
    pub(super) open: BinaryHeap<Reverse<(u32, usize)>>,
    /// How many more cells may be gone over around goals.
    pub(super) looks: usize,
}

impl Marks {
    pub(super) fn begin(&mut self, grid: Grid) {
        for cell in self.marked.drain(..) {
            // The list may be that of a larger arena.
            if let Some(first) = self.first.get_mut(cell) {
                *first = 0;
            }
        }
        self.links.clear();
        self.looks = MOST_LOOKS;
        self.first.resize(grid.num_cells(), 0);
        self.back.resize(grid.num_cells(), u32::MAX);
    }

    pub(super) fn add(&mut self, cell: usize, goal: usize) {
        self.links.push((goal as u32, self.first[cell]));
        self.first[cell] = self.links.len() as u32;
        self.marked.push(cell);
    }

    pub(super) fn of(&self, cell: usize, mut each: impl FnMut(usize)) {
        let mut next = self.first[cell];
        while let Some(&(goal, after)) = (next as usize).checked_sub(1).and_then(|place| self.links.get(place)) {
            each(goal as usize);
            next = after;
        }
    }
}
