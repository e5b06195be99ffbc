//! The stage `rebuilds`: no third-party crate is in the build folder twice under one profile. That happens if two of our crates
//! request different features of it, and makes everybody wait for it twice; `features/Cargo.toml` unifies them.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::process::{Result, Workspace, about};
use crate::stage::{Outcome, missing};

/// Searches the build folder after all other stages have built into it.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome> {
    let mut built = 0;
    let mut twice = Vec::new();
    for profile in ["debug", "release"] {
        let folder = workspace.target.join(profile).join("deps");
        for (package, times) in builds(&folder)? {
            built += 1;
            if times > 1 {
                twice.push(format!("{package} ({times} times in {profile})"));
            }
        }
    }
    if twice.is_empty() {
        return Ok(Outcome::Passed(format!("{built} third-party crates, each built once")));
    }
    let advice = "see who asks which features of it (cargo tree -e features -i CRATE --workspace), and name it with all of them in \
                  features/Cargo.toml; in a build folder that was not empty, it may be long ago";
    missing(
        "NO_REBUILDS",
        format!("built more than once: {}; {advice}", twice.join(", ")),
    )
}

/// Number of builds of each third-party library in a folder, as `name-version`. Checks leave no library.
fn builds(folder: &Path) -> Result<BTreeMap<String, usize>> {
    let mut builds = BTreeMap::new();
    if !folder.exists() {
        return Ok(builds);
    }
    for entry in fs::read_dir(folder).map_err(about(folder))? {
        let path = entry.map_err(about(folder))?.path();
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let stem = name.strip_suffix(".rlib").or_else(|| name.strip_suffix(".so"));
        // Its sources are listed in the file beside it, as a rule for `make`.
        let list = stem
            .and_then(|stem| stem.strip_prefix("lib"))
            .map(|stem| folder.join(format!("{stem}.d")));
        let sources = list.and_then(|list| fs::read_to_string(list).ok()).unwrap_or_default();
        let package = sources
            .split_once("/registry/src/")
            .and_then(|(_, below)| below.split('/').nth(1));
        if let Some(package) = package {
            *builds.entry(package.to_owned()).or_insert(0) += 1;
        }
    }
    Ok(builds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn third_party_libraries_are_counted_by_package() {
        let folder = std::env::temp_dir().join(format!("xtask-rebuilds-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let registry = "x.d: /home/user/.cargo/registry/src/index-0a1b";
        // The fourth was only checked, the fifth is one of ours.
        for (library, list, sources) in [
            ("liba-1.rlib", "a-1.d", format!("{registry}/a-1.0.0/src/lib.rs\n")),
            ("liba-2.rlib", "a-2.d", format!("{registry}/a-1.0.0/src/lib.rs\n")),
            ("liba-3.so", "a-3.d", format!("{registry}/a-2.0.0/src/lib.rs\n")),
            ("liba-4.rmeta", "a-4.d", format!("{registry}/a-1.0.0/src/lib.rs\n")),
            ("libours-5.rlib", "ours-5.d", "x.d: ours/src/lib.rs\n".to_owned()),
        ] {
            fs::write(folder.join(library), "").unwrap();
            fs::write(folder.join(list), sources).unwrap();
        }
        let found = builds(&folder);
        fs::remove_dir_all(&folder).unwrap();
        let expected = [("a-1.0.0".to_owned(), 2), ("a-2.0.0".to_owned(), 1)];
        assert_eq!(found, Ok(BTreeMap::from(expected)));
    }
}
