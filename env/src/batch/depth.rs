//! [`DepthForm`]: the numbers that a batch hands out depth in. The metres they are made from are drawn by `render`.

use crate::render::{gray_of_metres, rounded};

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
        *out = rounded(metres * 1000.0, 65_535.0) as u16;
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

    #[test]
    fn forms_round_as_a_cast_does() {
        let depth: Vec<f32> = (0..60_000_u16).map(|step| f32::from(step) * 0.001_713).collect();
        let (mut small, mut large) = (vec![0; depth.len()], vec![0; depth.len()]);
        gray(&depth, &mut small);
        millimetres(&depth, &mut large);
        for ((metres, small), large) in depth.iter().zip(small).zip(large) {
            assert_eq!(small, (metres * 2.55 + 0.5).clamp(0.0, 255.0) as u8, "{metres}");
            assert_eq!(large, (metres * 1000.0 + 0.5).clamp(0.0, 65_535.0) as u16, "{metres}");
        }
    }
}
