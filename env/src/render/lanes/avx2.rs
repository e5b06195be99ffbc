//! Eight lanes, with AVX2.
#![expect(
    unsafe_code,
    reason = "intrinsics of an instruction set: every call rests on the token, every pointer on a slice of checked length"
)]

use std::arch::x86_64::*;

use super::{Lanes, first, first_mut, operations};

/// Proof that the CPU has AVX2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    /// The proof, if this CPU has AVX2.
    pub(crate) fn detect() -> Option<Self> {
        std::arch::is_x86_feature_detected!("avx2").then_some(Self(()))
    }
}

const N: usize = 8;
type Float = __m256;
type Word = __m256i;
type Mask = __m256;

impl Lanes for Avx2 {
    const N: usize = N;
    type Float = Float;
    type Word = Word;
    type Mask = Mask;

    operations! { intrinsics:
        splat(value: f32) -> Float = _mm256_set1_ps(value);
        count_up() -> Float = _mm256_setr_ps(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0);
        load(from: &[f32]) -> Float = _mm256_loadu_ps(first::<_, N>(from).as_ptr());
        store(value: Float, to: &mut [f32]) -> () = _mm256_storeu_ps(first_mut::<_, N>(to).as_mut_ptr(), value);
        add(a: Float, b: Float) -> Float = _mm256_add_ps(a, b);
        sub(a: Float, b: Float) -> Float = _mm256_sub_ps(a, b);
        mul(a: Float, b: Float) -> Float = _mm256_mul_ps(a, b);
        div(a: Float, b: Float) -> Float = _mm256_div_ps(a, b);
        min(a: Float, b: Float) -> Float = _mm256_min_ps(a, b);
        max(a: Float, b: Float) -> Float = _mm256_max_ps(a, b);
        at_least(a: Float, b: Float) -> Mask = _mm256_cmp_ps::<_CMP_GE_OQ>(a, b);
        above(a: Float, b: Float) -> Mask = _mm256_cmp_ps::<_CMP_GT_OQ>(a, b);
        same(a: Float, b: Float) -> Mask = _mm256_cmp_ps::<_CMP_EQ_OQ>(a, b);
        root(a: Float) -> Float = _mm256_sqrt_ps(a);
        both(a: Mask, b: Mask) -> Mask = _mm256_and_ps(a, b);
        bits(mask: Mask) -> u32 = _mm256_movemask_ps(mask) as u32;
        select(mask: Mask, a: Float, b: Float) -> Float = _mm256_blendv_ps(b, a, mask);

        splat_word(value: u32) -> Word = _mm256_set1_epi32(value as i32);
        load_words(from: &[u32]) -> Word = _mm256_loadu_si256(first::<_, N>(from).as_ptr().cast());
        store_words(value: Word, to: &mut [u32]) -> () =
            _mm256_storeu_si256(first_mut::<_, N>(to).as_mut_ptr().cast(), value);
        select_words(mask: Mask, a: Word, b: Word) -> Word = _mm256_blendv_epi8(b, a, _mm256_castps_si256(mask));
        or(a: Word, b: Word) -> Word = _mm256_or_si256(a, b);
        xor(a: Word, b: Word) -> Word = _mm256_xor_si256(a, b);
        and(a: Word, b: Word) -> Word = _mm256_and_si256(a, b);
        equal(a: Word, b: Word) -> Mask = _mm256_castsi256_ps(_mm256_cmpeq_epi32(a, b));
        shift_left(value: Word, bits: u32) -> Word = _mm256_sll_epi32(value, _mm_cvtsi32_si128(bits as i32));
        shift_right(value: Word, bits: u32) -> Word = _mm256_srl_epi32(value, _mm_cvtsi32_si128(bits as i32));
        shift_byte(value: Word) -> Word = _mm256_slli_epi32::<8>(value);
        has_bit(value: Word, bit: u32) -> Mask = {
            let only = _mm256_set1_epi32(1 << bit);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(_mm256_and_si256(value, only), only))
        };
        has_any(value: Word, bits: u32) -> Mask = {
            let masked = _mm256_and_si256(value, _mm256_set1_epi32(bits as i32));
            let none = _mm256_cmpeq_epi32(masked, _mm256_setzero_si256());
            _mm256_castsi256_ps(_mm256_xor_si256(none, _mm256_set1_epi32(-1)))
        };
        modulate(a: Word, b: Word) -> Word = {
            let (zero, half) = (_mm256_setzero_si256(), _mm256_set1_epi16(64));
            let low = _mm256_mullo_epi16(_mm256_unpacklo_epi8(a, zero), _mm256_unpacklo_epi8(b, zero));
            let high = _mm256_mullo_epi16(_mm256_unpackhi_epi8(a, zero), _mm256_unpackhi_epi8(b, zero));
            _mm256_packus_epi16(
                _mm256_srli_epi16::<7>(_mm256_add_epi16(low, half)),
                _mm256_srli_epi16::<7>(_mm256_add_epi16(high, half)),
            )
        };
        mix(a: Word, b: Word, share: Word) -> Word = {
            let (zero, max) = (_mm256_setzero_si256(), _mm256_set1_epi16(255));
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
                _mm256_srli_epi16::<8>(_mm256_add_epi16(low, max)),
                _mm256_srli_epi16::<8>(_mm256_add_epi16(high, max)),
            )
        };
        gather(table: &[u32], at: Word) -> Word = {
            assert!(!table.is_empty(), "the table is empty");
            let last = _mm256_set1_epi32((table.len() - 1).min(i32::MAX as usize) as i32);
            // Clamps indices to the last word of the table.
            _mm256_i32gather_epi32::<4>(table.as_ptr().cast(), _mm256_min_epu32(at, last))
        };
        gather_grouped(table: &[u32], at: Word, group: u32) -> Word = {
            assert!(!table.is_empty(), "the table is empty");
            let last = _mm256_set1_epi32((table.len() - 1).min(i32::MAX as usize) as i32);
            // Clamps indices to the last word of the table.
            let at = _mm256_min_epu32(at, last);
            if group < 2 {
                _mm256_i32gather_epi32::<4>(table.as_ptr().cast(), at)
            } else {
                let (few, all) = if group == 2 {
                    (_mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6), _mm256_setr_epi32(0, 0, 1, 1, 2, 2, 3, 3))
                } else {
                    (_mm256_setr_epi32(0, 4, 0, 4, 0, 4, 0, 4), _mm256_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1))
                };
                let few = _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(at, few));
                let found = _mm_i32gather_epi32::<4>(table.as_ptr().cast(), few);
                _mm256_permutevar8x32_epi32(_mm256_castsi128_si256(found), all)
            }
        };
        power_of_two(value: Float) -> Float = _mm256_and_ps(value, _mm256_castsi256_ps(_mm256_set1_epi32(0x7F80_0000)));
        truncate(value: Float) -> Word = _mm256_cvttps_epi32(value);
        float(value: Word) -> Float = _mm256_cvtepi32_ps(value);

        store_rgb(value: Word, to: &mut [u8]) -> () = {
            let to: &mut [u8; 3 * N] = to.first_chunk_mut().expect("callers pass three bytes per lane");
            // Drops every fourth byte within each half, then joins the halves.
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
        };
        store_bytes(value: Word, to: &mut [u8]) -> () = {
            let to: &mut [u8; N] = first_mut(to);
            // Moves each half's bytes into its first word, then joins the words.
            let halves = _mm256_shuffle_epi8(value, _mm256_set1_epi32(0x0C08_0400));
            let packed = _mm256_permutevar8x32_epi32(halves, _mm256_setr_epi32(0, 4, 0, 4, 0, 4, 0, 4));
            _mm_storel_epi64(to.as_mut_ptr().cast(), _mm256_castsi256_si128(packed));
        };
        store_halves(value: Word, to: &mut [u16]) -> () = {
            let to: &mut [u16; N] = first_mut(to);
            let packed = _mm256_permute4x64_epi64::<0b1000>(_mm256_packus_epi32(value, value));
            _mm_storeu_si128(to.as_mut_ptr().cast(), _mm256_castsi256_si128(packed));
        };
        store_where(mask: Mask, value: Float, to: &mut [f32]) -> () =
            _mm256_maskstore_ps(first_mut::<_, N>(to).as_mut_ptr(), _mm256_castps_si256(mask), value);
        store_words_where(mask: Mask, value: Word, to: &mut [u32]) -> () =
            _mm256_maskstore_epi32(first_mut::<_, N>(to).as_mut_ptr().cast(), _mm256_castps_si256(mask), value);
    }
}
