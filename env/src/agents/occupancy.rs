//! [`OccupancyGrid`] marks the cells where the agent cannot walk: near walls, and near objects that paths avoid.

use driftworld_spec::{World, Zone, ZoneEnd};

use super::flood::{DIAGONAL, Ground};
use super::grid::Grid;
use crate::ground;
use crate::polygon::{is_near_or_inside, to_f32};
use crate::scene::Scene;

/// Factor on the cost of a step through a blocked cell, so that paths cross blocked cells only if there is no other way.
pub(super) const BLOCKED: u32 = 40;

/// Clearance of paths from walls and objects, in metres in addition to half the agent's width.
const CLEARANCE: f32 = 0.15;

/// Like [`CLEARANCE`], reduced for narrow corridors; `body` is half the agent's width.
fn clearance(corridor: f32, body: f32) -> f32 {
    CLEARANCE.min((corridor / 2.0 - body) / 2.0).max(0.0)
}

/// Distance in metres that the agent's centre keeps from zones that cost.
const ZONE_CLEARANCE: f32 = 0.35;

/// Maximum side of a cell in metres if zones end the episode as a failure, so that narrow gaps between them are found.
const SIDE_BESIDE_FAILURE: f32 = 0.25;

/// Counts the obstacles that block each cell: walls count once, and each avoided object once. Updates only what has changed
/// since the last path.
#[derive(Clone, Debug, Default)]
pub(super) struct OccupancyGrid {
    grid: Grid,
    walls: Walls,
    blockers: Vec<u32>,
    /// Whether a cell belongs to a wall of a layout, or to a zone that ends the episode as a failure: no path crosses it. Empty
    /// if there are neither.
    sealed: Vec<bool>,
    /// The avoided objects, in ascending order of index.
    discs: Vec<Disc>,
}

/// The ground for a flood from the start of walks, or from their end. It charges for the blocked cells that a walk leaves.
pub(super) struct Paths<'a, const FROM_START: bool>(pub(super) &'a OccupancyGrid);

impl<const FROM_START: bool> Ground for Paths<'_, FROM_START> {
    fn grid(&self) -> Grid {
        self.0.grid
    }

    fn max_cost(&self) -> u32 {
        BLOCKED * DIAGONAL
    }

    #[inline]
    fn cost(&self, from: usize, step: isize, open: u32) -> Option<u32> {
        let left = if FROM_START {
            from
        } else {
            from.wrapping_add_signed(step)
        };
        Some(open * if self.0.is_blocked(left) { BLOCKED } else { 1 })
    }
}

/// The obstacles other than objects.
#[derive(Clone, Debug, Default, PartialEq)]
struct Walls {
    arena_size: [f32; 2],
    /// Half the agent's width in metres.
    body: f32,
    /// Width of the layout's narrowest corridor, in metres.
    corridor: f32,
    regions: Vec<Vec<[f64; 2]>>,
    /// Zones that cost, or end an episode as a failure: paths avoid them if possible.
    zones: Vec<Zone>,
}

/// The ground where an object blocks the agent's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Disc {
    object: u32,
    centre: [f32; 2],
    radius: f32,
}

impl Disc {
    /// The cells whose centres it covers.
    pub(super) fn cells(self, grid: Grid) -> impl Iterator<Item = usize> {
        let near = grid.near(self.centre, self.radius);
        near.filter(move |cell| self.covers(*cell, grid))
    }

    /// An upper bound on the number of cells that it covers.
    pub(super) fn num_cells(self, grid: Grid) -> usize {
        let across = (2.0 * self.radius / grid.side()) as usize + 2;
        across.saturating_mul(across).min(grid.num_cells())
    }

    /// The first and the last cell that it covers in each row.
    fn rows(self, grid: Grid) -> impl Iterator<Item = (usize, usize)> {
        let [x, y] = self.centre;
        let column = |x: f32| grid.within([x, y - self.radius], [x, y + self.radius]);
        column(x).filter_map(move |middle| {
            let dy = grid.centre(middle)[1] - y;
            let half = (self.radius * self.radius - dy * dy).max(0.0).sqrt();
            // Two extra cells on each side allow for rounding.
            let end = |sign: f32| {
                let [x, y] = [x + sign * (half + 2.0 * grid.side()), grid.centre(middle)[1]];
                grid.cell_at([x, y])
            };
            let mut cells = end(-1.0)..=end(1.0);
            let covered = |cell: &usize| self.covers(*cell, grid);
            let first = cells.find(covered)?;
            Some((first, cells.rfind(covered).unwrap_or(first)))
        })
    }

