//! The natural style on the CPU. Draws objects with their texels, and marks walls and zones with their material numbers;
//! `compose_natural.rs` adds the texels of walls and zones.

use driftworld_spec::Surface;

use super::canvas::{Canvas, Triangle};
use super::compose_natural::Composition;
use super::cpu::{CpuRenderer, category};
use super::daylight::Daylight;
use super::frame::CATEGORY_MAP;
use super::lanes::Lanes;
use super::material::{GROUND, MATERIAL_SHIFT, WALLS};
use super::patch::{Patch, Sheet};
use super::raster::{Shading, dot, draw_block};
use super::rows::{Rows, packed};
use super::shade::{FULL_LEVEL, ROUNDING};
use super::shadows::{self, Cast, ShadowParams};
use super::surfaces;
use super::target::Target;
use super::view::{NEAR, Placement, Pose, View};
use super::visibility::{Drawable, Visible, find, level, sort_arena_last};
use crate::assets::{BLOCK, Material, Paint};
use crate::camera::Camera;
use crate::looks::NaturalLooks;
use crate::scene::{Item, PanelGroup, Scene};

/// Number of classes that fit into a label.
const CLASSES: u16 = 32;

/// Position of a face's axis in the packed pixel of a covered object's triangle, until the triangle is filled.
const AXIS_SHIFT: u32 = 30;

/// State of the style, reused between images.
#[derive(Clone, Debug, Default)]
pub(super) struct Natural {
    pub(super) rows: Rows,
    /// Coverings of walls that face along x and y, and of their tops.
    pub(super) walls: Option<[Patch; 3]>,
    /// How close each column is to the direction of the sun: a byte, repeated in the three bytes of a colour.
    pub(super) glow: Vec<u32>,
}

/// Values shared by all triangles of a material.
#[derive(Clone, Copy, Debug)]
struct NaturalParams<'a> {
    /// Levels 0 to 255: of the sun, of ambient light, and the addition for a face that points up.
    sun: [f32; 3],
    around: [f32; 3],
    above: [f32; 3],
    /// Labels of faces along x, y and z, in the highest byte.
    labels: [u32; 3],
    item: u32,
    may_need_clipping: bool,
    cover: Option<&'a Cover>,
}

/// Covering of an object's faces along x, y and z.
#[derive(Clone, Copy, Debug)]
struct Cover {
    patches: [Patch; 3],
    /// The object's label.
    label: u32,
    /// The image's middle, and metres per pixel at 1 m.
    middle: [f32; 2],
    step: f32,
}

impl NaturalParams<'_> {
    fn new(color: [f32; 3], daylight: &Daylight, labels: [u32; 3]) -> Self {
        let full = color.map(|channel| channel * FULL_LEVEL);
        let by = |light: [f32; 3]| [0, 1, 2].map(|k| full[k] * light[k]);
        Self {
            sun: by(daylight.sun),
            around: by(daylight.around),
            above: by(daylight.above),
            labels,
            item: 0,
            may_need_clipping: false,
            cover: None,
        }
    }

    #[inline(always)]
    fn byte<L: Lanes>(&self, l: L, channel: usize, sun: L::Float, up: L::Float) -> L::Word {
        let around = l.splat(self.around[channel] + ROUNDING);
        let level = l.mul_add(
            sun,
            l.splat(self.sun[channel]),
            l.mul_add(up, l.splat(self.above[channel]), around),
        );
        l.truncate(l.min(level, l.splat(FULL_LEVEL)))
    }
}

