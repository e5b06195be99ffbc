//! Selects how much is tested: by default the quick tier, or everything with `DRIFTWORLD_FULL=1`, as set by
//! `cargo xtask test --all`. Each crate includes this file as its module `tier`.

/// The first value in the quick tier, the second with `DRIFTWORLD_FULL=1`.
pub(crate) fn quick_or_full<T>(quick: T, full: T) -> T {
    if std::env::var_os("DRIFTWORLD_FULL").is_some() {
        full
    } else {
        quick
    }
}
