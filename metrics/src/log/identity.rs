//! Identifies files and directories, to detect whether one was replaced at its path.

use std::fs::Metadata;

/// The device and file id of a file or directory, which do not depend on its name. On systems without such ids, all are equal.
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
    fn identity_survives_renaming_but_not_copying() {
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
