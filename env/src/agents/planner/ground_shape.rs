//! [`GroundShape`]: the area of ground that a body covers, simplified for planning.

use crate::assets::ColliderShape;
use crate::sim::SimRef;

/// Plans round the positions of pushable bodies to multiples of this, in metres.
const ROUGH: f32 = 0.25;

/// The area of ground that a body covers: a rectangle or a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GroundShape {
    pub(super) at: [f32; 2],
    /// Sine and cosine of its heading; 0 and 1 for a disc.
    turn: [f32; 2],
    /// Half its width and depth; 0 for a disc.
    pub(super) half: [f32; 2],
    radius: f32,
}

impl GroundShape {
    pub(super) fn of(sim: SimRef, object: usize) -> Self {
        let (item, own) = (&sim.scene().items[object], &sim.objects()[object]);
        let heading = own.heading_deg.to_radians();
        let (turn, half, radius) = match &item.body.collider {
            ColliderShape::Box { half: [x, y, _] } => (
                [libm::sinf(heading), libm::cosf(heading)],
                [x * item.scale, y * item.scale],
                0.0,
            ),
            other => ([0.0, 1.0], [0.0; 2], other.radius() * item.scale),
        };
        Self {
            at: own.position,
            turn,
            half,
            radius,
        }
    }

    /// A disc of about this size, moved to a nearby point of a coarse grid, so that it seldom changes while the body is pushed.
    pub(super) fn roughly(self) -> Self {
        Self {
            at: self.at.map(|metres| (metres / ROUGH).round() * ROUGH),
            turn: [0.0, 1.0],
            half: [0.0; 2],
            radius: self.half[0].max(self.half[1]) + self.radius,
        }
    }

    /// Largest distance of its outline from its centre, in metres.
    pub(super) fn reach(&self) -> f32 {
        (self.half[0] * self.half[0] + self.half[1] * self.half[1]).sqrt() + self.radius
    }

    /// Whether it is much wider than deep, as doors are.
    pub(super) fn is_long(&self) -> bool {
        self.half[0] > 3.0 * self.half[1] && self.half[0] > 0.3
    }

    /// A position in the body's own axes: metres to the right of its centre and ahead of it.
    pub(super) fn own_axes(&self, at: [f32; 2]) -> [f32; 2] {
        let [dx, dy] = [at[0] - self.at[0], at[1] - self.at[1]];
        let [sine, cosine] = self.turn;
        [dx * cosine - dy * sine, dx * sine + dy * cosine]
    }

    /// Distance of a position from its outline in metres; for a disc, negative inside.
    pub(super) fn distance(&self, at: [f32; 2]) -> f32 {
        let [along, across] = self.own_axes(at);
        let out = [
            (along.abs() - self.half[0]).max(0.0),
            (across.abs() - self.half[1]).max(0.0),
        ];
        (out[0] * out[0] + out[1] * out[1]).sqrt() - self.radius
    }
}
