//! Collects the instances of one tile: one per visible object, and one per triangle of panels that are not computed
//! analytically.

use std::sync::Arc;

use super::super::compose::{CATEGORY_BITS, Walls};
use super::super::cpu::category;
use super::super::frame::CATEGORY_MAP;
use super::super::shade::Shader;
use super::super::view::{Placement, Pose, View};
use super::super::visibility::{Drawable, Visible, find, level};
use super::tile::{self, TileWords};
use crate::assets::{Asset, BLOCK, Block};
use crate::camera::Camera;
use crate::scene::{Item, PanelGroup, Scene};

/// Words per instance: the size of `Instance` in `objects.wgsl`.
pub(super) const WORDS: usize = 22;

/// Index of the word with the instance's tile.
const TILE: usize = 19;

/// One instance, in the order of `Instance` in `objects.wgsl`.
pub(super) type InstanceWords = [u32; WORDS];

/// The shape of an instance.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// A triangle whose corners are in the instance itself.
    Triangle,
    /// An asset, and the address of its level's materials, which is valid as long as the asset lives.
    Asset(Arc<Asset>, usize),
}

/// Contents of one tile. Reused between passes.
#[derive(Debug, Default)]
pub(super) struct TileContents {
    pub(super) tile: TileWords,
    pub(super) instances: Vec<InstanceWords>,
    /// One shape per instance.
    pub(super) shapes: Vec<Shape>,
    visible: Vec<Visible>,
}

impl TileContents {
    /// Collects everything in a scene that a camera sees in an image of this size. [`TileContents::place`] sets the tile's
    /// position later.
    pub(super) fn gather(&mut self, scene: &Scene, camera: &Camera, size: [u32; 2], with_class: bool) {
        let view = View::new(camera, size[0] as usize, size[1] as usize);
        let shader = Shader::new(&scene.light);
        let walls = Walls::around(scene, &view, &shader);
        self.tile = tile::words(scene, &view, &shader, walls.as_ref(), [0, 0]);
        self.instances.clear();
        self.shapes.clear();
        let mut all_visible = std::mem::take(&mut self.visible);
        find(scene, &view, walls.is_some(), &mut all_visible);
        for &visible in &all_visible {
            match visible.drawable {
                Drawable::Item(index) => {
                    self.add_item(&scene.items[index as usize], index, visible, &view, scene, with_class);
                }
                Drawable::Panels(index) => self.add_panels(&scene.panels[index as usize], &view, scene),
            }
        }
        self.visible = all_visible;
    }

    /// Sets the tile's index in the pass and its upper left corner in the atlas.
    pub(super) fn place(&mut self, number: u32, corner: [u32; 2]) {
        self.tile[0][0] = (corner[0] as f32).to_bits();
        self.tile[0][1] = (corner[1] as f32).to_bits();
        for instance in &mut self.instances {
            instance[TILE] = number;
        }
    }

    fn add_item(&mut self, item: &Item, index: u32, visible: Visible, view: &View, scene: &Scene, with_class: bool) {
        let at = view.placement(&Pose::of(item), scene.light.direction);
        let class = if with_class {
            u32::from(item.class_id) << CATEGORY_BITS
        } else {
            0
        };
        let label = (class | u32::from(category(item))) << 24;
        let color = item.color.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
        let materials = level(item, visible, view);
        self.instances.push(instance(&at, at.sun, color, [label, index + 1]));
        self.shapes
            .push(Shape::Asset(Arc::clone(&item.asset), materials.as_ptr().addr()));
    }

    fn add_panels(&mut self, group: &PanelGroup, view: &View, scene: &Scene) {
        let at = view.placement(&Pose::of_panels(group, view), scene.light.direction);
        let [r, g, b] = group.color;
        let label = u32::from(CATEGORY_MAP) << 24;
        for (block, lane) in group.blocks.iter().flat_map(triangles) {
            let normal = normal(block, lane);
            let lit = (0..3).map(|axis| normal[axis] * at.sun[axis]).sum();
            let placement = corners_as_rows(&at, corners(block, lane));
            self.instances
                .push(instance(&placement, [lit, 0.0, 0.0], [r, g, b, 1.0], [label, 0]));
            self.shapes.push(Shape::Triangle);
        }
    }
}

/// The lanes of a block that contain a triangle.
pub(super) fn triangles(block: &Block) -> impl Iterator<Item = (&Block, usize)> {
    let has_triangle = |lane: &usize| normal(block, *lane) != [0.0; 3];
    (0..BLOCK).filter(has_triangle).map(move |lane| (block, lane))
}

pub(super) fn normal(block: &Block, lane: usize) -> [f32; 3] {
    block.normal.map(|row| row[lane])
}

pub(super) fn corners(block: &Block, lane: usize) -> [[f32; 3]; 3] {
    [0, 3, 6].map(|first| [0, 1, 2].map(|axis| block.corners[first + axis][lane]))
}

/// The projection of a triangle's corners, as rows for the corners (1, 0, 0), (0, 1, 0) and (0, 0, 1), so that neighbouring
/// triangles share their edges bit for bit.
fn corners_as_rows(at: &Placement, corners: [[f32; 3]; 3]) -> Placement {
    let row = |row: &[f32; 4]| {
        let [a, b, c] = corners.map(|[x, y, z]| x * row[0] + (y * row[1] + (z * row[2] + row[3])));
        [a, b, c, 0.0]
    };
    Placement {
        column: row(&at.column),
        row: row(&at.row),
        depth: row(&at.depth),
        ..*at
    }
}

/// The words of an instance, without the tile's index.
fn instance(at: &Placement, sun: [f32; 3], color: [f32; 4], [label, item]: [u32; 2]) -> InstanceWords {
    let mut words = [0; WORDS];
    let numbers = at
        .column
        .iter()
        .chain(&at.row)
        .chain(&at.depth)
        .chain(&sun)
        .chain(&color);
    for (word, number) in words.iter_mut().zip(numbers) {
        *word = number.to_bits();
    }
    words[TILE..].copy_from_slice(&[0, label, item]);
    words
}
