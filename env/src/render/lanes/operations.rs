//! A macro for listing the operations of an instruction set, one per line.

/// Defines functions of an `impl` of [`Lanes`](super::Lanes), each by an expression for its result. Functions under
/// `intrinsics` may use instructions that only some CPUs have; the set's values prove that this CPU has them.
macro_rules! operations {
    (plain: $($name:ident($($operand:ident: $from:ty),*) -> $to:ty = $made:expr;)*) => {
        $(
            #[inline(always)]
            fn $name(self, $($operand: $from),*) -> $to {
                $made
            }
        )*
    };
    (intrinsics: $($name:ident($($operand:ident: $from:ty),*) -> $to:ty = $made:expr;)*) => {
        $(
            #[inline(always)]
            fn $name(self, $($operand: $from),*) -> $to {
                // SAFETY: a value of the set exists only if the CPU has its instructions, and each pointer is to an array of at
                // least as many elements as the instruction reads or writes; none needs alignment.
                unsafe { $made }
            }
        )*
    };
}

pub(super) use operations;
