//! The rule about versions: every dependency of a member says `workspace = true`, so that its version and features
//! live in the root's `[workspace.dependencies]` only. Reads manifest text just far enough to know; Cargo has already
//! checked that it is well formed.

use super::graph::{Graph, Import, Kind};
use super::table::FEATURES;
use crate::finding::Finding;

/// A dependency as its manifest writes it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Entry {
    pub(super) key: String,
    pub(super) kind: Kind,
    pub(super) line: usize,
    pub(super) inherits: bool,
}

/// Every import that brings its own version or path.
pub(super) fn check(graph: &Graph) -> Vec<Finding> {
    let all = graph
        .members
        .iter()
        .filter(|member| member.name != FEATURES)
        .flat_map(|member| member.imports.iter().map(move |import| (member, import)));
    let finding = |manifest: &str, import: &Import| {
        let found = format!("`{}` with a version or path of its own", import.name);
        let advice = format!(
            "write `{}.workspace = true`, and the version in the root Cargo.toml",
            import.name
        );
        Finding::new(manifest, import.line, found, "`workspace = true`", advice)
    };
    all.filter(|(_, import)| !import.inherits)
        .map(|(member, import)| finding(&member.manifest, import))
        .collect()
}

/// The dependencies of a manifest, `[workspace.dependencies]` left out.
pub(super) fn entries(manifest: &str) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    let mut section = Section::Other;
    for (index, line) in manifest.lines().enumerate() {
        let line_number = index + 1;
        let dense: String = line.chars().filter(|letter| !letter.is_whitespace()).collect();
        if dense.starts_with('[') {
            section = Section::from_header(&dense);
            if let Section::One(key, kind) = &section {
                entries.push(Entry {
                    key: key.clone(),
                    kind: *kind,
                    line: line_number,
                    inherits: false,
                });
            }
            continue;
        }
        match (&section, dense.split_once('=')) {
            (Section::Table(kind), Some((key, value))) => entries.push(entry(key, value, *kind, line_number)),
            (Section::One(..), Some(("workspace", value))) if value.starts_with("true") => {
                entries
                    .iter_mut()
                    .last()
                    .into_iter()
                    .for_each(|entry| entry.inherits = true);
            }
            _ => {}
        }
    }
    entries
}

/// `name.workspace = true` or `name = { workspace = true, … }`.
fn entry(key: &str, value: &str, kind: Kind, line: usize) -> Entry {
    let (name, dotted) = key
        .split_once('.')
        .map_or((key, None), |(name, rest)| (name, Some(rest)));
    let inherits = match dotted {
        Some(rest) => rest == "workspace" && value.starts_with("true"),
        None => value.split(['{', ',', '}']).any(|field| field == "workspace=true"),
    };
    Entry {
        key: name.trim_matches('"').to_owned(),
        kind,
        line,
        inherits,
    }
}

/// What the lines under a `[header]` are.
enum Section {
    /// One dependency per line.
    Table(Kind),
    /// One dependency, one of its fields per line.
    One(String, Kind),
    Other,
}

impl Section {
    fn from_header(header: &str) -> Self {
        let path = header.trim_start_matches('[').split(']').next().unwrap_or_default();
        if path.starts_with("workspace.") {
            return Self::Other;
        }
        let (before, last) = path.rsplit_once('.').unwrap_or(("", path));
        let table_before = before.rsplit('.').next().and_then(kind_of);
        match (kind_of(last), table_before) {
            (Some(kind), _) => Self::Table(kind),
            (None, Some(kind)) => Self::One(last.trim_matches('"').to_owned(), kind),
            (None, None) => Self::Other,
        }
    }
}

fn kind_of(table: &str) -> Option<Kind> {
    match table {
        "dependencies" => Some(Kind::Normal),
        "dev-dependencies" => Some(Kind::Dev),
        "build-dependencies" => Some(Kind::Build),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::graph::fixture;
    use super::*;

    fn check_entries(manifest: &str, expected: &[(&str, Kind, usize, bool)]) {
        let found = entries(manifest);
        let found: Vec<_> = found
            .iter()
            .map(|entry| (&*entry.key, entry.kind, entry.line, entry.inherits))
            .collect();
        assert_eq!(found, expected, "{manifest}");
    }

    #[test]
    fn every_way_to_inherit_is_known() {
        let manifest = "[dependencies]\na.workspace = true\nb = { workspace = true, features = [\"x\"] }\n\
                        c = { features = [\"x\"], workspace = true }  # why\n[dev-dependencies.d]\nworkspace = true\n";
        let (normal, dev) = (Kind::Normal, Kind::Dev);
        check_entries(
            manifest,
            &[
                ("a", normal, 2, true),
                ("b", normal, 3, true),
                ("c", normal, 4, true),
                ("d", dev, 5, true),
            ],
        );
    }

    #[test]
    fn a_version_or_path_of_its_own_is_seen() {
        let manifest = "[dependencies]\na = \"1\"\nb = { version = \"1\" }\n[target.'cfg(unix)'.build-dependencies]\n\
                        c.path = \"../c\"\n[dependencies.d]\nversion = \"1\"\n";
        let normal = Kind::Normal;
        let expected = [
            ("a", normal, 2, false),
            ("b", normal, 3, false),
            ("c", Kind::Build, 5, false),
            ("d", normal, 6, false),
        ];
        check_entries(manifest, &expected);
    }

    #[test]
    fn other_tables_are_not_dependencies() {
        check_entries(
            "[workspace.dependencies]\na = \"1\"\n[package]\nname = \"x\"\n[lints]\nworkspace = true\n",
            &[],
        );
    }

    #[test]
    fn an_import_with_its_own_version_is_reported() {
        let mut graph = fixture(&[("driftworld-spec", &[("serde", Kind::Normal)])], &[]);
        assert_eq!(check(&graph), []);
        graph.members[0].imports[0].inherits = false;
        let findings = check(&graph);
        assert_eq!(findings.len(), 1);
        assert!(
            findings[0].advice.contains("`serde.workspace = true`"),
            "{}",
            findings[0]
        );
    }
}
