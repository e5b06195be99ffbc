//! The renderer that needs nothing but a processor: sky and ground by formula, walls and objects by scan conversion.

use crate::assets::Paint;
use crate::camera::{Axes, Camera};
use crate::render::background::Background;
use crate::render::frame::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, FAR_DEPTH, Frame,
};
use crate::render::shade::Shader;
use crate::scene::{Item, Scene, WallPanel};

/// Nearest distance at which anything is drawn, in metres.
const NEAR: f32 = 0.05;

/// Draws scenes on the processor. Keeps its buffers from picture to picture; draws the same pixels on every machine.
#[derive(Clone, Debug, Default)]
pub struct CpuRenderer {
    /// 1 / depth per pixel; 0 is infinitely far.
    inverse_depth: Vec<f32>,
    order: Vec<(f32, u32)>,
    corners: Vec<[f32; 3]>,
}

/// What all pixels of a triangle share.
#[derive(Clone, Copy)]
struct Ink {
    rgb: [u8; 3],
    category: u8,
    class: u16,
    instance: u32,
}

/// A camera ready to project: screen x and y at depth 1, and depth.
struct View {
    axes: Axes,
    position: [f32; 3],
    scale: f32,
    half: [f32; 2],
}

impl View {
    fn new(camera: &Camera, frame: &Frame) -> Self {
        let half = [frame.width as f32 / 2.0, frame.height as f32 / 2.0];
        Self {
            axes: camera.axes(),
            position: camera.position,
            scale: half[1] / camera.tangent(),
            half,
        }
    }

    /// A point of the world in the camera's frame: right, up, forward, in metres.
    fn view_from_world(&self, point: [f32; 3]) -> [f32; 3] {
        let d = sub(point, self.position);
        [dot(d, self.axes.right), dot(d, self.axes.up), dot(d, self.axes.forward)]
    }

    /// Pixel coordinates and 1 / depth of a point in the camera's frame in front of the near plane.
    fn project(&self, [right, up, forward]: [f32; 3]) -> [f32; 3] {
        let inverse = 1.0 / forward;
        [
            self.half[0] + right * self.scale * inverse,
            self.half[1] - up * self.scale * inverse,
            inverse,
        ]
    }

    /// Whether a ball may be in the picture.
    fn sees(&self, [right, up, forward]: [f32; 3], radius: f32) -> bool {
        if forward + radius < NEAR {
            return false;
        }
        let [tx, ty] = [self.half[0] / self.scale, self.half[1] / self.scale];
        right.abs() - tx * forward <= radius * (1.0 + tx * tx).sqrt()
            && up.abs() - ty * forward <= radius * (1.0 + ty * ty).sqrt()
    }
}

impl CpuRenderer {
    /// A renderer.
    pub fn new() -> Self {
        Self::default()
    }

    /// Draws what the camera sees of the scene into the frame, at the frame's size.
    pub fn render(&mut self, scene: &Scene, camera: &Camera, frame: &mut Frame) {
        let pixels = frame.width as usize * frame.height as usize;
        self.inverse_depth.clear();
        self.inverse_depth.resize(pixels, 0.0);
        frame.class.fill(0);
        frame.instance.fill(0);
        let view = View::new(camera, frame);
        let shader = Shader::new(&scene.light);
        self.draw_items(scene, &view, &shader, frame);
        for wall in &scene.walls {
            self.draw_wall(wall, &view, &shader, frame);
        }
        Background::new(scene, &shader, camera, frame).fill(&self.inverse_depth, frame);
        for (depth, inverse) in frame.depth.iter_mut().zip(&self.inverse_depth) {
            if *inverse > 0.0 {
                *depth = (1.0 / inverse).min(FAR_DEPTH);
            }
        }
    }

    /// Nearest first, so that most hidden pixels fail the depth test.
    fn draw_items(&mut self, scene: &Scene, view: &View, shader: &Shader, frame: &mut Frame) {
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        for (index, item) in scene.items.iter().enumerate().filter(|(_, item)| item.visible) {
            let radius = item.asset.radius.max(item.asset.height) * item.scale;
            let centre =
                view.view_from_world([item.position[0], item.position[1], item.asset.height * item.scale / 2.0]);
            if view.sees(centre, radius) {
                order.push((centre[2], index as u32));
            }
        }
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        for &(_, index) in &order {
            self.draw_item(&scene.items[index as usize], index, view, shader, frame);
        }
        self.order = order;
    }

    fn draw_item(&mut self, item: &Item, index: u32, view: &View, shader: &Shader, frame: &mut Frame) {
        let heading = item.heading_deg.to_radians();
        let (sin, cos) = (libm::sinf(heading), libm::cosf(heading));
        // Headings turn clockwise.
        let turn = |[x, y, z]: [f32; 3]| [x * cos + y * sin, y * cos - x * sin, z];
        let category = match item.reward {
            _ if item.building => CATEGORY_BUILDING,
            reward if reward > 0.0 => CATEGORY_POSITIVE,
            reward if reward < 0.0 => CATEGORY_NEGATIVE,
            _ => CATEGORY_NEUTRAL,
        };
        for part in &item.asset.parts {
            let color = match part.paint {
                Paint::Main(own) => item.color.unwrap_or(own),
                Paint::Fixed(color) => color,
            };
            self.corners.clear();
            self.corners.extend(part.mesh.corners.iter().map(|corner| {
                let [x, y, z] = turn(corner.map(|metres| metres * item.scale));
                view.view_from_world([x + item.position[0], y + item.position[1], z])
            }));
            for (triangle, normal) in part.mesh.triangles.iter().zip(&part.normals) {
                let corners = triangle.map(|corner| self.corners[corner as usize]);
                if faces_away(corners) {
                    continue;
                }
                let rgb = shader.lit(color, turn(*normal));
                let ink = Ink {
                    rgb,
                    category,
                    class: item.class_id,
                    instance: index + 1,
                };
                self.draw_triangle(corners, ink, view, frame);
            }
        }
    }

