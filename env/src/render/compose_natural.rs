//! Composes images in the natural style: adds texels to the canvas, and lays it over ground, sky or ceiling. An image is
//! processed in columns as wide as a vector, each from top to bottom. Sky, wall and ground follow each other there, and along a
//! column only one coordinate of a wall's texels changes.

use std::ops::Range;

use super::canvas::Canvas;
use super::compose::metres;
use super::lanes::{Lanes, MAX_LANES};
use super::material::{BARE_IN_SHADOW, GROUND, GROUND_IN_SHADOW, ITEM_BITS, MATERIAL, MATERIAL_SHIFT, WALLS};
use super::natural::Natural;
use super::patch::{Patch, WallCache};
use super::rows::{CONTACT, CONTACT_PIXELS, Content, Row};
use super::shade::{FULL_LEVEL, ROUNDING};
use super::surfaces::NEUTRAL;
use super::target::Target;
use super::view::View;

/// The share of detail at full strength.
const FULL_SHARE: u32 = 255;

/// Smallest visible darkening, as a share; anything fainter changes no pixel. It is far above rounding errors, so rows for
/// which the computation is skipped would not have been darkened anyway.
const MIN_DARKENING: f32 = 1e-4;

/// Distance in metres that stands for "nothing touches the ground or the ceiling in this column".
const NOWHERE: f32 = 1e9;

/// Everything that an image is composed of.
pub(super) struct Composition<'a> {
    pub(super) canvas: &'a Canvas,
    pub(super) natural: &'a Natural,
    pub(super) view: View,
    pub(super) offsets: &'a [f32],
    pub(super) fog: Option<f32>,
    /// Colour of the fog away from the sun and towards it.
    pub(super) fog_words: [u32; 2],
    /// Factor on the ground's light in shadow.
    pub(super) shade: u32,
    /// Whether the canvas stores items' classes; otherwise `classes` holds the items' classes.
    pub(super) keeps_classes: bool,
    /// Whether labels contain classes.
    pub(super) labels_classes: bool,
    pub(super) classes: &'a [u16],
    /// Whether walls reach the ceiling, if there is one.
    pub(super) ceiling_meets_walls: bool,
}

/// State of one vector's columns, from top to bottom.
struct Columns<'a, L: Lanes> {
    /// Texels that the last rows with ground, clouds or ceiling shared, and the number of that pair of rows.
    shared: L::Word,
    pair: u32,
    offset: L::Float,
    /// Offset of the middle of each group of two columns, and of four.
    offset_of_two: L::Float,
    offset_of_four: L::Float,
    /// Maximum number of adjacent columns that may share a lookup.
    max_group: u32,
    glow: L::Word,
    /// The covering of walls, if columns of the image run along columns of its texels.
    wall: Option<&'a Patch>,
    wall_cache: WallCache<L>,
    /// Distance in metres of the last object that touches the ground.
    foot: L::Float,
    /// Distance in metres of walls that reach the ceiling, which is the same there as at eye height.
    lintel: L::Float,
    /// For ground and ceiling, the steepest slope of rows that are not yet near the end of a cached wall.
    contact_free_slope: [f32; 2],
}

/// Background of a vector: its pixels, and their texels.
#[derive(Clone, Copy)]
struct Background<W> {
    word: W,
    texel: W,
}

/// Visible surfaces of a vector.
#[derive(Clone, Copy)]
struct Surfaces<L: Lanes> {
    word: L::Word,
    /// 1 / depth, and depth.
    inverse: L::Float,
    metres: L::Float,
    in_front: L::Mask,
    /// Whether a standing object there may touch the ground or the ceiling.
    may_meet: bool,
}

