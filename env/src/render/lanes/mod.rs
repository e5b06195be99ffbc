//! Several pixels or triangles at a time: the operations that the renderer is made of, for each instruction set.
//! What is drawn with them is in the files beside this folder.
//!
//! Every set rounds alike: no fused multiply-add, the same order, IEEE division and square root. So one scene gives the same
//! pixels on every machine, and a test holds all sets of the machine against each other.
//!
//! Code between these operations avoids closures: they are functions without the instruction set, and the compiler then
//! calls each operation instead of putting it in place (measured: three times slower).

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod portable;

#[cfg(target_arch = "x86_64")]
pub(super) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(super) use avx512::Avx512;
pub(super) use portable::Portable;

/// The most lanes that any set has: buffers are padded to it.
pub(super) const MOST_LANES: usize = crate::assets::BLOCK;

/// Vectors of `N` numbers and what can be done with them.
///
/// A value of the implementing type is the proof that the processor knows its instructions.
/// Methods that take slices use their first `N` elements and panic on shorter ones.
pub(super) trait Lanes: Copy {
    /// How many numbers a vector holds.
    const N: usize;
    /// `N` floats.
    type Float: Copy;
    /// `N` words of 32 bits.
    type Word: Copy;
    /// `N` answers.
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
    /// The lesser; `b` where either is not a number.
    fn min(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// The greater; `b` where either is not a number.
    fn max(self, a: Self::Float, b: Self::Float) -> Self::Float;
    fn at_least(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    fn above(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    fn root(self, a: Self::Float) -> Self::Float;
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// One bit for each lane, the first lane's lowest.
    fn bits(self, mask: Self::Mask) -> u32;
    /// `a` where the mask holds, else `b`.
    fn select(self, mask: Self::Mask, a: Self::Float, b: Self::Float) -> Self::Float;

    fn splat_word(self, value: u32) -> Self::Word;
    fn load_words(self, from: &[u32]) -> Self::Word;
    fn store_words(self, value: Self::Word, to: &mut [u32]);
    fn select_words(self, mask: Self::Mask, a: Self::Word, b: Self::Word) -> Self::Word;
    fn or(self, a: Self::Word, b: Self::Word) -> Self::Word;
    fn xor(self, a: Self::Word, b: Self::Word) -> Self::Word;
    /// One byte to the left.
    fn shift_byte(self, value: Self::Word) -> Self::Word;
    /// Where the bit of this number is set.
    fn has_bit(self, value: Self::Word, bit: u32) -> Self::Mask;
    /// Floats cut to whole numbers; they must be within ±2³¹.
    fn truncate(self, value: Self::Float) -> Self::Word;
    /// Words, as signed numbers, as floats.
    fn float(self, value: Self::Word) -> Self::Float;

    /// The lowest three bytes of each word, `3 * N` bytes in all.
    fn store_rgb(self, value: Self::Word, to: &mut [u8]);

    /// `a * b + c`, rounded twice.
    #[inline(always)]
    fn mul_add(self, a: Self::Float, b: Self::Float, c: Self::Float) -> Self::Float {
        self.add(self.mul(a, b), c)
    }

    /// Stores where the mask holds and keeps the rest.
    #[inline(always)]
    fn store_where(self, mask: Self::Mask, value: Self::Float, to: &mut [f32]) {
        let kept = self.load(to);
        self.store(self.select(mask, value, kept), to);
    }

    /// Stores where the mask holds and keeps the rest.
    #[inline(always)]
    fn store_words_where(self, mask: Self::Mask, value: Self::Word, to: &mut [u32]) {
        let kept = self.load_words(to);
        self.store_words(self.select_words(mask, value, kept), to);
    }
}
