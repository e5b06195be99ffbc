//! Sixteen lanes by AVX-512 (F and BW).
#![expect(
    unsafe_code,
    reason = "intrinsics of an instruction set: every call rests on the token, every pointer on a slice of checked length"
)]

use std::arch::x86_64::{
    __m512, __m512i, __mmask16, _CMP_EQ_OQ, _CMP_GE_OQ, _CMP_GT_OQ, _mm_cvtsi32_si128, _mm_setr_epi8, _mm_storeu_si128,
    _mm256_storeu_si256, _mm512_add_epi16, _mm512_add_ps, _mm512_and_si512, _mm512_broadcast_i32x4,
    _mm512_castps_si512, _mm512_castsi512_ps, _mm512_cmp_ps_mask, _mm512_cmpeq_epi32_mask, _mm512_cvtepi32_epi8,
    _mm512_cvtepi32_epi16, _mm512_cvtepi32_ps, _mm512_cvttps_epi32, _mm512_div_ps, _mm512_i32gather_epi32,
    _mm512_loadu_ps, _mm512_loadu_si512, _mm512_mask_blend_epi32, _mm512_mask_blend_ps, _mm512_mask_storeu_epi32,
    _mm512_mask_storeu_ps, _mm512_max_ps, _mm512_min_epu32, _mm512_min_ps, _mm512_mul_ps, _mm512_mullo_epi16,
    _mm512_or_si512, _mm512_packus_epi16, _mm512_permutexvar_epi32, _mm512_set1_epi8, _mm512_set1_epi16,
    _mm512_set1_epi32, _mm512_set1_ps, _mm512_setr_epi32, _mm512_setr_ps, _mm512_setzero_si512, _mm512_shuffle_epi8,
    _mm512_sll_epi32, _mm512_slli_epi32, _mm512_sqrt_ps, _mm512_srl_epi32, _mm512_srli_epi16, _mm512_storeu_ps,
    _mm512_storeu_si512, _mm512_sub_ps, _mm512_test_epi32_mask, _mm512_unpackhi_epi8, _mm512_unpacklo_epi8,
    _mm512_xor_si512,
};

use super::Lanes;
use super::intrinsics::lanes_by_intrinsics;

/// Proof that the processor has AVX-512 F and BW.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(());

impl Avx512 {
    /// The proof, if this processor has it.
    pub(crate) fn detect() -> Option<Self> {
        (std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("avx512bw"))
            .then_some(Self(()))
    }
}