impl Composition<'_> {
    /// Writes all images that the target requests.
    #[inline(always)]
    pub(super) fn write<L: Lanes, const ITEMS: bool>(&self, l: L, target: &mut Target<'_>) {
        let width = self.canvas.width;
        let mut first = 0;
        while first < width {
            // The last vector is moved back to fit into the image, if the image is wide enough; some columns are processed
            // twice.
            let start = first.min(width.saturating_sub(L::N));
            self.write_columns::<L, ITEMS>(l, start, target);
            first = start + L::N;
        }
    }

    #[inline(always)]
    fn write_columns<L: Lanes, const ITEMS: bool>(&self, l: L, start: usize, target: &mut Target<'_>) {
        let Canvas { width, stride, .. } = *self.canvas;
        let mut columns = self.columns(l, start);
        let count = width.min(L::N);
        for (y, row) in self.natural.rows.seen.iter().enumerate() {
            let up = -self.view.offset(1, y as f32);
            let mut seen = self.seen(l, &mut columns, row, up, y * stride + start);
            if row.content != Content::Sky {
                seen.word = self.darken_contacts(l, &mut columns, row, &seen);
            }
            if let Some(distance) = self.fog {
                seen.word = self.add_fog(l, seen.word, seen.inverse, distance, columns.glow);
            }
            let mut item = l.splat_word(0);
            if ITEMS {
                let drawn = l.load_words(&self.canvas.items[y * stride + start..]);
                item = l.select_words(seen.in_front, drawn, item);
            }
            let out = y * width + start;
            if count == L::N {
                self.write_vector(l, &seen, item, target, out);
            } else {
                self.write_narrow_vector(l, &seen, item, target, out..out + count);
            }
        }
    }

    /// Writes a vector to all images.
    #[inline(always)]
    fn write_vector<L: Lanes>(&self, l: L, seen: &Surfaces<L>, item: L::Word, target: &mut Target<'_>, out: usize) {
        if let Some(rgb) = &mut target.rgb {
            l.store_rgb(seen.word, &mut rgb[3 * out..]);
        }
        if let Some(depth) = &mut target.depth {
            l.store(seen.metres, &mut depth[out..]);
        }
        if let Some(category) = &mut target.category {
            let label = l.and(l.shift_right(seen.word, 24), l.splat_word(!(MATERIAL >> 24)));
            l.store_bytes(label, &mut category[out..]);
        }
        if let Some(class) = &mut target.class {
            self.write_classes(l, seen.word, item, &mut class[out..]);
        }
        if let Some(instance) = &mut target.instance {
            l.store_words(item, &mut instance[out..]);
        }
    }

    #[inline(always)]
    fn write_classes<L: Lanes>(&self, l: L, word: L::Word, item: L::Word, class: &mut [u16]) {
        if self.labels_classes {
            let is_item = l.has_any(word, ITEM_BITS);
            let number = l.shift_right(word, MATERIAL_SHIFT);
            l.store_halves(l.select_words(is_item, number, l.splat_word(0)), class);
        } else if self.keeps_classes {
            l.store_halves(item, class);
        } else {
            let mut items = [0; MAX_LANES];
            l.store_words(item, &mut items);
            for (out, item) in class[..L::N].iter_mut().zip(items) {
                *out = (item as usize).checked_sub(1).map_or(0, |item| self.classes[item]);
            }
        }
    }

    /// Writes a row that is shorter than a vector.
    #[inline(never)]
    fn write_narrow_vector<L: Lanes>(
        &self,
        l: L,
        seen: &Surfaces<L>,
        item: L::Word,
        target: &mut Target<'_>,
        row: Range<usize>,
    ) {
        let (mut rgb, mut depth) = ([0; 3 * MAX_LANES], [0.0; MAX_LANES]);
        let (mut category, mut class, mut instance) = ([0; MAX_LANES], [0; MAX_LANES], [0; MAX_LANES]);
        let mut wide = Target {
            rgb: Some(&mut rgb),
            depth: Some(&mut depth),
            category: Some(&mut category),
            class: target.class.is_some().then_some(&mut class),
            instance: Some(&mut instance),
            ..Target::default()
        };
        self.write_vector(l, seen, item, &mut wide, 0);
        let count = row.len();
        copy(target.rgb.as_deref_mut(), &rgb[..3 * count], 3 * row.start);
        copy(target.depth.as_deref_mut(), &depth[..count], row.start);
        copy(target.category.as_deref_mut(), &category[..count], row.start);
        copy(target.class.as_deref_mut(), &class[..count], row.start);
        copy(target.instance.as_deref_mut(), &instance[..count], row.start);
    }

    #[inline(always)]
    fn columns<L: Lanes>(&self, l: L, start: usize) -> Columns<'_, L> {
        let mut columns = Columns {
            shared: l.splat_word(0),
            pair: u32::MAX,
            offset: l.load(&self.offsets[start..]),
            offset_of_two: self.shared_offset(l, start, 2.0),
            offset_of_four: self.shared_offset(l, start, 4.0),
            max_group: if start.is_multiple_of(4) { 4 } else { 1 },
            glow: l.load_words(&self.natural.glow[start..]),
            wall: self.natural.upright_walls(),
            wall_cache: WallCache::new(l),
            foot: l.splat(NOWHERE),
            lintel: l.splat(NOWHERE),
            contact_free_slope: [0.0; 2],
        };
        if columns.wall.is_some() {
            // Walls that are higher than the eye are all visible in the row at eye height.
            let pixel = self.canvas.height / 2 * self.canvas.stride + start;
            let drawn = l.load(&self.canvas.inverse_depth[pixel..]);
            let pixels = l.load_words(&self.canvas.pixels[pixel..]);
            let in_front = l.above(drawn, l.splat(0.0));
            let is_map = l.equal(l.and(pixels, l.splat_word(ITEM_BITS)), l.splat_word(0));
            let material = l.and(pixels, l.splat_word(MATERIAL));
            for (number, patch) in (WALLS..).zip(self.natural.walls.iter().flatten().take(2)) {
                let same = l.both(is_map, l.equal(material, l.splat_word(number << MATERIAL_SHIFT)));
                let same = l.both(in_front, same);
                if l.bits(same) != 0 {
                    columns
                        .wall_cache
                        .record(l, same, patch, columns.offset, (drawn, material));
                }
            }
            let rows = &self.natural.rows.seen;
            let [above, below] = [0, rows.len() - 1].map(|row| rows[row].plane[0]);
            if let Some([far, near]) = columns.wall_cache.range(l) {
                let [reach, min_reach] = [CONTACT[1], CONTACT_PIXELS * self.view.step];
                let until = |away: f32, inverse: f32| away * inverse - (reach * inverse).max(min_reach);
                columns.contact_free_slope = [
                    until(below, far).min(until(below, near)),
                    until(above, far).min(until(above, near)),
                ];
                if self.ceiling_meets_walls {
                    columns.lintel = columns.wall_cache.metres_or(l, NOWHERE);
                }
            }
        }
        columns
    }

    /// Offset at 1 m to the right of the middle of each `count` columns.
    #[inline(always)]
    fn shared_offset<L: Lanes>(&self, l: L, start: usize, count: f32) -> L::Float {
        let column = l.add(l.count_up(), l.splat(start as f32));
        let first = l.mul(l.float(l.truncate(l.mul(column, l.splat(1.0 / count)))), l.splat(count));
        let middle = l.splat(count / 2.0 - self.view.size[0] / 2.0);
        l.mul(l.add(first, middle), l.splat(self.view.step))
    }

    #[inline(always)]
    fn seen<L: Lanes>(&self, l: L, columns: &mut Columns<'_, L>, row: &Row, up: f32, pixel: usize) -> Surfaces<L> {
        let all = u32::MAX >> (32 - L::N);
        let drawn = l.load(&self.canvas.inverse_depth[pixel..]);
        let in_front = l.above(drawn, l.splat(row.inverse));
        let front = l.bits(in_front);
        if front == 0 {
            return Surfaces {
                word: self.behind(l, row, columns).word,
                inverse: l.splat(row.inverse),
                metres: l.splat(row.metres),
                in_front,
                may_meet: false,
            };
        }
        let pixels = l.load_words(&self.canvas.pixels[pixel..]);
        let mut is_covered = l.both(in_front, l.has_any(pixels, MATERIAL));
        if self.labels_classes {
            let is_map = l.equal(l.and(pixels, l.splat_word(ITEM_BITS)), l.splat_word(0));
            is_covered = l.both(is_covered, is_map);
        }
        let covered = l.bits(is_covered);
        let material = l.and(pixels, l.splat_word(MATERIAL));
        let from_cache = l.both(is_covered, columns.wall_cache.is_valid(l, drawn, material));
        if l.bits(from_cache) != covered {
            return self.many_surfaces(l, columns, row, up, (drawn, in_front), (pixels, is_covered));
        }
        let mut seen = Surfaces {
            word: pixels,
            inverse: drawn,
            metres: columns.wall_cache.metres,
            in_front,
            may_meet: covered != front
                || row.plane[1] > columns.contact_free_slope[usize::from(row.content == Content::Ceiling)],
        };
        if front != all {
            seen.word = l.select_words(in_front, pixels, self.behind(l, row, columns).word);
            seen.inverse = l.max(drawn, l.splat(row.inverse));
        }
        if let (true, Some(wall)) = (covered != 0, columns.wall) {
            let texel_color = l.modulate(pixels, columns.wall_cache.texel(l, wall, up));
            seen.word = l.select_words(from_cache, texel_color, seen.word);
        }
        if covered == front {
            seen.metres = l.select(in_front, seen.metres, l.splat(row.metres));
        } else {
            seen.metres = metres(l, seen.inverse);
        }
        seen
    }

    /// The visible surfaces of a vector that shows more than cached walls.
    #[inline(always)]
    fn many_surfaces<L: Lanes>(
        &self,
        l: L,
        columns: &mut Columns<'_, L>,
        row: &Row,
        up: f32,
        (drawn, in_front): (L::Float, L::Mask),
        (pixels, is_covered): (L::Word, L::Mask),
    ) -> Surfaces<L> {
        let behind = self.behind(l, row, columns);
        let material = l.and(pixels, l.splat_word(MATERIAL));
        let mut numbers = [0; MAX_LANES];
        l.store_words(material, &mut numbers);
        let mut word = l.select_words(in_front, pixels, behind.word);
        let mut inverse = l.max(drawn, l.splat(row.inverse));
        let shade = l.splat_word(self.shade);
        let mut left = l.bits(is_covered);
        while left != 0 {
            let number = numbers[left.trailing_zeros() as usize] >> MATERIAL_SHIFT;
            let same = l.both(is_covered, l.equal(material, l.splat_word(number << MATERIAL_SHIFT)));
            left &= !l.bits(same);
            let texel_color = match number {
                BARE_IN_SHADOW => {
                    inverse = l.select(same, l.splat(row.inverse), inverse);
                    l.modulate(behind.word, shade)
                }
                GROUND => l.modulate(pixels, behind.texel),
                GROUND_IN_SHADOW => l.modulate(l.modulate(pixels, behind.texel), shade),
                _ => match &self.natural.walls {
                    Some(patches) => {
                        let patch = &patches[(number - WALLS) as usize];
                        if columns.wall.is_some() && number <= WALLS + 1 {
                            columns
                                .wall_cache
                                .record(l, same, patch, columns.offset, (drawn, material));
                            columns.contact_free_slope = [0.0; 2];
                        }
                        l.modulate(pixels, patch.texel(l, up, columns.offset, drawn))
                    }
                    None => pixels,
                },
            };
            word = l.select_words(same, texel_color, word);
        }
        Surfaces {
            word,
            inverse,
            metres: metres(l, inverse),
            in_front,
            may_meet: true,
        }
    }

    /// Darkens both sides of the lines along which walls and objects touch the ground or the ceiling.
    #[inline(always)]
    fn darken_contacts<L: Lanes>(&self, l: L, columns: &mut Columns<'_, L>, row: &Row, seen: &Surfaces<L>) -> L::Word {
        let is_ceiling = row.content == Content::Ceiling;
        let foot = if is_ceiling { columns.lintel } else { columns.foot };
        // Darkening must depend on a pixel's own column alone, because the number of neighbours depends on the instruction set.
        if !seen.may_meet && l.bits(l.above(l.splat(row.metres + 1.0 / row.fade_rate), foot)) == 0 {
            return seen.word;
        }
        let [strength, reach] = CONTACT;
        let (zero, one) = (l.splat(0.0), l.splat(1.0));
        let [below, nearer] = row.plane;
        // For standing surfaces, the distance from the plane; for the plane, the distance in front of the standing surface.
        let standing = l.has_any(seen.word, ITEM_BITS | WALLS << MATERIAL_SHIFT);
        let away = l.sub(l.splat(below), l.mul(seen.metres, l.splat(nearer)));
        let away = l.select(standing, away, l.sub(foot, l.splat(row.metres)));
        let fades = l.mul(seen.inverse, l.splat(1.0 / (CONTACT_PIXELS * self.view.step)));
        let fades = l.select(standing, l.min(fades, l.splat(1.0 / reach)), l.splat(row.fade_rate));
        let near = l.max(l.min(l.sub(one, l.mul(away, fades)), one), zero);
        let meets = l.above(near, l.splat(MIN_DARKENING));
        if l.bits(meets) == 0 {
            return seen.word;
        }
        let meets_foot = l.both(standing, meets);
        if !is_ceiling && l.bits(meets_foot) != 0 {
            // Only the lowest pixels of a wall are its foot: seen from above, its edges overlap ground that they do not touch.
            let is_map = l.equal(l.and(seen.word, l.splat_word(ITEM_BITS)), l.splat_word(0));
            let is_above = l.above(l.mul(away, seen.inverse), l.splat(row.foot));
            columns.foot = l.select(meets_foot, l.select(l.both(is_map, is_above), foot, seen.metres), foot);
        }
        let dark = l.mul(l.mul(near, near), l.mul(fades, l.splat(128.0 * strength * reach)));
        let left = l.truncate(l.sub(l.splat(128.0 + ROUNDING), dark));
        l.modulate(seen.word, l.or(l.three_times(left), l.splat_word(0x80 << 24)))
    }

    #[inline(always)]
    fn behind<L: Lanes>(&self, l: L, row: &Row, columns: &mut Columns<'_, L>) -> Background<L::Word> {
        let base = l.splat_word(row.base);
        let neutral = l.splat_word(NEUTRAL);
        let texels = self.natural.rows.texels(row.content);
        if row.content == Content::Sky {
            let mut word = base;
            if row.sunward != row.base {
                word = l.mix(base, l.splat_word(row.sunward), columns.glow);
            }
            if row.side > 1 {
                look_up_shared(l, row, texels, columns);
                word = l.mix(word, l.splat_word(row.cloud), columns.shared);
            }
            return Background { word, texel: neutral };
        }
        if row.side <= 1 || texels.is_empty() {
            return Background {
                word: base,
                texel: neutral,
            };
        }
        look_up_shared(l, row, texels, columns);
        let mut texel = columns.shared;
        if row.detail > 0.0 {
            let mut detail = look_up(l, row, texels, columns, row.detail);
            if row.detail_share < FULL_SHARE {
                detail = l.mix(neutral, detail, l.three_times(l.splat_word(row.detail_share)));
            }
            texel = l.modulate(texel, detail);
        }
        Background {
            word: l.modulate(base, texel),
            texel,
        }
    }

    /// Blends colours into the fog with distance; the sky stays unchanged.
    #[inline(always)]
    fn add_fog<L: Lanes>(&self, l: L, word: L::Word, inverse: L::Float, distance: f32, glow: L::Word) -> L::Word {
        let (zero, one) = (l.splat(0.0), l.splat(1.0));
        let reach = l.mul(inverse, l.splat(distance));
        let share = l.div(one, l.mul_add(reach, reach, one));
        let share = l.select(l.at_least(zero, inverse), zero, share);
        let byte = l.truncate(l.mul_add(share, l.splat(FULL_LEVEL), l.splat(ROUNDING)));
        let [away, toward] = self.fog_words.map(|word| l.splat_word(word));
        let fog = l.mix(away, toward, glow);
        l.mix(word, fog, l.three_times(byte))
    }
}

