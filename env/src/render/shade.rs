//! Light on surfaces: sun and ambient on flat faces. The light's numbers are the scene's.

use super::cpu::dot;
use crate::scene::Light;

/// Turns colours and normals into pixels under one light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader {
    direction: [f32; 3],
    ambient: f32,
    tint: [f32; 3],
}

impl Shader {
    pub(crate) fn new(light: &Light) -> Self {
        Self {
            direction: light.direction,
            ambient: light.ambient,
            tint: light.color.map(|c| c * light.exposure),
        }
    }

    /// How much light reaches a face, by its normal of length 1.
    pub(crate) fn share(&self, normal: [f32; 3]) -> f32 {
        let facing = dot(normal, self.direction);
        // What looks away from the sun still gets a little from the sky, more if it looks up.
        let sky = 0.12 * (normal[2] + 1.0);
        self.ambient + (1.0 - self.ambient) * facing.max(0.0) + sky * (1.0 - facing.max(0.0)) * 0.5
    }

    /// A face's pixel colour.
    pub(crate) fn lit(&self, color: [f32; 3], normal: [f32; 3]) -> [u8; 3] {
        self.pixel(color, self.share(normal))
    }

    pub(crate) fn pixel(&self, color: [f32; 3], share: f32) -> [u8; 3] {
        std::array::from_fn(|k| (color[k] * self.tint[k] * share * 255.0 + 0.5).clamp(0.0, 255.0) as u8)
    }

    /// Brightness of the sky: it dims with the light, less than the ground does.
    pub(crate) fn sky_share(&self) -> f32 {
        let brightest = self.tint[0].max(self.tint[1]).max(self.tint[2]);
        (0.12 + 0.88 * brightest).min(1.06)
    }
}
