//! The background in the natural style, row by row: ground, sky with clouds, or a ceiling. Ground and ceiling are planes, and
//! the camera never rolls. So a row of an image has the same depth throughout, and evenly spaced texels of a single level.

use driftworld_spec::Surface;

use super::daylight::{Daylight, lerp};
use super::frame::{CATEGORY_MAP, CATEGORY_SKY, FAR_DEPTH};
use super::shade::{FULL_LEVEL, ROUNDING};
use super::surfaces::{self, SIDE, Tile};
use super::view::View;
use crate::looks::NaturalLooks;
use crate::scene::{Light, Scene};

/// Added to texel indices to make them positive; a multiple of every side of a tile.
const SHIFT: f32 = 65536.0;

/// Maximum number of texels per pixel along the pixel's footprint. The side of a level is a power of two, so a pixel shows
/// between half this many texels and this many.
const SHARPNESS: f32 = 1.25;

/// Columns may share a texel if its width is at least this many times theirs.
const MIN_TEXEL_COLUMNS: f32 = 1.25;

/// Number of finest texels across a pixel's width at which the detail starts to appear, and at which it reaches full strength.
const DETAIL: [f32; 2] = [0.5, 0.25];

/// The layer of clouds: its height above the eye in metres, metres per side of its tile, and the minimum slope of
/// a ray at which it is fully visible.
const CLOUDS: [f32; 3] = [40.0, 150.0, 0.22];

/// Covering of the ceiling.
pub(super) const CEILING: Surface = Surface::Tile;

/// Strength of the darkening where walls and objects touch ground or ceiling, and the distance in metres over which it fades.
pub(super) const CONTACT: [f32; 2] = [0.5, 0.35];

/// Minimum number of pixels over which that darkening fades, so that it does not flicker. It is fainter where this limit
/// applies.
pub(super) const CONTACT_PIXELS: f32 = 1.5;

/// Number of a wall's lowest pixels that count as touching the ground.
const FOOT_PIXELS: f32 = 3.0;

/// The part of a row that does not depend on the camera's position and heading.
#[derive(Clone, Copy, Debug, Default)]
struct RowLook {
    /// Distance along the view axis to the plane or the clouds, in metres.
    metres: f32,
    /// Height of the ray through the row at 1 m.
    offset: f32,
    /// Texels per metre at its level, and tiles per texel.
    density: f32,
    tiles: f32,
    row: Row,
}

/// A row of one image.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    /// 1 / depth; 0 for sky.
    pub(super) inverse: f32,
    /// Depth in metres.
    pub(super) metres: f32,
    /// Packed pixel without pattern; for the sky, away from the sun.
    pub(super) base: u32,
    /// Packed pixels of the sky towards the sun, and of clouds; equal to `base` if there is no difference.
    pub(super) sunward: u32,
    pub(super) cloud: u32,
    /// Texture coordinates: the value at the middle column, and its change per metre to the right at a depth of 1 m. The texel
    /// is `texels[(u & mask) << bits | v & mask | first]`. With a side of 1 there is nothing to look up.
    pub(super) u: [f32; 2],
    pub(super) v: [f32; 2],
    pub(super) side: u32,
    /// Number of adjacent columns that share a texel: 1, 2 or 4.
    pub(super) group: u32,
    /// Rows with the same number show the same texels.
    pub(super) pair: u32,
    /// Scale of the detail: the same tile, repeated at a finer scale, over texels larger than a pixel. 0 for no detail.
    pub(super) detail: f32,
    /// Strength of the detail, 1 to 255. It increases as rows get nearer, so that the detail appears without a seam.
    pub(super) detail_share: u32,
    pub(super) content: Content,
    /// Distance in metres of the plane from eye height, and by how much a ray through the row approaches it per metre.
    pub(super) plane: [f32; 2],
    /// 1 / the distance in metres over which the darkening at contacts with the plane fades.
    pub(super) fade_rate: f32,
    /// Maximum height above the plane, per metre of depth, at which a wall's pixel still counts as its foot.
    pub(super) foot: f32,
}

/// The content of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Content {
    Floor,
    Ceiling,
    #[default]
    Sky,
}

/// Everything on which rows depend except the camera's position and heading.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    size: [f32; 2],
    step: f32,
    height: f32,
    forward: f32,
    up: f32,
    light: Light,
    ground: [f32; 3],
    looks: NaturalLooks,
}

/// The rows of an image, cached for the next image. For the same camera and light, only the positions of texels differ.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    key: Option<Key>,
    daylight: Option<Daylight>,
    looks: Vec<RowLook>,
    pub(super) seen: Vec<Row>,
    ground: Option<&'static Tile>,
    ceiling: Option<&'static Tile>,
}

