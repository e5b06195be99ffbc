//! Converts between sRGB and linear light.

/// Converts an sRGB channel in 0..1 to linear light.
pub(super) fn linear(channel: f32) -> f32 {
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        libm::powf((channel + 0.055) / 1.055, 2.4)
    }
}

/// Converts linear light to an sRGB channel in 0..1.
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
    fn every_byte_round_trips() {
        for byte in 0..=255_u8 {
            let channel = f32::from(byte) / 255.0;
            let back = srgb(linear(channel)) * 255.0;
            assert!((back - f32::from(byte)).abs() < 0.01, "{byte}: {back}");
        }
        assert!((linear(0.5) - 0.214).abs() < 1e-3, "middle grey of the sRGB curve");
    }
}
