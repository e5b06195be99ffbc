//! Signs: a board on posts, which says what the world writes on it. Letters are in `letters.rs`.

use super::letters::{LETTER, written};
use super::{Asset, Builder, Mesh, Part};

/// The signs in the order of their model numbers.
pub(crate) const SIGNS: [&str; 2] = ["post", "wide"];

const WOOD: [f32; 3] = [0.42, 0.30, 0.20];
const BOARD: [f32; 3] = [0.94, 0.92, 0.84];
const DARK: [f32; 3] = [0.06, 0.06, 0.08];
const LIGHT: [f32; 3] = [0.97, 0.97, 0.95];

/// From the ground to the middle of a board in metres: about as high as the agent's eye.
const MIDDLE: f32 = 1.15;

/// Pixels of a square of a letter from which on letters are drawn, seen from the sign's nearest point.
const READABLE: f32 = 1.6;

/// How thick a board is, and how far letters are before it, in metres.
const THICK: f32 = 0.05;
const BEFORE: f32 = 0.01;

/// What letters are written with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) enum Lettering {
    /// For boards that are light: those of no other colour, too.
    #[default]
    Dark,
    /// For boards that are dark.
    Light,
}

impl Lettering {
    /// The lettering that is seen on a colour (sRGB).
    pub(crate) fn on([r, g, b]: [f32; 3]) -> Self {
        // The eye's weights; half of what is seen as white is a little below a half in sRGB.
        if 0.30 * r + 0.59 * g + 0.11 * b < 0.45 {
            Self::Light
        } else {
            Self::Dark
        }
    }
}

/// Sign number `model` of [`SIGNS`] with a text on its front. The letters are left out where one of their squares is below
/// [`READABLE`] pixels: they would flicker, and be read as others.
pub(crate) fn sign(model: u32, text: &str, lettering: Lettering) -> Asset {
    let ([wide, high], posts) = match model {
        2 => ([2.2, 0.62], [0.8, -0.8].as_slice()),
        _ => ([1.3, 0.62], [0.0].as_slice()),
    };
    let post = |x: &f32| Mesh::cuboid([0.09, 0.09, MIDDLE + high / 2.0], 0.0).moved([*x, -0.07, 0.0]);
    let posts = posts.iter().fold(Mesh::default(), |mesh, x| mesh.with(&post(x)));
    let bare = Builder::default()
        .main(BOARD, Mesh::cuboid([wide, THICK, high], MIDDLE - high / 2.0))
        .fixed(WOOD, posts);
    let asset = bare.boxed();
    let count = text.chars().count();
    if text.trim().is_empty() {
        return asset;
    }
    let [columns, rows] = LETTER.map(|count| count as f32);
    let square = (wide / ((columns + 1.0) * count as f32 + 1.0)).min(high / (rows + 2.0));
    let letters = written(text, square, THICK / 2.0 + BEFORE, MIDDLE);
    let color = match lettering {
        Lettering::Dark => DARK,
        Lettering::Light => LIGHT,
    };
    let mut all = asset.parts.clone();
    all.push(Part::new(letters, super::Paint::Fixed(color)));
    // Half a pixel may be off: that is this much where a square is so many pixels.
    let levels = vec![(0.0, all), (square / (2.0 * READABLE), asset.parts)];
    Asset::of_levels(levels, asset.collider)
}
