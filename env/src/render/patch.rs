//! Maps screen positions on covered walls and objects to texels of a tile's levels.

use super::canvas::Texture;
use super::compose::metres;
use super::lanes::{Lanes, MAX_LANES};
use super::surfaces::{SIDE, Tile};
use super::view::View;

/// Added to positions to make them positive; no wall or object is that many tiles long.
pub(super) const SHIFT: f32 = 4096.0;

/// Texels per pixel.
const SHARPNESS: f32 = 1.0;
/// Minimum cosine of a viewing angle; smaller ones are raised to it.
pub(super) const GRAZING: f32 = 0.06;

/// Mapping from screen positions to texels, for faces of one direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    texels: &'static [u32],
    /// Texture coordinates in tiles at the camera, and their change per metre of depth at the image's middle, per metre to the
    /// right and per metre up.
    pub(super) u: [f32; 4],
    pub(super) v: [f32; 4],
    /// Cosine of the faces' angle to the camera: at the middle, to the right and up.
    pub(super) facing: [f32; 3],
    /// Texels per side of the level, for 1 / depth of 1 per metre.
    pub(super) sharpness: f32,
}

impl Patch {
    /// A patch of a scaled tile on faces with this normal, along these axes from an origin, all in the world's frame.
    pub(super) fn new(
        (tile, scale): (&'static Tile, f32),
        view: &View,
        origin: [f32; 3],
        axes: [[f32; 3]; 2],
        normal: [f32; 3],
    ) -> Self {
        let period = tile.period * scale;
        let from = crate::vector::sub(view.position, origin);
        let along = |axis: [f32; 3]| {
            let rows = [from, view.axes.forward, view.axes.right, view.axes.up];
            rows.map(|row| crate::vector::dot(row, axis) / period)
        };
        Self {
            texels: &tile.texels,
            u: along(axes[0]),
            v: along(axes[1]),
            facing: [view.axes.forward, view.axes.right, view.axes.up].map(|axis| crate::vector::dot(axis, normal)),
            sharpness: SHARPNESS * tile.sharpness * period / view.step,
        }
    }

    /// Texels at these columns of a row, `up` metres up at 1 m, for 1 / depth.
    #[inline(always)]
    pub(super) fn texel<L: Lanes>(&self, l: L, up: f32, offset: L::Float, inverse: L::Float) -> L::Word {
        let depth = depth(l, inverse);
        let side = self.side(l, up, offset, inverse);
        let u = texel_index(l, self.u, up, offset, depth, side);
        let v = texel_index(l, self.v, up, offset, depth, side);
        l.gather(self.texels, l.truncate(l.mul_add(side, l.add(side, u), v)))
    }

    /// Texels per side of the level whose texels are about as large as a pixel.
    #[inline(always)]
    fn side<L: Lanes>(&self, l: L, up: f32, offset: L::Float, inverse: L::Float) -> L::Float {
        let (zero, one) = (l.splat(0.0), l.splat(1.0));
        let [middle, right, above] = self.facing;
        let facing = l.mul_add(l.splat(right), offset, l.splat(middle + up * above));
        let facing = l.max(l.max(facing, l.sub(zero, facing)), l.splat(GRAZING));
        let side = l.mul(l.mul(inverse, facing), l.splat(self.sharpness));
        l.power_of_two(l.min(l.max(side, one), l.splat(SIDE as f32)))
    }

    /// Whether each column of an image runs along the tile's v axis only: an upright face in front of a level camera.
    pub(super) fn is_upright(&self) -> bool {
        [self.u[3], self.v[1], self.v[2], self.facing[2]] == [0.0; 4]
    }
}

/// A patch as a triangle's texture, in images whose middle is at this column and row.
#[derive(Clone, Copy)]
pub(super) struct Sheet<'a> {
    pub(super) patch: &'a Patch,
    pub(super) middle: [f32; 2],
    pub(super) step: f32,
}

