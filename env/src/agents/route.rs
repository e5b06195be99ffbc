//! Ways around obstacles: the next step to a goal, and how far it is. Which of several goals is nearest is found in
//! `nearest.rs`; who walks the ways, in `on_rails.rs`.

use driftworld_spec::World;

use super::flood::{Charge, Flood, STRAIGHT};
use super::marks::Marks;
use super::occupancy::OccupancyGrid;
use super::steering::distance;
use crate::scene::Scene;

/// Ways to one goal at a time, over the free cells of the arena. Another goal takes over what is known of the ground.
#[derive(Clone, Debug, Default)]
pub(super) struct Route {
    pub(super) occupancy: OccupancyGrid,
    pub(super) flood: Flood,
    pub(super) marks: Marks,
}

impl Route {
    /// Leads to a place from now on, clear of walls and of these objects where they stand at the start.
    ///
    /// The goal's own cell may be blocked by what stands around it.
    pub(super) fn lead(&mut self, world: &World, scene: &Scene, goal: [f32; 2], avoided: &[u32]) {
        self.occupancy.block(world, scene, avoided);
        let grid = self.occupancy.grid();
        self.flood.begin(&self.occupancy, grid.cell_at(goal));
    }

    /// Where to walk next from a place: the point a few cells down the way to the goal.
    pub(super) fn next(&mut self, from: [f32; 2], ahead: usize) -> [f32; 2] {
        let grid = self.occupancy.grid();
        let mut cell = self.open_cell(from);
        // Cells that are nearer than this one are found by then, and the way leads over no others.
        self.flood.reach(cell, &self.occupancy, Charge::Entered);
        for _ in 0..ahead {
            let around = grid.around().map(|(step, _)| cell.wrapping_add_signed(step));
            let inside = around.into_iter().filter(|next| !self.occupancy.is_closed(*next));
            match inside.min_by_key(|next| self.flood.distance(*next)) {
                Some(next) if self.flood.distance(next) < self.flood.distance(cell) => cell = next,
                _ => break,
            }
        }
        grid.centre(cell)
    }

    /// Whether the way from a place that is so far from the goal, in metres as the crow flies, hardly leads around anything.
    pub(super) fn is_straight(&mut self, from: [f32; 2], straight: f32) -> bool {
        let cell = self.open_cell(from);
        let way = self.flood.reach(cell, &self.occupancy, Charge::Entered);
        self.metres(way) <= 1.25 * straight + 2.0 * self.occupancy.grid().side()
    }

    /// The cell of a place, or one beside it where that belongs to a wall.
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

    /// A distance of the flood in metres.
    pub(super) fn metres(&self, distance: u32) -> f32 {
        distance as f32 / STRAIGHT as f32 * self.occupancy.grid().side()
    }
}
