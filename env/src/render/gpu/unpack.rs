//! Converts the bytes of a pass to the images of one tile.

use super::super::compose::CATEGORY_BITS;
use super::super::frame::FAR_DEPTH;
use super::super::target::Target;
use super::super::view::NEAR;
use super::atlas::Layout;
use crate::scene::Scene;

/// Bytes per pixel in each plane.
const BYTES: usize = 4;

/// Fills all images that a target requests, from the tile whose upper left corner is at `corner`.
pub(super) fn unpack(
    bytes: &[u8],
    layout: Layout,
    corner: [u32; 2],
    scene: &Scene,
    with_class: bool,
    target: &mut Target<'_>,
) {
    let (width, height) = (target.width as usize, target.height as usize);
    let [left, top] = corner.map(|pixel| pixel as usize);
    let row_of = |plane: Option<usize>, y: usize| {
        plane.map(|start| {
            let from = start + (top + y) * layout.row + left * BYTES;
            bytes[from..from + width * BYTES].as_chunks::<BYTES>().0
        })
    };
    for y in 0..height {
        let row = y * width..(y + 1) * width;
        if let Some(words) = row_of(layout.words, y) {
            if let Some(rgb) = &mut target.rgb {
                let pixels = rgb[3 * row.start..3 * row.end].as_chunks_mut::<3>().0;
                for (out, [red, green, blue, _]) in pixels.iter_mut().zip(words) {
                    *out = [*red, *green, *blue];
                }
            }
            if let Some(category) = &mut target.category {
                for (out, word) in category[row.clone()].iter_mut().zip(words) {
                    *out = word[3] & ((1 << CATEGORY_BITS) - 1);
                }
            }
            if let (Some(class), true) = (&mut target.class, with_class) {
                for (out, word) in class[row.clone()].iter_mut().zip(words) {
                    *out = u16::from(word[3] >> CATEGORY_BITS);
                }
            }
        }
        if let (Some(depth), Some(inverse)) = (&mut target.depth, row_of(layout.depth, y)) {
            for (out, inverse) in depth[row.clone()].iter_mut().zip(inverse) {
                *out = metres(f32::from_le_bytes(*inverse));
            }
        }
        if let Some(items) = row_of(layout.items, y) {
            if let (Some(class), false) = (&mut target.class, with_class) {
                for (out, item) in class[row.clone()].iter_mut().zip(items) {
                    let item = (u32::from_le_bytes(*item) as usize).checked_sub(1);
                    *out = item
                        .and_then(|index| scene.items.get(index))
                        .map_or(0, |item| item.class_id);
                }
            }
            if let Some(instance) = &mut target.instance {
                for (out, item) in instance[row].iter_mut().zip(items) {
                    *out = u32::from_le_bytes(*item);
                }
            }
        }
    }
}

/// Converts near plane / depth to metres.
fn metres(inverse: f32) -> f32 {
    if inverse > NEAR / FAR_DEPTH {
        NEAR / inverse
    } else {
        FAR_DEPTH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_in_metres_and_the_sky_has_far_depth() {
        for (inverse, expected) in [(1.0, NEAR), (0.005, 10.0), (0.0, FAR_DEPTH), (1e-9, FAR_DEPTH)] {
            assert!((metres(inverse) - expected).abs() < 1e-5 * expected, "{inverse}");
        }
    }
}
