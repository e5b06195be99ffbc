//! Distances from one cell to others, by Dijkstra's algorithm with one bucket per distance, computed only as far as needed.

use super::occupancy::OccupancyGrid;

/// Cost of a straight and of a diagonal step, in fifths of a cell.
pub(super) const STRAIGHT: u32 = 5;
pub(super) const DIAGONAL: u32 = 7;

/// Factor on the cost of a step through a blocked cell, so that paths cross blocked cells only if there is no other way.
pub(super) const BLOCKED: u32 = 40;

/// More than the largest step cost, so that queued cells are never a full round ahead; a power of two.
const NUM_BUCKETS: usize = 512;

/// Which cell of a flood step decides whether the step counts as blocked: always the one that the walk leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Charge {
    /// The flood spreads from the walk's goal: the cell that the flood enters.
    Entered,
    /// The flood spreads from the walk's start: the cell that the flood leaves.
    Left,
}

/// Distances from one cell, in fifths of a cell: final for cells nearer than `next`, upper bounds for the others.
#[derive(Clone, Debug, Default)]
pub(super) struct Flood {
    distance: Vec<u32>,
    /// Queued cells by distance, modulo the number of buckets. A cell may also be queued under an outdated distance.
    buckets: Vec<Vec<u32>>,
    next: u32,
    num_waiting: usize,
}

impl Flood {
    /// Restarts from a cell.
    pub(super) fn begin(&mut self, occupancy: &OccupancyGrid, start: usize) {
        let grid = occupancy.grid();
        self.distance.clear();
        self.distance.resize(grid.num_cells(), u32::MAX);
        // Distance 0 cannot be undercut, so the flood never enters the rim or the walls of layouts.
        grid.rim()
            .chain(occupancy.sealed())
            .for_each(|cell| self.distance[cell] = 0);
        self.buckets.resize_with(NUM_BUCKETS, Vec::new);
        self.buckets.iter_mut().for_each(Vec::clear);
        self.distance[start] = 0;
        self.buckets[0].push(start as u32);
        (self.next, self.num_waiting) = (0, 1);
    }

    /// The distance of a cell: final, or the shortest so far; `u32::MAX` if there is none yet.
    pub(super) fn distance(&self, cell: usize) -> u32 {
        self.distance[cell]
    }

    /// Finalises the distances of a cell and of all nearer cells.
    pub(super) fn reach(&mut self, cell: usize, occupancy: &OccupancyGrid, charge: Charge) -> u32 {
        while self.distance[cell] >= self.next && self.spread(occupancy, charge, |_| {}).is_some() {}
        self.distance[cell]
    }

    /// Spreads from the nearest queued cells, which it passes to the callback; returns their distance. `None` once the queue is
    /// empty.
    pub(super) fn spread(
        &mut self,
        occupancy: &OccupancyGrid,
        charge: Charge,
        mut found: impl FnMut(usize),
    ) -> Option<u32> {
        if self.num_waiting == 0 {
            return None;
        }
        let slot = |distance: u32| distance as usize % NUM_BUCKETS;
        while self.buckets[slot(self.next)].is_empty() {
            self.next += 1;
        }
        let here = self.next;
        let around = occupancy
            .grid()
            .around()
            .map(|(step, is_diagonal)| (step, if is_diagonal { DIAGONAL } else { STRAIGHT }));
        let mut cells = std::mem::take(&mut self.buckets[slot(here)]);
        for cell in cells.iter().map(|cell| *cell as usize) {
            if self.distance[cell] != here {
                continue;
            }
            found(cell);
            let factor = if charge == Charge::Left && occupancy.is_blocked(cell) {
                BLOCKED
            } else {
                1
            };
            for (step, cost) in around {
                let other = cell.wrapping_add_signed(step);
                let known = self.distance[other];
                // Most neighbours already have a shorter distance.
                if here + cost >= known {
                    continue;
                }
                let is_costly = charge == Charge::Entered && occupancy.is_blocked(other);
                let through = here + cost * if is_costly { BLOCKED } else { factor };
                if through < known {
                    self.distance[other] = through;
                    self.buckets[slot(through)].push(other as u32);
                    self.num_waiting += 1;
                }
            }
        }
        self.num_waiting -= cells.len();
        cells.clear();
        self.buckets[slot(here)] = cells;
        self.next = here + 1;
        Some(here)
    }
}
