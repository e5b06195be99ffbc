//! [`View`]: a camera prepared for projecting, and the projection of an object's frame.

use crate::camera::{Axes, Camera};
use crate::scene::{Item, PanelGroup};
use crate::vector::{add, dot, scaled, sub};

/// Minimum distance in metres at which anything is drawn.
pub(crate) const NEAR: f32 = 0.05;

/// A camera for an image of a given size. Pixel centres have integer coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) axes: Axes,
    pub(crate) position: [f32; 3],
    /// Width and height in pixels.
    pub(crate) size: [f32; 2],
    /// Pixels per metre at 1 m.
    pub(crate) scale: f32,
    /// Metres per pixel at 1 m.
    pub(crate) step: f32,
}

/// Projection of points of an object's frame onto the screen: `row · (x, y, z, 1)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    /// Column times depth.
    pub(crate) column: [f32; 4],
    /// Row times depth.
    pub(crate) row: [f32; 4],
    /// Depth in metres.
    pub(crate) depth: [f32; 4],
    /// The camera's position, in the object's frame.
    pub(crate) eye: [f32; 3],
    /// Towards the sun, in the object's frame.
    pub(crate) sun: [f32; 3],
}

/// An object's frame in the world: rotated about the vertical axis, scaled and translated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose {
    pub(crate) position: [f32; 3],
    pub(crate) heading_deg: f32,
    pub(crate) scale: f32,
}

impl Pose {
    /// The world's own frame.
    pub(crate) const WORLD: Self = Self {
        position: [0.0; 3],
        heading_deg: 0.0,
        scale: 1.0,
    };

    /// The frame of panels. Flat ones are lifted slightly off the ground, depending on the camera.
    pub(crate) fn of_panels(group: &PanelGroup, view: &View) -> Self {
        /// Camera height in metres above which the lift stays the same.
        const MAX_HEIGHT: f32 = 1000.0;
        let height = view.position[2].clamp(0.0, MAX_HEIGHT);
        Self {
            position: [0.0, 0.0, group.lift * height],
            ..Self::WORLD
        }
    }

    pub(crate) fn of(item: &Item) -> Self {
        Self {
            position: [item.position[0], item.position[1], 0.0],
            heading_deg: item.heading_deg,
            scale: item.scale,
        }
    }
}

impl View {
    pub(crate) fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let half = height as f32 / 2.0;
        Self {
            axes: camera.axes(),
            position: camera.position,
            size: [width as f32, height as f32],
            scale: half / camera.tangent(),
            step: camera.tangent() / half,
        }
    }

    /// Offset of a column or row from the image's middle, at 1 m: to the right, or down.
    pub(crate) fn offset(&self, axis: usize, pixel: f32) -> f32 {
        (pixel + 0.5 - self.size[axis] / 2.0) * self.step
    }

    /// A point of the world in the camera's frame: right, up, forward, in metres.
    pub(crate) fn view_from_world(&self, point: [f32; 3]) -> [f32; 3] {
        let d = sub(point, self.position);
        [dot(d, self.axes.right), dot(d, self.axes.up), dot(d, self.axes.forward)]
    }

    /// Whether a ball may be in the image.
    pub(crate) fn sees(&self, [right, up, forward]: [f32; 3], radius: f32) -> bool {
        if forward + radius < NEAR {
            return false;
        }
        let [tx, ty] = self.size.map(|pixels| pixels / 2.0 * self.step);
        // A ball is outside if it is beyond a side by more than its radius; comparing squares avoids square roots.
        let beyond = |across: f32, tangent: f32| {
            let over = across.abs() - tangent * forward;
            over > 0.0 && over * over > radius * radius * (1.0 + tangent * tangent)
        };
        !(beyond(right, tx) || beyond(up, ty))
    }

    /// The projection from an object's frame to the screen.
    pub(crate) fn placement(&self, pose: &Pose, sun: [f32; 3]) -> Placement {
        let heading = pose.heading_deg.to_radians();
        let (sin, cos) = if heading == 0.0 {
            (0.0, 1.0)
        } else {
            (libm::sinf(heading), libm::cosf(heading))
        };
        let Axes { right, up, forward } = self.axes;
        let [middle_x, middle_y] = self.size.map(|pixels| pixels / 2.0 - 0.5);
        let d = sub(pose.position, self.position);
        let (x_axis, y_axis) = ([cos, -sin, 0.0], [sin, cos, 0.0]);
        let row = |direction: [f32; 3]| {
            [
                dot(direction, x_axis) * pose.scale,
                dot(direction, y_axis) * pose.scale,
                direction[2] * pose.scale,
                dot(direction, d),
            ]
        };
        let object_from_world = |[x, y, z]: [f32; 3]| [x * cos - y * sin, x * sin + y * cos, z];
        Placement {
            column: row(add(scaled(right, self.scale), scaled(forward, middle_x))),
            row: row(add(scaled(up, -self.scale), scaled(forward, middle_y))),
            depth: row(forward),
            eye: object_from_world(scaled(d, -1.0 / pose.scale)),
            sun: object_from_world(sun),
        }
    }
}
