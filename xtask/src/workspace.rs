//! Where the workspace and its build folder are, and who its members are. What they import is read in `layers`.

use std::path::PathBuf;

use crate::error::XtaskError;
use crate::metadata::Metadata;

/// The checkout that xtask was called in.
pub(crate) struct Workspace {
    /// The folder of the root `Cargo.toml`.
    pub(crate) root: PathBuf,
    /// Cargo's build folder, inside the root unless a user moved it.
    pub(crate) target: PathBuf,
    metadata: Metadata,
}

impl Workspace {
    /// Asks Cargo, without resolving dependencies: needs no network and no lock file.
    pub(crate) fn load() -> Result<Self, XtaskError> {
        let metadata = Metadata::read(&["--no-deps"])?;
        Ok(Self {
            root: metadata.workspace_root.clone(),
            target: metadata.target_directory.clone(),
            metadata,
        })
    }

    /// Name and folder of every member; the folder is relative to the root and empty for the root package.
    pub(crate) fn members(&self) -> Vec<(String, String)> {
        let folder = |manifest: &PathBuf| {
            let folder = manifest.parent().unwrap_or(manifest);
            let folder = folder.strip_prefix(&self.root).unwrap_or(folder);
            folder.to_string_lossy().replace('\\', "/")
        };
        let members = self.metadata.members();
        members
            .map(|package| (package.name.clone(), folder(&package.manifest_path)))
            .collect()
    }

    /// The names of the root package's examples, sorted.
    pub(crate) fn examples(&self) -> Vec<String> {
        let root = self.root.join("Cargo.toml");
        let root = self.metadata.members().find(|package| package.manifest_path == root);
        let targets = root.map(|package| package.targets.as_slice()).unwrap_or_default();
        let examples = targets
            .iter()
            .filter(|target| target.kind.iter().any(|kind| kind == "example"));
        let mut names: Vec<String> = examples.map(|target| target.name.clone()).collect();
        names.sort();
        names
    }
}
