//! Light on flat faces: sun, ambient and sky light.
//!
//! Light is applied in gamma space: sRGB values are multiplied directly, without linearising. So a colour in full light is the
//! colour that the task specifies, and no image depends on a power function, which platforms round differently. The
//! disadvantage is that half the light looks darker than in reality. The formula is implemented three times: for one face
//! (here), for the lanes of a block (`raster.rs`) and on the GPU (`objects.wgsl`). All three use the constants below.

use crate::scene::Light;
use crate::vector::dot;

/// Sky light on a vertical face that faces away from the sun, as a share of full light; the ground gets twice as much.
pub(crate) const SKY_SHARE: f32 = 0.06;

/// The level of a colour of 1 in full light, which is the highest value of a byte.
pub(crate) const FULL_LEVEL: f32 = 255.0;

/// Added to a level before truncating it to a byte.
pub(crate) const ROUNDING: f32 = 0.5;

/// Computes levels from colours and normals in one light. Levels may exceed 255; the caller clamps them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shader {
    direction: [f32; 3],
    /// Share of ambient light.
    pub(crate) ambient: f32,
    /// The light's colour times its brightness.
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

    /// Share of light on a face with this unit normal.
    ///
    /// Faces turned away from the sun still get some light from the sky, more if they face up.
    pub(crate) fn share(&self, normal: [f32; 3]) -> f32 {
        let sun = dot(normal, self.direction).max(0.0);
        self.ambient + (1.0 - self.ambient) * sun + SKY_SHARE * (normal[2] + 1.0) * (1.0 - sun)
    }

    /// A colour in full light.
    pub(crate) fn in_light(&self, color: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| color[k] * self.tint[k] * FULL_LEVEL)
    }

    /// A face's packed pixel: red lowest, no label.
    pub(crate) fn packed_pixel(&self, color: [f32; 3], normal: [f32; 3]) -> u32 {
        let share = self.share(normal);
        let [red, green, blue] = self
            .in_light(color)
            .map(|level| (level * share + ROUNDING).min(FULL_LEVEL) as u8);
        u32::from_le_bytes([red, green, blue, 0])
    }
}
