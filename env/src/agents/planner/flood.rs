//! [`Flood`]: costs of paths from some cells to others, by Dijkstra's algorithm with one bucket per cost, computed only as far as
//! needed.

use super::floor::Floor;

/// Cost of a straight and of a diagonal step over open ground, in fifths of a cell.
pub(super) const STRAIGHT: u32 = 5;
pub(super) const DIAGONAL: u32 = 7;

/// Paths that cost more count as none, so that sums of costs do not overflow.
const TOO_FAR: u32 = 1 << 31;

/// Costs of paths from some cells, in fifths of a cell: final for cells below `next`, upper bounds for the others.
#[derive(Clone, Debug, Default)]
pub(super) struct Flood {
    cost: Vec<u32>,
    /// Queued cells by cost, modulo the number of buckets, a power of two. A cell may also be queued under an outdated cost.
    buckets: Vec<Vec<u32>>,
    next: u32,
    num_waiting: usize,
    /// Whether paths lead away from the first cells, instead of to them.
    is_outward: bool,
}

impl Flood {
    /// Restarts from these cells, with paths to them or away from them.
    pub(super) fn begin(&mut self, floor: &Floor, starts: &[u32], is_outward: bool) {
        self.cost.clear();
        self.cost.resize(floor.grid.num_cells(), u32::MAX);
        // More buckets than the highest cost, so that queued cells are never a full round ahead.
        let num_buckets = (floor.max_cost as usize + 1).next_power_of_two();
        self.buckets.iter_mut().for_each(Vec::clear);
        self.buckets.resize_with(num_buckets, Vec::new);
        for start in starts {
            self.cost[*start as usize] = 0;
        }
        self.buckets[0].extend(starts);
        (self.next, self.num_waiting, self.is_outward) = (0, starts.len(), is_outward);
    }

    /// The cost of a cell: final, or the lowest so far; `u32::MAX` if there is none yet.
    pub(super) fn cost(&self, cell: usize) -> u32 {
        self.cost[cell]
    }

    /// Finalises the costs of a cell and of all cheaper cells.
    pub(super) fn reach(&mut self, floor: &Floor, cell: usize) -> u32 {
        while self.cost[cell] >= self.next && self.spread(floor) {}
        self.cost[cell]
    }

    /// Spreads from the cheapest queued cells. False if none is queued.
    fn spread(&mut self, floor: &Floor) -> bool {
        if self.num_waiting == 0 {
            return false;
        }
        let mask = self.buckets.len() - 1;
        while self.buckets[self.next as usize & mask].is_empty() {
            self.next += 1;
        }
        let here = self.next;
        let around = floor
            .grid
            .around()
            .map(|(step, is_diagonal)| (step, if is_diagonal { DIAGONAL } else { STRAIGHT }));
        let mut cells = std::mem::take(&mut self.buckets[here as usize & mask]);
        for cell in cells.iter().map(|cell| *cell as usize) {
            if self.cost[cell] != here {
                continue;
            }
            for (step, open) in around {
                let other = cell.wrapping_add_signed(step);
                let known = self.cost[other];
                // Most neighbours already have a lower cost.
                if here + open >= known {
                    continue;
                }
                let Some(cost) = floor.cost(cell, step, open, self.is_outward) else {
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
        true
    }
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::agents::grid::Grid;
    use crate::agents::planner::zone_costs::ZoneCosts;

    proptest! {
        #[test]
        fn costs_match_repeated_relaxation(
            drawn in vec(prop_oneof![Just(0_u16), 1_u16..9, Just(4000)], 80),
            starts in vec(0_usize..80, 1..3),
            order in vec(0_usize..80, 80),
        ) {
            let grid = Grid::over([-2.5, -2.0], [2.5, 2.0], 0.5);
            let inside: Vec<usize> = grid.within([-2.5, -2.0], [2.5, 2.0]).collect();
            prop_assert_eq!(inside.len(), 80);
            let mut weights = vec![0; grid.num_cells()];
            for (cell, weight) in inside.iter().zip(drawn) {
                weights[*cell] = weight;
            }
            let starts: Vec<usize> = starts.into_iter().map(|start| inside[start]).collect();
            weights[starts[0]] = 1;
            let floor = Floor::of(grid, weights);
            let mut expected = vec![u32::MAX; grid.num_cells()];
            for start in &starts {
                expected[*start] = 0;
            }
            for _ in &inside {
                for cell in inside.iter().copied().filter(|cell| expected[*cell] < u32::MAX).collect::<Vec<_>>() {
                    for (step, is_diagonal) in grid.around() {
                        let other = cell.wrapping_add_signed(step);
                        if let Some(cost) = floor.cost(cell, step, if is_diagonal { DIAGONAL } else { STRAIGHT }, false) {
                            expected[other] = expected[other].min(expected[cell] + cost);
                        }
                    }
                }
            }
            // The cost is final, regardless of earlier queries.
            let mut flood = Flood::default();
            flood.begin(&floor, &starts.iter().map(|start| *start as u32).collect::<Vec<_>>(), false);
            for cell in order.into_iter().map(|number| inside[number]) {
                prop_assert_eq!(flood.reach(&floor, cell), expected[cell]);
            }
        }

        /// On even ground, only entering zones tells the two directions apart.
        #[test]
        fn path_costs_the_same_from_either_end(
            entering in vec(prop_oneof![Just(0_u32), 1_u32..40], 80),
            ends in [0_usize..80, 0_usize..80],
        ) {
            let grid = Grid::over([-2.5, -2.0], [2.5, 2.0], 0.5);
            let inside: Vec<usize> = grid.within([-2.5, -2.0], [2.5, 2.0]).collect();
            let (mut weights, mut costs) = (vec![0; grid.num_cells()], vec![0; grid.num_cells()]);
            for (cell, cost) in inside.iter().zip(entering) {
                (weights[*cell], costs[*cell]) = (1, cost);
            }
            let mut floor = Floor::of(grid, weights);
            floor.zone_costs = ZoneCosts::of_entering(costs);
            floor.max_cost += floor.zone_costs.max_entry();
            let [start, end] = ends.map(|number| inside[number]);
            let cost = |from: usize, to: usize, is_outward| {
                let mut flood = Flood::default();
                flood.begin(&floor, &[from as u32], is_outward);
                flood.reach(&floor, to)
            };
            prop_assert_eq!(cost(start, end, true), cost(end, start, false));
        }
    }
}
