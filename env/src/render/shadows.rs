//! Draws shadows on the ground: objects are projected along the light onto the ground, and drawn where ground is visible.
//! Nothing else gets shadows.

use super::canvas::{Canvas, Triangle, at_top};
use super::daylight::Daylight;
use super::hidden::Hidden;
use super::lanes::Lanes;
use super::material::{BARE_IN_SHADOW, GROUND, ITEM_BITS, MATERIAL, MATERIAL_SHIFT};
use super::raster::Shading;
use super::view::{NEAR, Placement, Pose, View};
use super::visibility::{Drawable, Visible};
use crate::assets::{BLOCK, Material};
use crate::looks::NaturalLooks;
use crate::scene::{ARENA_WALLS, Item, Scene};

/// Height of shadows above the ground, as a fraction of the camera's height; above zones.
const LIFT: f32 = 2e-3;

/// Maximum length of a shadow, as a multiple of the object's height.
const MAX_LENGTH: f32 = 2.5;

/// Width of the shadow below an object in diffuse light, as a multiple of the object's width.
const SPREAD: f32 = 1.2;

/// Maximum error of a simplified mesh that casts a shadow, in pixels.
const TOLERANCE: f32 = 2.5;

/// How shadows are cast: opposite to `toward`, the direction of the light, scaled to a height of 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cast {
    toward: [f32; 3],
    spread: f32,
}

impl Cast {
    /// The shadows of an image, if there are any.
    pub(super) fn of(looks: &NaturalLooks, daylight: &Daylight, view: &View) -> Option<Self> {
        if !looks.has_shadows || view.position[2] <= 0.0 {
            return None;
        }
        match looks.ceiling {
            Some(_) => Some(Self::below()),
            None => Self::of_sun(daylight.direction),
        }
    }

    /// Shadows of a sun in this direction; `None` if it is too low.
    fn of_sun([x, y, z]: [f32; 3]) -> Option<Self> {
        if z < 0.02 {
            return None;
        }
        let length = (x * x + y * y).sqrt() / z;
        let shorter = (MAX_LENGTH / length.max(1e-6)).min(1.0) / z;
        Some(Self {
            toward: [x * shorter, y * shorter, 1.0],
            spread: 1.0,
        })
    }

    /// Shadows directly below objects, in diffuse light.
    fn below() -> Self {
        Self {
            toward: [0.0, 0.0, 1.0],
            spread: SPREAD,
        }
    }

    /// Bounding ball of the shadow of an object with this position, radius and height.
    fn ball(&self, [x, y]: [f32; 2], radius: f32, height: f32) -> ([f32; 3], f32) {
        let away = [self.toward[0], self.toward[1]].map(|part| part * height / 2.0);
        let length = (away[0] * away[0] + away[1] * away[1]).sqrt();
        ([x - away[0], y - away[1], 0.0], radius * self.spread + length)
    }

    /// Whether a shadow is too flat to be visible: less than two pixels high.
    fn is_too_flat(view: &View, depth: f32, radius: f32) -> bool {
        depth > radius && 2.0 * radius * view.position[2].abs() * view.scale < 2.0 * depth * depth
    }

    /// The projection from an object's frame to its shadow on the screen.
    pub(super) fn placement(&self, view: &View, pose: &Pose) -> Placement {
        let mut at = view.placement(pose, self.toward);
        let lift = LIFT * view.position[2].clamp(0.0, 1000.0) / pose.scale;
        let [x, y, _] = at.sun;
        for row in [&mut at.column, &mut at.row, &mut at.depth] {
            row[3] += row[2] * lift;
            row[2] = -(row[0] * x + row[1] * y);
            row[0] *= self.spread;
            row[1] *= self.spread;
        }
        at
    }
}

/// Collects the objects whose shadows may be visible, and outdoors also the walls within the arena. Leaves out shadows behind
/// the walls recorded in `hidden`. Depths are those of the shadows.
pub(super) fn find(
    scene: &Scene,
    looks: &NaturalLooks,
    cast: &Cast,
    view: &View,
    hidden: &Hidden,
    found: &mut Vec<Visible>,
) {
    found.clear();
    let mut record = |(middle, reach): ([f32; 3], f32), drawable: Drawable| {
        let there = view.view_from_world(middle);
        let is_hidden = || hidden.hides_ball(middle, reach, 0.0, view);
        if view.sees(there, reach) && !Cast::is_too_flat(view, there[2], reach) && !is_hidden() {
            found.push(Visible {
                nearest: there[2] - reach,
                drawable,
            });
        }
    };
    for (index, item) in (0..).zip(&scene.items) {
        if item.visible {
            let (radius, height) = (item.asset.radius * item.scale, item.asset.height * item.scale);
            record(cast.ball(item.position, radius, height), Drawable::Item(index));
        }
    }
    if looks.ceiling.is_some() {
        return;
    }
    for (index, group) in (0..).zip(&scene.panels).skip(ARENA_WALLS) {
        if !group.edges.is_empty() {
            let [x, y, _] = group.middle;
            record(cast.ball([x, y], group.radius, group.height), Drawable::Panels(index));
        }
    }
}