    /// Whether it covers the centre of a cell.
    pub(super) fn covers(self, cell: usize, grid: Grid) -> bool {
        let at = grid.centre(cell);
        let (dx, dy) = (at[0] - self.centre[0], at[1] - self.centre[1]);
        dx * dx + dy * dy < self.radius * self.radius
    }
}

impl OccupancyGrid {
    pub(super) fn grid(&self) -> Grid {
        self.grid
    }

    /// Whether anything blocks a cell.
    pub(super) fn is_blocked(&self, cell: usize) -> bool {
        self.blockers[cell] > 0
    }

    /// Whether no path may cross a cell, even as a last resort: it belongs to the rim, a wall of a layout, or a zone that
    /// fails.
    pub(super) fn is_closed(&self, cell: usize) -> bool {
        self.grid.is_rim(cell) || self.sealed.get(cell).is_some_and(|sealed| *sealed)
    }

    /// All cells that no path may cross.
    pub(super) fn closed(&self) -> impl Iterator<Item = usize> {
        let sealed = (0..self.sealed.len()).filter(|cell| self.sealed[*cell]);
        self.grid.rim().chain(sealed)
    }

    /// The number of obstacles that block a cell.
    pub(super) fn count(&self, cell: usize) -> u32 {
        self.blockers[cell]
    }

    /// The ground that an object blocks, if it is avoided.
    pub(super) fn disc(&self, object: u32) -> Option<Disc> {
        let index = self.discs.binary_search_by_key(&object, |disc| disc.object).ok()?;
        Some(self.discs[index])
    }

    /// Blocks the walls of a world and the `avoided` objects at their start positions; frees everything else.
    pub(super) fn block(&mut self, world: &World, scene: &Scene, avoided: &[u32]) {
        self.block_walls(world, scene);
        let margin = self.walls.body + clearance(self.walls.corridor, self.walls.body);
        let mut discs: Vec<Disc> = avoided
            .iter()
            .map(|&object| {
                let item = &scene.items[object as usize];
                Disc {
                    object,
                    centre: world.objects[object as usize].coordinates.map(|metres| metres as f32),
                    radius: item.body.collider.radius() * item.scale + margin,
                }
            })
            .collect();
        discs.sort_by_key(|disc| disc.object);
        // Both lists are sorted; a disc in only one of them was added or removed.
        let mut changed: Vec<(Disc, bool)> = Vec::new();
        let (mut old, mut new) = (self.discs.iter().peekable(), discs.iter().peekable());
        loop {
            match (old.peek(), new.peek()) {
                (Some(left), Some(right)) if left == right => {
                    old.next();
                    new.next();
                }
                (Some(left), right) if right.is_none_or(|right| left.object <= right.object) => {
                    changed.push((**left, false));
                    old.next();
                }
                (_, Some(right)) => {
                    changed.push((**right, true));
                    new.next();
                }
                (_, None) => break,
            }
        }
        self.apply(&changed);
        self.discs = discs;
    }

    /// Blocks (`true`) or frees the cells of discs.
    fn apply(&mut self, changed: &[(Disc, bool)]) {
        let grid = self.grid;
        let num_cells: usize = changed.iter().map(|(disc, _)| disc.num_cells(grid)).sum();
        if num_cells <= 4 * grid.num_cells() {
            for (disc, is_added) in changed {
                for cell in disc.cells(grid) {
                    self.blockers[cell] = self.blockers[cell].wrapping_add_signed(if *is_added { 1 } else { -1 });
                }
            }
            return;
        }
        // For many large discs: differences between neighbouring cells, then a running sum. Each row ends in a cell of the rim.
        let mut steps = vec![0_i32; grid.num_cells()];
        for (disc, is_added) in changed {
            let by = if *is_added { 1 } else { -1 };
            for (first, last) in disc.rows(grid) {
                steps[first] += by;
                steps[last + 1] -= by;
            }
        }
        let mut by = 0;
        for (blockers, step) in self.blockers.iter_mut().zip(steps) {
            by += step;
            *blockers = blockers.wrapping_add_signed(by);
        }
    }

