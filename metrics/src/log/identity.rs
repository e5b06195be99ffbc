//! Whether what lies at a path is still the file or the directory that was opened there.
//!
//! Not here: what follows if it is not, see `log_folder` and `block_file`.

use std::fs::Metadata;

/// Which file or directory it is, whatever its name: its device and its number there. Equal for all where the system
/// has no such numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Identity(u64, u64);

impl Identity {
    #[cfg(unix)]
    pub(super) fn of(found: &Metadata) -> Self {
        use std::os::unix::fs::MetadataExt;
        Self(found.dev(), found.ino())
    }

    #[cfg(not(unix))]
    pub(super) fn of(_: &Metadata) -> Self {
        Self(0, 0)
    }
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_file_is_itself_under_every_name_and_no_copy_of_it() {
        let base = tempfile::tempdir().unwrap();
        let at = |name: &str| base.path().join(name);
        let of = |name: &str| Identity::of(&fs::metadata(at(name)).unwrap());
        fs::write(at("a"), "text").unwrap();
        let identity = of("a");
        fs::copy(at("a"), at("copy")).unwrap();
        fs::rename(at("a"), at("b")).unwrap();
        assert_eq!(of("b"), identity);
        assert_ne!(of("copy"), identity);
    }
}
