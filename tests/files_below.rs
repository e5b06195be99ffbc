//! Lists the files of a folder, to compare it with an earlier state. Crates include this file as their module `files_below`.

use std::collections::BTreeMap;
use std::path::Path;

/// Every file below a folder by its relative path; none if the folder does not exist.
pub(crate) fn files_below(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if let (Ok(name), Ok(bytes)) = (path.strip_prefix(folder), std::fs::read(&path)) {
                found.insert(name.display().to_string(), bytes);
            }
        }
    }
    found
}
