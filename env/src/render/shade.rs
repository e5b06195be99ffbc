//! Light on surfaces: sun, ambient and sky light on flat faces. The light of a scene is in `scene.rs`.
//!
//! Light is applied in gamma space: sRGB values are multiplied as they stand, and never made linear. A colour in full
//! light is then the colour that the task names, and no picture depends on a power function, which platforms round
//! differently. The price is that half the light looks darker than half a real one.
//!
//! The formula exists three times, for one face (here), for the lanes of a block (`raster.rs`) and on a graphics card
//! (`objects.wgsl`). All three take their numbers from the constants below.

use crate::scene::Light;
use crate::vector::dot;

/// Light from the sky on a face that the sun does not reach, as a share: once for an upright face, twice for the
/// ground.
pub(crate) const SKY_SHARE: f32 = 0.06;

/// The level of a colour of 1 in full light, and the highest that a byte holds.
pub(crate) const FULL_LEVEL: f32 = 255.0;

/// Added to a level before it is cut to a byte.
pub(crate) const ROUNDING: f32 = 0.5;

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
