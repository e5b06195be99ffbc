//! `Cargo.lock`: which versions are built, with their checksums. Read here by its lines, which Cargo writes in one
//! form.

use std::fs;

use crate::error::XtaskError;
use crate::workspace::Workspace;

/// A package of the lock file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Locked {
    pub(crate) name: String,
    pub(crate) version: String,
    /// SHA-256 of what the registry hands out; none for our own crates.
    pub(crate) checksum: Option<String>,
}

/// Every package of the lock file.
pub(crate) fn locked(workspace: &Workspace) -> Result<Vec<Locked>, XtaskError> {
    let path = workspace.root.join("Cargo.lock");
    let text = fs::read_to_string(&path).map_err(|source| XtaskError::File { path, source })?;
    Ok(read(&text))
}

fn read(text: &str) -> Vec<Locked> {
    let packages = text.split("[[package]]\n").skip(1);
    let of = |package: &str, key: &str| {
        let prefix = format!("{key} = \"");
        let line = package.lines().find_map(|line| line.strip_prefix(prefix.as_str()))?;
        Some(line.trim_end_matches('"').to_owned())
    };
    packages
        .filter_map(|package| {
            Some(Locked {
                name: of(package, "name")?,
                version: of(package, "version")?,
                checksum: of(package, "checksum"),
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_read_with_and_without_a_checksum() {
        let text = "version = 4\n\n[[package]]\nname = \"a\"\nversion = \"1.0.0\"\nsource = \"registry+x\"\nchecksum = \"ab\"\n\
                    dependencies = [\n \"b\",\n]\n\n[[package]]\nname = \"b\"\nversion = \"0.1.0\"\n";
        let package = |name: &str, version: &str, checksum: Option<&str>| Locked {
            name: name.to_owned(),
            version: version.to_owned(),
            checksum: checksum.map(str::to_owned),
        };
        assert_eq!(
            read(text),
            [package("a", "1.0.0", Some("ab")), package("b", "0.1.0", None)]
        );
    }
}
