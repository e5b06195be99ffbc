//! The form in which each set of instructions lists its operations: one in a line.

/// Functions of an `impl` of [`Lanes`](super::Lanes), each as what it makes of its operands. Those under `intrinsics` may
/// call what only some processors have, in a set whose values prove that the processor has it.
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
                // SAFETY: a value of the set exists only where the processor has its instructions, and each pointer is
                // that of an array of at least as many elements as the instruction reads or writes; none needs alignment.
                unsafe { $made }
            }
        )*
    };
}

pub(super) use operations;
