//! Numbers rounded as everywhere, however another library has set the calling thread.

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use std::arch::asm;

use pyo3::prelude::*;

/// Does work without the interpreter's lock, and with numbers rounded to the nearest and small ones kept.
pub(crate) fn detach<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> T {
    py.detach(|| usually_rounded(work))
}

/// Does work with numbers rounded to the nearest and small ones kept, as a thread begins; threads begun by the work have that, too.
/// Afterwards the thread rounds as it did before.
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
    /// All exceptions masked, rounding to the nearest, small numbers kept.
    pub(super) const USUAL: Control = 0x1f80;
    /// What computing leaves there.
    pub(super) const FLAGS: Control = 0x3f;

    #[expect(unsafe_code, reason = "no safe function reads the register")]
    pub(super) fn get() -> Control {
        let mut found = 0;
        // SAFETY: Four bytes are written to where `found` is; nothing else changes.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut found, options(nostack, preserves_flags)) };
        found
    }

    #[expect(unsafe_code, reason = "no safe function sets the register")]
    pub(super) fn set(control: Control) {
        // SAFETY: The four bytes are read; the value is the usual one, or one that was there before.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const control, options(nostack, preserves_flags)) };
    }
}

#[cfg(target_arch = "aarch64")]
mod control {
    //! The register FPCR.
    use super::asm;

    pub(super) type Control = u64;
    /// No exceptions trapped, rounding to the nearest, small numbers kept.
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
        // SAFETY: The value is the usual one, or one that was there before.
        unsafe { asm!("msr fpcr, {}", in(reg) control, options(nostack, preserves_flags)) };
    }
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod control {
    //! Other machines: the register is left alone.
    pub(super) type Control = u32;
    pub(super) const USUAL: Control = 0;
    pub(super) const FLAGS: Control = 0;

    pub(super) fn get() -> Control {
        USUAL
    }

    pub(super) fn set(_: Control) {}
}

use control::{Control, FLAGS, USUAL, get, set};
