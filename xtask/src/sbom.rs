//! What is in a program that is handed out: a bill of materials in CycloneDX 1.5. What is handed out, and where it is
//! written, is `dist.rs`'s.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::{Value, json};

use crate::error::XtaskError;
use crate::lock::{Locked, locked};
use crate::metadata::{Metadata, Package};
use crate::process::{cargo, quiet_output};
use crate::virtual_environment::VirtualEnvironment;
use crate::workspace::Workspace;

/// Judges a bill by CycloneDX's own schema; the package comes with it.
const JUDGE: &str = "\
import sys
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
error = JsonStrictValidator(SchemaVersion.V1_5).validate_str(open(sys.argv[1], encoding='utf-8').read())
sys.exit(f'{sys.argv[1]}: {error}' if error else 0)
";

/// A program, and what it is built with.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Product<'a> {
    pub(crate) package: &'a str,
    /// Arguments of Cargo that say which features are on.
    pub(crate) features: &'a [&'a str],
    pub(crate) target: &'a str,
}

impl Product<'_> {
    /// Its bill: every crate that it is built from, with version, licence, checksum, and what each is built from. Those
    /// that only build it, macros among them, have the scope `excluded`. `sha256` is that of the file.
    pub(crate) fn bill(self, workspace: &Workspace, sha256: &str) -> Result<Value, XtaskError> {
        let features = ["--all-features", "--locked", "--filter-platform", self.target];
        let metadata = Metadata::read(&features)?;
        let linked = self.crates(workspace, "normal,no-proc-macro")?;
        let built = self.crates(workspace, "normal,build")?;
        let materials = Materials {
            root: self.package,
            sha256,
            linked: &linked,
            built: &built,
            locked: &locked(workspace)?,
        };
        Ok(materials.bill(&metadata))
    }

    /// Names and versions, as Cargo resolves them for this product alone.
    fn crates(self, workspace: &Workspace, edges: &str) -> Result<BTreeSet<String>, XtaskError> {
        let mut tree = cargo(workspace, &["tree", "--locked", "--package", self.package]);
        tree.args(self.features).args([
            "--edges",
            edges,
            "--target",
            self.target,
            "--prefix",
            "none",
            "--format",
            "{p}",
        ]);
        let text = quiet_output(tree)?;
        let name = |line: &str| {
            let mut words = line.split_whitespace();
            let (name, version) = (words.next()?, words.next()?);
            Some(format!("{name} {}", version.trim_start_matches('v')))
        };
        Ok(text.lines().filter_map(name).collect())
    }
}

/// Fails where a file is no bill by CycloneDX's schema.
pub(crate) fn judge(tools: &VirtualEnvironment, path: &Path) -> Result<(), XtaskError> {
    let mut judge = tools.python(&["-c", JUDGE]);
    judge.arg(path);
    quiet_output(judge).map(drop)
}

/// What a bill is made from.
struct Materials<'a> {
    root: &'a str,
    sha256: &'a str,
    /// Crates whose code is in the program, by name and version.
    linked: &'a BTreeSet<String>,
    /// These and the crates that only build it.
    built: &'a BTreeSet<String>,
    locked: &'a [Locked],
}

impl Materials<'_> {
    fn bill(&self, metadata: &Metadata) -> Value {
        let packages: BTreeMap<&str, &Package> = metadata
            .packages
            .iter()
            .filter(|package| self.built.contains(&called(package)))
            .map(|package| (package.id.as_str(), package))
            .collect();
        let mut components: Vec<&Package> = packages.values().copied().collect();
        components.sort_by_key(|package| (&package.name, &package.version));
        let root = components.iter().position(|package| package.name == self.root);
        let root = root.map(|index| components.remove(index));
        let edges = metadata.nodes().filter_map(|node| {
            let from = packages.get(node.id.as_str())?;
            let is_built = |edge: &&crate::metadata::Edge| {
                let kinds = &edge.dep_kinds;
                kinds.iter().any(|kind| kind.kind.as_deref() != Some("dev"))
            };
            let to = node.deps.iter().filter(is_built);
            let to: BTreeSet<String> = to
                .filter_map(|edge| packages.get(edge.pkg.as_str()))
                .map(|package| address(package))
                .collect();
            Some((address(from), to))
        });
        let edges: BTreeMap<String, BTreeSet<String>> = edges.collect();
        let dependencies: Vec<Value> = edges
            .into_iter()
            .map(|(from, to)| json!({ "ref": from, "dependsOn": to }))
            .collect();
        let mut program = root.map_or_else(|| json!({ "name": self.root }), |root| self.component(root));
        program["type"] = "application".into();
        program["hashes"] = json!([{ "alg": "SHA-256", "content": self.sha256 }]);
        if let Some(program) = program.as_object_mut() {
            program.remove("scope");
        }
        json!({
            "$schema": "http://cyclonedx.org/schema/bom-1.5.schema.json",
            "bomFormat": "CycloneDX",
            "specVersion": "1.5",
            "version": 1,
            "metadata": {
                "tools": { "components": [{ "type": "application", "name": "xtask", "version": env!("CARGO_PKG_VERSION") }] },
                "component": program,
            },
            "components": components.into_iter().map(|package| self.component(package)).collect::<Vec<_>>(),
            "dependencies": dependencies,
        })
    }

    fn component(&self, package: &Package) -> Value {
        let scope = if self.linked.contains(&called(package)) {
            "required"
        } else {
            "excluded"
        };
        let mut component = json!({
            "type": "library",
            "bom-ref": address(package),
            "name": package.name,
            "version": package.version,
            "scope": scope,
            "purl": address(package),
        });
        if let Some(license) = &package.license {
            // As crates wrote it before SPDX had expressions.
            let expression = license.replace('/', " OR ");
            component["licenses"] = json!([{ "expression": expression }]);
        }
        let locked = self
            .locked
            .iter()
            .find(|locked| (&locked.name, &locked.version) == (&package.name, &package.version));
        if let Some(checksum) = locked.and_then(|locked| locked.checksum.as_ref()) {
            component["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
        }
        component
    }
}

