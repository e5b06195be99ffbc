//! Signs with text on their boards.

use super::letters::{CHARACTER_SIZE, text_mesh};
use super::{Asset, Paint, Part};

const DARK: [f32; 3] = [0.06, 0.06, 0.08];
const LIGHT: [f32; 3] = [0.97, 0.97, 0.95];

/// Width and height of each kind of board, and the height of its centre, in metres.
const POST: [f32; 2] = [1.3, 0.62];
const WIDE: [f32; 2] = [2.2, 0.62];
const CENTRE: f32 = 1.15;

/// Minimum size in pixels of a letter's squares in the image; smaller text is not drawn.
const MIN_SQUARE_PIXELS: f32 = 1.6;

/// Thickness of a board, and the distance of letters in front of it, in metres.
const THICKNESS: f32 = 0.05;
const GAP: f32 = 0.01;

/// Whether light letters are readable on a colour (sRGB), and dark ones are not.
pub(crate) fn needs_light_letters([r, g, b]: [f32; 3]) -> bool {
    // Luma weights. In sRGB, perceived middle grey is slightly below one half.
    0.30 * r + 0.59 * g + 0.11 * b < 0.45
}

/// The sign number `model` with text on its front, in light or dark letters. Letters with squares smaller than
/// [`MIN_SQUARE_PIXELS`] are not drawn, because they would flicker and be misread.
pub(crate) fn sign(bare: &Asset, model: u32, text: &str, is_light: bool) -> Asset {
    if text.trim().is_empty() {
        return bare.clone();
    }
    let [wide, high] = if model == 2 { WIDE } else { POST };
    let count = text.chars().count();
    let [columns, rows] = CHARACTER_SIZE.map(|count| count as f32);
    let square = (wide / ((columns + 1.0) * count as f32 + 1.0)).min(high / (rows + 2.0));
    let letters = text_mesh(text, square, THICKNESS / 2.0 + GAP, CENTRE);
    let color = if is_light { LIGHT } else { DARK };
    let mut all = bare.parts.clone();
    all.push(Part::new(letters, Paint::Fixed(color)));
    // The allowed error is half a pixel, which is this many metres if a square is `MIN_SQUARE_PIXELS` wide.
    let levels = vec![(0.0, all), (square / (2.0 * MIN_SQUARE_PIXELS), bare.parts.clone())];
    Asset::of_levels(levels, bare.collider.clone())
}
