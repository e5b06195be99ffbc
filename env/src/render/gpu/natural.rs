//! The natural style in one tile, in numbers for the shaders: rows, what covers walls and objects, what casts shadows. All of it
//! is found by the code of the processor's renderer; `natural.wgsl` reads what is written here. The plain style is in
//! `instances.rs` and `tile.rs`.

use std::sync::Arc;

use driftworld_spec::Surface;

use super::super::cpu::category;
use super::super::daylight::Daylight;
use super::super::frame::CATEGORY_MAP;
use super::super::hidden::Hidden;
use super::super::natural::{self, GROUND, Natural, OBJECTS, WALLS};
use super::super::rows::{self, Row, Shows};
use super::super::shadows::{self, Cast};
use super::super::view::{Pose, View};
use super::super::visibility::{Drawable, Visible, find, level, sort};
use super::instances::{Labels, Shape, TileContents, corners, corners_as_rows, instance, normal, triangles};
use super::texels;
use super::tile::Quad;
use crate::camera::Camera;
use crate::looks::NaturalLooks;
use crate::scene::{Item, PanelGroup, Scene};

/// The words of a row and of a patch: the sizes of `Row` and `Patch` in `natural.wgsl`.
pub(super) const ROW: usize = 12;
pub(super) const PATCH: usize = 16;

/// The bits of an instance's label that say what covers it, and the one that says that its colour is lit.
pub(super) const COVER: u32 = 31;
pub(super) const IS_LIT: u32 = 32;

/// What only tiles in the natural style have. Kept from pass to pass.
#[derive(Debug, Default)]
pub(super) struct NaturalContents {
    pub(super) rows: Vec<[u32; ROW]>,
    pub(super) patches: Vec<[u32; PATCH]>,
    /// Which tiles of texels they need: a bit for each.
    pub(super) needed: u32,
    natural: Natural,
    hidden: Hidden,
    /// What covers the faces of patches.
    covering: Vec<Surface>,
}

/// What the instances of one picture share.
struct Picture<'a> {
    scene: &'a Scene,
    view: View,
    daylight: Daylight,
    labels: Labels,
}

impl TileContents {
    /// As [`TileContents::gather`], in the natural style.
    pub(super) fn gather_natural(
        &mut self,
        scene: &Scene,
        looks: &NaturalLooks,
        camera: &Camera,
        size: [u32; 2],
        labels: Labels,
    ) {
        let view = View::new(camera, size[0] as usize, size[1] as usize);
        let mut own = std::mem::take(&mut self.natural);
        let daylight = own.natural.rows.prepare(scene, looks, &view);
        let picture = Picture {
            scene,
            view,
            daylight,
            labels,
        };
        self.tile.clear();
        self.tile.extend(tile(&picture, looks));
        self.objects.clear();
        self.shadows.clear();
        own.begin(looks, &view);
        let mut order = std::mem::take(&mut self.visible);
        find(scene, &view, false, &mut order);
        sort(&mut order);
        for &visible in &order {
            match visible.drawable {
                Drawable::Item(index) => self.add_natural_item(index, visible, &picture, &mut own),
                Drawable::Panels(index) => self.add_natural_panels(&scene.panels()[index as usize], &picture, &mut own),
            }
        }
        if let Some(cast) = Cast::of(looks, &daylight, &view) {
            shadows::find(scene, looks, &cast, &view, Some(&own.hidden), &mut order);
            for &shadow in &order {
                self.add_shadow(shadow, &cast, &picture);
            }
        }
        self.visible = order;
        own.finish(looks);
        self.natural = own;
    }

    fn add_natural_item(&mut self, index: u32, visible: Visible, picture: &Picture<'_>, own: &mut NaturalContents) {
        let (item, view) = (&picture.scene.items[index as usize], &picture.view);
        let [x, y] = item.position;
        let top = item.asset.height * item.scale;
        if own
            .hidden
            .hides_ball([x, y, top / 2.0], item.asset.ball_radius() * item.scale, top, view)
        {
            return;
        }
        let at = view.placement(&Pose::of(item), picture.daylight.direction);
        let label = picture.labels.class(item) | u32::from(category(item)) << 24 | own.cover(item, view);
        let color = item.color.map_or([0.0; 4], |[r, g, b]| [r, g, b, 1.0]);
        let materials = level(item, visible, view);
        let words = instance(&at, at.sun, color, [label, index + 1]);
        let shape = Shape::Asset(Arc::clone(&item.asset), materials.as_ptr().addr());
        self.objects.push(words, shape);
    }

    fn add_natural_panels(&mut self, group: &PanelGroup, picture: &Picture<'_>, own: &mut NaturalContents) {
        let view = &picture.view;
        if own.hidden.hides_panels(group, view) {
            return;
        }
        let at = view.placement(&Pose::of_panels(group, view), picture.daylight.direction);
        for (block, lane) in group.blocks.iter().flat_map(triangles) {
            let normal = normal(block, lane);
            let [x, y, z] = normal.map(f32::abs);
            let cover = if group.edges.is_empty() {
                GROUND
            } else if z > x.max(y) {
                0
            } else {
                WALLS + u32::from(y > x)
            };
            // Light is laid on here, for the corners of an instance have no normal.
            let [r, g, b] = picture.daylight.levels(group.color, normal).map(|level| level / 255.0);
            let of_corners = corners_as_rows(&at, corners(block, lane));
            let label = u32::from(CATEGORY_MAP) << 24 | cover | IS_LIT;
            let words = instance(&of_corners, [0.0; 3], [r, g, b, 1.0], [label, 0]);
            self.objects.push(words, Shape::Triangle);
        }
        own.hidden.note(group, view);
    }