/// The level of an item's mesh that is fine enough for its shadow.
pub(super) fn level<'a>(item: &'a Item, shadow: Visible, view: &View) -> &'a [Material] {
    let pixels_per_metre = view.scale * item.scale / shadow.nearest.max(NEAR);
    item.asset.level(TOLERANCE / pixels_per_metre)
}

/// Values shared by all triangles of a shadow.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadowParams {
    pub(super) may_need_clipping: bool,
    /// Whether the faces turned away from the light cast the shadow. Walls have no tops, so their shadow ends with the shadow
    /// of the edge farthest from the light.
    pub(super) from_behind: bool,
}

impl Shading for ShadowParams {
    #[inline(always)]
    fn item(&self) -> (u32, bool) {
        (0, self.may_need_clipping)
    }

    #[inline(always)]
    fn is_mirrored(&self) -> bool {
        self.from_behind
    }

    /// Faces towards the light, which have the same winding from above as the resulting triangles, or faces away from it.
    #[inline(always)]
    fn facing<L: Lanes>(&self, l: L, normal: [L::Float; 3], _behind: L::Float, at: &Placement) -> L::Mask {
        let zero = l.splat(0.0);
        let light = super::raster::dot(l, normal, at.sun, zero);
        if self.from_behind {
            l.above(zero, light)
        } else {
            l.above(light, zero)
        }
    }

    #[inline(always)]
    fn pixels<L: Lanes>(&self, _l: L, _normal: [L::Float; 3], _at: &Placement) -> [u32; BLOCK] {
        [BARE_IN_SHADOW << MATERIAL_SHIFT; BLOCK]
    }

    #[inline(always)]
    fn fill<L: Lanes, const ITEMS: bool>(&self, l: L, canvas: &mut Canvas, triangle: &Triangle) {
        shade::<L, ITEMS>(l, canvas, triangle);
    }
}

/// Marks a shadow on bare ground and zones.
#[inline(always)]
fn shade<L: Lanes, const ITEMS: bool>(l: L, canvas: &mut Canvas, triangle: &Triangle) {
    let Triangle { columns, rows, .. } = *triangle;
    let zero = l.splat(0.0);
    let bare = l.splat_word(triangle.pixel);
    let (material, zone) = (
        l.splat_word(MATERIAL | ITEM_BITS),
        l.splat_word(GROUND << MATERIAL_SHIFT),
    );
    let shaded = l.splat_word(1 << MATERIAL_SHIFT);
    let top = rows[0] as f32;
    let last_start = canvas.stride - L::N;
    let mut start = columns[0].min(last_start);
    loop {
        let x = l.add(l.count_up(), l.splat(start as f32));
        let mut edges = [
            at_top(l, triangle.edges[0], x, top),
            at_top(l, triangle.edges[1], x, top),
            at_top(l, triangle.edges[2], x, top),
        ];
        let mut inverse = at_top(l, triangle.inverse_depth, x, top);
        let mut pixel = rows[0] * canvas.stride + start;
        for _ in rows[0]..=rows[1] {
            let lanes = pixel..pixel + L::N;
            let inside = l.at_least(l.min(edges[0], l.min(edges[1], edges[2])), zero);
            let depths = l.load(&canvas.inverse_depth[lanes.clone()]);
            let drawn = l.both(inside, l.above(inverse, depths));
            if l.bits(drawn) != 0 {
                let old = l.load_words(&canvas.pixels[lanes.clone()]);
                let on_zone = l.both(drawn, l.equal(l.and(old, material), zone));
                let on_ground = l.both(drawn, l.at_least(zero, depths));
                l.store_words_where(on_zone, l.or(old, shaded), &mut canvas.pixels[lanes.clone()]);
                l.store_words_where(on_ground, bare, &mut canvas.pixels[lanes.clone()]);
                l.store_where(on_ground, inverse, &mut canvas.inverse_depth[lanes.clone()]);
                if ITEMS {
                    l.store_words_where(on_ground, l.splat_word(0), &mut canvas.items[lanes]);
                }
            }
            for (edge, line) in edges.iter_mut().zip(triangle.edges) {
                *edge = l.add(*edge, l.splat(line[2]));
            }
            inverse = l.add(inverse, l.splat(triangle.inverse_depth[2]));
            pixel += canvas.stride;
        }
        start += L::N;
        if start > columns[1] {
            return;
        }
        start = start.min(last_start);
    }
}
