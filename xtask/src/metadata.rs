//! What `cargo metadata` reports, as far as xtask wants it. Read here and not by a crate made for it, which would ask other features of
//! `serde_json` than the rest of the house does, and have it built twice.

use std::path::PathBuf;

use serde::Deserialize;

use crate::error::XtaskError;
use crate::process::quiet_output;

/// The report on a workspace.
#[derive(Deserialize)]
pub(crate) struct Metadata {
    pub(crate) packages: Vec<Package>,
    pub(crate) workspace_members: Vec<String>,
    pub(crate) workspace_root: PathBuf,
    pub(crate) target_directory: PathBuf,
    resolve: Option<Resolve>,
}

#[derive(Deserialize)]
pub(crate) struct Package {
    pub(crate) id: String,
    pub(crate) name: String,
    pub(crate) manifest_path: PathBuf,
    pub(crate) dependencies: Vec<Dependency>,
    pub(crate) targets: Vec<Target>,
}

/// A line under `[dependencies]` or its kin.
#[derive(Deserialize)]
pub(crate) struct Dependency {
    pub(crate) name: String,
    pub(crate) rename: Option<String>,
    /// `dev`, `build`, or nothing.
    pub(crate) kind: Option<String>,
}

#[derive(Deserialize)]
pub(crate) struct Target {
    pub(crate) name: String,
    pub(crate) kind: Vec<String>,
}

#[derive(Deserialize)]
struct Resolve {
    nodes: Vec<Node>,
}

/// What a package is built from.
#[derive(Deserialize)]
pub(crate) struct Node {
    pub(crate) id: String,
    pub(crate) deps: Vec<Edge>,
}

#[derive(Deserialize)]
pub(crate) struct Edge {
    pub(crate) pkg: String,
    pub(crate) dep_kinds: Vec<EdgeKind>,
}

#[derive(Deserialize)]
pub(crate) struct EdgeKind {
    pub(crate) kind: Option<String>,
}

impl Metadata {
    /// Asks Cargo about the workspace around the current folder, with these arguments more.
    pub(crate) fn read(arguments: &[&str]) -> Result<Self, XtaskError> {
        let mut command = crate::process::bare_cargo();
        command.args(["metadata", "--format-version", "1"]).args(arguments);
        let text = quiet_output(command)?;
        serde_json::from_str(&text).map_err(|source| XtaskError::Metadata { source })
    }

    /// The packages of the workspace itself.
    pub(crate) fn members(&self) -> impl Iterator<Item = &Package> {
        self.packages
            .iter()
            .filter(|package| self.workspace_members.contains(&package.id))
    }

    /// What each package is built from; nothing where dependencies were not asked for.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = &Node> {
        self.resolve.iter().flat_map(|resolve| &resolve.nodes)
    }
}
