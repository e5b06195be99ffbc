//! Eight lanes by AVX2.
#![expect(
    unsafe_code,
    reason = "intrinsics of an instruction set: every call rests on the token, every pointer on a slice of checked length"
)]

use std::arch::x86_64::{
    __m256, __m256i, _CMP_EQ_OQ, _CMP_GE_OQ, _CMP_GT_OQ, _mm_cvtsi32_si128, _mm_storel_epi64, _mm_storeu_si128,
    _mm256_add_epi16, _mm256_add_ps, _mm256_and_ps, _mm256_and_si256, _mm256_blendv_epi8, _mm256_blendv_ps,
    _mm256_castps_si256, _mm256_castsi256_ps, _mm256_castsi256_si128, _mm256_cmp_ps, _mm256_cmpeq_epi32,
    _mm256_cvtepi32_ps, _mm256_cvttps_epi32, _mm256_div_ps, _mm256_extracti128_si256, _mm256_i32gather_epi32,
    _mm256_loadu_ps, _mm256_loadu_si256, _mm256_maskstore_epi32, _mm256_maskstore_ps, _mm256_max_ps, _mm256_min_epu32,
    _mm256_min_ps, _mm256_movemask_ps, _mm256_mul_ps, _mm256_mullo_epi16, _mm256_or_si256, _mm256_packus_epi16,
    _mm256_packus_epi32, _mm256_permute4x64_epi64, _mm256_permutevar8x32_epi32, _mm256_set1_epi8, _mm256_set1_epi16,
    _mm256_set1_epi32, _mm256_set1_ps, _mm256_setr_epi8, _mm256_setr_epi32, _mm256_setr_ps, _mm256_setzero_si256,
    _mm256_shuffle_epi8, _mm256_sll_epi32, _mm256_slli_epi32, _mm256_sqrt_ps, _mm256_srl_epi32, _mm256_srli_epi16,
    _mm256_storeu_ps, _mm256_storeu_si256, _mm256_sub_ps, _mm256_unpackhi_epi8, _mm256_unpacklo_epi8, _mm256_xor_si256,
};

use super::Lanes;
use super::intrinsics::lanes_by_intrinsics;

/// Proof that the processor has AVX2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    /// The proof, if this processor has it.
    pub(crate) fn detect() -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx2").then_some(Self(()))
    }
}

