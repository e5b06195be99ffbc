//! [`Reader`]: the state of reading one reset file: the warnings, and the map from places in the world to places in
//! the file.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use crate::describe::describe;
use crate::warning::Remarks;

#[derive(Default)]
pub(super) struct Reader {
    pub(super) warnings: Remarks,
    /// For each object of the world, its index in the file.
    pub(super) kept: Vec<usize>,
    /// Keys that the file spells differently: maps pointers with our names to pointers into the file.
    pub(super) spelled: BTreeMap<String, String>,
}

impl Reader {
    pub(super) fn warn(&mut self, pointer: impl Into<String>, text: impl Into<String>) {
        self.warnings.push(as_spelled(pointer.into(), &self.spelled), text);
    }

    /// Warns about an unexpected value. `expected` says what was expected and what is assumed.
    pub(super) fn warn_instead(&mut self, pointer: impl Into<String>, found: &Json, expected: &str) {
        self.warn(pointer, format!("found {}, expected {expected}", describe(found)));
    }
}

/// Maps a pointer with our key names to a pointer into the file, where keys may be spelled differently.
pub(super) fn as_spelled(pointer: String, spelled: &BTreeMap<String, String>) -> String {
    let ends = pointer.match_indices('/').map(|(end, _)| end).chain([pointer.len()]);
    let longest_known = ends
        .filter_map(|end| Some((end, spelled.get(&pointer[..end])?)))
        .next_back();
    match longest_known {
        Some((end, place)) => format!("{place}{}", &pointer[end..]),
        None => pointer,
    }
}
