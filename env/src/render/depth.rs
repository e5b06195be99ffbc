//! Converts depth to millimetres and to grey. [`DepthForm`] is the number format of a batch's depth images.

/// The number format of a batch's depth images; formats are named like the dtypes of `NumPy`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::EnumString)]
pub enum DepthForm {
    /// Metres, as rendered.
    #[default]
    #[strum(serialize = "float32")]
    Metres,
    /// Whole millimetres, capped at 65,535, as from depth cameras.
    #[strum(serialize = "uint16")]
    Millimetres,
    /// Grey, as in L2Explorer: 0 at the camera, 255 at 100 m and beyond.
    #[strum(serialize = "uint8")]
    Gray,
}

/// Converts depth to grey as in L2Explorer: black at the camera, white at 100 m and beyond.
pub fn depth_to_gray(depth: &[f32]) -> Vec<u8> {
    let gray = |metres: &f32| rounded(metres * GRAY_PER_METRE, 255.0) as u8;
    depth.iter().map(gray).collect()
}

/// Grey levels per metre: 255 at 100 m.
const GRAY_PER_METRE: f32 = 2.55;

/// The nearest integer, halves rounded up, within 0..=`most`, which must be below 2²³.
///
/// A sum with 2²³ has no bits for a fraction, so its last bits are the integer. Compilers vectorise this, but not a saturating
/// cast; with SSE2 the cast takes three times as long.
#[inline]
fn rounded(number: f32, most: f32) -> u32 {
    const SHIFT: f32 = 8_388_608.0;
    let raised = number + 0.5;
    // Comparisons instead of `clamp`, which would pass NaN through.
    let below = if raised < most { raised } else { most };
    let within = if below > 0.0 { below } else { 0.0 };
    let whole = within + SHIFT;
    let is_rounded_up = whole - SHIFT > within;
    (whole.to_bits() - SHIFT.to_bits()).wrapping_sub(u32::from(is_rounded_up))
}

/// Converts metres to millimetres, rounded.
pub(crate) fn millimetres(depth: &[f32], out: &mut [u16]) {
    scaled(depth, 1000.0, 65_535.0, |word| word as u16, out);
}

/// Converts metres to grey.
pub(crate) fn gray(depth: &[f32], out: &mut [u8]) {
    scaled(depth, GRAY_PER_METRE, 255.0, |word| word as u8, out);
}

/// Rounds `scale` times the metres, capped at `most`, with the CPU's widest vectors. 84 × 84 pixels take 0.7 µs with AVX-512,
/// 1.2 µs with AVX2 and 2.1 µs with SSE2; the results are the same.
fn scaled<T>(depth: &[f32], scale: f32, most: f32, lowest: impl Fn(u32) -> T, out: &mut [T]) {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx512bw") && is_x86_feature_detected!("avx512vl") {
            #[expect(unsafe_code, reason = "the processor was just checked for these instructions")]
            // SAFETY: the CPU has these instructions; AVX-512BW implies F and AVX2.
            return unsafe { scaled_avx512(depth, scale, most, lowest, out) };
        }
        if is_x86_feature_detected!("avx2") {
            #[expect(unsafe_code, reason = "the processor was just checked for these instructions")]
            // SAFETY: the CPU has these instructions.
            return unsafe { scaled_avx2(depth, scale, most, lowest, out) };
        }
    }
    scaled_inline(depth, scale, most, lowest, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512bw,avx512vl")]
fn scaled_avx512<T>(depth: &[f32], scale: f32, most: f32, lowest: impl Fn(u32) -> T, out: &mut [T]) {
    scaled_inline(depth, scale, most, lowest, out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn scaled_avx2<T>(depth: &[f32], scale: f32, most: f32, lowest: impl Fn(u32) -> T, out: &mut [T]) {
    scaled_inline(depth, scale, most, lowest, out);
}

#[expect(clippy::inline_always, reason = "must be compiled for each caller's instruction set")]
#[inline(always)]
fn scaled_inline<T>(depth: &[f32], scale: f32, most: f32, lowest: impl Fn(u32) -> T, out: &mut [T]) {
    for (out, metres) in out.iter_mut().zip(depth) {
        *out = lowest(rounded(metres * scale, most));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_distances_give_the_largest_number() {
        let depth = [0.0, 0.0625, 50.0, 99.9, 65.6, 1000.0];
        let (mut small, mut large) = ([0; 6], [0; 6]);
        gray(&depth, &mut small);
        millimetres(&depth, &mut large);
        assert_eq!(small, [0, 0, 128, 255, 167, 255]);
        assert_eq!(large, [0, 63, 50_000, 65_535, 65_535, 65_535]);
    }

    #[test]
    fn conversion_rounds_like_a_cast() {
        let steps = (0..60_000_u16).step_by(if cfg!(miri) { 599 } else { 1 });
        let depth: Vec<f32> = steps.map(|step| f32::from(step) * 0.001_713).collect();
        let (mut small, mut large) = (vec![0; depth.len()], vec![0; depth.len()]);
        gray(&depth, &mut small);
        millimetres(&depth, &mut large);
        for ((metres, small), large) in depth.iter().zip(small).zip(large) {
            assert_eq!(small, (metres * 2.55 + 0.5).clamp(0.0, 255.0) as u8, "{metres}");
            assert_eq!(large, (metres * 1000.0 + 0.5).clamp(0.0, 65_535.0) as u16, "{metres}");
        }
    }

    #[test]
    fn widest_instruction_set_gives_the_same_numbers() {
        let steps = (0..10_007_u16).step_by(if cfg!(miri) { 59 } else { 1 });
        let depth: Vec<f32> = steps.map(|step| f32::from(step) * 0.011_3).collect();
        let (mut fast, mut plain) = (vec![0_u8; depth.len()], vec![0_u8; depth.len()]);
        gray(&depth, &mut fast);
        scaled_inline(&depth, GRAY_PER_METRE, 255.0, |word| word as u8, &mut plain);
        assert_eq!(fast, plain);
    }
}