impl Rows {
    /// Prepares the rows for an image, and returns its light.
    pub(super) fn prepare(&mut self, scene: &Scene, looks: &NaturalLooks, view: &View) -> Daylight {
        let ceiling = looks.ceiling.filter(|ceiling| view.position[2] < ceiling.height);
        let key = Key {
            size: view.size,
            step: view.step,
            height: view.position[2],
            forward: view.axes.forward[2],
            up: view.axes.up[2],
            light: scene.light,
            ground: scene.ground_color,
            looks: NaturalLooks { ceiling, ..*looks },
        };
        let daylight = match self.daylight {
            Some(daylight) if self.key == Some(key) => daylight,
            _ => {
                let daylight = Daylight::new(&scene.light, looks.ceiling.is_some());
                self.paint(&key, &daylight);
                (self.key, self.daylight) = (Some(key), Some(daylight));
                daylight
            }
        };
        let axes = &view.axes;
        for (look, row) in self.looks.iter().zip(&mut self.seen) {
            if look.row.side > 1 {
                let is_sky = look.row.content == Content::Sky;
                let coordinate = |axis: usize| {
                    let from = if is_sky { 0.0 } else { view.position[axis] };
                    let ahead = axes.forward[axis] + look.offset * axes.up[axis];
                    let at = (from + ahead * look.metres) * look.density;
                    // Keeps texel indices small, so that they are exact.
                    let turns = (at * look.tiles) as i32 as f32;
                    [
                        at - turns * look.row.side as f32 + SHIFT,
                        axes.right[axis] * look.metres * look.density,
                    ]
                };
                (row.u, row.v) = (coordinate(0), coordinate(1));
            }
        }
        daylight
    }

    /// The texels of a row's content; empty if it has no pattern.
    pub(super) fn texels(&self, content: Content) -> &'static [u32] {
        let tile = match content {
            Content::Floor => self.ground,
            Content::Ceiling => self.ceiling,
            Content::Sky => Some(surfaces::clouds()),
        };
        tile.map_or(&[], |tile| &tile.texels)
    }

    fn paint(&mut self, key: &Key, daylight: &Daylight) {
        self.ground = surfaces::tile(key.looks.ground.surface);
        self.ceiling = surfaces::tile(CEILING);
        self.looks.clear();
        let rows = key.size[1] as usize;
        for y in 0..rows {
            let offset = (key.size[1] / 2.0 - 0.5 - y as f32) * key.step;
            let rise = key.forward + offset * key.up;
            let mut look = match key.looks.ceiling {
                _ if rise < 0.0 => {
                    let scale = key.looks.ground.scale as f32;
                    let color = daylight.levels(key.ground, [0.0, 0.0, 1.0]);
                    let plane = Plane {
                        rise,
                        below: key.height.max(0.01),
                        color,
                        scale,
                    };
                    plane.look(key, offset, Content::Floor, self.ground)
                }
                Some(ceiling) => {
                    let color = daylight.levels(ceiling.color, [0.0, 0.0, -1.0]);
                    let plane = Plane {
                        rise,
                        below: ceiling.height - key.height,
                        color,
                        scale: 2.0,
                    };
                    plane.look(key, offset, Content::Ceiling, self.ceiling)
                }
                None => sky(key, daylight, offset, rise),
            };
            let inverse = look.row.inverse;
            look.row.metres = if inverse > 1.0 / FAR_DEPTH {
                1.0 / inverse
            } else {
                FAR_DEPTH
            };
            look.row.pair = y as u32 / 2;
            if let (1, Some(above)) = (y % 2, self.looks.last()) {
                look.share_texels(above);
            }
            self.looks.push(look);
        }
        self.seen.clear();
        self.seen.extend(self.looks.iter().map(|look| look.row));
    }
}

/// A plane in a row: the slope of the row's rays, and the plane's distance from eye height.
struct Plane {
    rise: f32,
    below: f32,
    color: [f32; 3],
    scale: f32,
}

impl Plane {
    fn look(&self, key: &Key, offset: f32, content: Content, tile: Option<&Tile>) -> RowLook {
        let inverse = self.rise.abs() / self.below;
        let base = packed(self.color, CATEGORY_MAP);
        let metres = 1.0 / inverse.max(1e-6);
        // A pixel's footprint on the plane is longer than wide.
        let length = metres * metres * key.step * key.up.abs().max(0.05) / self.below;
        let mut look = RowLook {
            metres,
            offset,
            density: 0.0,
            tiles: 0.0,
            row: Row {
                inverse,
                base,
                sunward: base,
                cloud: base,
                side: 1,
                content,
                plane: [self.below, self.rise.abs()],
                fade_rate: 1.0 / CONTACT[1].max(CONTACT_PIXELS * length),
                foot: FOOT_PIXELS * key.step / (key.up - offset * key.forward).max(0.05),
                ..Row::default()
            },
        };
        if let Some(tile) = tile {
            let period = tile.period * self.scale;
            let width = metres * key.step;
            look.sharpen(period, length / tile.sharpness, width);
            let ([first, all], shown) = (DETAIL, width * SIDE as f32 / period);
            let share = ((first - shown) / (first - all)).min(1.0);
            if tile.is_grain && share > 0.0 {
                look.row.detail = 5.0;
                look.row.detail_share = (FULL_LEVEL * share + ROUNDING) as u32;
            }
        }
        look
    }
}

