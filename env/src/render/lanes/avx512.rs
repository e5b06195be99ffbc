//! Sixteen lanes, with AVX-512 (F and BW).
#![expect(
    unsafe_code,
    reason = "intrinsics of an instruction set: every call rests on the token, every pointer on a slice of checked length"
)]

use std::arch::x86_64::*;

use super::{Lanes, first, first_mut, operations};

/// Proof that the CPU has AVX-512 F and BW.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(());

impl Avx512 {
    /// The proof, if this CPU has both.
    pub(crate) fn detect() -> Option<Self> {
        (std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("avx512bw"))
            .then_some(Self(()))
    }
}

const N: usize = 16;
type Float = __m512;
type Word = __m512i;
type Mask = __mmask16;

impl Lanes for Avx512 {
    const N: usize = N;
    type Float = Float;
    type Word = Word;
    type Mask = Mask;

    operations! { plain:
        both(a: Mask, b: Mask) -> Mask = a & b;
        bits(mask: Mask) -> u32 = u32::from(mask);
    }
    operations! { intrinsics:
        splat(value: f32) -> Float = _mm512_set1_ps(value);
        count_up() -> Float =
            _mm512_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0);
        load(from: &[f32]) -> Float = _mm512_loadu_ps(first::<_, N>(from).as_ptr());
        store(value: Float, to: &mut [f32]) -> () = _mm512_storeu_ps(first_mut::<_, N>(to).as_mut_ptr(), value);
        add(a: Float, b: Float) -> Float = _mm512_add_ps(a, b);
        sub(a: Float, b: Float) -> Float = _mm512_sub_ps(a, b);
        mul(a: Float, b: Float) -> Float = _mm512_mul_ps(a, b);
        div(a: Float, b: Float) -> Float = _mm512_div_ps(a, b);
        min(a: Float, b: Float) -> Float = _mm512_min_ps(a, b);
        max(a: Float, b: Float) -> Float = _mm512_max_ps(a, b);
        at_least(a: Float, b: Float) -> Mask = _mm512_cmp_ps_mask::<_CMP_GE_OQ>(a, b);
        above(a: Float, b: Float) -> Mask = _mm512_cmp_ps_mask::<_CMP_GT_OQ>(a, b);
        same(a: Float, b: Float) -> Mask = _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(a, b);
        root(a: Float) -> Float = _mm512_sqrt_ps(a);
        select(mask: Mask, a: Float, b: Float) -> Float = _mm512_mask_blend_ps(mask, b, a);

