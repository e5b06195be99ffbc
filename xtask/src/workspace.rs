//! Where the workspace and its build folder are, and who its members are. What they import is read in `layers`.

use cargo_metadata::{Metadata, MetadataCommand, TargetKind};
use std::path::{Path, PathBuf};

use crate::error::XtaskError;

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
        let metadata = MetadataCommand::new()
            .no_deps()
            .exec()
            .map_err(|source| XtaskError::Metadata {
                source: Box::new(source),
            })?;
        Ok(Self {
            root: metadata.workspace_root.clone().into_std_path_buf(),
            target: metadata.target_directory.clone().into_std_path_buf(),
            metadata,
        })
    }

    /// Name and folder of every member; the folder is relative to the root and empty for the root package.
    pub(crate) fn members(&self) -> Vec<(String, String)> {
        let folder = |manifest: &Path| {
            let folder = manifest.parent().unwrap_or(manifest);
            folder
                .strip_prefix(&self.root)
                .unwrap_or(folder)
                .to_string_lossy()
                .replace('\\', "/")
        };
        let packages = self.metadata.workspace_packages();
        packages
            .iter()
            .map(|package| (package.name.to_string(), folder(package.manifest_path.as_std_path())))
            .collect()
    }

    /// The names of the root package's examples, sorted.
    pub(crate) fn examples(&self) -> Vec<String> {
        let targets = self
            .metadata
            .root_package()
            .map(|package| package.targets.as_slice())
            .unwrap_or_default();
        let examples = targets.iter().filter(|target| target.is_kind(TargetKind::Example));
        let mut names: Vec<String> = examples.map(|target| target.name.clone()).collect();
        names.sort();
        names
    }
}
