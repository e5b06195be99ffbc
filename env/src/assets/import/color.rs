//! Colours as files write them and as models keep them: light in numbers that add up, and sRGB.

/// The light of an sRGB channel in 0..1.
pub(super) fn linear(channel: f32) -> f32 {
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        libm::powf((channel + 0.055) / 1.055, 2.4)
    }
}

/// The sRGB channel in 0..1 of an amount of light.
pub(super) fn srgb(light: f32) -> f32 {
    let light = light.clamp(0.0, 1.0);
    let channel = if light <= 0.003_130_8 {
        light * 12.92
    } else {
        1.055 * libm::powf(light, 1.0 / 2.4) - 0.055
    };
    channel.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_comes_back() {
        for byte in 0..=255_u8 {
            let channel = f32::from(byte) / 255.0;
            let back = srgb(linear(channel)) * 255.0;
            assert!((back - f32::from(byte)).abs() < 0.01, "{byte}: {back}");
        }
        assert!(
            (linear(0.5) - 0.214).abs() < 1e-3,
            "the middle grey of the standard's curve"
        );
    }
}
