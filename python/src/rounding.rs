//! Fixes the floating-point mode, because other libraries may have changed it for the calling thread.

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use std::arch::asm;

use pyo3::prelude::*;

/// Runs work without the GIL, rounding to nearest and with denormals.
pub(crate) fn detach<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    py.detach(|| usually_rounded(work))
}

/// Runs work rounding to nearest and with denormals, as in a new thread; threads started by the work inherit that. Afterwards
/// the thread's mode is restored.
pub(crate) fn usually_rounded<T>(work: impl FnOnce() -> T) -> T {
    struct Before(Control);
    impl Drop for Before {
        fn drop(&mut self) {
            set(self.0);
        }
    }
    let before = get();
    if before & !FLAGS == USUAL {
        return work();
    }
    set(USUAL);
    let _before = Before(before);
    work()
}

#[cfg(target_arch = "x86_64")]
mod control {
    //! The register MXCSR.
    use super::asm;

    pub(super) type Control = u32;
    /// All exceptions masked, rounding to nearest, denormals kept.
    pub(super) const USUAL: Control = 0x1f80;
    /// Flags that computations set.
    pub(super) const FLAGS: Control = 0x3f;

    #[expect(unsafe_code, reason = "no safe function reads the register")]
    pub(super) fn get() -> Control {
        let mut found = 0;
        // SAFETY: Four bytes are written to `found`; nothing else changes.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut found, options(nostack, preserves_flags)) };
        found
    }

    #[expect(unsafe_code, reason = "no safe function sets the register")]
    pub(super) fn set(control: Control) {
        // SAFETY: The four bytes are read; the value is the usual one, or one that was read before.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const control, options(nostack, preserves_flags)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod control {
    //! The register FPCR.
    use super::asm;

    pub(super) type Control = u64;
    /// No exceptions trapped, rounding to nearest, denormals kept.
    pub(super) const USUAL: Control = 0;
    /// Flags are in another register.
    pub(super) const FLAGS: Control = 0;

    #[expect(unsafe_code, reason = "no safe function reads the register")]
    pub(super) fn get() -> Control {
        let found;
        // SAFETY: Only the register is read.
        unsafe { asm!("mrs {}, fpcr", out(reg) found, options(nostack, preserves_flags)) };
        found
    }

    #[expect(unsafe_code, reason = "no safe function sets the register")]
    pub(super) fn set(control: Control) {
        // SAFETY: The value is the usual one, or one that was read before.
        unsafe { asm!("msr fpcr, {}", in(reg) control, options(nostack, preserves_flags)) };
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod control {
    //! Other machines: the mode is not changed.
    pub(super) type Control = u32;
    pub(super) const USUAL: Control = 0;
    pub(super) const FLAGS: Control = 0;

    pub(super) fn get() -> Control {
        USUAL
    }

    pub(super) fn set(_: Control) {}
}

use control::{Control, FLAGS, USUAL, get, set};
