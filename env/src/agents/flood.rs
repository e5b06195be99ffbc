//! How far every cell is from one of them: Dijkstra's way of finding it, with one bucket for each distance, and no
//! farther than anyone asks.

use super::occupancy::OccupancyGrid;

/// Cost of a step to a straight and to a slanting neighbour, in fifths of a cell.
pub(super) const STRAIGHT: u32 = 5;
pub(super) const SLANTING: u32 = 7;

/// How many times as dear a step is that belongs to a blocked cell: a way through is the last resort, for who is shut
/// in.
pub(super) const BLOCKED: u32 = 40;

/// More than the dearest step, so that what waits is never a full round ahead; a power of two.
const NUM_BUCKETS: usize = 512;

/// Which cell of a step makes it dear where it is blocked. Of a walk from far to near it is always the one that is
/// left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Charge {
    /// The flood spreads from the goal of walks: the cell that it comes to.
    Entered,
    /// The flood spreads from the start of walks: the cell that it comes from.
    Left,
}

/// Distances from one cell, in fifths of a cell: of the cells nearer than `next` they are found, of others they are
/// bounds.
#[derive(Clone, Debug, Default)]
pub(super) struct Flood {
    distance: Vec<u32>,
    /// Cells by the distance under which they wait, modulo the number of buckets. Some wait under an old distance, too.
    buckets: Vec<Vec<u32>>,
    next: u32,
    num_waiting: usize,
}

impl Flood {
    /// Begins anew from a cell.
    pub(super) fn begin(&mut self, occupancy: &OccupancyGrid, start: usize) {
        let grid = occupancy.grid();
        self.distance.clear();
        self.distance.resize(grid.num_cells(), u32::MAX);
        // Nothing is nearer than 0: the rim and the walls of layouts are never come to.
        grid.rim()
            .chain(occupancy.sealed())
            .for_each(|cell| self.distance[cell] = 0);
        self.buckets.resize_with(NUM_BUCKETS, Vec::new);
        self.buckets.iter_mut().for_each(Vec::clear);
        self.distance[start] = 0;
        self.buckets[0].push(start as u32);
        (self.next, self.num_waiting) = (0, 1);
    }

    /// The distance of a cell: found, or the shortest so far; `u32::MAX` if there is none yet.
    pub(super) fn distance(&self, cell: usize) -> u32 {
        self.distance[cell]
    }

    /// Finds the distance of a cell, and of all that are nearer.
    pub(super) fn reach(&mut self, cell: usize, occupancy: &OccupancyGrid, charge: Charge) -> u32 {
        while self.distance[cell] >= self.next && self.spread(occupancy, charge, |_| {}).is_some() {}
        self.distance[cell]
    }

    /// Spreads from the nearest cells that wait, which are told; hands back how far they are. `None` if all are found.
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
            .map(|(step, is_slanting)| (step, if is_slanting { SLANTING } else { STRAIGHT }));
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
                // Most neighbours are known to be nearer, whatever they cost.
                if here + cost >= known {
                    continue;
                }
                let dear = charge == Charge::Entered && occupancy.is_blocked(other);
                let through = here + cost * if dear { BLOCKED } else { factor };
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