impl Texture for Sheet<'_> {
    #[inline(always)]
    fn apply<L: Lanes>(
        self,
        l: L,
        mask: L::Mask,
        packed: L::Word,
        (row, x): (usize, L::Float),
        inverse: L::Float,
    ) -> L::Word {
        if l.bits(mask) == 0 {
            return packed;
        }
        let up = (self.middle[1] - row as f32) * self.step;
        let offset = l.mul(l.sub(x, l.splat(self.middle[0])), l.splat(self.step));
        l.modulate(packed, self.patch.texel(l, up, offset, inverse))
    }
}

#[inline(always)]
fn depth<L: Lanes>(l: L, inverse: L::Float) -> L::Float {
    l.div(l.splat(1.0), l.max(inverse, l.splat(1e-4)))
}

/// The index of a texel along a side of a tile of `side` texels.
#[inline(always)]
fn texel_index<L: Lanes>(
    l: L,
    [at, ahead, right, above]: [f32; 4],
    up: f32,
    offset: L::Float,
    depth: L::Float,
    side: L::Float,
) -> L::Float {
    let slope = l.mul_add(l.splat(right), offset, l.splat(ahead + up * above));
    wrapped_texel(
        l,
        l.mul_add(l.mul(depth, side), slope, l.mul(side, l.splat(at + SHIFT))),
        side,
    )
}

/// The index within its tile of the texel at `texels` along the side.
#[inline(always)]
fn wrapped_texel<L: Lanes>(l: L, texels: L::Float, side: L::Float) -> L::Float {
    let last = l.truncate(l.sub(side, l.splat(1.0)));
    l.float(l.and(l.truncate(texels), last))
}

/// Caches the columns' view of walls. As long as 1 / depth and covering stay the same, so do the level and the column of
/// texels.
#[derive(Clone, Copy)]
pub(super) struct WallCache<L: Lanes> {
    /// 1 / depth; below 0 if nothing is cached.
    inverse: L::Float,
    /// The bits of a packed pixel that identify the covering.
    material: L::Word,
    /// Distance in metres, for depth images and for darkening contacts.
    pub(super) metres: L::Float,
    /// Texels per side, texels per metre of depth, and the last texel of a row.
    side: L::Float,
    density: L::Float,
    last: L::Word,
    /// The first texel of the column.
    first: L::Word,
}

impl<L: Lanes> WallCache<L> {
    #[inline(always)]
    pub(super) fn new(l: L) -> Self {
        Self {
            inverse: l.splat(-1.0),
            material: l.splat_word(0),
            metres: l.splat(0.0),
            side: l.splat(1.0),
            density: l.splat(0.0),
            last: l.splat_word(0),
            first: l.splat_word(1),
        }
    }

    /// Where the cached values are still valid.
    #[inline(always)]
    pub(super) fn is_valid(&self, l: L, inverse: L::Float, material: L::Word) -> L::Mask {
        l.both(l.same(inverse, self.inverse), l.equal(material, self.material))
    }

    /// The cached distance in metres, or `otherwise`.
    #[inline(always)]
    pub(super) fn metres_or(&self, l: L, otherwise: f32) -> L::Float {
        l.select(l.above(self.inverse, l.splat(0.0)), self.metres, l.splat(otherwise))
    }

    /// The smallest and largest cached 1 / depth, if any is cached.
    #[inline(always)]
    pub(super) fn range(&self, l: L) -> Option<[f32; 2]> {
        let mut all = [-1.0; MAX_LANES];
        l.store(self.inverse, &mut all);
        let (mut min, mut max) = (f32::INFINITY, 0.0_f32);
        for inverse in all {
            if inverse > 0.0 {
                (min, max) = (min.min(inverse), max.max(inverse));
            }
        }
        (max > 0.0).then_some([min, max])
    }

