//! [`FreeSpace`]: the clearance of a point, that is, its distance to walls and regions.

use std::sync::Arc;

use driftworld_spec::{Plan, WorldDraft};

/// The free space of an arena, considering walls and regions only.
#[derive(Debug)]
pub(crate) struct FreeSpace {
    half: [f64; 2],
    regions: Vec<Region>,
    /// The layout's plan.
    pub(crate) plan: Option<Arc<Plan>>,
}

#[derive(Debug)]
struct Region {
    corners: Vec<[f64; 2]>,
    low: [f64; 2],
    high: [f64; 2],
}

impl FreeSpace {
    pub(crate) fn new(world: &WorldDraft) -> Self {
        let environment = &world.environment_params;
        // An invalid layout has no plan; the check of the world rejects it.
        let plan = world.layout_problems().is_empty().then(|| world.plan()).flatten();
        let map = environment.regions().into_iter().map(<[[f64; 2]]>::to_vec);
        let walls = environment.walls.iter().map(|wall| wall.polygon.clone());
        let planned: Vec<Vec<[f64; 2]>> = plan
            .iter()
            .flat_map(|plan| &plan.walls)
            .map(|wall| wall.polygon.clone())
            .collect();
        Self {
            half: environment.arena_size().map(|side| side / 2.0),
            regions: map.chain(walls).chain(planned).map(Region::new).collect(),
            plan,
        }
    }

    /// Distance in metres to the nearest wall; negative outside the arena and inside a region.
    pub(crate) fn clearance(&self, [x, y]: [f64; 2], enough: f64) -> f64 {
        let outer = (self.half[0] - x.abs()).min(self.half[1] - y.abs());
        self.regions
            .iter()
            .fold(outer, |nearest, region| nearest.min(region.clearance([x, y], enough)))
    }
}

impl Region {
    fn new(corners: Vec<[f64; 2]>) -> Self {
        let fold = |pick: fn(f64, f64) -> f64, start| {
            corners
                .iter()
                .fold([start; 2], |[x, y], corner| [pick(x, corner[0]), pick(y, corner[1])])
        };
        let (low, high) = (fold(f64::min, f64::INFINITY), fold(f64::max, f64::NEG_INFINITY));
        Self { corners, low, high }
    }

    /// Distance to the polygon, negative inside; may be any value above `enough` if the polygon is farther away than that.
    fn clearance(&self, [x, y]: [f64; 2], enough: f64) -> f64 {
        let beyond = (self.low[0] - x)
            .max(x - self.high[0])
            .max(self.low[1] - y)
            .max(y - self.high[1]);
        if beyond > enough {
            return beyond;
        }
        let mut inside = false;
        let mut nearest = f64::INFINITY;
        let mut from = self.corners[self.corners.len() - 1];
        for &to in &self.corners {
            nearest = nearest.min(distance_to_segment([x, y], from, to));
            // Even–odd rule, which is also correct for polygons that touch themselves.
            if (from[1] > y) != (to[1] > y) && x < (to[0] - from[0]) * (y - from[1]) / (to[1] - from[1]) + from[0] {
                inside = !inside;
            }
            from = to;
        }
        if inside { -nearest } else { nearest }
    }
}

fn distance_to_segment([x, y]: [f64; 2], [ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    let (dx, dy) = (bx - ax, by - ay);
    let squared = dx * dx + dy * dy;
    let along = if squared == 0.0 {
        0.0
    } else {
        (((x - ax) * dx + (y - ay) * dy) / squared).clamp(0.0, 1.0)
    };
    let (ex, ey) = (x - ax - along * dx, y - ay - along * dy);
    (ex * ex + ey * ey).sqrt()
}
