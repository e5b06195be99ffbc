//! Light of the natural style: sun and sky, which depend on the sun's elevation, or lamps under a ceiling. Each face gets
//! sunlight according to its angle, and ambient light according to how much it faces up. The sum is about 1 in full daylight,
//! so that saturated colours keep their shading. As in the plain style, everything is computed in gamma space.

use super::shade::FULL_LEVEL;
use crate::scene::Light;

/// Light in one scene.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Daylight {
    /// Towards the sun, length 1.
    pub(super) direction: [f32; 3],
    /// Per channel: the factor for a face that points at the sun, the ambient factor of a vertical face, and the addition for a
    /// face that points up.
    pub(super) sun: [f32; 3],
    pub(super) around: [f32; 3],
    pub(super) above: [f32; 3],
    /// Levels 0 to 255 of the sky: at the zenith, at the horizon away from the sun, and at the horizon towards it.
    pub(super) zenith: [f32; 3],
    pub(super) horizon: [f32; 3],
    pub(super) sunward: [f32; 3],
    /// Level of clouds.
    pub(super) cloud: [f32; 3],
    /// How much the horizon differs towards the sun, 0..1.
    pub(super) glow: f32,
}

/// Smooth step from 0 at `from` to 1 at `to`.
pub(super) fn smoothstep(value: f32, from: f32, to: f32) -> f32 {
    let share = ((value - from) / (to - from)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

pub(super) fn lerp(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}

impl Daylight {
    pub(super) fn new(light: &Light, is_inside: bool) -> Self {
        // Under a ceiling nothing depends on the sun, not even fog.
        let height = if is_inside { 1.0 } else { light.direction[2] };
        // Dim light looks like a low sun as well.
        let low = (1.0 - smoothstep(height, 0.04, 0.5)).max(0.9 * (1.0 - smoothstep(light.exposure, 0.1, 0.8)));
        let exposure = if light.exposure < 1.0 {
            light.exposure.sqrt()
        } else {
            1.0 + 0.3 * (light.exposure - 1.0)
        };
        let color: [f32; 3] = std::array::from_fn(|k| light.color[k] * exposure);
        let sky = Self::sky(light, exposure, low, height);
        if is_inside {
            return Self::inside(color, sky);
        }
        let warm = lerp([1.0; 3], [1.0, 0.66, 0.36], low);
        let cold = lerp([0.94, 1.0, 1.1], [0.84, 0.84, 1.06], low);
        let strength = (1.0 - light.ambient) * smoothstep(height, -0.06, 0.1) * (0.88 - 0.08 * low);
        let around = light.ambient * (1.5 + 0.1 * low);
        let top: [f32; 3] = std::array::from_fn(|k| color[k] * cold[k] * around);
        let bottom = [0, 1, 2].map(|k| color[k] * around * [0.74, 0.72, 0.66][k]);
        Self {
            direction: light.direction,
            sun: [0, 1, 2].map(|k| color[k] * warm[k] * strength),
            around: [0, 1, 2].map(|k| f32::midpoint(top[k], bottom[k])),
            above: [0, 1, 2].map(|k| (top[k] - bottom[k]) / 2.0),
            ..sky
        }
    }

    /// Lamps under the whole ceiling, slightly brighter from one side, so that corners are visible.
    fn inside(color: [f32; 3], sky: Self) -> Self {
        const LAMPS: [f32; 3] = [0.48, -0.36, 0.8];
        Self {
            direction: LAMPS,
            sun: color.map(|level| 0.3 * level),
            around: color.map(|level| 0.72 * level),
            above: color.map(|level| 0.06 * level),
            ..sky
        }
    }

    /// Levels of a colour on a face with this unit normal: 0 to 255, or above.
    pub(super) fn levels(&self, color: [f32; 3], normal: [f32; 3]) -> [f32; 3] {
        let sun = crate::vector::dot(normal, self.direction).max(0.0);
        std::array::from_fn(|k| {
            color[k] * FULL_LEVEL * (sun * self.sun[k] + normal[2] * self.above[k] + self.around[k])
        })
    }

    /// Factor on the ground's light in shadow, as a texel: 128 is full light.
    pub(super) fn shade(&self) -> u32 {
        let sun = self.direction[2].max(0.0);
        let left = [0, 1, 2].map(|k| {
            let shaded = self.around[k] + self.above[k];
            let share = shaded / (shaded + sun * self.sun[k]).max(1e-6);
            (share * 128.0 + 0.5).clamp(0.0, 128.0) as u32
        });
        0x80 << 24 | left[2] << 16 | left[1] << 8 | left[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(height: f32, exposure: f32) -> Light {
        let across = (1.0 - height * height).sqrt();
        Light {
            direction: [0.0, across, height],
            color: [1.0; 3],
            exposure,
            ambient: 0.35,
            sky_color: [0.36, 0.62, 0.9],
            fog_distance: None,
            fog_in_depth: false,
        }
    }

    /// A low sun is warm, and so is the sky towards it; a high sun is white.
    #[test]
    fn a_low_sun_warms_light_and_sky() {
        let warmth = |levels: [f32; 3]| levels[0] / levels[2];
        let mut previous = [f32::INFINITY; 2];
        for height in [0.08, 0.2, 0.35, 0.6, 0.9] {
            let day = Daylight::new(&light(height, 1.0), false);
            let here = [warmth(day.sun), warmth(day.sunward)];
            assert!(
                here[0] <= previous[0] && here[1] <= previous[1],
                "{height}: {here:?} after {previous:?}"
            );
            previous = here;
        }
        assert!((previous[0] - 1.0).abs() < 1e-5);
        assert!(warmth(Daylight::new(&light(0.08, 1.0), false).sun) > 1.7);
    }

    /// Under a ceiling nothing depends on the sun's position, not even the look of fog.
    #[test]
    fn sun_has_no_effect_under_a_ceiling() {
        let noon = Daylight::new(&light(1.0, 0.7), true);
        for height in [-0.5, 0.04, 0.3, 0.9] {
            let inside = Daylight::new(&light(height, 0.7), true);
            assert_eq!(inside, noon, "{height}");
        }
    }

    /// In full daylight a saturated colour is clipped by at most 6 %, so that faces in different directions keep different
    /// levels.
    #[test]
    fn saturated_colours_keep_their_shading() {
        let day = Daylight::new(&light(0.6, 1.0), false);
        let faces = [
            [0.0, 0.8, 0.6],
            [0.0, 0.0, 1.0],
            [0.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, -1.0, 0.0],
        ];
        let levels: Vec<f32> = faces
            .iter()
            .map(|normal| day.levels([1.0, 0.0, 0.0], *normal)[0])
            .collect();
        assert!(levels[0] < 1.06 * FULL_LEVEL, "{levels:?}");
        let distinct = levels.windows(2).filter(|pair| (pair[0] - pair[1]).abs() > 8.0).count();
        assert!(distinct >= 3, "{levels:?}");
    }

    #[test]
    fn more_light_is_brighter_and_shadow_is_darker() {
        let mut previous = 0.0;
        for exposure in [0.05, 0.2, 0.6, 1.0, 1.5] {
            let day = Daylight::new(&light(0.7, exposure), false);
            let ground = day.levels([0.5; 3], [0.0, 0.0, 1.0])[1];
            assert!(ground > previous);
            assert!(day.shade() >> 8 & 255 < 110);
            previous = ground;
        }
    }
}
