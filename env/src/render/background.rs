//! Sky and ground by formula: what every pixel shows that no triangle has taken.

use super::cpu::dot;
use super::frame::{CATEGORY_MAP, CATEGORY_SKY, FAR_DEPTH, Frame};
use super::shade::Shader;
use crate::assets::hash;
use crate::camera::{Axes, Camera};
use crate::scene::Scene;

/// Side of the squares on the ground in metres.
const SQUARE: f32 = 2.0;

pub(crate) struct Background<'a> {
    axes: Axes,
    height: f32,
    position: [f32; 3],
    step: f32,
    half: [f32; 2],
    shader: &'a Shader,
    ground: [f32; 3],
    ground_share: f32,
    zenith: [f32; 3],
    horizon: [f32; 3],
}

impl<'a> Background<'a> {
    pub(crate) fn new(scene: &Scene, shader: &'a Shader, camera: &Camera, frame: &Frame) -> Self {
        let half = [frame.width as f32 / 2.0, frame.height as f32 / 2.0];
        let bright = shader.sky_share();
        let zenith = scene.light.sky_color.map(|c| c * bright);
        Self {
            axes: camera.axes(),
            height: camera.position[2].max(0.01),
            position: camera.position,
            step: camera.tangent() / half[1],
            half,
            shader,
            ground: scene.ground_color,
            ground_share: shader.share([0.0, 0.0, 1.0]),
            zenith,
            horizon: scene.light.sky_color.map(|c| (c * 0.42 + 0.55) * bright),
        }
    }

    pub(crate) fn fill(&self, inverse_depth: &[f32], frame: &mut Frame) {
        let width = frame.width as usize;
        for row in 0..frame.height as usize {
            let up = (self.half[1] - row as f32 - 0.5) * self.step;
            let at_row: [f32; 3] = std::array::from_fn(|k| self.axes.forward[k] + up * self.axes.up[k]);
            for column in 0..width {
                let pixel = row * width + column;
                if inverse_depth[pixel] > 0.0 {
                    continue;
                }
                let right = (column as f32 + 0.5 - self.half[0]) * self.step;
                let ray: [f32; 3] = std::array::from_fn(|k| at_row[k] + right * self.axes.right[k]);
                let (rgb, depth, category) = self.look(ray);
                frame.rgb[pixel * 3..pixel * 3 + 3].copy_from_slice(&rgb);
                frame.depth[pixel] = depth;
                frame.category[pixel] = category;
            }
        }
    }

    /// What a ray meets; its length along the view axis is 1.
    fn look(&self, ray: [f32; 3]) -> ([u8; 3], f32, u8) {
        let metres = if ray[2] < 0.0 {
            -self.height / ray[2]
        } else {
            f32::INFINITY
        };
        if metres.is_finite() {
            return (self.ground_at(ray, metres), metres.min(FAR_DEPTH), CATEGORY_MAP);
        }
        let rise = (ray[2] / dot(ray, ray).sqrt()).clamp(0.0, 1.0);
        let share = 1.0 - (1.0 - rise) * (1.0 - rise) * (1.0 - rise);
        let rgb = std::array::from_fn(|k| {
            let level = self.horizon[k] + (self.zenith[k] - self.horizon[k]) * share;
            (level * 255.0 + 0.5).clamp(0.0, 255.0) as u8
        });
        (rgb, FAR_DEPTH, CATEGORY_SKY)
    }

    /// Squares of slightly different shades, so that motion can be seen; they fade with distance before they flicker.
    fn ground_at(&self, ray: [f32; 3], metres: f32) -> [u8; 3] {
        // How many squares a pixel covers where the ray meets the ground.
        let blur = metres * self.step * metres / (self.height * SQUARE);
        let fade = (1.0 - blur * 1.3).clamp(0.0, 1.0);
        if fade == 0.0 {
            return self.shader.pixel(self.ground, self.ground_share);
        }
        let [cx, cy] = [0, 1].map(|axis| square((self.position[axis] + ray[axis] * metres) / SQUARE));
        let checker = if (cx + cy) & 1 == 0 { 0.045 } else { -0.045 };
        let speckle = 0.07 * (hash(cx as u32, cy as u32) - 0.5);
        let share = self.ground_share * (1.0 + (checker + speckle) * fade);
        self.shader.pixel(self.ground, share)
    }
}

/// The number of a square: `floor`, without the call that it is on processors from before 2008.
fn square(place: f32) -> i32 {
    let cut = place as i32;
    if cut as f32 > place { cut - 1 } else { cut }
}
