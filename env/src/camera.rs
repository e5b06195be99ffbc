//! [`Camera`]: the pose and field of view from which an image is rendered.

use crate::scene::Scene;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position in metres; x east, y north, z up.
    pub position: [f32; 3],
    /// Heading in degrees clockwise from +y.
    pub heading_deg: f32,
    /// Elevation of the view in degrees; negative looks down.
    pub pitch_deg: f32,
    /// Vertical field of view in degrees.
    pub field_of_view_deg: f32,
}

/// The camera's axes as unit vectors in the world's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    pub(crate) right: [f32; 3],
    pub(crate) up: [f32; 3],
    pub(crate) forward: [f32; 3],
}

impl Camera {
    /// The view of an agent at `position` with this heading; `height` is the height of its eyes.
    pub fn first_person(position: [f32; 2], heading_deg: f32, height: f32, field_of_view_deg: f32) -> Self {
        Self {
            position: [position[0], position[1], height],
            heading_deg,
            pitch_deg: 0.0,
            field_of_view_deg,
        }
    }

    /// The arena and the sky above it, seen from a raised point south-west of its centre.
    pub fn overview(scene: &Scene) -> Self {
        let [width, depth] = scene.arena_size();
        let span = width.max(depth).max(4.0);
        Self {
            position: [-0.30 * span, -0.62 * span, 0.24 * span],
            heading_deg: 24.0,
            pitch_deg: -16.0,
            field_of_view_deg: 50.0,
        }
    }

    pub(crate) fn axes(&self) -> Axes {
        let (heading, pitch) = (self.heading_deg.to_radians(), self.pitch_deg.to_radians());
        let (sin_h, cos_h) = (libm::sinf(heading), libm::cosf(heading));
        let (sin_p, cos_p) = (libm::sinf(pitch), libm::cosf(pitch));
        Axes {
            right: [cos_h, -sin_h, 0.0],
            up: [-sin_h * sin_p, -cos_h * sin_p, cos_p],
            forward: [sin_h * cos_p, cos_h * cos_p, sin_p],
        }
    }

    /// Half the height of the image plane at a distance of 1 m.
    pub(crate) fn tangent(&self) -> f32 {
        let half = (self.field_of_view_deg.clamp(1.0, 170.0) / 2.0).to_radians();
        libm::sinf(half) / libm::cosf(half)
    }
}
