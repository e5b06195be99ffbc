//! Encodes one image of a pass for the shaders: camera, light, ground and walls, as read by `tile.wgsl`.

use super::super::compose::Walls;
use super::super::shade::{FULL_LEVEL, Shader};
use super::super::view::View;
use crate::scene::Scene;

/// Number of four-component vectors per tile: the size of `Tile` in `tile.wgsl`.
pub(super) const QUADS: usize = 14;

/// The words of one tile, in the order of `Tile` in `tile.wgsl`.
pub(super) type TileWords = [[u32; 4]; QUADS];

/// Describes an image whose upper left corner is at `corner` of the atlas, in pixels.
pub(super) fn words(scene: &Scene, view: &View, shader: &Shader, walls: Option<&Walls>, corner: [u32; 2]) -> TileWords {
    let with = |[a, b, c]: [f32; 3], d: f32| [a, b, c, d].map(f32::to_bits);
    let four = |numbers: [f32; 4]| numbers.map(f32::to_bits);
    let [zenith, horizon] = shader.sky(scene.light.sky_color);
    let upward = shader.share([0.0, 0.0, 1.0]);
    let ground = shader.in_light(scene.ground_color).map(|level| level * upward);
    let fog = horizon.map(|level| level.min(FULL_LEVEL));
    let [width, height] = view.size;
    let none = [0.0; 4];
    [
        four([corner[0] as f32, corner[1] as f32, width, height]),
        with(view.axes.forward, view.step),
        with(view.axes.right, view.position[2].max(0.01)),
        with(view.axes.up, walls.map_or(1.0, |walls| walls.above)),
        with(view.position, if walls.is_some() { 1.0 } else { 0.0 }),
        four(walls.map_or(none, |walls| walls.base)),
        four(walls.map_or(none, |walls| walls.right)),
        four(walls.map_or(none, |walls| walls.up)),
        walls.map_or([0; 4], |walls| walls.pixels),
        with(ground, 0.0),
        with(zenith, 0.0),
        with(horizon, 0.0),
        with(shader.tint, shader.ambient),
        with(fog, scene.light.fog_distance.unwrap_or(0.0)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_of_quads_matches_the_shaders_struct() {
        let text = include_str!("tile.wgsl");
        let fields = text
            .split("struct Tile {")
            .nth(1)
            .and_then(|rest| rest.split('}').next());
        let count = fields.map_or(0, |fields| fields.matches(": vec4").count());
        assert_eq!(count, QUADS);
    }
}
