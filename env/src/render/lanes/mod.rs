//! SIMD operations for the renderer, for each instruction set.
//!
//! All instruction sets round the same way: they use no fused multiply-add, the same order of operations, and IEEE division and
//! square root. So a scene gives the same pixels on every machine. A test compares all sets that the CPU has. Code between
//! these operations avoids closures. Closures lack the target feature, so the compiler calls each operation instead of inlining
//! it, which is three times slower.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod operations;
mod portable;

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(super) use avx512::Avx512;
use operations::operations;
pub(super) use portable::Portable;

/// Maximum number of lanes of any set; buffers are padded to it.
pub(super) const MAX_LANES: usize = crate::assets::BLOCK;

/// The first `N` elements of a slice, for reading.
#[inline(always)]
fn first<T, const N: usize>(from: &[T]) -> &[T; N] {
    from.first_chunk().expect(TOO_SHORT)
}

/// The first `N` elements of a slice, for writing.
#[inline(always)]
fn first_mut<T, const N: usize>(to: &mut [T]) -> &mut [T; N] {
    to.first_chunk_mut().expect(TOO_SHORT)
}

const TOO_SHORT: &str = "callers pass at least one vector";

/// Vectors of `N` numbers and their operations.
///
/// A value of the implementing type proves that the CPU supports the instructions.
/// Methods that take slices use their first `N` elements and panic on shorter ones.
pub(super) trait Lanes: Copy {
    /// Numbers per vector.
    const N: usize;
    /// `N` floats.
    type Float: Copy;
    /// `N` words of 32 bits.
    type Word: Copy;
    /// `N` booleans.
    type Mask: Copy;

