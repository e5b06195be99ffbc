//! The colours of the sky, in the plain style and in the natural one.

use super::daylight::{Daylight, lerp, smoothstep};
use super::shade::{FULL_LEVEL, Shader};
use crate::scene::Light;

/// Brightness of the sky: without light, its increase per unit of the brightest channel, and its maximum.
const SKY_BRIGHTNESS: [f32; 3] = [0.12, 0.88, 1.06];

/// Height of fog above the eye, in metres.
const FOG_HEIGHT: f32 = 30.0;

/// The horizon's colour: this share of the zenith's, plus this much white.
const HORIZON: [f32; 2] = [0.42, 0.55];

impl Shader {
    /// The sky's colours at the zenith and at the horizon, given its own colour. The sky dims with the light, but less than the
    /// ground.
    pub(crate) fn sky(&self, color: [f32; 3]) -> [[f32; 3]; 2] {
        let brightest = self.tint[0].max(self.tint[1]).max(self.tint[2]);
        let [dark, gain, max] = SKY_BRIGHTNESS;
        let bright = (dark + gain * brightest).min(max) * FULL_LEVEL;
        let [share, white] = HORIZON;
        [color.map(|c| c * bright), color.map(|c| (c * share + white) * bright)]
    }
}

impl Daylight {
    /// The sky in this light. `height` is the z coordinate of the unit vector towards the sun; `low` is how low the sun looks,
    /// 0..1.
    pub(super) fn sky(light: &Light, exposure: f32, low: f32, height: f32) -> Self {
        let bright = exposure * (0.62 + 0.38 * smoothstep(height, -0.1, 0.35)) * FULL_LEVEL;
        let tint = lerp([1.0; 3], [0.7, 0.62, 0.74], low);
        let away = lerp([1.0; 3], [0.88, 0.72, 0.76], low);
        let toward = lerp([1.0; 3], [1.5, 0.92, 0.4], low);
        let pale: [f32; 3] = light.sky_color.map(|channel| channel * 0.42 + 0.55);
        let level = |own: [f32; 3], by: [f32; 3]| std::array::from_fn(|k| (own[k] * by[k] * bright).min(FULL_LEVEL));
        let white = lerp([0.98; 3], [1.0, 0.74, 0.62], low);
        Self {
            zenith: level(light.sky_color, tint),
            horizon: level(pale, away),
            sunward: level(pale, toward),
            cloud: level([1.0; 3], white),
            glow: low,
            ..Self::default()
        }
    }

    /// The sky's colours away from the sun and towards it, along a ray that rises by `rise` per metre, and the fog's share in
    /// them.
    pub(super) fn sky_along(&self, rise: f32, fog_distance: Option<f32>) -> ([f32; 3], [f32; 3], f32) {
        let steepness = rise / (rise * rise + 1.0).sqrt();
        let left = 1.0 - steepness;
        let share = 1.0 - left * left * left;
        let fog = fog_distance.map_or(0.0, |distance| {
            let reach = rise / FOG_HEIGHT * distance;
            1.0 / (1.0 + reach * reach)
        });
        let of = |horizon: [f32; 3]| lerp(lerp(horizon, self.zenith, share), horizon, fog);
        let toward = lerp(self.horizon, self.sunward, self.glow);
        (of(self.horizon), of(toward), fog)
    }
}
