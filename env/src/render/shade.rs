//! Light on surfaces: sun and ambient on flat faces. The light's numbers are the scene's.

use crate::scene::Light;
use crate::vector::dot;

/// Turns colours and normals into levels 0 to 255 under one light; more than 255 is cut by whoever makes bytes of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader {
    direction: [f32; 3],
    /// Share of the light that comes from everywhere.
    pub(crate) ambient: f32,
    /// The light's colour times how bright it is.
    pub(crate) tint: [f32; 3],
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
    ///
    /// What looks away from the sun still gets a little from the sky, more if it looks up.
    pub(crate) fn share(&self, normal: [f32; 3]) -> f32 {
        let sun = dot(normal, self.direction).max(0.0);
        self.ambient + (1.0 - self.ambient) * sun + 0.06 * (normal[2] + 1.0) * (1.0 - sun)
    }

    /// A colour in full light.
    pub(crate) fn in_light(&self, color: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| color[k] * self.tint[k] * 255.0)
    }

    /// A face's packed pixel: red lowest, no label.
    pub(crate) fn packed_pixel(&self, color: [f32; 3], normal: [f32; 3]) -> u32 {
        let share = self.share(normal);
        let [red, green, blue] = self.in_light(color).map(|level| (level * share + 0.5).min(255.0) as u8);
        u32::from_le_bytes([red, green, blue, 0])
    }

    /// The sky's colours at the zenith and at the horizon, for its own colour. It dims with the light, less than the ground does.
    pub(crate) fn sky(&self, color: [f32; 3]) -> [[f32; 3]; 2] {
        let brightest = self.tint[0].max(self.tint[1]).max(self.tint[2]);
        let bright = (0.12 + 0.88 * brightest).min(1.06) * 255.0;
        [color.map(|c| c * bright), color.map(|c| (c * 0.42 + 0.55) * bright)]
    }
}
