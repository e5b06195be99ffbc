//! The map of a scene: seen from straight above, north on top, with the agent on it.

use super::cpu::CpuRenderer;
use super::frame::Frame;
use crate::camera::Camera;
use crate::scene::Scene;

/// Least radius of an object on the map, as a share of the map's height.
const LEAST_SIZE: f32 = 0.014;

/// A picture: 8-bit RGB, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `(height, width, 3)` bytes.
    pub rgb: Vec<u8>,
}

/// The scene from above, with the agent's position and heading as an arrow if it is given.
///
/// All of the arena and every object is on it; objects that would be specks are drawn larger than they are.
pub fn top_down(scene: &Scene, width: u32, height: u32, agent: Option<([f32; 2], f32)>) -> Image {
    let span = span(scene, width as f32 / height as f32);
    // From so high that nothing leans.
    let camera_height = 40.0 * span;
    let camera = Camera {
        position: [0.0, 0.0, camera_height],
        heading_deg: 0.0,
        pitch_deg: -90.0,
        field_of_view_deg: 2.0 * libm::atanf(span / 2.0 / camera_height).to_degrees(),
    };
    let mut scene = scene.clone();
    for item in &mut scene.items {
        item.scale = item.scale.max(LEAST_SIZE * span / item.asset.radius);
    }
    let mut frame = Frame::new(width, height);
    CpuRenderer::new().render(&scene, &camera, &mut frame);
    let mut image = Image {
        width,
        height,
        rgb: frame.rgb,
    };
    let scale = height as f32 / span;
    let pixel = |[x, y]: [f32; 2]| [width as f32 / 2.0 + x * scale, height as f32 / 2.0 - y * scale];
    for wall in &scene.walls {
        image.line(
            pixel(wall.from),
            pixel(wall.to),
            wall.color.map(|channel| (channel * 200.0) as u8),
        );
    }
    if let Some((position, heading)) = agent {
        image.arrow(pixel(position), heading);
    }
    image
}

/// Height of the ground that the map shows, in metres: arena and objects, with a margin of 6 %.
fn span(scene: &Scene, aspect: f32) -> f32 {
    let [mut wide, mut deep] = scene.arena_size();
    for item in scene.items.iter().filter(|item| item.visible) {
        let radius = item.asset.radius * item.scale;
        wide = wide.max(2.0 * (item.position[0].abs() + radius));
        deep = deep.max(2.0 * (item.position[1].abs() + radius));
    }
    deep.max(wide / aspect).max(1.0) * 1.06
}

impl Image {
    /// A line as thick as a hundredth of the picture, at least two pixels: walls are thin from above.
    fn line(&mut self, from: [f32; 2], to: [f32; 2], rgb: [u8; 3]) {
        let thick = (self.height as i32 / 150).max(1);
        let along = [to[0] - from[0], to[1] - from[1]];
        let steps = along[0].abs().max(along[1].abs()).ceil().clamp(1.0, 10_000.0);
        for k in 0..=steps as i32 {
            let share = k as f32 / steps;
            // Far outside is far outside: corners may lie anywhere.
            let pixel = |axis: usize| (from[axis] + along[axis] * share).clamp(-1e6, 1e6) as i32;
            let (x, y) = (pixel(0), pixel(1));
            for (dx, dy) in (0..=thick).flat_map(|dx| (0..=thick).map(move |dy| (dx, dy))) {
                self.set(x + dx - thick / 2, y + dy - thick / 2, rgb);
            }
        }
    }

    /// An arrowhead with a dark rim.
    fn arrow(&mut self, [x, y]: [f32; 2], heading_deg: f32) {
        let size = (self.height as f32 / 22.0).max(5.0);
        let heading = heading_deg.to_radians();
        let (sin, cos) = (libm::sinf(heading), libm::cosf(heading));
        let reach = size.ceil() as i32 + 2;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                // Along the heading and to its right, in arrow lengths.
                let along = (dx as f32 * sin - dy as f32 * cos) / size;
                let side = (dx as f32 * cos + dy as f32 * sin).abs() / size;
                let inside =
                    |grow: f32| along < 1.0 + grow && along > -0.7 - grow && side < (1.0 - along) * 0.42 + grow;
                if inside(0.0) {
                    self.set(x as i32 + dx, y as i32 + dy, [255, 255, 255]);
                } else if inside(0.18) {
                    self.set(x as i32 + dx, y as i32 + dy, [20, 24, 30]);
                }
            }
        }
    }

    fn set(&mut self, x: i32, y: i32, rgb: [u8; 3]) {
        if (0..self.width as i32).contains(&x) && (0..self.height as i32).contains(&y) {
            let at = (y as usize * self.width as usize + x as usize) * 3;
            self.rgb[at..at + 3].copy_from_slice(&rgb);
        }
    }
}
