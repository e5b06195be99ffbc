//! Draws a map of a scene from straight above, with north at the top and the agent as an arrow.

use super::cpu::CpuRenderer;
use super::frame::Frame;
use crate::assets::{ColliderShape, Paint};
use crate::camera::Camera;
use crate::scene::{ARENA_WALLS, Item, Scene};

/// Minimum radius of an object on the map, as a fraction of the map's height.
const MIN_RADIUS: f32 = 0.014;

/// Classes that are hardly visible from above.
const THIN: [&str; 4] = ["door", "key", "switch", "sign"];

/// An 8-bit RGB image, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `(height, width, 3)` bytes.
    pub rgb: Vec<u8>,
}

/// A map of the scene, with an arrow for the agent's position and heading if given.
///
/// Shows the whole arena and every object; tiny objects are enlarged. Walls are filled, with a dark rim; doors, keys, switches
/// and signs are bars and dots.
pub fn top_down(scene: &Scene, width: u32, height: u32, agent: Option<([f32; 2], f32)>) -> Image {
    top_down_with_way(scene, width, height, agent, &[])
}

/// Like [`top_down`], with a line through these positions, in metres, under the arrow.
pub fn top_down_with_way(
    scene: &Scene,
    width: u32,
    height: u32,
    agent: Option<([f32; 2], f32)>,
    way: &[[f32; 2]],
) -> Image {
    let span = span(scene, width as f32 / height as f32);
    // High enough to avoid perspective.
    let camera_height = 40.0 * span;
    let camera = Camera {
        position: [0.0, 0.0, camera_height],
        heading_deg: 0.0,
        pitch_deg: -90.0,
        field_of_view_deg: 2.0 * libm::atanf(span / 2.0 / camera_height).to_degrees(),
    };
    let mut scene = scene.clone().with_wall_tops();
    // Maps have no surface patterns or shadows.
    scene.natural = None;
    for item in &mut scene.items {
        item.scale = item.scale.max(MIN_RADIUS * span / item.asset.radius);
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
    // Rims are dark if there are walls other than the arena's.
    let brightness = if scene.walls.len() > ARENA_WALLS { 90.0 } else { 200.0 };
    for wall in &scene.walls {
        image.line([wall.from, wall.to].map(pixel), 0, darkened(wall.color, brightness));
    }
    let numbers = THIN.map(|class| scene.catalogue().class_number(class));
    for item in scene
        .items
        .iter()
        .filter(|item| item.visible && numbers.contains(&item.class_id))
    {
        image.bar(item, pixel);
    }
    for (more, rgb) in [(2 * (height as i32 / 300).max(1), [20, 24, 30]), (0, [255, 255, 255])] {
        for step in way.windows(2) {
            image.line([step[0], step[1]].map(pixel), more, rgb);
        }
    }
    if let Some((position, heading)) = agent {
        image.arrow(pixel(position), heading);
    }
    image
}

/// Pixels per metre of the map that [`top_down`] draws at this size; the arena's centre is in the middle of the image.
pub fn top_down_scale(scene: &Scene, width: u32, height: u32) -> f32 {
    height as f32 / span(scene, width as f32 / height as f32)
}

/// Height in metres of the area that the map shows: the arena and all objects, with a margin of 6 %.
fn span(scene: &Scene, aspect: f32) -> f32 {
    let [mut wide, mut deep] = scene.arena_size();
    for item in scene.items.iter().filter(|item| item.visible) {
        let radius = item.asset.radius * item.scale;
        wide = wide.max(2.0 * (item.position[0].abs() + radius));
        deep = deep.max(2.0 * (item.position[1].abs() + radius));
    }
    deep.max(wide / aspect).max(1.0) * 1.06
}

/// A colour in bytes, scaled to this brightness.
fn darkened(color: [f32; 3], brightness: f32) -> [u8; 3] {
    color.map(|channel| (channel * brightness) as u8)
}

impl Image {
    /// Draws a door as a bar along its width, and other objects as a dot, in their main colour with a dark rim.
    fn bar(&mut self, item: &Item, pixel: impl Fn([f32; 2]) -> [f32; 2]) {
        let half = match item.body.collider {
            ColliderShape::Box {
                half: [width, depth, _],
            } if width > 3.0 * depth => width * item.scale,
            _ => 0.0,
        };
        let heading = item.heading_deg.to_radians();
        let (along, [x, y]) = ([libm::cosf(heading) * half, -libm::sinf(heading) * half], item.position);
        let ends = [[x - along[0], y - along[1]], [x + along[0], y + along[1]]].map(pixel);
        let own = item.asset.parts.iter().find_map(|part| match part.paint {
            Paint::Main(color) => Some(color),
            Paint::Fixed(_) => None,
        });
        let more = (self.height as i32 / if half > 0.0 { 300 } else { 100 }).max(1);
        self.line(ends, more + 2 * (self.height as i32 / 200).max(1), [20, 24, 30]);
        self.line(ends, more, darkened(item.color.or(own).unwrap_or([0.5; 3]), 255.0));
    }

    /// Draws a thick line: walls are thin from above. Its thickness is relative to the image, at least two pixels, plus
    /// `more` pixels.
    fn line(&mut self, [from, to]: [[f32; 2]; 2], more: i32, rgb: [u8; 3]) {
        let thick = (self.height as i32 / 150).max(1) + more;
        let along = [to[0] - from[0], to[1] - from[1]];
        let steps = along[0].abs().max(along[1].abs()).ceil().clamp(1.0, 10_000.0);
        for k in 0..=steps as i32 {
            let share = k as f32 / steps;
            // Clamped, because corners may be anywhere.
            let pixel = |axis: usize| (from[axis] + along[axis] * share).clamp(-1e6, 1e6) as i32;
            let (x, y) = (pixel(0), pixel(1));
            for (dx, dy) in (0..=thick).flat_map(|dx| (0..=thick).map(move |dy| (dx, dy))) {
                self.set(x + dx - thick / 2, y + dy - thick / 2, rgb);
            }
        }
    }

    /// Draws an arrowhead with a dark rim.
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
