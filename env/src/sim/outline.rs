//! [`Outline`]: the area of ground that an asset's body covers, in total and up to the agent's height, before rotation and
//! translation. The agent is an upright cylinder, so the parts of balls, capsules and hulls above its head do not stop it.
//! Boxes and cylinders are equally wide at every height. Bodies other than the agent collide with whole footprints.

use rapier3d::prelude::{SharedShape, Vector};

use super::footprint::{Footprint, Point};
use crate::assets::ColliderShape;

/// A body's footprints in its own frame, around the origin and facing +y.
pub(super) struct Outline {
    /// Up to the agent's height; `None` if it is the same as the whole.
    low: Option<Footprint>,
    whole: Footprint,
}

impl Outline {
    /// The outline of a body that is equally wide at every height.
    pub(super) fn of_whole(whole: Footprint) -> Self {
        Self { low: None, whole }
    }

    /// The outline of an asset's body at a scale, for an agent of this height in metres.
    pub(super) fn of(shape: &ColliderShape, scale: f32, agent_height: f32) -> Self {
        let scaled = |metres: f32| f64::from((metres * scale).max(0.005));
        let agent_height = f64::from(agent_height);
        match shape {
            ColliderShape::Box { half: [x, y, _] } => Self::of_whole(Footprint::rectangle([scaled(*x), scaled(*y)])),
            ColliderShape::Cylinder { radius, .. } => Self::of_whole(Footprint::disc([0.0; 2], scaled(*radius))),
            // Both have a hemisphere at the bottom, which a low agent touches below its centre.
            ColliderShape::Ball { radius } | ColliderShape::Capsule { radius, .. } => {
                let radius = scaled(*radius);
                let below = (radius - agent_height).max(0.0);
                let low = (radius * radius - below * below).max(0.0).sqrt();
                Self {
                    low: (below > 0.0).then(|| Footprint::disc([0.0; 2], low)),
                    whole: Footprint::disc([0.0; 2], radius),
                }
            }
            ColliderShape::Hull { points } => {
                let corners: Vec<[f64; 3]> = points
                    .iter()
                    .map(|point| point.map(|metres| f64::from(metres * scale)))
                    .collect();
                let Some(whole) = Footprint::around(corners.iter().map(|&[x, y, _]| [x, y]).collect()) else {
                    return Self::of_whole(Footprint::disc([0.0; 2], scaled(shape.radius())));
                };
                let is_taller = corners.iter().any(|corner| corner[2] > agent_height);
                let low = is_taller.then(|| Footprint::around(points_below(&corners, agent_height)));
                Self {
                    low: low.flatten(),
                    whole,
                }
            }
        }
    }

    pub(super) fn is_disc(&self) -> bool {
        self.whole.as_disc().is_some()
    }

    /// The whole outline as a shape for the physics of pushed bodies, around the origin: a ball, or a prism. All such shapes
    /// touch at the height of their centres, where their contacts are exactly those of their outlines.
    pub(super) fn upright(&self) -> SharedShape {
        /// Half the height of prisms, in metres.
        const HALF_PRISM_HEIGHT: f32 = 4.0;
        if let Some(radius) = self.whole.as_disc() {
            return SharedShape::ball(radius as f32);
        }
        if let [from, to] = self.whole.corners.as_slice() {
            let half_length = (to[0] - from[0]) / 2.0;
            return SharedShape::cuboid(half_length as f32, self.whole.rounding as f32, HALF_PRISM_HEIGHT);
        }
        let corners = self.whole.corners.iter();
        let corners: Vec<Vector> = corners
            .flat_map(|&[x, y]| [HALF_PRISM_HEIGHT, -HALF_PRISM_HEIGHT].map(|z| Vector::new(x as f32, y as f32, z)))
            .collect();
        let reach = |axis: usize| corners.iter().fold(0.0_f32, |max, corner| max.max(corner[axis].abs()));
        let (x, y) = (reach(0), reach(1));
        let is_rectangle =
            corners.len() == 8 && corners.iter().all(|corner| corner.x.abs() == x && corner.y.abs() == y);
        let prism = (!is_rectangle).then(|| SharedShape::convex_hull(&corners));
        prism
            .flatten()
            .unwrap_or_else(|| SharedShape::cuboid(x, y, HALF_PRISM_HEIGHT))
    }

