//! The operations that are one intrinsic in every instruction set of x86-64, written once. What differs between sets
//! is in their own files: the names of the intrinsics, which no macro of the language can put together, and what one set
//! does in one instruction and another in several.

/// Implements [`Lanes`](super::Lanes) by the intrinsics that are named, for a type whose values prove that the
/// processor has them; what differs between sets is added as it stands.
macro_rules! lanes_by_intrinsics {
    (
        $set:ident: $count:literal lanes of $float:ident, $word:ident, $mask:ident;
        memory: $load:ident, $store:ident, $load_words:ident, $store_words:ident, $splat_word:ident;
        calls: {
            $($name:ident($($operand:ident: $from:ty),*) -> $to:ty = $by:ident$(::<$constant:tt>)?($($given:ident),*);)*
        }
        $($own:item)*
    ) => {
        const N: usize = $count;

        /// The first lanes of a slice, for reading.
        #[inline(always)]
        fn first<T>(from: &[T]) -> &[T; N] {
            from.first_chunk()
                .expect("callers hand in at least as much as a vector holds")
        }

        /// The first lanes of a slice, for writing.
        #[inline(always)]
        fn first_mut<T>(to: &mut [T]) -> &mut [T; N] {
            to.first_chunk_mut()
                .expect("callers hand in at least as much as a vector holds")
        }

        // SAFETY of all blocks below: a value of the set exists only where the processor has its instructions, and each
        // pointer is that of an array of exactly as many elements as the instruction reads or writes; none needs
        // alignment.
        impl Lanes for $set {
            const N: usize = N;
            type Float = $float;
            type Word = $word;
            type Mask = $mask;

            $(
                #[inline(always)]
                fn $name(self, $($operand: $from),*) -> $to {
                    // SAFETY: above.
                    unsafe { $by$(::<$constant>)?($($given),*) }
                }
            )*
            #[inline(always)]
            fn splat_word(self, value: u32) -> $word {
                // SAFETY: above.
                unsafe { $splat_word(value as i32) }
            }
            #[inline(always)]
            fn load(self, from: &[f32]) -> $float {
                // SAFETY: above.
                unsafe { $load(first(from).as_ptr()) }
            }
            #[inline(always)]
            fn store(self, value: $float, to: &mut [f32]) {
                // SAFETY: above.
                unsafe { $store(first_mut(to).as_mut_ptr(), value) }
            }
            #[inline(always)]
            fn load_words(self, from: &[u32]) -> $word {
                // SAFETY: above.
                unsafe { $load_words(first(from).as_ptr().cast()) }
            }
            #[inline(always)]
            fn store_words(self, value: $word, to: &mut [u32]) {
                // SAFETY: above.
                unsafe { $store_words(first_mut(to).as_mut_ptr().cast(), value) }
            }
            $($own)*
        }
    };
}

pub(super) use lanes_by_intrinsics;