    /// Caches the values of these columns; the patch must be upright.
    #[inline(always)]
    pub(super) fn record(
        &mut self,
        l: L,
        columns: L::Mask,
        patch: &Patch,
        offset: L::Float,
        (inverse, material): (L::Float, L::Word),
    ) {
        let depth = depth(l, inverse);
        let side = patch.side(l, 0.0, offset, inverse);
        let u = texel_index(l, patch.u, 0.0, offset, depth, side);
        self.inverse = l.select(columns, inverse, self.inverse);
        self.material = l.select_words(columns, material, self.material);
        self.metres = l.select(columns, metres(l, inverse), self.metres);
        self.side = l.select(columns, side, self.side);
        self.density = l.select(columns, l.mul(depth, side), self.density);
        self.last = l.truncate(l.sub(self.side, l.splat(1.0)));
        self.first = l.select_words(columns, l.truncate(l.mul(side, l.add(side, u))), self.first);
    }

    /// Texels of a row, `up` metres up at 1 m, from the tile of an upright patch, with the same result as [`Patch::texel`].
    #[inline(always)]
    pub(super) fn texel(&self, l: L, patch: &Patch, up: f32) -> L::Word {
        let [at, _, _, above] = patch.v;
        let texels = l.mul_add(self.density, l.splat(up * above), l.mul(self.side, l.splat(at + SHIFT)));
        l.gather(patch.texels, l.or(self.first, l.and(l.truncate(texels), self.last)))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::lanes::Portable;
    use super::super::surfaces;
    use super::*;
    use crate::camera::Camera;

    /// Bricks at their normal size.
    fn bricks() -> (&'static Tile, f32) {
        (
            surfaces::tile(driftworld_spec::Surface::Brick).expect("bricks have a tile"),
            1.0,
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The cache finds the same texels with less work, and marks columns that it does not contain.
        #[test]
        fn cache_finds_the_same_texels_as_its_patch(
            (at, heading, eye) in (prop::array::uniform2(-50.0_f32..50.0), 0.0_f32..360.0, 0.1_f32..3.0),
            distances in prop::array::uniform4(0.05_f32..90.0),
            (first, rows) in (0_usize..80, prop::collection::vec(0..84_u16, 1..8)),
        ) {
            let view = View::new(&Camera::first_person(at, heading, eye, 60.0), 84, 84);
            let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
            let patch = Patch::new(bricks(), &view, [0.0; 3], [y, z], x);
            prop_assert!(patch.is_upright());
            let l = Portable;
            let offset: [f32; 4] = std::array::from_fn(|k| view.offset(0, (first + k) as f32));
            let inverse = distances.map(|metres| 1.0 / metres);
            let material = [4 << 27; 4];
            let mut cache = WallCache::new(l);
            cache.record(l, [true, true, true, false], &patch, offset, (inverse, material));
            prop_assert_eq!(cache.is_valid(l, inverse, material), [true, true, true, false]);
            prop_assert_eq!(cache.is_valid(l, inverse.map(|inverse| inverse * 1.01), material), [false; 4]);
            prop_assert_eq!(cache.is_valid(l, inverse, [5 << 27; 4]), [false; 4]);
            for row in rows {
                let up = -view.offset(1, f32::from(row));
                let (found, expected) = (cache.texel(l, &patch, up), patch.texel(l, up, offset, inverse));
                prop_assert_eq!(found[..3].to_vec(), expected[..3].to_vec());
            }
            prop_assert_eq!(cache.metres[..3].to_vec(), metres(l, inverse)[..3].to_vec());
        }

        /// A camera that looks up or down does not see walls column by column.
        #[test]
        fn only_a_level_camera_sees_upright_patches(heading in 0.0_f32..360.0, pitch in prop_oneof![1.0_f32..80.0, -80.0_f32..-1.0]) {
            let camera = Camera { pitch_deg: pitch, ..Camera::first_person([0.0; 2], heading, 1.0, 60.0) };
            let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
            let patch = Patch::new(bricks(), &View::new(&camera, 84, 84), [0.0; 3], [x, z], y);
            prop_assert!(!patch.is_upright());
        }
    }
}