    /// The whole outline around the origin, rotated to a heading in degrees.
    pub(super) fn rotate_into(&self, heading_deg: f32, whole: &mut Footprint) {
        self.whole.place_into(turn(heading_deg), [0.0; 2], whole);
    }

    /// Rotates the outline to a heading in degrees, and moves it to a position.
    pub(super) fn place_into(&self, heading_deg: f32, at: Point, low: &mut Footprint, whole: &mut Footprint) {
        // Discs do not depend on the heading.
        let turn = if self.is_disc() { [0.0, 1.0] } else { turn(heading_deg) };
        self.whole.place_into(turn, at, whole);
        self.low.as_ref().unwrap_or(&self.whole).place_into(turn, at, low);
    }
}

/// Sine and cosine of a heading; headings are clockwise.
fn turn(heading_deg: f32) -> Point {
    if heading_deg == 0.0 {
        return [0.0, 1.0];
    }
    let (sine, cosine) = libm::sincos(-f64::from(heading_deg).to_radians());
    [sine, cosine]
}

/// The part of a convex body below a height, seen from above: its corners there, and the points where its edges cross that
/// height.
fn points_below(corners: &[[f64; 3]], height: f64) -> Vec<Point> {
    let is_low = |corner: &&[f64; 3]| corner[2] <= height;
    let mut points: Vec<Point> = corners.iter().filter(is_low).map(|&[x, y, _]| [x, y]).collect();
    for low in corners.iter().filter(is_low) {
        for high in corners.iter().filter(|corner| !is_low(corner)) {
            let share = (height - low[2]) / (high[2] - low[2]);
            points.push([0, 1].map(|axis| low[axis] + (high[axis] - low[axis]) * share));
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reach(outline: &Outline, heading_deg: f32, from: Point) -> [f64; 2] {
        let mut placed = [Footprint::disc([0.0; 2], 0.0), Footprint::disc([0.0; 2], 0.0)];
        let [low, whole] = &mut placed;
        outline.place_into(heading_deg, [0.0; 2], low, whole);
        [low.gap(from).distance, whole.gap(from).distance]
    }

    #[test]
    fn low_agent_meets_a_ball_below_its_centre() {
        let ball = Outline::of(&ColliderShape::Ball { radius: 2.0 }, 1.0, 1.0);
        let [low, whole] = reach(&ball, 0.0, [10.0, 0.0]);
        assert!((whole - 8.0).abs() < 1e-9 && (low - (10.0 - 3.0_f64.sqrt())).abs() < 1e-9);
    }

    #[test]
    fn tent_is_wider_at_its_base_and_rotates_clockwise() {
        let points = vec![
            [-1.0, -2.0, 0.0],
            [1.0, -2.0, 0.0],
            [1.0, 2.0, 0.0],
            [-1.0, 2.0, 0.0],
            [0.0, 0.0, 4.0],
        ];
        let tent = Outline::of(&ColliderShape::Hull { points: points.clone() }, 1.0, 1.0);
        let [low, whole] = reach(&tent, 90.0, [10.0, 0.0]);
        assert!((whole - 8.0).abs() < 1e-9 && (low - 8.0).abs() < 1e-9);
        // Upside down, it is a quarter as wide at a quarter of its height.
        let upside_down = points.iter().map(|&[x, y, z]| [x, y, 4.0 - z]).collect();
        let funnel = Outline::of(&ColliderShape::Hull { points: upside_down }, 1.0, 1.0);
        let [low, whole] = reach(&funnel, 0.0, [10.0, 0.0]);
        assert!((whole - 9.0).abs() < 1e-9 && (low - 9.75).abs() < 1e-9);
    }
}