/// Looks up a row's texels, unless the row above shares them.
#[inline(always)]
fn look_up_shared<L: Lanes>(l: L, row: &Row, texels: &[u32], columns: &mut Columns<'_, L>) {
    if columns.pair != row.pair {
        (columns.shared, columns.pair) = (look_up(l, row, texels, columns, 1.0), row.pair);
    }
}

/// Looks up a row's texels in a tile that is `finer` times as fine.
#[inline(always)]
fn look_up<L: Lanes>(l: L, row: &Row, texels: &[u32], columns: &Columns<'_, L>, finer: f32) -> L::Word {
    let (offset, group) = match row.group {
        4 if finer == 1.0 => (columns.offset_of_four, columns.max_group),
        2 if finer == 1.0 => (columns.offset_of_two, columns.max_group.min(2)),
        _ => (columns.offset, 1),
    };
    let mask = l.splat_word(row.side - 1);
    let u = l.mul_add(l.splat(row.u[1] * finer), offset, l.splat(row.u[0] * finer));
    let v = l.mul_add(l.splat(row.v[1] * finer), offset, l.splat(row.v[0] * finer));
    let (u, v) = (l.and(l.truncate(u), mask), l.and(l.truncate(v), mask));
    let index = l.or(v, l.shift_left(u, row.side.ilog2()));
    l.gather_grouped(texels, l.or(index, l.splat_word(row.side * row.side)), group)
}

fn copy<T: Copy>(to: Option<&mut [T]>, from: &[T], start: usize) {
    if let Some(to) = to {
        to[start..start + from.len()].copy_from_slice(from);
    }
}
