//! Ways around obstacles: how far every place is from a goal, on a grid. Who walks them is in `on_rails.rs`.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use driftworld_spec::World;

use crate::scene::Scene;

/// Most cells along one side of the grid.
const MOST_CELLS: usize = 256;

/// Cost of a step to a straight and to a slanting neighbour, in tenths of a cell.
const STRAIGHT: u32 = 10;
const SLANTING: u32 = 14;

/// Distances to a goal over the free cells of the arena.
#[derive(Clone, Debug)]
pub(crate) struct Route {
    cells: [usize; 2],
    corner: [f32; 2],
    side: f32,
    distance: Vec<u32>,
}

impl Route {
    /// Ways to a place that keep clear of walls and of these objects where they stand at the start.
    pub(crate) fn to(world: &World, scene: &Scene, goal: [f32; 2], avoided: &[u32]) -> Self {
        let [width, depth] = scene.arena_size();
        let side = (width.max(depth) / MOST_CELLS as f32).max(0.5);
        let cells = [width, depth].map(|metres| ((metres / side).ceil() as usize).max(1));
        let mut route = Self {
            cells,
            corner: [-width / 2.0, -depth / 2.0],
            side,
            distance: vec![u32::MAX; cells[0] * cells[1]],
        };
        let blocked = route.blocked(world, scene, avoided);
        route.flood(goal, &blocked);
        route
    }

    fn blocked(&self, world: &World, scene: &Scene, avoided: &[u32]) -> Vec<bool> {
        let body = world.agent_params.agent_width as f32 / 2.0;
        let margin = body + 0.15;
        let regions: Vec<Vec<[f64; 2]>> = world
            .environment_params
            .regions()
            .into_iter()
            .map(<[[f64; 2]]>::to_vec)
            .chain(world.environment_params.walls.iter().map(|wall| wall.polygon.clone()))
            .collect();
        let discs = avoided.iter().map(|&index| {
            let (object, item) = (&world.objects[index as usize], &scene.items[index as usize]);
            let position = object.coordinates.map(|metres| metres as f32);
            (position, item.asset.collider.radius() * item.scale + margin)
        });
        let mut blocked = vec![false; self.distance.len()];
        for (cell, taken) in blocked.iter_mut().enumerate() {
            let at = self.centre(cell);
            let edge = [0, 1].map(|axis| self.corner[axis].abs() - at[axis].abs());
            *taken =
                edge[0] < body || edge[1] < body || regions.iter().any(|corners| near_or_inside(corners, at, margin));
        }
        for (centre, radius) in discs {
            self.block_disc(centre, radius, &mut blocked);
        }
        blocked
    }

    fn block_disc(&self, centre: [f32; 2], radius: f32, blocked: &mut [bool]) {
        let low = [0, 1].map(|axis| self.index(centre[axis] - radius, axis));
        let high = [0, 1].map(|axis| self.index(centre[axis] + radius, axis));
        for y in low[1]..=high[1] {
            for x in low[0]..=high[0] {
                let cell = y * self.cells[0] + x;
                let at = self.centre(cell);
                let (dx, dy) = (at[0] - centre[0], at[1] - centre[1]);
                blocked[cell] |= dx * dx + dy * dy < radius * radius;
            }
        }
    }

    /// Dijkstra from the goal. The goal's own cell may be blocked by what stands around it.
    fn flood(&mut self, goal: [f32; 2], blocked: &[bool]) {
        let start = self.cell_at(goal);
        self.distance[start] = 0;
        let mut open = BinaryHeap::from([Reverse((0, start))]);
        while let Some(Reverse((distance, cell))) = open.pop() {
            if distance > self.distance[cell] {
                continue;
            }
            for (next, cost) in neighbours(self.cells, cell) {
                let through = distance + if blocked[next] { cost * 40 } else { cost };
                if through < self.distance[next] {
                    self.distance[next] = through;
                    open.push(Reverse((through, next)));
                }
            }
        }
    }

    /// Where to walk next from a place: the point a few cells down the way to the goal.
    pub(crate) fn next(&self, from: [f32; 2], ahead: usize) -> [f32; 2] {
        let mut cell = self.cell_at(from);
        for _ in 0..ahead {
            let nearer = neighbours(self.cells, cell)
                .map(|(next, _)| next)
                .min_by_key(|next| self.distance[*next]);
            match nearer {
                Some(next) if self.distance[next] < self.distance[cell] => cell = next,
                _ => break,
            }
        }
        self.centre(cell)
    }

    /// Length of the way from a place, in metres; places inside obstacles count forty times.
    pub(crate) fn length(&self, from: [f32; 2]) -> f32 {
        self.distance[self.cell_at(from)] as f32 / STRAIGHT as f32 * self.side
    }

    fn index(&self, metres: f32, axis: usize) -> usize {
        let cell = (metres - self.corner[axis]) / self.side;
        cell.clamp(0.0, (self.cells[axis] - 1) as f32) as usize
    }

    fn cell_at(&self, [x, y]: [f32; 2]) -> usize {
        self.index(y, 1) * self.cells[0] + self.index(x, 0)
    }

    fn centre(&self, cell: usize) -> [f32; 2] {
        let (x, y) = (cell % self.cells[0], cell / self.cells[0]);
        [
            self.corner[0] + (x as f32 + 0.5) * self.side,
            self.corner[1] + (y as f32 + 0.5) * self.side,
        ]
    }
}

/// The up to eight cells around a cell, with the cost of going there.
fn neighbours([columns, rows]: [usize; 2], cell: usize) -> impl Iterator<Item = (usize, u32)> {
    let (x, y) = ((cell % columns) as i64, (cell / columns) as i64);
    let around = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
    around.into_iter().filter_map(move |(dx, dy)| {
        let (nx, ny) = (x + dx, y + dy);
        let inside = nx >= 0 && ny >= 0 && nx < columns as i64 && ny < rows as i64;
        let cost = if dx == 0 || dy == 0 { STRAIGHT } else { SLANTING };
        inside.then(|| (ny as usize * columns + nx as usize, cost))
    })
}

fn near_or_inside(corners: &[[f64; 2]], [x, y]: [f32; 2], margin: f32) -> bool {
    let mut inside = false;
    let mut near = false;
    for (from, to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let ([ax, ay], [bx, by]) = (from.map(|c| c as f32), to.map(|c| c as f32));
        let (dx, dy) = (bx - ax, by - ay);
        let squared = dx * dx + dy * dy;
        let along = if squared > 0.0 {
            (((x - ax) * dx + (y - ay) * dy) / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let (ex, ey) = (x - ax - along * dx, y - ay - along * dy);
        near |= ex * ex + ey * ey < margin * margin;
        if (ay > y) != (by > y) && x < dx * (y - ay) / dy + ax {
            inside = !inside;
        }
    }
    near || inside
}