impl RowLook {
    /// Shares the texels of the row above, if both have the same content and level, and no detail.
    fn share_texels(&mut self, above: &Self) {
        let [row, other] = [&self.row, &above.row];
        let has_detail = row.detail > 0.0 || other.detail > 0.0;
        if row.content == other.content && row.side > 1 && row.side == other.side && !has_detail {
            (self.metres, self.offset) = (above.metres, above.offset);
            self.row.group = above.row.group;
        } else {
            self.row.pair = u32::MAX - 1 - self.row.pair;
        }
    }

    /// Chooses the level whose texels are about as long as a pixel; all lengths are in metres.
    fn sharpen(&mut self, period: f32, pixel: f32, width: f32) {
        let texels = (SHARPNESS * period / pixel.max(1e-9)).clamp(1.0, SIDE as f32);
        let side = 1 << (texels as u32).ilog2();
        self.row.side = side;
        self.density = side as f32 / period;
        self.tiles = 1.0 / side as f32;
        let columns = 1.0 / (self.density * width);
        self.row.group = [4, 2]
            .into_iter()
            .find(|group| columns >= MIN_TEXEL_COLUMNS * *group as f32)
            .unwrap_or(1);
    }
}

fn sky(key: &Key, daylight: &Daylight, offset: f32, rise: f32) -> RowLook {
    let (away, toward, fog) = daylight.sky_along(rise, key.light.fog_distance);
    let base = packed(away, CATEGORY_SKY);
    let mut look = RowLook {
        offset,
        row: Row {
            base,
            sunward: packed(toward, CATEGORY_SKY),
            cloud: base,
            side: 1,
            content: Content::Sky,
            ..Row::default()
        },
        ..RowLook::default()
    };
    let [height, period, full] = CLOUDS;
    let seen = (rise / full).min(1.0) * (1.0 - fog);
    if key.looks.has_clouds && seen > 0.02 {
        look.metres = height / rise;
        look.row.cloud = packed(lerp(away, daylight.cloud, 0.85 * seen), CATEGORY_SKY);
        let pixel = look.metres * look.metres * key.step * key.up.abs().max(0.05) / height;
        look.sharpen(period, pixel, look.metres * key.step);
    }
    look
}

/// Packs levels and a category into a pixel.
pub(super) fn packed(levels: [f32; 3], category: u8) -> u32 {
    let [red, green, blue] = levels.map(|level| (level + ROUNDING).clamp(0.0, FULL_LEVEL) as u8);
    u32::from_le_bytes([red, green, blue, category])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The farthest row of the ground has no detail. It increases from row to row without jumps.
    #[test]
    fn detail_increases_gradually_from_row_to_row() {
        let tile = surfaces::tile(Surface::Noise);
        for side in [160.0, 320.0, 640.0] {
            let step = 2.0 * libm::tanf(30_f32.to_radians()) / side;
            let share = |rows: f32| {
                let offset = -rows * step;
                let plane = Plane {
                    rise: offset,
                    below: 1.0,
                    color: [0.5; 3],
                    scale: 1.0,
                };
                let key = Key {
                    size: [side; 2],
                    step,
                    height: 1.0,
                    forward: 0.0,
                    up: 1.0,
                    light: LIGHT,
                    ground: [0.5; 3],
                    looks: LOOKS,
                };
                plane.look(&key, offset, Content::Floor, tile).row.detail_share
            };
            let shares: Vec<u32> = (1..side as u32 / 2).map(|row| share(row as f32)).collect();
            let max_increase = 255.0 * 64.0 / side;
            for pair in shares.windows(2) {
                assert!(
                    pair[0] <= pair[1] && (pair[1] - pair[0]) as f32 <= max_increase,
                    "{side}: {pair:?}"
                );
            }
            assert!(
                shares[0] == 0 && shares[shares.len() - 1] > 0,
                "{side}: detail appears in near rows"
            );
        }
    }

    const LIGHT: Light = Light {
        direction: [0.0, 0.0, 1.0],
        color: [1.0; 3],
        exposure: 1.0,
        ambient: 0.35,
        sky_color: [0.36, 0.62, 0.9],
        fog_distance: None,
        fog_in_depth: false,
    };

    const LOOKS: NaturalLooks = NaturalLooks {
        ground: driftworld_spec::Covering {
            surface: Surface::Noise,
            scale: 1.0,
        },
        walls: driftworld_spec::Covering {
            surface: Surface::Brick,
            scale: 1.0,
        },
        ceiling: None,
        has_shadows: true,
        has_clouds: true,
    };
}