    fn splat(self, value: f32) -> Self::Float;
    /// 0, 1, 2, …
    fn count_up(self) -> Self::Float;
    fn load(self, from: &[f32]) -> Self::Float;
    fn store(self, value: Self::Float, to: &mut [f32]);
    fn add(self, a: Self::Float, b: Self::Float) -> Self::Float;
    fn sub(self, a: Self::Float, b: Self::Float) -> Self::Float;
    fn mul(self, a: Self::Float, b: Self::Float) -> Self::Float;
    fn div(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// The smaller number; `b` if either is NaN.
    fn min(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// The larger number; `b` if either is NaN.
    fn max(self, a: Self::Float, b: Self::Float) -> Self::Float;
    fn at_least(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    fn above(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    /// Whether both are equal.
    fn same(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    fn root(self, a: Self::Float) -> Self::Float;
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// One bit per lane, the first lane's lowest.
    fn bits(self, mask: Self::Mask) -> u32;
    /// `a` where the mask holds, otherwise `b`.
    fn select(self, mask: Self::Mask, a: Self::Float, b: Self::Float) -> Self::Float;

    fn splat_word(self, value: u32) -> Self::Word;
    fn load_words(self, from: &[u32]) -> Self::Word;
    fn store_words(self, value: Self::Word, to: &mut [u32]);
    fn select_words(self, mask: Self::Mask, a: Self::Word, b: Self::Word) -> Self::Word;
    fn or(self, a: Self::Word, b: Self::Word) -> Self::Word;
    fn xor(self, a: Self::Word, b: Self::Word) -> Self::Word;
    fn and(self, a: Self::Word, b: Self::Word) -> Self::Word;
    /// Whether both are equal.
    fn equal(self, a: Self::Word, b: Self::Word) -> Self::Mask;
    /// Shifts left by `bits`, less than 32.
    fn shift_left(self, value: Self::Word, bits: u32) -> Self::Word;
    /// Shifts right by `bits`, less than 32, filling with zeros.
    fn shift_right(self, value: Self::Word, bits: u32) -> Self::Word;
    /// Shifts left by one byte.
    fn shift_byte(self, value: Self::Word) -> Self::Word;
    /// Whether this bit is set.
    fn has_bit(self, value: Self::Word, bit: u32) -> Self::Mask;
    /// Whether any of these bits is set.
    fn has_any(self, value: Self::Word, bits: u32) -> Self::Mask;
    /// Multiplies bytes, where 128 in `b` means 1; capped at 255.
    fn modulate(self, a: Self::Word, b: Self::Word) -> Self::Word;
    /// Interpolates bytes: `a` where the byte of `share` is 0, `b` where it is 255.
    fn mix(self, a: Self::Word, b: Self::Word, share: Self::Word) -> Self::Word;
    /// The words of a table at these indices; the last one for indices beyond it.
    ///
    /// # Panics
    /// On an empty table.
    fn gather(self, table: &[u32], at: Self::Word) -> Self::Word;
    /// Like `gather`, where each group of `group` lanes (two or four) has the same index.
    fn gather_grouped(self, table: &[u32], at: Self::Word, group: u32) -> Self::Word;
    /// The largest power of two up to each float, which must be above 0.
    fn power_of_two(self, value: Self::Float) -> Self::Float;
    /// Truncates floats to integers; they must be within ±2³¹.
    fn truncate(self, value: Self::Float) -> Self::Word;
    /// Converts words, as signed integers, to floats.
    fn float(self, value: Self::Word) -> Self::Float;

    /// Stores the lowest three bytes of each word, `3 * N` bytes in total.
    fn store_rgb(self, value: Self::Word, to: &mut [u8]);

    /// Stores the lowest byte of each word.
    fn store_bytes(self, value: Self::Word, to: &mut [u8]);

    /// Stores the lower half of each word, which must be less than 65,536.
    fn store_halves(self, value: Self::Word, to: &mut [u16]);

    /// `a * b + c`, rounded after the product and after the sum.
    #[inline(always)]
    fn mul_add(self, a: Self::Float, b: Self::Float, c: Self::Float) -> Self::Float {
        self.add(self.mul(a, b), c)
    }

    /// Copies the lowest byte of each word into its lowest three bytes; the rest of the word must be 0.
    #[inline(always)]
    fn three_times(self, value: Self::Word) -> Self::Word {
        self.or(value, self.shift_byte(self.or(value, self.shift_byte(value))))
    }

    /// Stores where the mask holds and keeps the rest.
    #[inline(always)]
    fn store_where(self, mask: Self::Mask, value: Self::Float, to: &mut [f32]) {
        let written = self.load(to);
        self.store(self.select(mask, value, written), to);
    }

    /// Stores where the mask holds and keeps the rest.
    #[inline(always)]
    fn store_words_where(self, mask: Self::Mask, value: Self::Word, to: &mut [u32]) {
        let written = self.load_words(to);
        self.store_words(self.select_words(mask, value, written), to);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TABLE: [u32; 12] = [3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8];

    /// The first `count` numbers after a write; checks that the write changes no others.
    fn written<T: Copy + PartialEq>(filler: T, count: usize, write: impl FnOnce(&mut [T])) -> Vec<T> {
        let mut all = [filler; 3 * MAX_LANES + 1];
        write(&mut all);
        assert!(
            all[count..].iter().all(|written| *written == filler),
            "nothing else is written"
        );
        all[..count].to_vec()
    }

    /// Results of every operation on these numbers, vector by vector, which must be the same for all sets.
    fn all_operations<L: Lanes>(lanes: L, a: &[f32], b: &[f32], words: &[u32]) -> Vec<Vec<u32>> {
        let mut all_results: Vec<Vec<u32>> = Vec::new();
        for first in (0..MAX_LANES).step_by(L::N) {
            let mut results = Vec::new();
            let (a, b) = (lanes.load(&a[first..]), lanes.load(&b[first..]));
            let word = lanes.load_words(&words[first..]);
            let (above, at_least) = (lanes.above(a, b), lanes.at_least(a, b));
            let small = lanes.min(lanes.max(a, lanes.splat(-1e6)), lanes.splat(1e6));
            let count = lanes.add(lanes.count_up(), lanes.splat(first as f32));
            let shared = |share: f32| lanes.truncate(lanes.mul_add(count, lanes.splat(share), lanes.splat(6.0)));
            let of_bits = |floats: Vec<f32>| floats.into_iter().map(f32::to_bits).collect::<Vec<u32>>();
            for value in [
                count,
                lanes.add(a, b),
                lanes.sub(a, b),
                lanes.mul(a, b),
                lanes.div(a, b),
                lanes.min(a, b),
                lanes.max(a, b),
                lanes.root(lanes.max(a, lanes.splat(0.0))),
                lanes.mul_add(a, b, a),
                lanes.select(above, a, b),
                lanes.select(lanes.both(above, at_least), b, a),
                lanes.select(lanes.same(a, lanes.float(lanes.truncate(a))), b, a),
                lanes.float(lanes.truncate(small)),
                lanes.float(word),
                lanes.power_of_two(lanes.max(a, lanes.splat(0.125))),
            ] {
                results.push(of_bits(written(7.0, L::N, |to| lanes.store(value, to))));
            }
            results.push(of_bits(written(7.0, L::N, |to| lanes.store_where(above, a, to))));
            for value in [
                lanes.or(word, lanes.splat_word(0x0F0F_00FF)),
                lanes.xor(word, lanes.truncate(small)),
                lanes.shift_byte(word),
                lanes.and(word, lanes.truncate(small)),
                lanes.shift_left(word, 5),
                lanes.shift_right(word, 27),
                lanes.select_words(lanes.has_any(word, 0x0081_0100), word, lanes.splat_word(1)),
                lanes.modulate(word, lanes.xor(word, lanes.splat_word(0x8055_AAFF))),
                lanes.mix(word, lanes.splat_word(0x00FF_8001), lanes.shift_byte(word)),
                lanes.gather(&TABLE, lanes.and(word, lanes.splat_word(15))),
                lanes.gather_grouped(&TABLE, lanes.and(word, lanes.splat_word(15)), 1),
                lanes.gather_grouped(&TABLE, shared(0.5), 2),
                lanes.gather_grouped(&TABLE, shared(0.25), 4),
                lanes.select_words(
                    lanes.equal(lanes.and(word, lanes.splat_word(1)), lanes.splat_word(1)),
                    word,
                    lanes.splat_word(2),
                ),
                lanes.three_times(lanes.and(word, lanes.splat_word(255))),
                lanes.select_words(lanes.has_bit(word, 3), word, lanes.splat_word(1)),
            ] {
                results.push(written(7, L::N, |to| lanes.store_words(value, to)));
            }
            results.push(written(7, L::N, |to| lanes.store_words_where(at_least, word, to)));
            let bits = lanes.bits(above);
            results.push((0..L::N).map(|lane| bits >> lane & 1).collect());
            let rgb = written(7, 3 * L::N, |to| lanes.store_rgb(word, to));
            let bytes = written(7, L::N, |to| lanes.store_bytes(word, to));
            results.extend([rgb, bytes].map(|bytes| bytes.into_iter().map(u32::from).collect()));
            let low = lanes.and(word, lanes.splat_word(0xFFFF));
            let halves = written(7, L::N, |to| lanes.store_halves(low, to));
            results.push(halves.into_iter().map(u32::from).collect());
            all_results.resize(results.len(), Vec::new());
            for (all_results, result) in all_results.iter_mut().zip(results) {
                all_results.extend(result);
            }
        }
        all_results
    }

    #[test]
    fn bytes_are_scaled_and_mixed_independently() {
        let one = |word: [u32; 4]| word[0];
        let splat = |word: u32| Portable.splat_word(word);
        for byte in 0..=255 {
            assert_eq!(
                one(Portable.modulate(splat(byte), splat(128))),
                byte,
                "a factor of 1 changes nothing"
            );
            assert_eq!(
                one(Portable.modulate(splat(byte), splat(255))),
                ((byte * 255 + 64) / 128).min(255)
            );
            let share = |share: u32| one(Portable.mix(splat(byte), splat(200), splat(share)));
            assert_eq!((share(0), share(255)), (byte, 200));
            assert!(share(128).abs_diff(u32::midpoint(byte, 200)) <= 1);
        }
        assert_eq!(
            one(Portable.gather(&TABLE, splat(u32::MAX))),
            8,
            "indices are clamped to the last word"
        );
        assert_eq!(Portable.power_of_two([1.0, 1.9, 2.0, 300.0]), [1.0, 1.0, 2.0, 256.0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn operations_agree_between_instruction_sets(
            a in prop::collection::vec(prop_oneof![-1e3..1e3_f32, Just(0.0), Just(-0.0)], MAX_LANES),
            b in prop::collection::vec(prop_oneof![0.1..1e3_f32, -1e3..-0.1_f32], MAX_LANES),
            words in prop::collection::vec(0..1_u32 << 30, MAX_LANES),
        ) {
            let expected = all_operations(Portable, &a, &b, &words);
            #[cfg(target_arch = "x86_64")]
            {
                if let Some(lanes) = Avx2::detect() {
                    prop_assert_eq!(all_operations(lanes, &a, &b, &words), expected.clone(), "AVX2");
                }
                if let Some(lanes) = Avx512::detect() {
                    prop_assert_eq!(all_operations(lanes, &a, &b, &words), expected.clone(), "AVX-512");
                }
            }
            prop_assert_eq!(expected[0][MAX_LANES - 1], ((MAX_LANES - 1) as f32).to_bits());
        }
    }
}