impl Shading for NaturalParams<'_> {
    #[inline(always)]
    fn item(&self) -> (u32, bool) {
        (self.item, self.may_need_clipping)
    }

    #[inline(always)]
    fn pixels<L: Lanes>(&self, l: L, normal: [L::Float; 3], at: &Placement) -> [u32; BLOCK] {
        let zero = l.splat(0.0);
        let sun = l.max(dot(l, normal, at.sun, zero), zero);
        let (red, green, blue) = (
            self.byte(l, 0, sun, normal[2]),
            self.byte(l, 1, sun, normal[2]),
            self.byte(l, 2, sun, normal[2]),
        );
        let rgb = l.or(red, l.shift_byte(l.or(green, l.shift_byte(blue))));
        let [along_x, along_y, along_z] = self.labels;
        let mut label = l.splat_word(along_x);
        if along_x != along_y {
            let x = l.max(normal[0], l.sub(zero, normal[0]));
            let y = l.max(normal[1], l.sub(zero, normal[1]));
            let z = l.max(normal[2], l.sub(zero, normal[2]));
            label = l.select_words(l.above(y, x), l.splat_word(along_y), label);
            label = l.select_words(l.above(z, l.max(x, y)), l.splat_word(along_z), label);
        }
        let mut pixels = [0; BLOCK];
        l.store_words(l.or(rgb, label), &mut pixels);
        pixels
    }

    #[inline(always)]
    fn fill<L: Lanes, const ITEMS: bool>(&self, l: L, canvas: &mut Canvas, triangle: &Triangle) {
        let Some(cover) = self.cover else {
            canvas.fill::<L, ITEMS>(l, triangle, ());
            return;
        };
        let sheet = Sheet {
            patch: &cover.patches[(triangle.pixel >> AXIS_SHIFT) as usize],
            middle: cover.middle,
            step: cover.step,
        };
        let pixel = triangle.pixel & 0x00FF_FFFF | cover.label;
        canvas.fill::<L, ITEMS>(l, &Triangle { pixel, ..*triangle }, sheet);
    }
}

/// An image with its camera and light.
struct Picture<'a> {
    scene: &'a Scene,
    looks: &'a NaturalLooks,
    view: View,
    daylight: Daylight,
    /// Whether the canvas stores items' classes instead of their indices.
    keeps_classes: bool,
    /// Whether items' labels contain their classes, in the bits that hold the material number for pixels of the map.
    labels_classes: bool,
}

/// Whether the classes of a scene's items fit into a label: five bits.
pub(super) fn labels_hold_classes(scene: &Scene) -> bool {
    scene.highest_class < CLASSES
}

impl CpuRenderer {
    #[inline(always)]
    pub(super) fn draw_natural<L: Lanes, const ITEMS: bool>(
        &mut self,
        lanes: L,
        scene: &Scene,
        looks: &NaturalLooks,
        camera: &Camera,
        target: &mut Target<'_>,
    ) {
        let (width, height) = (target.width as usize, target.height as usize);
        let view = View::new(camera, width, height);
        let daylight = self.natural.rows.prepare(scene, looks, &view);
        let picture = Picture {
            scene,
            looks,
            view,
            daylight,
            keeps_classes: target.instance.is_none(),
            labels_classes: !ITEMS && target.class.is_some(),
        };
        self.canvas.clear(width, height, ITEMS);
        self.natural.cover_walls(looks, &view);
        let mut order = std::mem::take(&mut self.order);
        find(scene, &view, false, &mut order);
        sort_arena_last(&mut order);
        self.hidden.clear(&view);
        for &visible in &order {
            match visible.drawable {
                Drawable::Item(index) => self.draw_natural_item::<L, ITEMS>(lanes, index, visible, &picture),
                Drawable::Panels(index) => {
                    let group = &scene.panels[index as usize];
                    if self.hidden.hides_panels(group, &view) {
                        continue;
                    }
                    self.draw_natural_panels::<L, ITEMS>(lanes, group, visible, &picture);
                    self.hidden.record(group, &view);
                }
            }
        }
        self.order = order;
        self.draw_shadows::<L, ITEMS>(lanes, &picture);
        self.measure_columns(&view, width);
        self.natural.measure_glow(lanes, &picture, &self.offsets);
        self.classes.clear();
        if ITEMS && target.class.is_some() && !picture.keeps_classes {
            self.classes.extend(scene.items.iter().map(|item| item.class_id));
        }
        let composition = Composition {
            canvas: &self.canvas,
            natural: &self.natural,
            view,
            offsets: &self.offsets,
            fog: scene.light.fog_distance,
            fog_words: fog_words(&daylight),
            shade: shade(looks, &daylight),
            keeps_classes: picture.keeps_classes,
            labels_classes: picture.labels_classes,
            classes: &self.classes,
            ceiling_meets_walls: looks.ceiling.is_some_and(|ceiling| ceiling.meets_walls),
        };
        composition.write::<L, ITEMS>(lanes, target);
    }