fn called(package: &Package) -> String {
    format!("{} {}", package.name, package.version)
}

/// Its package URL.
fn address(package: &Package) -> String {
    format!("pkg:cargo/{}@{}", package.name, package.version.replace('+', "%2B"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bill_has_what_is_linked_and_what_builds_it_and_nothing_else() {
        let package = |name: &str, license: &str| json!({ "id": name, "name": name, "version": "1.0.0", "license": license, "manifest_path": "", "dependencies": [], "targets": [] });
        let edge = |name: &str, kind: Option<&str>| json!({ "pkg": name, "dep_kinds": [{ "kind": kind }] });
        let metadata = json!({
            "packages": [package("program", "MIT"), package("linked", "MIT/Apache-2.0"), package("builder", "MIT"), package("tested", "MIT")],
            "workspace_members": ["program"], "workspace_root": "", "target_directory": "",
            "resolve": { "nodes": [
                { "id": "program", "deps": [edge("linked", None), edge("builder", Some("build")), edge("tested", Some("dev"))] },
                { "id": "linked", "deps": [] }, { "id": "builder", "deps": [] }, { "id": "tested", "deps": [] },
            ] },
        });
        let metadata: Metadata = serde_json::from_value(metadata).expect("as Cargo writes it");
        let set = |names: &[&str]| {
            names
                .iter()
                .map(|name| format!("{name} 1.0.0"))
                .collect::<BTreeSet<_>>()
        };
        let locked = [Locked {
            name: "linked".into(),
            version: "1.0.0".into(),
            checksum: Some("ab".into()),
        }];
        let materials = Materials {
            root: "program",
            sha256: "cd",
            linked: &set(&["program", "linked"]),
            built: &set(&["program", "linked", "builder"]),
            locked: &locked,
        };
        let bill = materials.bill(&metadata);
        assert_eq!(bill["metadata"]["component"]["hashes"][0]["content"], "cd");
        let told = |index: usize, key: &str| bill["components"][index][key].clone();
        assert_eq!(
            (told(0, "name"), told(0, "scope")),
            ("builder".into(), "excluded".into())
        );
        assert_eq!(
            (told(1, "name"), told(1, "scope")),
            ("linked".into(), "required".into())
        );
        assert_eq!(told(1, "licenses"), json!([{ "expression": "MIT OR Apache-2.0" }]));
        assert_eq!(told(1, "hashes"), json!([{ "alg": "SHA-256", "content": "ab" }]));
        assert_eq!(told(2, "name"), Value::Null);
        let of_program = &bill["dependencies"][2];
        assert_eq!(
            (&of_program["ref"], &of_program["dependsOn"]),
            (
                &json!("pkg:cargo/program@1.0.0"),
                &json!(["pkg:cargo/builder@1.0.0", "pkg:cargo/linked@1.0.0"])
            )
        );
    }
    #[test]
    fn every_crate_that_cargo_links_is_in_the_bill_of_the_real_program() {
        let workspace = Workspace::load().expect("xtask stands in its workspace");
        for (package, features) in [("driftworld", &["--features", "full"][..]), ("driftworld-unity", &[])] {
            let product = Product {
                package,
                features,
                target: "x86_64-unknown-linux-gnu",
            };
            let bill = product
                .bill(&workspace, &"0".repeat(64))
                .expect("Cargo knows the program");
            let components = bill["components"].as_array().expect("a list");
            let with_scope = |scope: &str| {
                let components = components.iter().filter(|component| component["scope"] == scope);
                let called = components.map(|it| format!("{} {}", it["name"], it["version"]).replace('"', ""));
                called.collect::<BTreeSet<_>>()
            };
            let mut linked = product
                .crates(&workspace, "normal,no-proc-macro")
                .expect("Cargo has a tree");
            linked.retain(|name| !name.starts_with(&format!("{package} ")));
            assert!(linked.len() > 20, "{linked:?}");
            assert_eq!(with_scope("required"), linked);
            assert!(with_scope("excluded").iter().any(|name| name.starts_with("syn ")));
            assert!(components.iter().all(|component| component["licenses"].is_array()));
            let known: BTreeSet<&str> = components.iter().filter_map(|it| it["bom-ref"].as_str()).collect();
            let dependencies = bill["dependencies"].as_array().expect("a list");
            let to = dependencies
                .iter()
                .flat_map(|it| it["dependsOn"].as_array().expect("a list"));
            assert!(to.filter_map(Value::as_str).all(|to| known.contains(to)));
        }
    }
}