lanes_by_intrinsics! {
    Avx2: 8 lanes of __m256, __m256i, __m256;
    memory: _mm256_loadu_ps, _mm256_storeu_ps, _mm256_loadu_si256, _mm256_storeu_si256, _mm256_set1_epi32;
    calls: {
        splat(value: f32) -> __m256 = _mm256_set1_ps(value);
        root(a: __m256) -> __m256 = _mm256_sqrt_ps(a);
        truncate(value: __m256) -> __m256i = _mm256_cvttps_epi32(value);
        float(value: __m256i) -> __m256 = _mm256_cvtepi32_ps(value);
        add(a: __m256, b: __m256) -> __m256 = _mm256_add_ps(a, b);
        sub(a: __m256, b: __m256) -> __m256 = _mm256_sub_ps(a, b);
        mul(a: __m256, b: __m256) -> __m256 = _mm256_mul_ps(a, b);
        div(a: __m256, b: __m256) -> __m256 = _mm256_div_ps(a, b);
        min(a: __m256, b: __m256) -> __m256 = _mm256_min_ps(a, b);
        max(a: __m256, b: __m256) -> __m256 = _mm256_max_ps(a, b);
        or(a: __m256i, b: __m256i) -> __m256i = _mm256_or_si256(a, b);
        xor(a: __m256i, b: __m256i) -> __m256i = _mm256_xor_si256(a, b);
        and(a: __m256i, b: __m256i) -> __m256i = _mm256_and_si256(a, b);
        shift_byte(value: __m256i) -> __m256i = _mm256_slli_epi32::<8>(value);
        at_least(a: __m256, b: __m256) -> __m256 = _mm256_cmp_ps::<_CMP_GE_OQ>(a, b);
        above(a: __m256, b: __m256) -> __m256 = _mm256_cmp_ps::<_CMP_GT_OQ>(a, b);
        same(a: __m256, b: __m256) -> __m256 = _mm256_cmp_ps::<_CMP_EQ_OQ>(a, b);
        both(a: __m256, b: __m256) -> __m256 = _mm256_and_ps(a, b);
        select(mask: __m256, a: __m256, b: __m256) -> __m256 = _mm256_blendv_ps(b, a, mask);
    }

    #[inline(always)]
    fn count_up(self) -> __m256 {
        // SAFETY: as in the macro.
        unsafe { _mm256_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0) }
    }
    #[inline(always)]
    fn bits(self, mask: __m256) -> u32 {
        // SAFETY: as in the macro.
        unsafe { _mm256_movemask_ps(mask) as u32 }
    }
    #[inline(always)]
    fn select_words(self, mask: __m256, a: __m256i, b: __m256i) -> __m256i {
        // SAFETY: as in the macro.
        unsafe { _mm256_blendv_epi8(b, a, _mm256_castps_si256(mask)) }
    }
    #[inline(always)]
    fn has_bit(self, value: __m256i, bit: u32) -> __m256 {
        // SAFETY: as in the macro.
        unsafe {
            let only = _mm256_set1_epi32(1 << bit);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(value, only), only))
        }
    }
    #[inline(always)]
    fn equal(self, a: __m256i, b: __m256i) -> __m256 {
        // SAFETY: as in the macro.
        unsafe { _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b)) }
    }
    #[inline(always)]
    fn shift_left(self, value: __m256i, bits: u32) -> __m256i {
        // SAFETY: as in the macro.
        unsafe { _mm256_sll_epi32(value, _mm_cvtsi32_si128(bits as i32)) }
    }
    #[inline(always)]
    fn shift_right(self, value: __m256i, bits: u32) -> __m256i {
        // SAFETY: as in the macro.
        unsafe { _mm256_srl_epi32(value, _mm_cvtsi32_si128(bits as i32)) }
    }
    #[inline(always)]
    fn has_any(self, value: __m256i, bits: u32) -> __m256 {
        // SAFETY: as in the macro.
        unsafe {
            let none = _mm256_cmpeq_epi32(
                _mm256_and_si256(value, _mm256_set1_epi32(bits as i32)),
                _mm256_setzero_si256(),
            );
            _mm256_castsi256_ps(_mm256_xor_si256(none, _mm256_set1_epi32(-1)))
        }
    }
    #[inline(always)]
    fn modulate(self, a: __m256i, b: __m256i) -> __m256i {
        // SAFETY: as in the macro.
        unsafe {
            let (zero, half) = (_mm256_setzero_si256(), _mm256_set1_epi16(64));
            let low = _mm256_mullo_epi16(_mm256_unpacklo_epi8(a, zero), _mm256_unpacklo_epi8(b, zero));
            let high = _mm256_mullo_epi16(_mm256_unpackhi_epi8(a, zero), _mm256_unpackhi_epi8(b, zero));
            _mm256_packus_epi16(
                _mm256_srli_epi16::<7>(_mm256_add_epi16(low, half)),
                _mm256_srli_epi16::<7>(_mm256_add_epi16(high, half)),
            )
        }
    }
    #[inline(always)]
    fn mix(self, a: __m256i, b: __m256i, share: __m256i) -> __m256i {
        // SAFETY: as in the macro.
        unsafe {
            let (zero, most) = (_mm256_setzero_si256(), _mm256_set1_epi16(255));
            let rest = _mm256_xor_si256(share, _mm256_set1_epi8(-1));
            let low = _mm256_add_epi16(
                _mm256_mullo_epi16(_mm256_unpacklo_epi8(a, zero), _mm256_unpacklo_epi8(rest, zero)),
                _mm256_mullo_epi16(_mm256_unpacklo_epi8(b, zero), _mm256_unpacklo_epi8(share, zero)),
            );
            let high = _mm256_add_epi16(
                _mm256_mullo_epi16(_mm256_unpackhi_epi8(a, zero), _mm256_unpackhi_epi8(rest, zero)),
                _mm256_mullo_epi16(_mm256_unpackhi_epi8(b, zero), _mm256_unpackhi_epi8(share, zero)),
            );
            _mm256_packus_epi16(
                _mm256_srli_epi16::<8>(_mm256_add_epi16(low, most)),
                _mm256_srli_epi16::<8>(_mm256_add_epi16(high, most)),
            )
        }
    }
    #[inline(always)]
    fn gather(self, table: &[u32], at: __m256i) -> __m256i {
        assert!(!table.is_empty(), "a table has words");
        let last = self.splat_word((table.len() - 1).min(i32::MAX as usize) as u32);
        // SAFETY: as in the macro; no place is beyond the last word of the table.
        unsafe {
            let at = _mm256_min_epu32(at, last);
            _mm256_i32gather_epi32::<4>(table.as_ptr().cast(), at)
        }
    }
    #[inline(always)]
    fn power_of_two(self, value: __m256) -> __m256 {
        // SAFETY: as in the macro.
        unsafe {
            let exponent = _mm256_set1_epi32(0x7F80_0000);
            _mm256_castsi256_ps(_mm256_and_si256(_mm256_castps_si256(value), exponent))
        }
    }
    #[inline(always)]
    fn store_rgb(self, value: __m256i, to: &mut [u8]) {
        let to: &mut [u8; 3 * N] = to.first_chunk_mut().expect("callers hand in three bytes a lane");
        // SAFETY: as in the macro; 16 and 8 bytes of the 24 are written.
        unsafe {
            // Within each half the fourth bytes go out; then the halves close up.
            let halves = _mm256_setr_epi8(
                0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1, 0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1,
                -1, -1,
            );
            let packed = _mm256_permutevar8x32_epi32(
                _mm256_shuffle_epi8(value, halves),
                _mm256_setr_epi32(0, 1, 2, 4, 5, 6, 3, 7),
            );
            _mm_storeu_si128(to.as_mut_ptr().cast(), _mm256_castsi256_si128(packed));
            _mm_storel_epi64(to[16..].as_mut_ptr().cast(), _mm256_extracti128_si256::<1>(packed));
        }
    }
    #[inline(always)]
    fn store_bytes(self, value: __m256i, to: &mut [u8]) {
        let to: &mut [u8; N] = first_mut(to);
        // SAFETY: as in the macro; 8 bytes are written.
        unsafe {
            // Each half's bytes into its first word, and the words together.
            let halves = _mm256_shuffle_epi8(value, _mm256_set1_epi32(0x0C08_0400));
            let packed = _mm256_permutevar8x32_epi32(halves, _mm256_setr_epi32(0, 4, 0, 4, 0, 4, 0, 4));
            _mm_storel_epi64(to.as_mut_ptr().cast(), _mm256_castsi256_si128(packed));
        }
    }
    #[inline(always)]
    fn store_halves(self, value: __m256i, to: &mut [u16]) {
        let to: &mut [u16; N] = first_mut(to);
        // SAFETY: as in the macro; 16 bytes are written.
        unsafe {
            let packed = _mm256_permute4x64_epi64::<0b1000>(_mm256_packus_epi32(value, value));
            _mm_storeu_si128(to.as_mut_ptr().cast(), _mm256_castsi256_si128(packed));
        }
    }
    #[inline(always)]
    fn store_where(self, mask: __m256, value: __m256, to: &mut [f32]) {
        // SAFETY: as in the macro.
        unsafe { _mm256_maskstore_ps(first_mut(to).as_mut_ptr(), _mm256_castps_si256(mask), value) }
    }
    #[inline(always)]
    fn store_words_where(self, mask: __m256, value: __m256i, to: &mut [u32]) {
        // SAFETY: as in the macro.
        unsafe { _mm256_maskstore_epi32(first_mut(to).as_mut_ptr().cast(), _mm256_castps_si256(mask), value) }
    }
}
