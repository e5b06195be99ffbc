//! [`Flood`]: costs of paths from some cells to others, by Dijkstra's algorithm with one bucket per cost, computed only as far as
//! needed.

use super::grid::Grid;

/// Cost of a straight and of a diagonal step over open ground, in fifths of a cell.
pub(super) const STRAIGHT: u32 = 5;
pub(super) const DIAGONAL: u32 = 7;

/// More than the cost of any path. A flood goes no farther, so that sums of costs do not overflow.
const TOO_FAR: u32 = 1 << 31;

/// Ground that a flood spreads over.
pub(super) trait Ground {
    fn grid(&self) -> Grid;

    /// The highest cost of a step.
    fn max_cost(&self) -> u32;

    /// The cost of spreading from a cell to its neighbour at this offset, where a step on open ground costs `open`; `None` if
    /// no step leads there.
    fn cost(&self, from: usize, step: isize, open: u32) -> Option<u32>;
}

/// Costs of paths from some cells, in fifths of a cell: final for cells below `next`, upper bounds for the others.
#[derive(Clone, Debug, Default)]
pub(super) struct Flood {
    cost: Vec<u32>,
    /// Queued cells by cost, modulo the number of buckets, a power of two. A cell may also be queued under an outdated cost.
    buckets: Vec<Vec<u32>>,
    next: u32,
    num_waiting: usize,
}

impl Flood {
    /// Restarts from these cells.
    pub(super) fn begin(&mut self, ground: &impl Ground, starts: &[u32]) {
        self.cost.clear();
        self.cost.resize(ground.grid().num_cells(), u32::MAX);
        // More buckets than the highest cost, so that queued cells are never a full round ahead.
        let num_buckets = (ground.max_cost() as usize + 1).next_power_of_two();
        self.buckets.iter_mut().for_each(Vec::clear);
        self.buckets.resize_with(num_buckets, Vec::new);
        for start in starts {
            self.cost[*start as usize] = 0;
        }
        self.buckets[0].extend(starts);
        (self.next, self.num_waiting) = (0, starts.len());
    }

    /// Keeps the flood out of a cell: cost 0 cannot be undercut.
    pub(super) fn shut(&mut self, cell: usize) {
        self.cost[cell] = 0;
    }

    /// The cost of a cell: final, or the lowest so far; `u32::MAX` if there is none yet.
    pub(super) fn cost(&self, cell: usize) -> u32 {
        self.cost[cell]
    }

    /// Finalises the costs of a cell and of all cheaper cells.
    pub(super) fn reach(&mut self, ground: &impl Ground, cell: usize) -> u32 {
        while self.cost[cell] >= self.next && self.spread(ground, |_| {}).is_some() {}
        self.cost[cell]
    }

    /// Spreads from the cheapest queued cells, which it passes to the callback; returns their cost. `None` once the queue is
    /// empty.
    pub(super) fn spread(&mut self, ground: &impl Ground, mut found: impl FnMut(usize)) -> Option<u32> {
        if self.num_waiting == 0 {
            return None;
        }
        let mask = self.buckets.len() - 1;
        while self.buckets[self.next as usize & mask].is_empty() {
            self.next += 1;
        }
        let here = self.next;
        let around = ground
            .grid()
            .around()
            .map(|(step, is_diagonal)| (step, if is_diagonal { DIAGONAL } else { STRAIGHT }));
        let mut cells = std::mem::take(&mut self.buckets[here as usize & mask]);
        for cell in cells.iter().map(|cell| *cell as usize) {
            if self.cost[cell] != here {
                continue;
            }
            found(cell);
            for (step, open) in around {
                let other = cell.wrapping_add_signed(step);
                let known = self.cost[other];
                // Most neighbours already have a lower cost.
                if here + open >= known {
                    continue;
                }
                let Some(cost) = ground.cost(cell, step, open) else {
                    continue;
                };
                let through = here + cost;
                if through < known.min(TOO_FAR) {
                    self.cost[other] = through;
                    self.buckets[through as usize & mask].push(other as u32);
                    self.num_waiting += 1;
                }
            }
        }
        self.num_waiting -= cells.len();
        cells.clear();
        self.buckets[here as usize & mask] = cells;
        self.next = here + 1;
        Some(here)
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    /// Weights of cells; a step costs that of the cell it leads to, and cells of weight 0 are closed.
    struct Weights(Grid, Vec<u32>);

    impl Ground for Weights {
        fn grid(&self) -> Grid {
            self.0
        }

        fn max_cost(&self) -> u32 {
            DIAGONAL * self.1.iter().max().unwrap()
        }

        fn cost(&self, from: usize, step: isize, open: u32) -> Option<u32> {
            let weight = self.1[from.wrapping_add_signed(step)];
            (weight > 0).then_some(open * weight)
        }
    }

    proptest! {
        #[test]
        fn costs_match_repeated_relaxation(
            drawn in vec(prop_oneof![Just(0_u32), 1_u32..9, Just(4000)], 80),
            starts in vec(0_usize..80, 1..3),
            order in vec(0_usize..80, 80),
        ) {
            let grid = Grid::over([5.0, 4.0]);
            let inside: Vec<usize> = (0..grid.num_cells()).filter(|cell| !grid.is_rim(*cell)).collect();
            prop_assert_eq!(inside.len(), 80);
            let mut ground = Weights(grid, vec![0; grid.num_cells()]);
            for (cell, weight) in inside.iter().zip(drawn) {
                ground.1[*cell] = weight;
            }
            let starts: Vec<usize> = starts.into_iter().map(|start| inside[start]).collect();
            ground.1[starts[0]] = 1;
            let mut expected = vec![u32::MAX; grid.num_cells()];
            starts.iter().for_each(|start| expected[*start] = 0);
            for _ in &inside {
                for cell in inside.iter().copied().filter(|cell| expected[*cell] < u32::MAX).collect::<Vec<_>>() {
                    for (step, is_diagonal) in grid.around() {
                        let other = cell.wrapping_add_signed(step);
                        if let Some(cost) = ground.cost(cell, step, if is_diagonal { DIAGONAL } else { STRAIGHT }) {
                            expected[other] = expected[other].min(expected[cell] + cost);
                        }
                    }
                }
            }
            // Final whatever was asked before.
            let mut flood = Flood::default();
            flood.begin(&ground, &starts.iter().map(|start| *start as u32).collect::<Vec<_>>());
            for cell in order.into_iter().map(|number| inside[number]) {
                prop_assert_eq!(flood.reach(&ground, cell), expected[cell]);
            }
        }
    }
}
