//! Finds files of the original programs, which are not in this repository. Tests that need an absent file print that they are
//! skipped. Crates include this file as their module `reference_data`.

use std::path::{Path, PathBuf};

/// A file or folder of the reference data; `None`, and a message, if it is absent.
#[expect(clippy::print_stderr, reason = "a skip must be seen")]
pub(crate) fn reference(name: &str) -> Option<PathBuf> {
    // Beside the checkout; the crate is the checkout itself or a folder in it.
    let checkout = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.lock"));
    let up = if checkout.is_file() { "../.." } else { ".." };
    let default = Path::new(env!("CARGO_MANIFEST_DIR")).join(up).join("shared/reference");
    let path = std::env::var_os("DRIFTWORLD_REFERENCE")
        .map_or(default, PathBuf::from)
        .join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("skipped: {} is missing; set DRIFTWORLD_REFERENCE", path.display());
    None
}
