//! [`DepthForm`]: the numbers that a batch hands out depth in. The metres they are made from are drawn by `render`.

use crate::render::gray_of_metres;

/// What numbers a batch's depth images are made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DepthForm {
    /// Metres, as drawn.
    #[default]
    Metres,
    /// Whole millimetres up to 65,535; what is farther is 65,535. As depth cameras give it.
    Millimetres,
    /// Grey, as L2Explorer shows it: 0 at the camera, 255 at 100 m and beyond.
    Gray,
}

/// Millimetres for metres, rounded.
pub(super) fn millimetres(depth: &[f32], out: &mut [u16]) {
    for (out, metres) in out.iter_mut().zip(depth) {
        *out = (metres * 1000.0 + 0.5).clamp(0.0, 65_535.0) as u16;
    }
}

/// Grey for metres.
pub(super) fn gray(depth: &[f32], out: &mut [u8]) {
    for (out, metres) in out.iter_mut().zip(depth) {
        *out = gray_of_metres(*metres);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_far_end_of_each_form_is_its_greatest_number() {
        let depth = [0.0, 0.0625, 50.0, 99.9, 65.6, 1000.0];
        let (mut small, mut large) = ([0; 6], [0; 6]);
        gray(&depth, &mut small);
        millimetres(&depth, &mut large);
        assert_eq!(small, [0, 0, 128, 255, 167, 255]);
        assert_eq!(large, [0, 63, 50_000, 65_535, 65_535, 65_535]);
    }
}
