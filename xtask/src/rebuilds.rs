//! The `rebuilds` stage: no crate of others lies in the build folder twice under one profile. Twice means that two parts of the house asked
//! different features of it, and everybody waits for it twice; `features/Cargo.toml` is where they are made one.

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::path::Path;

use crate::error::XtaskError;
use crate::outcome::Outcome;
use crate::workspace::Workspace;

/// Set, it turns "found some" into a failure: in a folder that was empty, nothing older can be meant.
const REQUIRE: &str = "DRIFTWORLD_REQUIRE_NO_REBUILDS";

/// The folders that profiles build into.
const PROFILES: [&str; 3] = ["debug", "release", "dist"];

/// Looks through the build folder, after all that the other stages built into it.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome, XtaskError> {
    let mut built = 0;
    let mut twice = Vec::new();
    for profile in PROFILES {
        let folder = workspace.target.join(profile).join("deps");
        if !folder.is_dir() {
            continue;
        }
        let builds = builds(&folder)?;
        built += builds.len();
        let often = builds.into_iter().filter(|(_, times)| *times > 1);
        twice.extend(often.map(|(package, times)| format!("{package} ({times} times in {profile})")));
    }
    if twice.is_empty() {
        return Ok(Outcome::PassedWith(format!(
            "{built} crates of others, each built once"
        )));
    }
    let twice = twice.join(", ");
    if env::var_os(REQUIRE).is_some() {
        return Err(XtaskError::BuiltTwice { packages: twice });
    }
    Ok(Outcome::Skipped(format!(
        "built more than once, maybe long ago: {twice}; `cargo clean` and run again to know"
    )))
}

/// How many times each library of another's package lies in a folder, as `name-version`. What is only checked leaves no library.
fn builds(folder: &Path) -> Result<BTreeMap<String, usize>, XtaskError> {
    let failed = |source| XtaskError::File {
        path: folder.to_owned(),
        source,
    };
    let mut builds = BTreeMap::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let is_library = path
            .extension()
            .is_some_and(|ending| ending == "rlib" || ending == "so");
        let stem = path
            .file_stem()
            .and_then(|stem| stem.to_str())
            .and_then(|stem| stem.strip_prefix("lib"));
        let Some(stem) = stem.filter(|_| is_library) else {
            continue;
        };
        // What it was made of stands in the file beside it.
        let sources = fs::read_to_string(folder.join(stem).with_extension("d")).unwrap_or_default();
        if let Some(package) = package(&sources) {
            *builds.entry(package).or_insert(0) += 1;
        }
    }
    Ok(builds)
}

/// The package below Cargo's registry that the first source in a list for `make` belongs to.
fn package(sources: &str) -> Option<String> {
    let (_, below) = sources.split_once("/registry/src/")?;
    Some(below.split('/').nth(1)?.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_of_others_are_counted_by_package() {
        let folder = env::temp_dir().join(format!("xtask-rebuilds-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        let registry = "/home/user/.cargo/registry/src/index-0a1b";
        for (library, package) in [
            ("liba-1.rlib", "a-1.0.0"),
            ("liba-2.rlib", "a-1.0.0"),
            ("liba-3.so", "a-2.0.0"),
        ] {
            write(library, "");
            let list = Path::new(library.trim_start_matches("lib")).with_extension("d");
            write(
                &list.to_string_lossy(),
                &format!("x.d: {registry}/{package}/src/lib.rs\n"),
            );
        }
        // Only checked, and one of ours.
        write("liba-4.rmeta", "");
        write("a-4.d", &format!("x.d: {registry}/a-1.0.0/src/lib.rs\n"));
        write("libours-5.rlib", "");
        write("ours-5.d", "x.d: ours/src/lib.rs\n");
        let found = builds(&folder).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        let expected = [("a-1.0.0".to_owned(), 2), ("a-2.0.0".to_owned(), 1)];
        assert_eq!(found, BTreeMap::from(expected));
    }
}
