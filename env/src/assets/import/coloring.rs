//! The colour of a triangle: the mean of its material, texture and vertex colours in linear light.

use super::texture::Texture;

/// Number of texture samples along each side of a triangle.
const SAMPLES: usize = 5;

/// Colours of a primitive's triangles.
pub(super) struct Coloring<'a> {
    pub(super) factor: [f32; 4],
    pub(super) texture: Option<Texture<'a>>,
    /// Texture coordinates of each vertex; empty without a texture.
    pub(super) uvs: Vec<[f32; 3]>,
    /// Linear colour of each vertex; empty without vertex colours.
    pub(super) colors: Vec<[f32; 3]>,
}

impl Coloring<'_> {
    /// A triangle's mean linear colour: the product of the colours of its material, texture and vertices.
    pub(super) fn of(&self, triangle: [u32; 3]) -> [f32; 3] {
        let [r, g, b, _] = self.factor;
        let factor = [r, g, b];
        if self.texture.is_none() && self.colors.is_empty() {
            return factor;
        }
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for (i, j) in (0..SAMPLES).flat_map(|i| (0..SAMPLES - i).map(move |j| (i, j))) {
            // The offset of a third keeps samples off the edges.
            let share = |k: usize| (k as f32 + 1.0 / 3.0) / SAMPLES as f32;
            let at = [1.0 - share(i) - share(j), share(i), share(j)];
            let mean = |list: &[[f32; 3]]| {
                let mut mean = [0.0; 3];
                for (corner, share) in triangle.iter().zip(at) {
                    let value = list.get(*corner as usize).copied().unwrap_or([1.0; 3]);
                    (0..3).for_each(|k| mean[k] += share * value[k]);
                }
                mean
            };
            let [r, g, b, weight] = self.texture.map_or([1.0; 4], |texture| {
                let [u, v, _] = mean(&self.uvs);
                texture.at([u, v])
            });
            let corner = if self.colors.is_empty() {
                [1.0; 3]
            } else {
                mean(&self.colors)
            };
            weights += weight;
            for (sum, (light, own)) in sum.iter_mut().zip([r, g, b].into_iter().zip(corner)) {
                *sum += weight * light * own.clamp(0.0, 1.0);
            }
        }
        if weights <= 0.0 {
            return factor;
        }
        [0, 1, 2].map(|k| factor[k] * sum[k] / weights)
    }
}
