//! Marks which cells belong to which goals, for the search in `nearest.rs`.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::grid::Grid;

/// Maximum number of cells visited around goals per choice; beyond that, the best path length found so far is used.
const MAX_SEARCHED_CELLS: usize = 4_000_000;

/// The goals of each cell, as linked lists in one vector, and scratch space for searching around a goal.
#[derive(Clone, Debug, Default)]
pub(super) struct Marks {
    /// For each cell, the index of its first link, counted from 1; 0 if it has none.
    first: Vec<u32>,
    /// A goal's number, and the index of the cell's next link, counted from 1.
    links: Vec<(u32, u32)>,
    marked: Vec<usize>,
    /// Distance from each cell to the goal of the current search.
    pub(super) back: Vec<u32>,
    pub(super) touched: Vec<usize>,
    pub(super) open: BinaryHeap<Reverse<(u32, usize)>>,
    /// Number of cells around goals that may still be visited.
    pub(super) searches_left: usize,
}

impl Marks {
    pub(super) fn begin(&mut self, grid: Grid) {
        for cell in self.marked.drain(..) {
            // The marks may be left over from a larger arena.
            if let Some(first) = self.first.get_mut(cell) {
                *first = 0;
            }
        }
        self.links.clear();
        self.searches_left = MAX_SEARCHED_CELLS;
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
