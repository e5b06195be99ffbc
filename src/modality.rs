//! The kinds of images, and their PNG formats.

use crate::env::{Frame, category_color, depth_to_gray};
use crate::spec::Modality;

#[cfg(not(target_family = "wasm"))]
use crate::report::ReportError;
#[cfg(not(target_family = "wasm"))]
use crate::report::picture::{Gray, Picture};

/// The largest value of a 16-bit image.
const FULL: f32 = 65_535.0;

/// All kinds of images, in numerical order.
pub(crate) const ALL: [Modality; 5] = [
    Modality::Rgb,
    Modality::Depth,
    Modality::Segmentation,
    Modality::Class,
    Modality::Instance,
];

/// Their names in arguments, documents and file names.
pub(crate) const NAMES: [&str; 5] = ["rgb", "depth", "segmentation", "class", "instance"];

/// A kind's name.
pub(crate) fn name(kind: Modality) -> &'static str {
    NAMES[kind as usize]
}

/// A frame as colours, three bytes per pixel; classes and instances are coloured by `color_of`.
pub fn to_rgb(kind: Modality, frame: &Frame, color_of: fn(u32) -> [u8; 3]) -> Vec<u8> {
    match kind {
        Modality::Rgb => frame.rgb.clone(),
        Modality::Depth => gray_rgb(&frame.depth),
        Modality::Segmentation => frame.category.iter().flat_map(|it| category_color(*it)).collect(),
        Modality::Class => frame.class.iter().flat_map(|id| color_of(u32::from(*id))).collect(),
        Modality::Instance => frame.instance.iter().flat_map(|id| color_of(*id)).collect(),
    }
}

/// Distances as greys, three bytes each.
pub(crate) fn gray_rgb(metres: &[f32]) -> Vec<u8> {
    depth_to_gray(metres).into_iter().flat_map(|gray| [gray; 3]).collect()
}

/// A colour for a number, unlike the colours of adjacent numbers; black for 0.
pub fn number_color(number: u32) -> [u8; 3] {
    [97_u32, 53, 151].map(|step| {
        let share = number.wrapping_mul(step) % 192;
        if number == 0 { 0 } else { 64 + share as u8 }
    })
}

/// A PNG file's bytes: colours and reward categories as RGB; depths (in levels of `metres_per_level`, at most 65535 of them),
/// classes and instances as 16-bit numbers. Larger numbers are clamped.
#[cfg(not(target_family = "wasm"))]
pub(crate) fn to_png(kind: Modality, frame: &Frame, metres_per_level: f32) -> Result<Vec<u8>, ReportError> {
    let (width, height) = (frame.width, frame.height);
    let picture = |rgb: Vec<u8>| Picture { width, height, rgb }.to_png();
    let gray = |levels: Vec<u16>| Gray { width, height, levels }.to_png();
    let clamped = |number: &u32| u16::try_from(*number).unwrap_or(u16::MAX);
    match kind {
        Modality::Rgb | Modality::Segmentation => picture(to_rgb(kind, frame, number_color)),
        Modality::Depth => {
            let level = |metres: &f32| (metres / metres_per_level + 0.5).min(FULL) as u16;
            gray(frame.depth.iter().map(level).collect())
        }
        Modality::Class => gray(frame.class.clone()),
        Modality::Instance => gray(frame.instance.iter().map(clamped).collect()),
    }
}

/// The size of a depth level: the finest of a millimetre, a centimetre and a decimetre with which 16 bits can represent twice a
/// distance.
pub(crate) fn metres_per_level(distance: f32) -> f32 {
    let fine = [0.001, 0.01].into_iter().find(|level| 2.0 * distance < level * FULL);
    fine.unwrap_or(0.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_resolution_follows_the_distance() {
        assert_eq!([2.0, 40.0, 900.0].map(metres_per_level), [0.001, 0.01, 0.1]);
    }
}
