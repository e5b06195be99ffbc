//! Loads memory into the cache before it is used.

/// Asks the processor to load a value into its cache. Does nothing where Rust has no instruction for it.
pub(crate) fn prefetch<T: ?Sized>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T1, _mm_prefetch};
        /// Bytes of a cache line.
        const LINE: usize = 64;
        let start = std::ptr::from_ref(value).cast::<i8>();
        for offset in (0..size_of_val(value)).step_by(LINE) {
            #[expect(unsafe_code, reason = "the intrinsic takes a pointer")]
            // SAFETY: a hint neither reads nor faults, and the address is within the value.
            unsafe {
                _mm_prefetch::<_MM_HINT_T1>(start.wrapping_add(offset));
            }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}