    fn block_walls(&mut self, world: &World, scene: &Scene) {
        let (arena_size, body) = (scene.arena_size(), world.agent_params.agent_width as f32 / 2.0);
        let corridor = world.plan().map_or(f32::INFINITY, |plan| plan.corridor as f32);
        let zones = || world.environment_params.zones.iter().filter(|zone| zone.is_costly());
        let fails = |zone: &Zone| zone.ends == Some(ZoneEnd::Failure);
        let known = &self.walls;
        if !self.blockers.is_empty()
            && (known.arena_size, known.body, known.corridor) == (arena_size, body, corridor)
            && known.regions.iter().map(Vec::as_slice).eq(world.obstacles())
            && known.zones.iter().eq(zones())
        {
            return;
        }
        let margin = body + clearance(corridor, body);
        // Fine enough that even narrow corridors have cells with free centres.
        let grid = match world.plan() {
            // Also fine enough that a body beside a wall is not in one of the wall's cells.
            Some(_) => Grid::fine(arena_size, (corridor / 2.0 - margin).min(body / 1.45)),
            None if zones().any(fails) => Grid::fine(arena_size, SIDE_BESIDE_FAILURE),
            None => Grid::fine(arena_size, f32::INFINITY),
        };
        self.grid = grid;
        self.discs.clear();
        self.blockers.clear();
        self.blockers.resize(grid.num_cells(), 0);
        self.sealed.clear();
        let half = arena_size.map(|metres| metres / 2.0);
        for cell in grid.within(half.map(|metres| -metres), half) {
            let at = grid.centre(cell);
            let is_near = |axis: usize| half[axis] - at[axis].abs() < body;
            self.blockers[cell] = u32::from(is_near(0) || is_near(1));
        }
        // At this distance, no step between cells can cross a wall.
        let seal = 0.71 * grid.side();
        if world.plan().is_some() || zones().any(fails) {
            self.sealed.resize(grid.num_cells(), false);
        }
        let walls = world.obstacles().map(|corners| (corners.to_vec(), margin, true));
        let costly = zones().map(|zone| (ground::corners(zone), ZONE_CLEARANCE, fails(zone)));
        for (corners, margin, is_sealed) in walls.chain(costly) {
            let near = grid.near_polygon(&corners, margin);
            let corners = to_f32(&corners);
            let is_within =
                |cell: usize, metres: f32| is_near_or_inside(corners.iter().copied(), grid.centre(cell), metres);
            for cell in near {
                if self.blockers[cell] == 0 && is_within(cell, margin) {
                    self.blockers[cell] = 1;
                }
                if is_sealed && let Some(sealed) = self.sealed.get_mut(cell) {
                    *sealed |= is_within(cell, seal);
                }
            }
        }
        let regions = world.obstacles().map(<[[f64; 2]]>::to_vec).collect();
        self.walls = Walls {
            arena_size,
            body,
            corridor,
            regions,
            zones: zones().cloned().collect(),
        };
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn rows_of_a_disc_cover_exactly_its_cells(
            size in [1.0..400.0_f32, 1.0..400.0_f32],
            place in [-1.2..1.2_f32, -1.2..1.2_f32],
            radius in prop_oneof![0.0..3.0_f32, 0.0..300.0_f32],
        ) {
            let grid = Grid::over(size);
            let centre = [place[0] * size[0] / 2.0, place[1] * size[1] / 2.0];
            let disc = Disc { object: 0, centre, radius };
            let rows = disc.rows(grid).flat_map(|(first, last)| first..=last);
            let cells: Vec<usize> = disc.cells(grid).collect();
            prop_assert!(rows.eq(cells.iter().copied()));
            prop_assert!(cells.len() <= disc.num_cells(grid));
        }

        #[test]
        fn adding_many_discs_at_once_equals_adding_each(
            discs in prop::collection::vec(([-30.0..30.0_f32, -30.0..30.0_f32], 0.0..60.0_f32, any::<bool>()), 1..40),
        ) {
            let grid = Grid::over([50.0, 40.0]);
            let ground = OccupancyGrid { grid, blockers: vec![100; grid.num_cells()], ..OccupancyGrid::default() };
            let discs: Vec<(Disc, bool)> = discs
                .into_iter()
                .map(|(centre, radius, is_added)| (Disc { object: 0, centre, radius }, is_added))
                .collect();
            let (mut together, mut alone) = (ground.clone(), ground);
            together.apply(&discs);
            for disc in &discs {
                for cell in disc.0.cells(grid) {
                    alone.blockers[cell] = alone.blockers[cell].wrapping_add_signed(if disc.1 { 1 } else { -1 });
                }
            }
            prop_assert!(together.blockers == alone.blockers);
        }
    }
}