    fn add_shadow(&mut self, shadow: Visible, cast: &Cast, picture: &Picture<'_>) {
        let (scene, view) = (picture.scene, &picture.view);
        match shadow.drawable {
            Drawable::Item(index) => {
                let item = &scene.items[index as usize];
                let at = cast.placement(view, &Pose::of(item));
                let materials = shadows::level(item, shadow, view);
                let shape = Shape::Asset(Arc::clone(&item.asset), materials.as_ptr().addr());
                self.shadows.push(instance(&at, [0.0; 3], [0.0; 4], [0, 0]), shape);
            }
            Drawable::Panels(index) => {
                let at = cast.placement(view, &Pose::WORLD);
                let blocks = &scene.panels()[index as usize].blocks;
                let faces = blocks.iter().flat_map(triangles);
                for (block, lane) in faces.filter(|(block, lane)| cast.is_cast_by(normal(block, *lane))) {
                    // Seen from above, what looks away from the light turns the other way.
                    let [a, b, c] = corners(block, lane);
                    let of_corners = corners_as_rows(&at, [a, c, b]);
                    let words = instance(&of_corners, [0.0; 3], [0.0; 4], [0, 0]);
                    self.shadows.push(words, Shape::Triangle);
                }
            }
        }
    }
}

impl NaturalContents {
    fn begin(&mut self, looks: &NaturalLooks, view: &View) {
        self.hidden.clear(view);
        self.natural.cover_walls(looks, view);
        self.covering.clear();
        self.covering.resize(OBJECTS as usize, looks.walls.surface);
    }

    /// The number of what covers an item's faces along x; 0 if nothing does.
    fn cover(&mut self, item: &Item, view: &View) -> u32 {
        let [first, ..] = self.natural.cover_item(item, view);
        self.covering.resize(self.natural.patches.len(), item.surface);
        first
    }

    /// Writes rows and patches down.
    fn finish(&mut self, looks: &NaturalLooks) {
        self.needed = 0;
        let mut begins = |surface: Surface| {
            let number = texels::number(surface)?;
            self.needed |= 1 << number;
            Some(texels::start(number))
        };
        let ground = begins(looks.ground.surface);
        let ceiling = begins(rows::CEILING);
        self.patches.clear();
        for (patch, surface) in self.natural.patches.iter().zip(&self.covering).skip(WALLS as usize) {
            let words = patch.as_ref().zip(begins(*surface)).map(|(patch, start)| {
                let numbers = patch.u.iter().chain(&patch.v).chain(&patch.facing);
                let mut words = [0; PATCH];
                for (word, number) in words.iter_mut().zip(numbers.chain([&patch.sharpness])) {
                    *word = number.to_bits();
                }
                (words[12], words[13]) = (start, 1);
                words
            });
            self.patches.push(words.unwrap_or_default());
        }
        self.needed |= 1 << texels::CLOUDS;
        self.rows.clear();
        self.rows.extend(self.natural.rows.seen.iter().map(|row| {
            row_words(
                row,
                match row.shows {
                    Shows::Floor => ground,
                    Shows::Ceiling => ceiling,
                    Shows::Sky => Some(texels::start(texels::CLOUDS)),
                },
            )
        }));
    }
}

/// The words of a row, in the order of `Row` in `natural.wgsl`; without texels it has no pattern.
fn row_words(row: &Row, texels: Option<u32>) -> [u32; ROW] {
    let [u, du] = row.u.map(f32::to_bits);
    let [v, dv] = row.v.map(f32::to_bits);
    [
        row.inverse.to_bits(),
        row.base,
        row.sunward,
        row.cloud,
        u,
        du,
        v,
        dv,
        if texels.is_some() { row.side } else { 1 },
        row.detail.to_bits(),
        row.shows as u32 | row.detail_share << 8,
        texels.unwrap_or(0),
    ]
}

/// The words of a tile, in the order of `Tile` in `natural.wgsl`.
fn tile(picture: &Picture<'_>, looks: &NaturalLooks) -> [Quad; 7] {
    let Picture {
        scene, view, daylight, ..
    } = picture;
    let four = |numbers: [f32; 4]| numbers.map(f32::to_bits);
    let three = |[x, y, z]: [f32; 3]| four([x, y, z, 0.0]);
    let [width, height] = view.size;
    let (forward, right) = (view.axes.forward, view.axes.right);
    let [x, y] = natural::glow_towards(looks, daylight).unwrap_or([0.0; 2]);
    let [away, toward] = natural::fog_words(daylight);
    [
        four([0.0, 0.0, width, height]),
        four([
            forward[0],
            forward[1],
            view.step,
            scene.light.fog_distance.unwrap_or(0.0),
        ]),
        four([right[0], right[1], x, y]),
        three(daylight.sun),
        three(daylight.around),
        three(daylight.above),
        [away, toward, natural::shade(looks, daylight), 0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words of a struct of the shader.
    fn words_of(name: &str) -> usize {
        let text = include_str!("natural.wgsl");
        let fields = text
            .split(&format!("struct {name} {{"))
            .nth(1)
            .and_then(|rest| rest.split('}').next())
            .expect("the shader has it");
        let fields = fields.lines().filter(|line| !line.trim().starts_with("//"));
        let types = fields.filter_map(|line| line.split_once(": ").map(|(_, kind)| kind));
        types
            .map(|kind| match kind.trim_end_matches(',') {
                "vec4f" | "vec4u" => 4,
                "vec2f" => 2,
                _ => 1,
            })
            .sum()
    }

    #[test]
    fn there_are_words_for_each_field_of_the_shader() {
        assert_eq!(
            [words_of("Row"), words_of("Patch"), words_of("Tile")],
            [ROW, PATCH, 4 * 7]
        );
    }
}
