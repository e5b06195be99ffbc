//! Draws the objects that the agent carries as small pictures at the bottom of its view. They appear only in the colour image,
//! and are always drawn on the CPU, so that their pixels do not depend on the renderer.

use driftworld_spec::World;

use super::cpu::CpuRenderer;
use super::target::Target;
use crate::camera::Camera;
use crate::scene::{Item, Light, Scene};

/// The image's height divided by the height of an object's picture.
const HEIGHT_DIVISOR: u32 = 5;

/// Minimum height of an object's picture in pixels, if the image is that large.
const MIN_SIDE: u32 = 8;

/// Draws carried objects. Allocates for the first one, and afterwards only for larger pictures.
#[derive(Clone, Debug, Default)]
pub(super) struct Hand(Option<Box<Studio>>);

/// A scene with only the object to draw.
#[derive(Clone, Debug)]
struct Studio {
    renderer: CpuRenderer,
    scene: Scene,
    rgb: Vec<u8>,
    instance: Vec<u32>,
}

impl Hand {
    /// Draws these items side by side at the bottom of the colour image, in this order. If there is no room for all, draws the
    /// last ones.
    pub(super) fn draw(&mut self, scene: &Scene, carried: &[u32], target: &mut Target<'_>) {
        let (width, height) = (target.width, target.height);
        let side = (height / HEIGHT_DIVISOR).max(MIN_SIDE).min(width).min(height);
        let Some(rgb) = target.rgb.as_deref_mut().filter(|_| side > 0) else {
            return;
        };
        let room = (width / side) as usize;
        let shown = &carried[carried.len().saturating_sub(room)..];
        let left = (width - side * shown.len() as u32) / 2;
        for (number, item) in shown.iter().enumerate() {
            let Some(item) = scene.items.get(*item as usize) else {
                continue;
            };
            let studio = self.0.get_or_insert_with(Box::default);
            studio.draw(item, scene.light, side);
            studio.paste(rgb, width, [left + side * number as u32, height - side], side);
        }
    }
}

impl Default for Studio {
    fn default() -> Self {
        Self {
            renderer: CpuRenderer::new(),
            scene: Scene::from_world(&World::default()),
            rgb: Vec::new(),
            instance: Vec::new(),
        }
    }
}

impl Studio {
    /// Draws one object so that it fills a square, in the world's light but without fog.
    fn draw(&mut self, item: &Item, light: Light, side: u32) {
        /// Behind the camera, to its left and above, so that every visible side is lit.
        const SUN: [f32; 3] = [-0.36, -0.8, 0.48];
        /// Distance of the camera, in lengths of the object.
        const DISTANCE: f32 = 3.0;
        /// Height of the camera above the object's centre.
        const ABOVE: f32 = 0.6;
        let length = item.asset.height.max(2.0 * item.asset.radius).max(1e-3);
        let item = Item {
            position: [0.0; 2],
            // Shows its front, slightly from the side.
            heading_deg: 200.0,
            scale: 1.0 / length,
            // Its class number may be unknown in this scene.
            class_id: 0,
            visible: true,
            ..item.clone()
        };
        let middle = item.asset.height * item.scale / 2.0;
        self.scene.items.clear();
        self.scene.items.push(item);
        self.scene.light = Light {
            direction: SUN,
            fog_distance: None,
            ..light
        };
        let camera = Camera {
            position: [0.0, -DISTANCE, middle + ABOVE],
            heading_deg: 0.0,
            pitch_deg: -libm::atanf(ABOVE / DISTANCE).to_degrees(),
            field_of_view_deg: 24.0,
        };
        let pixels = side as usize * side as usize;
        self.rgb.resize(3 * pixels, 0);
        self.instance.resize(pixels, 0);
        let mut target = Target {
            instance: Some(&mut self.instance),
            ..Target::of_colors([side, side], &mut self.rgb)
        };
        self.renderer
            .draw(&self.scene, &camera, &mut target)
            .expect("the side is 1 to 4096 pixels, and the buffers have its size");
    }

    /// Copies the object's pixels, without their background, into an image.
    fn paste(&self, rgb: &mut [u8], width: u32, [left, top]: [u32; 2], side: u32) {
        for (pixel, _) in self.instance.iter().enumerate().filter(|(_, item)| **item > 0) {
            let [x, y] = [pixel as u32 % side, pixel as u32 / side];
            let to = 3 * ((top + y) as usize * width as usize + (left + x) as usize);
            rgb[to..to + 3].copy_from_slice(&self.rgb[3 * pixel..3 * pixel + 3]);
        }
    }
}
