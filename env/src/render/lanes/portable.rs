//! Lanes as plain arrays, for processors of any kind; the compiler makes vectors of them where it can.

use super::Lanes;

/// Four lanes without any instruction of a particular processor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

const N: usize = 4;

#[inline(always)]
fn map<A: Copy, B: Copy, C>(a: [A; N], b: [B; N], f: impl Fn(A, B) -> C) -> [C; N] {
    std::array::from_fn(|k| f(a[k], b[k]))
}

/// The first lanes of a slice.
#[inline(always)]
fn first<T: Copy>(from: &[T]) -> [T; N] {
    *from
        .first_chunk()
        .expect("callers hand in at least as much as a vector holds")
}

impl Lanes for Portable {
    const N: usize = N;
    type Float = [f32; N];
    type Word = [u32; N];
    type Mask = [bool; N];

    #[inline(always)]
    fn splat(self, value: f32) -> [f32; N] {
        [value; N]
    }
    #[inline(always)]
    fn count_up(self) -> [f32; N] {
        std::array::from_fn(|k| k as f32)
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> [f32; N] {
        first(from)
    }
    #[inline(always)]
    fn store(self, value: [f32; N], to: &mut [f32]) {
        to[..N].copy_from_slice(&value);
    }
    #[inline(always)]
    fn add(self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        map(a, b, |a, b| a + b)
    }
    #[inline(always)]
    fn sub(self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        map(a, b, |a, b| a - b)
    }
    #[inline(always)]
    fn mul(self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        map(a, b, |a, b| a * b)
    }
    #[inline(always)]
    fn div(self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        map(a, b, |a, b| a / b)
    }
    #[inline(always)]
    fn min(self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        map(a, b, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn max(self, a: [f32; N], b: [f32; N]) -> [f32; N] {
        map(a, b, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn at_least(self, a: [f32; N], b: [f32; N]) -> [bool; N] {
        map(a, b, |a, b| a >= b)
    }
    #[inline(always)]
    fn above(self, a: [f32; N], b: [f32; N]) -> [bool; N] {
        map(a, b, |a, b| a > b)
    }
    #[inline(always)]
    fn same(self, a: [f32; N], b: [f32; N]) -> [bool; N] {
        map(a, b, |a, b| a == b)
    }
    #[inline(always)]
    fn root(self, a: [f32; N]) -> [f32; N] {
        a.map(f32::sqrt)
    }
    #[inline(always)]
    fn both(self, a: [bool; N], b: [bool; N]) -> [bool; N] {
        map(a, b, |a, b| a & b)
    }
    #[inline(always)]
    fn bits(self, mask: [bool; N]) -> u32 {
        (0..N).fold(0, |bits, k| bits | (u32::from(mask[k]) << k))
    }
    #[inline(always)]
    fn select(self, mask: [bool; N], a: [f32; N], b: [f32; N]) -> [f32; N] {
        std::array::from_fn(|k| if mask[k] { a[k] } else { b[k] })
    }

    #[inline(always)]
    fn splat_word(self, value: u32) -> [u32; N] {
        [value; N]
    }
    #[inline(always)]
    fn load_words(self, from: &[u32]) -> [u32; N] {
        first(from)
    }
    #[inline(always)]
    fn store_words(self, value: [u32; N], to: &mut [u32]) {
        to[..N].copy_from_slice(&value);
    }
    #[inline(always)]
    fn select_words(self, mask: [bool; N], a: [u32; N], b: [u32; N]) -> [u32; N] {
        std::array::from_fn(|k| if mask[k] { a[k] } else { b[k] })
    }
    #[inline(always)]
    fn or(self, a: [u32; N], b: [u32; N]) -> [u32; N] {
        map(a, b, |a, b| a | b)
    }
    #[inline(always)]
    fn xor(self, a: [u32; N], b: [u32; N]) -> [u32; N] {
        map(a, b, |a, b| a ^ b)
    }
    #[inline(always)]
    fn and(self, a: [u32; N], b: [u32; N]) -> [u32; N] {
        map(a, b, |a, b| a & b)
    }
    #[inline(always)]
    fn equal(self, a: [u32; N], b: [u32; N]) -> [bool; N] {
        map(a, b, |a, b| a == b)
    }
    #[inline(always)]
    fn shift_left(self, value: [u32; N], bits: u32) -> [u32; N] {
        value.map(|word| word << bits)
    }
    #[inline(always)]
    fn shift_right(self, value: [u32; N], bits: u32) -> [u32; N] {
        value.map(|word| word >> bits)
    }
    #[inline(always)]
    fn modulate(self, a: [u32; N], b: [u32; N]) -> [u32; N] {
        map(a, b, |a, b| {
            let byte = |shift: u32| (((a >> shift & 255) * (b >> shift & 255) + 64) >> 7).min(255) << shift;
            byte(0) | byte(8) | byte(16) | byte(24)
        })
    }
    #[inline(always)]
    fn mix(self, a: [u32; N], b: [u32; N], share: [u32; N]) -> [u32; N] {
        std::array::from_fn(|k| {
            let byte = |shift: u32| {
                let (a, b, share) = (a[k] >> shift & 255, b[k] >> shift & 255, share[k] >> shift & 255);
                ((a * (255 - share) + b * share + 255) >> 8) << shift
            };
            byte(0) | byte(8) | byte(16) | byte(24)
        })
    }
    #[inline(always)]
    fn gather(self, table: &[u32], at: [u32; N]) -> [u32; N] {
        at.map(|at| table[(at as usize).min(table.len() - 1)])
    }
    #[inline(always)]
    fn power_of_two(self, value: [f32; N]) -> [f32; N] {
        value.map(|float| f32::from_bits(float.to_bits() & 0x7F80_0000))
    }
    #[inline(always)]
    fn shift_byte(self, value: [u32; N]) -> [u32; N] {
        value.map(|word| word << 8)
    }
    #[inline(always)]
    fn has_bit(self, value: [u32; N], bit: u32) -> [bool; N] {
        value.map(|word| word & (1 << bit) != 0)
    }
    #[inline(always)]
    fn has_any(self, value: [u32; N], bits: u32) -> [bool; N] {
        value.map(|word| word & bits != 0)
    }
    #[inline(always)]
    fn truncate(self, value: [f32; N]) -> [u32; N] {
        value.map(|float| float as i32 as u32)
    }
    #[inline(always)]
    fn float(self, value: [u32; N]) -> [f32; N] {
        value.map(|word| word as i32 as f32)
    }

    #[inline(always)]
    fn store_rgb(self, value: [u32; N], to: &mut [u8]) {
        for (pixel, word) in to[..3 * N].as_chunks_mut::<3>().0.iter_mut().zip(value) {
            let [red, green, blue, _] = word.to_le_bytes();
            *pixel = [red, green, blue];
        }
    }
    #[inline(always)]
    fn store_bytes(self, value: [u32; N], to: &mut [u8]) {
        to[..N].copy_from_slice(&value.map(|word| word as u8));
    }
    #[inline(always)]
    fn store_halves(self, value: [u32; N], to: &mut [u16]) {
        to[..N].copy_from_slice(&value.map(|word| word as u16));
    }
}
