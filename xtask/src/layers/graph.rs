//! The crates and their imports, read from `cargo metadata` and the manifests. Judges nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use super::inheritance::{self, Entry};
use crate::error::XtaskError;
use crate::metadata::{Dependency, Metadata, Package};

/// The workspace's crates, and the third-party crates below them.
pub(super) struct Graph {
    pub(super) members: Vec<Member>,
    /// Third-party crate to the crates it is built from (dev dependencies left out), with all features on and for
    /// every platform; versions of one crate are taken together.
    pub(super) third_party: BTreeMap<String, Vec<String>>,
}

/// A crate of the workspace.
pub(super) struct Member {
    pub(super) name: String,
    /// Relative to the root.
    pub(super) manifest: String,
    /// As declared, optional and platform-bound ones included, so that no feature set escapes.
    pub(super) imports: Vec<Import>,
}

/// One line under `[dependencies]` or its kin.
pub(super) struct Import {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// In the manifest, from 1.
    pub(super) line: usize,
    /// Whether it says `workspace = true`.
    pub(super) inherits: bool,
}

/// Which of a manifest's three dependency tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Normal,
    Dev,
    Build,
}

impl Kind {
    /// For messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal dependency",
            Self::Dev => "dev dependency",
            Self::Build => "build dependency",
        }
    }
}

impl Graph {
    /// Whether the crate is one of ours.
    pub(super) fn is_member(&self, name: &str) -> bool {
        self.members.iter().any(|member| member.name == name)
    }
}

/// Reads the workspace around the current folder.
pub(super) fn read() -> Result<Graph, XtaskError> {
    let metadata = Metadata::read(&["--all-features"])?;
    let members = metadata.members().map(|package| member(&metadata, package));
    Ok(Graph {
        members: members.collect::<Result<_, _>>()?,
        third_party: third_party(&metadata),
    })
}

fn member(metadata: &Metadata, package: &Package) -> Result<Member, XtaskError> {
    let path = &package.manifest_path;
    let text = fs::read_to_string(path).map_err(|source| XtaskError::File {
        path: path.clone(),
        source,
    })?;
    let entries = inheritance::entries(&text);
    let manifest = path.strip_prefix(&metadata.workspace_root).unwrap_or(path);
    let imports = package
        .dependencies
        .iter()
        .map(|dependency| import(dependency, &entries))
        .collect();
    Ok(Member {
        name: package.name.clone(),
        manifest: manifest.to_string_lossy().replace('\\', "/"),
        imports,
    })
}

/// An import that the manifest's text does not show counts as one that does not inherit: better a false alarm.
fn import(dependency: &Dependency, entries: &[Entry]) -> Import {
    let kind = match dependency.kind.as_deref() {
        Some("dev") => Kind::Dev,
        Some("build") => Kind::Build,
        _ => Kind::Normal,
    };
    let key = dependency.rename.as_ref().unwrap_or(&dependency.name);
    let entry = entries.iter().find(|entry| entry.key == *key && entry.kind == kind);
    Import {
        name: dependency.name.clone(),
        kind,
        line: entry.map_or(1, |entry| entry.line),
        inherits: entry.is_some_and(|entry| entry.inherits),
    }
}

fn third_party(metadata: &Metadata) -> BTreeMap<String, Vec<String>> {
    let names: BTreeMap<_, _> = metadata
        .packages
        .iter()
        .map(|package| (package.id.as_str(), package.name.as_str()))
        .collect();
    let mut edges: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for node in metadata.nodes() {
        if metadata.workspace_members.contains(&node.id) {
            continue;
        }
        let is_dev = |kind: &Option<String>| kind.as_deref() == Some("dev");
        let built_from = node
            .deps
            .iter()
            .filter(|dep| dep.dep_kinds.is_empty() || dep.dep_kinds.iter().any(|info| !is_dev(&info.kind)));
        let below = built_from
            .filter_map(|dep| names.get(dep.pkg.as_str()))
            .map(|name| (*name).to_owned());
        edges
            .entry(names.get(node.id.as_str()).copied().unwrap_or_default().to_owned())
            .or_default()
            .extend(below);
    }
    edges
        .into_iter()
        .map(|(name, below)| (name, below.into_iter().collect()))
        .collect()
}

/// A small graph for tests: members with their imports, and third-party crates with theirs.
#[cfg(test)]
pub(super) fn fixture(members: &[(&str, &[(&str, Kind)])], third_party: &[(&str, &[&str])]) -> Graph {
    let import = |(name, kind): &(&str, Kind)| Import {
        name: (*name).into(),
        kind: *kind,
        line: 1,
        inherits: true,
    };
    let member = |(name, imports): &(&str, &[(&str, Kind)])| Member {
        name: (*name).into(),
        manifest: format!("{name}/Cargo.toml"),
        imports: imports.iter().map(import).collect(),
    };
    let below = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    Graph {
        members: members.iter().map(member).collect(),
        third_party: third_party
            .iter()
            .map(|(name, names)| ((*name).to_owned(), below(names)))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The real workspace, so that a change in what Cargo reports is noticed.
    #[test]
    fn cargos_own_report_is_understood() {
        let graph = read().unwrap();
        let xtask = graph.members.iter().find(|member| member.name == "xtask").unwrap();
        assert_eq!(xtask.manifest, "xtask/Cargo.toml");
        let import = xtask.imports.iter().find(|import| import.name == "serde_json").unwrap();
        assert!(import.inherits && import.line > 1 && import.kind == Kind::Normal);
        let below = &graph.third_party["serde_json"];
        assert!(below.iter().any(|name| name == "serde_core"), "{below:?}");
        assert!(!graph.third_party.contains_key("xtask"));
    }
}