lanes_by_intrinsics! {
    Avx512: 16 lanes of __m512, __m512i, __mmask16;
    memory: _mm512_loadu_ps, _mm512_storeu_ps, _mm512_loadu_si512, _mm512_storeu_si512, _mm512_set1_epi32;
    calls: {
        splat(value: f32) -> __m512 = _mm512_set1_ps(value);
        root(a: __m512) -> __m512 = _mm512_sqrt_ps(a);
        truncate(value: __m512) -> __m512i = _mm512_cvttps_epi32(value);
        float(value: __m512i) -> __m512 = _mm512_cvtepi32_ps(value);
        add(a: __m512, b: __m512) -> __m512 = _mm512_add_ps(a, b);
        sub(a: __m512, b: __m512) -> __m512 = _mm512_sub_ps(a, b);
        mul(a: __m512, b: __m512) -> __m512 = _mm512_mul_ps(a, b);
        div(a: __m512, b: __m512) -> __m512 = _mm512_div_ps(a, b);
        min(a: __m512, b: __m512) -> __m512 = _mm512_min_ps(a, b);
        max(a: __m512, b: __m512) -> __m512 = _mm512_max_ps(a, b);
        or(a: __m512i, b: __m512i) -> __m512i = _mm512_or_si512(a, b);
        xor(a: __m512i, b: __m512i) -> __m512i = _mm512_xor_si512(a, b);
        and(a: __m512i, b: __m512i) -> __m512i = _mm512_and_si512(a, b);
        shift_byte(value: __m512i) -> __m512i = _mm512_slli_epi32::<8>(value);
        at_least(a: __m512, b: __m512) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_GE_OQ>(a, b);
        above(a: __m512, b: __m512) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(a, b);
        same(a: __m512, b: __m512) -> __mmask16 = _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(a, b);
        select(mask: __mmask16, a: __m512, b: __m512) -> __m512 = _mm512_mask_blend_ps(mask, b, a);
        select_words(mask: __mmask16, a: __m512i, b: __m512i) -> __m512i = _mm512_mask_blend_epi32(mask, b, a);
    }

    #[inline(always)]
    fn count_up(self) -> __m512 {
        // SAFETY: as in the macro.
        unsafe {
            _mm512_setr_ps(
                0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0,
            )
        }
    }
    #[inline(always)]
    fn both(self, a: __mmask16, b: __mmask16) -> __mmask16 {
        a & b
    }
    #[inline(always)]
    fn bits(self, mask: __mmask16) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn has_bit(self, value: __m512i, bit: u32) -> __mmask16 {
        // SAFETY: as in the macro.
        unsafe { _mm512_test_epi32_mask(value, _mm512_set1_epi32(1 << bit)) }
    }
    #[inline(always)]
    fn equal(self, a: __m512i, b: __m512i) -> __mmask16 {
        // SAFETY: as in the macro.
        unsafe { _mm512_cmpeq_epi32_mask(a, b) }
    }
    #[inline(always)]
    fn shift_left(self, value: __m512i, bits: u32) -> __m512i {
        // SAFETY: as in the macro.
        unsafe { _mm512_sll_epi32(value, _mm_cvtsi32_si128(bits as i32)) }
    }
    #[inline(always)]
    fn shift_right(self, value: __m512i, bits: u32) -> __m512i {
        // SAFETY: as in the macro.
        unsafe { _mm512_srl_epi32(value, _mm_cvtsi32_si128(bits as i32)) }
    }
    #[inline(always)]
    fn has_any(self, value: __m512i, bits: u32) -> __mmask16 {
        // SAFETY: as in the macro.
        unsafe { _mm512_test_epi32_mask(value, _mm512_set1_epi32(bits as i32)) }
    }
    #[inline(always)]
    fn modulate(self, a: __m512i, b: __m512i) -> __m512i {
        // SAFETY: as in the macro.
        unsafe {
            let (zero, half) = (_mm512_setzero_si512(), _mm512_set1_epi16(64));
            let low = _mm512_mullo_epi16(_mm512_unpacklo_epi8(a, zero), _mm512_unpacklo_epi8(b, zero));
            let high = _mm512_mullo_epi16(_mm512_unpackhi_epi8(a, zero), _mm512_unpackhi_epi8(b, zero));
            _mm512_packus_epi16(
                _mm512_srli_epi16::<7>(_mm512_add_epi16(low, half)),
                _mm512_srli_epi16::<7>(_mm512_add_epi16(high, half)),
            )
        }
    }
    #[inline(always)]
    fn mix(self, a: __m512i, b: __m512i, share: __m512i) -> __m512i {
        // SAFETY: as in the macro.
        unsafe {
            let (zero, most) = (_mm512_setzero_si512(), _mm512_set1_epi16(255));
            let rest = _mm512_xor_si512(share, _mm512_set1_epi8(-1));
            let low = _mm512_add_epi16(
                _mm512_mullo_epi16(_mm512_unpacklo_epi8(a, zero), _mm512_unpacklo_epi8(rest, zero)),
                _mm512_mullo_epi16(_mm512_unpacklo_epi8(b, zero), _mm512_unpacklo_epi8(share, zero)),
            );
            let high = _mm512_add_epi16(
                _mm512_mullo_epi16(_mm512_unpackhi_epi8(a, zero), _mm512_unpackhi_epi8(rest, zero)),
                _mm512_mullo_epi16(_mm512_unpackhi_epi8(b, zero), _mm512_unpackhi_epi8(share, zero)),
            );
            _mm512_packus_epi16(
                _mm512_srli_epi16::<8>(_mm512_add_epi16(low, most)),
                _mm512_srli_epi16::<8>(_mm512_add_epi16(high, most)),
            )
        }
    }
    #[inline(always)]
    fn gather(self, table: &[u32], at: __m512i) -> __m512i {
        assert!(!table.is_empty(), "a table has words");
        let last = self.splat_word((table.len() - 1).min(i32::MAX as usize) as u32);
        // SAFETY: as in the macro; no place is beyond the last word of the table.
        unsafe {
            let at = _mm512_min_epu32(at, last);
            _mm512_i32gather_epi32::<4>(at, table.as_ptr().cast())
        }
    }
    #[inline(always)]
    fn power_of_two(self, value: __m512) -> __m512 {
        // SAFETY: as in the macro.
        unsafe {
            let exponent = _mm512_set1_epi32(0x7F80_0000);
            _mm512_castsi512_ps(_mm512_and_si512(_mm512_castps_si512(value), exponent))
        }
    }
    #[inline(always)]
    fn store_rgb(self, value: __m512i, to: &mut [u8]) {
        let to: &mut [u8; 3 * N] = to.first_chunk_mut().expect("callers hand in three bytes a lane");
        // SAFETY: as in the macro; the mask lets 12 words, 48 bytes, through.
        unsafe {
            // Within each quarter the fourth bytes go out; then the quarters close up.
            let quarter = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
            let packed = _mm512_permutexvar_epi32(
                _mm512_setr_epi32(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 3, 7, 11, 15),
                _mm512_shuffle_epi8(value, _mm512_broadcast_i32x4(quarter)),
            );
            _mm512_mask_storeu_epi32(to.as_mut_ptr().cast(), 0x0fff, packed);
        }
    }
    #[inline(always)]
    fn store_bytes(self, value: __m512i, to: &mut [u8]) {
        // SAFETY: as in the macro.
        unsafe { _mm_storeu_si128(first_mut(to).as_mut_ptr().cast(), _mm512_cvtepi32_epi8(value)) }
    }
    #[inline(always)]
    fn store_halves(self, value: __m512i, to: &mut [u16]) {
        // SAFETY: as in the macro.
        unsafe { _mm256_storeu_si256(first_mut(to).as_mut_ptr().cast(), _mm512_cvtepi32_epi16(value)) }
    }
    #[inline(always)]
    fn store_where(self, mask: __mmask16, value: __m512, to: &mut [f32]) {
        // SAFETY: as in the macro.
        unsafe { _mm512_mask_storeu_ps(first_mut(to).as_mut_ptr(), mask, value) }
    }
    #[inline(always)]
    fn store_words_where(self, mask: __mmask16, value: __m512i, to: &mut [u32]) {
        // SAFETY: as in the macro.
        unsafe { _mm512_mask_storeu_epi32(first_mut(to).as_mut_ptr().cast(), mask, value) }
    }
}
