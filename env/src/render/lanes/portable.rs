//! Lanes as plain arrays for any CPU; the compiler vectorises them where it can.

use super::{Lanes, first, first_mut, operations};

/// Four lanes that need no special instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Portable;

const N: usize = 4;
type Float = [f32; N];
type Word = [u32; N];
type Mask = [bool; N];

#[inline(always)]
fn map<A: Copy, B: Copy, C>(a: [A; N], b: [B; N], f: impl Fn(A, B) -> C) -> [C; N] {
    std::array::from_fn(|k| f(a[k], b[k]))
}

impl Lanes for Portable {
    const N: usize = N;
    type Float = Float;
    type Word = Word;
    type Mask = Mask;

    operations! { plain:
        splat(value: f32) -> Float = [value; N];
        count_up() -> Float = std::array::from_fn(|k| k as f32);
        load(from: &[f32]) -> Float = *first(from);
        store(value: Float, to: &mut [f32]) -> () = *first_mut(to) = value;
        add(a: Float, b: Float) -> Float = map(a, b, |a, b| a + b);
        sub(a: Float, b: Float) -> Float = map(a, b, |a, b| a - b);
        mul(a: Float, b: Float) -> Float = map(a, b, |a, b| a * b);
        div(a: Float, b: Float) -> Float = map(a, b, |a, b| a / b);
        min(a: Float, b: Float) -> Float = map(a, b, |a, b| if a < b { a } else { b });
        max(a: Float, b: Float) -> Float = map(a, b, |a, b| if a > b { a } else { b });
        at_least(a: Float, b: Float) -> Mask = map(a, b, |a, b| a >= b);
        above(a: Float, b: Float) -> Mask = map(a, b, |a, b| a > b);
        same(a: Float, b: Float) -> Mask = map(a, b, |a, b| a == b);
        root(a: Float) -> Float = a.map(f32::sqrt);
        both(a: Mask, b: Mask) -> Mask = map(a, b, |a, b| a & b);
        bits(mask: Mask) -> u32 = (0..N).fold(0, |bits, k| bits | (u32::from(mask[k]) << k));
        select(mask: Mask, a: Float, b: Float) -> Float = std::array::from_fn(|k| if mask[k] { a[k] } else { b[k] });

        splat_word(value: u32) -> Word = [value; N];
        load_words(from: &[u32]) -> Word = *first(from);
        store_words(value: Word, to: &mut [u32]) -> () = *first_mut(to) = value;
        select_words(mask: Mask, a: Word, b: Word) -> Word =
            std::array::from_fn(|k| if mask[k] { a[k] } else { b[k] });
        or(a: Word, b: Word) -> Word = map(a, b, |a, b| a | b);
        xor(a: Word, b: Word) -> Word = map(a, b, |a, b| a ^ b);
        and(a: Word, b: Word) -> Word = map(a, b, |a, b| a & b);
        equal(a: Word, b: Word) -> Mask = map(a, b, |a, b| a == b);
        shift_left(value: Word, bits: u32) -> Word = value.map(|word| word << bits);
        shift_right(value: Word, bits: u32) -> Word = value.map(|word| word >> bits);
        shift_byte(value: Word) -> Word = value.map(|word| word << 8);
        has_bit(value: Word, bit: u32) -> Mask = value.map(|word| word & (1 << bit) != 0);
        has_any(value: Word, bits: u32) -> Mask = value.map(|word| word & bits != 0);
        modulate(a: Word, b: Word) -> Word = map(a, b, |a, b| {
            let byte = |shift: u32| (((a >> shift & 255) * (b >> shift & 255) + 64) >> 7).min(255) << shift;
            byte(0) | byte(8) | byte(16) | byte(24)
        });
        mix(a: Word, b: Word, share: Word) -> Word = std::array::from_fn(|k| {
            let byte = |shift: u32| {
                let (a, b, share) = (a[k] >> shift & 255, b[k] >> shift & 255, share[k] >> shift & 255);
                ((a * (255 - share) + b * share + 255) >> 8) << shift
            };
            byte(0) | byte(8) | byte(16) | byte(24)
        });
        gather(table: &[u32], at: Word) -> Word = at.map(|at| table[(at as usize).min(table.len() - 1)]);
        gather_grouped(table: &[u32], at: Word, group: u32) -> Word = {
            let word = |lane: usize| table[(at[lane] as usize).min(table.len() - 1)];
            match group {
                4 => [word(0); N],
                2 => {
                    let [low, high] = [word(0), word(2)];
                    [low, low, high, high]
                }
                _ => std::array::from_fn(word),
            }
        };
        power_of_two(value: Float) -> Float = value.map(|float| f32::from_bits(float.to_bits() & 0x7F80_0000));
        truncate(value: Float) -> Word = value.map(|float| float as i32 as u32);
        float(value: Word) -> Float = value.map(|word| word as i32 as f32);

        store_rgb(value: Word, to: &mut [u8]) -> () =
            for (pixel, word) in to[..3 * N].as_chunks_mut::<3>().0.iter_mut().zip(value) {
                let [red, green, blue, _] = word.to_le_bytes();
                *pixel = [red, green, blue];
            };
        store_bytes(value: Word, to: &mut [u8]) -> () = *first_mut(to) = value.map(|word| word as u8);
        store_halves(value: Word, to: &mut [u16]) -> () = *first_mut(to) = value.map(|word| word as u16);
    }
}