        splat_word(value: u32) -> Word = _mm512_set1_epi32(value as i32);
        load_words(from: &[u32]) -> Word = _mm512_loadu_si512(first::<_, N>(from).as_ptr().cast());
        store_words(value: Word, to: &mut [u32]) -> () =
            _mm512_storeu_si512(first_mut::<_, N>(to).as_mut_ptr().cast(), value);
        select_words(mask: Mask, a: Word, b: Word) -> Word = _mm512_mask_blend_epi32(mask, b, a);
        or(a: Word, b: Word) -> Word = _mm512_or_si512(a, b);
        xor(a: Word, b: Word) -> Word = _mm512_xor_si512(a, b);
        and(a: Word, b: Word) -> Word = _mm512_and_si512(a, b);
        equal(a: Word, b: Word) -> Mask = _mm512_cmpeq_epi32_mask(a, b);
        shift_left(value: Word, bits: u32) -> Word = _mm512_sll_epi32(value, _mm_cvtsi32_si128(bits as i32));
        shift_right(value: Word, bits: u32) -> Word = _mm512_srl_epi32(value, _mm_cvtsi32_si128(bits as i32));
        shift_byte(value: Word) -> Word = _mm512_slli_epi32::<8>(value);
        has_bit(value: Word, bit: u32) -> Mask = _mm512_test_epi32_mask(value, _mm512_set1_epi32(1 << bit));
        has_any(value: Word, bits: u32) -> Mask = _mm512_test_epi32_mask(value, _mm512_set1_epi32(bits as i32));
        modulate(a: Word, b: Word) -> Word = {
            let (zero, half) = (_mm512_setzero_si512(), _mm512_set1_epi16(64));
            let low = _mm512_mullo_epi16(_mm512_unpacklo_epi8(a, zero), _mm512_unpacklo_epi8(b, zero));
            let high = _mm512_mullo_epi16(_mm512_unpackhi_epi8(a, zero), _mm512_unpackhi_epi8(b, zero));
            _mm512_packus_epi16(
                _mm512_srli_epi16::<7>(_mm512_add_epi16(low, half)),
                _mm512_srli_epi16::<7>(_mm512_add_epi16(high, half)),
            )
        };
        mix(a: Word, b: Word, share: Word) -> Word = {
            let (zero, max) = (_mm512_setzero_si512(), _mm512_set1_epi16(255));
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
                _mm512_srli_epi16::<8>(_mm512_add_epi16(low, max)),
                _mm512_srli_epi16::<8>(_mm512_add_epi16(high, max)),
            )
        };
        gather(table: &[u32], at: Word) -> Word = {
            assert!(!table.is_empty(), "the table is empty");
            let last = _mm512_set1_epi32((table.len() - 1).min(i32::MAX as usize) as i32);
            // Clamps indices to the last word of the table.
            _mm512_i32gather_epi32::<4>(_mm512_min_epu32(at, last), table.as_ptr().cast())
        };
        gather_grouped(table: &[u32], at: Word, group: u32) -> Word = {
            assert!(!table.is_empty(), "the table is empty");
            let last = _mm512_set1_epi32((table.len() - 1).min(i32::MAX as usize) as i32);
            // Clamps indices to the last word of the table.
            let at = _mm512_min_epu32(at, last);
            let table = table.as_ptr().cast();
            match group {
                4 => {
                    let few = _mm512_setr_epi32(0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12);
                    let few = _mm512_castsi512_si128(_mm512_permutexvar_epi32(few, at));
                    let found = _mm512_castsi128_si512(_mm_i32gather_epi32::<4>(table, few));
                    let all = _mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
                    _mm512_permutexvar_epi32(all, found)
                }
                2 => {
                    let few = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 0, 2, 4, 6, 8, 10, 12, 14);
                    let few = _mm512_castsi512_si256(_mm512_permutexvar_epi32(few, at));
                    let found = _mm512_castsi256_si512(_mm256_i32gather_epi32::<4>(table, few));
                    let all = _mm512_setr_epi32(0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7);
                    _mm512_permutexvar_epi32(all, found)
                }
                _ => _mm512_i32gather_epi32::<4>(at, table),
            }
        };
        power_of_two(value: Float) -> Float = {
            let exponent = _mm512_set1_epi32(0x7F80_0000);
            _mm512_castsi512_ps(_mm512_and_si512(_mm512_castps_si512(value), exponent))
        };
        truncate(value: Float) -> Word = _mm512_cvttps_epi32(value);
        float(value: Word) -> Float = _mm512_cvtepi32_ps(value);

        store_rgb(value: Word, to: &mut [u8]) -> () = {
            let to: &mut [u8; 3 * N] = to.first_chunk_mut().expect("callers pass three bytes per lane");
            // Drops every fourth byte within each quarter, then joins the quarters.
            let quarter = _mm_setr_epi8(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, -1, -1, -1, -1);
            let packed = _mm512_permutexvar_epi32(
                _mm512_setr_epi32(0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14, 3, 7, 11, 15),
                _mm512_shuffle_epi8(value, _mm512_broadcast_i32x4(quarter)),
            );
            _mm512_mask_storeu_epi32(to.as_mut_ptr().cast(), 0x0fff, packed);
        };
        store_bytes(value: Word, to: &mut [u8]) -> () =
            _mm_storeu_si128(first_mut::<_, N>(to).as_mut_ptr().cast(), _mm512_cvtepi32_epi8(value));
        store_halves(value: Word, to: &mut [u16]) -> () =
            _mm256_storeu_si256(first_mut::<_, N>(to).as_mut_ptr().cast(), _mm512_cvtepi32_epi16(value));
        store_where(mask: Mask, value: Float, to: &mut [f32]) -> () =
            _mm512_mask_storeu_ps(first_mut::<_, N>(to).as_mut_ptr(), mask, value);
        store_words_where(mask: Mask, value: Word, to: &mut [u32]) -> () =
            _mm512_mask_storeu_epi32(first_mut::<_, N>(to).as_mut_ptr().cast(), mask, value);
    }
}
