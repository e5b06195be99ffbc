//! [`LayoutWall`]: single walls, as segments, circles and polygons.

use super::LayoutWall;
use super::draws::{Draws, Purpose, share_of};
use super::plan::{Plan, PlanWall};

/// Default thickness of a segment in metres.
const THICKNESS: f64 = 0.3;

/// Number of corners of a circle.
const CORNERS: usize = 24;

/// The keys that are present.
pub(super) fn present<const N: usize>(keys: [(&'static str, bool); N]) -> Vec<&'static str> {
    let present = keys.into_iter().filter(|(_, is_there)| *is_there);
    present.map(|(key, _)| key).collect()
}

impl LayoutWall {
    /// The keys of the forms that are set.
    pub(super) fn forms(&self) -> Vec<&'static str> {
        present([
            ("from", self.from.is_some() || self.to.is_some()),
            ("circle", self.circle.is_some()),
            ("polygon", self.polygon.is_some()),
        ])
    }

    /// Its corners, counterclockwise for a segment and a circle.
    fn corners(&self) -> Vec<[f64; 2]> {
        if let (Some(from), Some(to)) = (self.from, self.to) {
            let direction = [to[0] - from[0], to[1] - from[1]];
            let length = libm::hypot(direction[0], direction[1]).max(f64::MIN_POSITIVE);
            let half = self.thickness.unwrap_or(THICKNESS) / 2.0 / length;
            let right = [direction[1] * half, -direction[0] * half];
            let offset = |end: [f64; 2], side: f64| [end[0] + side * right[0], end[1] + side * right[1]];
            return vec![offset(from, 1.0), offset(to, 1.0), offset(to, -1.0), offset(from, -1.0)];
        }
        if let Some(circle) = self.circle {
            let corner = |number: usize| {
                let angle = std::f64::consts::TAU * number as f64 / CORNERS as f64;
                [
                    circle.center[0] + circle.radius * libm::cos(angle),
                    circle.center[1] + circle.radius * libm::sin(angle),
                ]
            };
            return (0..CORNERS).map(corner).collect();
        }
        self.polygon.clone().unwrap_or_default()
    }
}

/// The plan with a share of the walls; they are always removed in the order of seed 0.
pub(super) fn plan(walls: &[LayoutWall], standing: f64, seed: u64) -> Plan {
    let mut order: Vec<usize> = (0..walls.len()).collect();
    Draws::new(0, Purpose::Standing).shuffle(&mut order);
    order.truncate(share_of(standing, walls.len()));
    order.sort_unstable();
    let wall = |index: &usize| PlanWall {
        polygon: walls[*index].corners(),
        height: walls[*index].height,
        color: walls[*index].color,
    };
    let mut plan = Plan::of_cells([0.0; 2], [0, 0], seed, |_, _| None);
    plan.walls = order.iter().map(wall).collect();
    plan
}