    #[inline(always)]
    fn draw_natural_item<L: Lanes, const ITEMS: bool>(
        &mut self,
        lanes: L,
        index: u32,
        visible: Visible,
        picture: &Picture<'_>,
    ) {
        let (item, view) = (&picture.scene.items[index as usize], &picture.view);
        if self.hidden.hides_item(item, view) {
            return;
        }
        let class = if picture.labels_classes { item.class_id } else { 0 };
        let label = u32::from(class) << MATERIAL_SHIFT | u32::from(category(item)) << 24;
        let cover = cover(item, view, label);
        let at = view.placement(&Pose::of(item), picture.daylight.direction);
        for material in level(item, visible, view) {
            let color = color_of(item, material);
            // A class's finish covers only parts in the object's main colour, not handles and feet.
            let is_covered = item.surface != Surface::Plain || matches!(material.paint, Paint::Main(_));
            let cover = cover.as_ref().filter(|_| is_covered);
            let labels = cover.map_or([label; 3], |_| [0, 1, 2].map(|axis| axis << AXIS_SHIFT));
            let params = NaturalParams {
                item: if picture.keeps_classes {
                    u32::from(item.class_id)
                } else {
                    index + 1
                },
                may_need_clipping: visible.nearest < NEAR,
                cover,
                ..NaturalParams::new(color, &picture.daylight, labels)
            };
            for block in &material.blocks {
                draw_block::<L, ITEMS, _>(lanes, &mut self.canvas, block, &at, &params);
            }
        }
    }

    #[inline(always)]
    fn draw_natural_panels<L: Lanes, const ITEMS: bool>(
        &mut self,
        lanes: L,
        group: &PanelGroup,
        visible: Visible,
        picture: &Picture<'_>,
    ) {
        let (view, daylight) = (&picture.view, &picture.daylight);
        let materials = if group.height > 0.0 {
            [WALLS, WALLS + 1, WALLS + 2]
        } else if group.lift > 0.0 {
            [GROUND; 3]
        } else {
            [0; 3]
        };
        let labels = materials.map(|number| number << MATERIAL_SHIFT | u32::from(CATEGORY_MAP) << 24);
        let at = view.placement(&Pose::of_panels(group, view), daylight.direction);
        let params = NaturalParams {
            may_need_clipping: visible.nearest < NEAR,
            ..NaturalParams::new(group.color, daylight, labels)
        };
        for block in &group.blocks {
            draw_block::<L, ITEMS, _>(lanes, &mut self.canvas, block, &at, &params);
        }
    }

    #[inline(always)]
    fn draw_shadows<L: Lanes, const ITEMS: bool>(&mut self, lanes: L, picture: &Picture<'_>) {
        let Picture {
            scene,
            looks,
            view,
            daylight,
            ..
        } = picture;
        let Some(cast) = Cast::of(looks, daylight, view) else {
            return;
        };
        let mut found = std::mem::take(&mut self.order);
        shadows::find(scene, looks, &cast, view, &self.hidden, &mut found);
        for &shadow in &found {
            let params = ShadowParams {
                may_need_clipping: shadow.nearest < NEAR,
                from_behind: matches!(shadow.drawable, Drawable::Panels(_)),
            };
            match shadow.drawable {
                Drawable::Item(index) => {
                    let item = &scene.items[index as usize];
                    let at = cast.placement(view, &Pose::of(item));
                    for block in shadows::level(item, shadow, view)
                        .iter()
                        .flat_map(|material| &material.blocks)
                    {
                        draw_block::<L, ITEMS, _>(lanes, &mut self.canvas, block, &at, &params);
                    }
                }
                Drawable::Panels(index) => {
                    let at = cast.placement(view, &Pose::WORLD);
                    for block in &scene.panels[index as usize].blocks {
                        draw_block::<L, ITEMS, _>(lanes, &mut self.canvas, block, &at, &params);
                    }
                }
            }
        }
        self.order = found;
    }
}

/// Factor on the ground's light directly below objects under a ceiling, as a texel.
const SHADE_BELOW_OBJECTS: u32 = 0x8062_6262;

/// Factor on the ground's light in shadow, as a texel.
pub(super) fn shade(looks: &NaturalLooks, daylight: &Daylight) -> u32 {
    if looks.ceiling.is_some() {
        SHADE_BELOW_OBJECTS
    } else {
        daylight.shade()
    }
}

/// Packed colours of the fog away from the sun and towards it.
pub(super) fn fog_words(daylight: &Daylight) -> [u32; 2] {
    [daylight.horizon, fog_towards_sun(daylight)].map(|levels| packed(levels, 0))
}

