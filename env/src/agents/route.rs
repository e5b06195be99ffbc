//! [`Route`]: a path around obstacles to one goal, its next step and its length.

use driftworld_spec::World;

use super::flood::{Flood, STRAIGHT};
use super::marks::Marks;
use super::occupancy::{OccupancyGrid, Paths};
use crate::polygon::distance;
use crate::scene::Scene;

/// Paths to one goal at a time, over the free cells of the arena. Keeps the occupancy grid when the goal changes.
#[derive(Clone, Debug, Default)]
pub(super) struct Route {
    pub(super) occupancy: OccupancyGrid,
    pub(super) flood: Flood,
    pub(super) marks: Marks,
}

impl Route {
    /// Sets the goal; paths avoid walls, and these objects at their start positions. Objects around the goal may block its own
    /// cell.
    pub(super) fn lead(&mut self, world: &World, scene: &Scene, goal: [f32; 2], avoided: &[u32]) {
        self.occupancy.block(world, scene, avoided);
        let grid = self.occupancy.grid();
        self.begin(grid.cell_at(goal));
    }

    /// Restarts the flood from a cell.
    pub(super) fn begin(&mut self, start: usize) {
        self.flood.begin(&Paths::<true>(&self.occupancy), &[start as u32]);
        self.occupancy.closed().for_each(|cell| self.flood.shut(cell));
    }

    /// The cost of the path from a cell to the goal.
    pub(super) fn reach(&mut self, cell: usize) -> u32 {
        self.flood.reach(&Paths::<false>(&self.occupancy), cell)
    }

    /// The next point to walk to from a position: a few cells along the path to the goal.
    pub(super) fn next(&mut self, from: [f32; 2], ahead: usize) -> [f32; 2] {
        let grid = self.occupancy.grid();
        let mut cell = self.open_cell(from);
        // The path uses only nearer cells, whose distances are final now.
        self.reach(cell);
        for _ in 0..ahead {
            let around = grid.around().map(|(step, _)| cell.wrapping_add_signed(step));
            let inside = around.into_iter().filter(|next| !self.occupancy.is_closed(*next));
            match inside.min_by_key(|next| self.flood.cost(*next)) {
                Some(next) if self.flood.cost(next) < self.flood.cost(cell) => cell = next,
                _ => break,
            }
        }
        grid.centre(cell)
    }

    /// Whether the path from a position hardly exceeds the straight-line distance to the goal, `straight` metres.
    pub(super) fn is_straight(&mut self, from: [f32; 2], straight: f32) -> bool {
        let cell = self.open_cell(from);
        let length = self.reach(cell);
        self.metres(length) <= 1.25 * straight + 2.0 * self.occupancy.grid().side()
    }

    /// The cell of a position, or the nearest open neighbour if that cell is closed.
    pub(super) fn open_cell(&self, from: [f32; 2]) -> usize {
        let grid = self.occupancy.grid();
        let cell = grid.cell_at(from);
        if !self.occupancy.is_closed(cell) {
            return cell;
        }
        let around = grid.around().map(|(step, _)| cell.wrapping_add_signed(step));
        let open = around.into_iter().filter(|next| !self.occupancy.is_closed(*next));
        let far = |cell: &usize| distance(grid.centre(*cell), from);
        open.min_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or(cell)
    }

    /// Converts a flood distance to metres.
    pub(super) fn metres(&self, distance: u32) -> f32 {
        distance as f32 / STRAIGHT as f32 * self.occupancy.grid().side()
    }
}