    fn draw_wall(&mut self, wall: &WallPanel, view: &View, shader: &Shader, frame: &mut Frame) {
        let along = [wall.to[0] - wall.from[0], wall.to[1] - wall.from[1]];
        let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
        if length == 0.0 || wall.height <= 0.0 {
            return;
        }
        let normal = [along[1] / length, -along[0] / length, 0.0];
        let at = |[x, y]: [f32; 2], z: f32| view.view_from_world([x, y, z]);
        let corners = [
            at(wall.from, 0.0),
            at(wall.to, 0.0),
            at(wall.to, wall.height),
            at(wall.from, wall.height),
        ];
        if faces_away([corners[0], corners[1], corners[2]]) {
            return;
        }
        let ink = Ink {
            rgb: shader.lit(wall.color, normal),
            category: CATEGORY_MAP,
            class: 0,
            instance: 0,
        };
        self.draw_triangle([corners[0], corners[1], corners[2]], ink, view, frame);
        self.draw_triangle([corners[0], corners[2], corners[3]], ink, view, frame);
    }

    /// Cuts a triangle at the near plane and draws what is left.
    fn draw_triangle(&mut self, corners: [[f32; 3]; 3], ink: Ink, view: &View, frame: &mut Frame) {
        if corners.iter().all(|corner| corner[2] >= NEAR) {
            return self.fill(corners.map(|corner| view.project(corner)), ink, frame);
        }
        let mut polygon = [[0.0; 3]; 4];
        let mut count = 0;
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            if a[2] >= NEAR {
                polygon[count] = a;
                count += 1;
            }
            if (a[2] >= NEAR) != (b[2] >= NEAR) {
                let share = (NEAR - a[2]) / (b[2] - a[2]);
                polygon[count] = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, NEAR];
                count += 1;
            }
        }
        for k in 2..count {
            let corners = [polygon[0], polygon[k - 1], polygon[k]];
            self.fill(corners.map(|corner| view.project(corner)), ink, frame);
        }
    }

    /// Fills the pixels whose centres lie in a triangle and that nothing nearer has taken.
    fn fill(&mut self, [a, b, c]: [[f32; 3]; 3], ink: Ink, frame: &mut Frame) {
        let (width, height) = (frame.width as f32, frame.height as f32);
        let least = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
        let most = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
        let (left, right) = (
            (least(0) - 0.5).ceil().max(0.0),
            (most(0) - 0.5).floor().min(width - 1.0),
        );
        let (top, bottom) = (
            (least(1) - 0.5).ceil().max(0.0),
            (most(1) - 0.5).floor().min(height - 1.0),
        );
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if !(left <= right && top <= bottom && area < 0.0) {
            return;
        }
        // Share of corner b and of corner c at a pixel's centre, and how they change from pixel to pixel.
        let inverse_area = 1.0 / area;
        let (bx, by) = ((c[1] - a[1]) * inverse_area, (a[0] - c[0]) * inverse_area);
        let (cx, cy) = ((a[1] - b[1]) * inverse_area, (b[0] - a[0]) * inverse_area);
        let (zb, zc) = (b[2] - a[2], c[2] - a[2]);
        for row in top as usize..=bottom as usize {
            let dy = row as f32 + 0.5 - a[1];
            let offset = row * frame.width as usize;
            for column in left as usize..=right as usize {
                let dx = column as f32 + 0.5 - a[0];
                let (share_b, share_c) = (dx * bx + dy * by, dx * cx + dy * cy);
                if share_b < 0.0 || share_c < 0.0 || share_b + share_c > 1.0 {
                    continue;
                }
                let inverse = a[2] + share_b * zb + share_c * zc;
                let pixel = offset + column;
                if inverse > self.inverse_depth[pixel] {
                    self.inverse_depth[pixel] = inverse;
                    frame.rgb[pixel * 3..pixel * 3 + 3].copy_from_slice(&ink.rgb);
                    frame.category[pixel] = ink.category;
                    frame.class[pixel] = ink.class;
                    frame.instance[pixel] = ink.instance;
                }
            }
        }
    }
}

/// Whether a triangle of the camera's frame shows its back: its corners run clockwise.
fn faces_away([a, b, c]: [[f32; 3]; 3]) -> bool {
    let normal = cross(sub(b, a), sub(c, a));
    // The camera's frame (right, up, forward) is left-handed, so the sign is turned.
    dot(normal, a) <= 0.0
}

pub(crate) fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