/// Horizontal unit vector towards the sky's glow; `None` under a ceiling or with the sun overhead.
pub(super) fn glow_towards(looks: &NaturalLooks, daylight: &Daylight) -> Option<[f32; 2]> {
    let [x, y, _] = daylight.direction;
    let length = (x * x + y * y).sqrt();
    (length >= 0.05 && looks.ceiling.is_none()).then(|| [x / length, y / length])
}

/// Share of grey mixed into a pure colour, which makes paint look weathered.
const MAX_GRAY_SHARE: f32 = 0.28;

/// A material's colour, muted in proportion to its purity.
fn color_of(item: &Item, material: &Material) -> [f32; 3] {
    let color = match material.paint {
        Paint::Main(own) => item.color.unwrap_or(own),
        Paint::Fixed(color) => color,
    };
    let [red, green, blue] = color;
    let max = red.max(green).max(blue);
    let share = MAX_GRAY_SHARE * (max - red.min(green).min(blue));
    let gray = 0.6 * max;
    color.map(|channel| channel + (gray - channel) * share)
}

/// The covering of an object: its surface, or the finish of its class, scaled to the object and centred on it.
fn cover(item: &Item, view: &View, label: u32) -> Option<Cover> {
    let (tile, scale, middle) = match surfaces::tile(item.surface) {
        Some(tile) => (tile, 1.0, 0.0),
        None => (item.finish?.tile(), item.scale, item.asset.height * item.scale / 2.0),
    };
    let heading = item.heading_deg.to_radians();
    let (sine, cosine) = (libm::sinf(heading), libm::cosf(heading));
    let (x, y, z) = ([cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]);
    let origin = [item.position[0], item.position[1], middle];
    let patch = |axes, normal| Patch::new((tile, scale), view, origin, axes, normal);
    Some(Cover {
        patches: [patch([y, z], x), patch([x, z], y), patch([x, y], z)],
        label,
        middle: view.size.map(|pixels| pixels / 2.0 - 0.5),
        step: view.step,
    })
}

fn fog_towards_sun(daylight: &Daylight) -> [f32; 3] {
    [0, 1, 2].map(|k| daylight.horizon[k] + (daylight.sunward[k] - daylight.horizon[k]) * daylight.glow)
}

impl Natural {
    /// Sets the coverings of walls.
    pub(super) fn cover_walls(&mut self, looks: &NaturalLooks, view: &View) {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        self.walls = surfaces::tile(looks.walls.surface).map(|tile| {
            let of = (tile, looks.walls.scale as f32);
            [([y, z], x), ([x, z], y), ([x, y], z)].map(|(axes, normal)| Patch::new(of, view, [0.0; 3], axes, normal))
        });
    }

    /// The covering of walls, if columns of the image run along columns of its texels.
    pub(super) fn upright_walls(&self) -> Option<&Patch> {
        let [along_x, along_y, _] = self.walls.as_ref()?;
        (along_x.is_upright() && along_y.is_upright()).then_some(along_x)
    }

    /// Computes how close each column is to the direction of the sun.
    #[inline(always)]
    fn measure_glow<L: Lanes>(&mut self, l: L, picture: &Picture<'_>, offsets: &[f32]) {
        self.glow.clear();
        self.glow.resize(offsets.len(), 0);
        let Some(sun) = glow_towards(picture.looks, &picture.daylight) else {
            return;
        };
        let axes = &picture.view.axes;
        let (half, one) = (l.splat(0.5), l.splat(1.0));
        for first in (0..offsets.len()).step_by(L::N) {
            let offset = l.load(&offsets[first..]);
            let east = l.mul_add(l.splat(axes.right[0]), offset, l.splat(axes.forward[0]));
            let north = l.mul_add(l.splat(axes.right[1]), offset, l.splat(axes.forward[1]));
            let toward = l.mul_add(east, l.splat(sun[0]), l.mul(north, l.splat(sun[1])));
            let length = l.root(l.max(l.mul_add(east, east, l.mul(north, north)), l.splat(1e-6)));
            let share = l.mul(l.add(l.div(toward, length), one), half);
            let share = l.max(l.mul(share, l.mul(share, share)), l.splat(0.0));
            let byte = l.truncate(l.min(l.mul(share, l.splat(FULL_LEVEL)), l.splat(FULL_LEVEL)));
            l.store_words(l.three_times(byte), &mut self.glow[first..]);
        }
    }
}
