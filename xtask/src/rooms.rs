//! Checks which of our crates import which others, and that versions of dependencies are in the root manifest. `[bans]` in
//! `deny.toml` restricts third-party crates.

use serde_json::Value;

/// Each of our crates with those that it may import, directly or indirectly; all without the prefix `driftworld-`.
const ROOMS: [(&str, &str); 18] = [
    ("features", ""),
    ("text", ""),
    ("atomic-files", ""),
    ("files", "text"),
    ("schema-errors", "features"),
    ("spec", "features text schema-errors"),
    ("generator", "features text schema-errors spec"),
    ("similarity", "features text schema-errors spec"),
    ("env", "features text schema-errors spec"),
    ("metrics", "text atomic-files files"),
    (
        "curriculum",
        "features text atomic-files files schema-errors spec generator similarity env metrics",
    ),
    (
        "report",
        "features text atomic-files files schema-errors spec similarity metrics",
    ),
    (
        "driftworld",
        "features text atomic-files files schema-errors spec generator similarity env metrics curriculum report",
    ),
    (
        "python",
        "features text atomic-files files schema-errors spec generator similarity env metrics curriculum report driftworld",
    ),
    (
        "wasm",
        "features text atomic-files files schema-errors spec generator similarity env metrics curriculum report driftworld",
    ),
    ("unity", "features text atomic-files files schema-errors spec env"),
    (
        "fuzz",
        "features text atomic-files files schema-errors spec generator similarity env metrics curriculum unity",
    ),
    ("xtask", "features"),
];

/// Imports that the table does not allow, from `cargo metadata`.
pub(crate) fn check(metadata: &Value) -> Vec<String> {
    let of = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let name = |package: &Value| {
        package["name"]
            .as_str()
            .unwrap_or_default()
            .replacen("driftworld-", "", 1)
    };
    let packages = of(&metadata["packages"]);
    let ours: Vec<String> = packages.iter().map(name).collect();
    let mut findings = Vec::new();
    for package in &packages {
        let from = name(package);
        let Some((_, allowed)) = ROOMS.iter().find(|(room, _)| *room == from) else {
            findings.push(format!(
                "found the crate `{from}`, expected a line for it in xtask/src/rooms.rs"
            ));
            continue;
        };
        let imported = of(&package["dependencies"]).iter().map(name).collect::<Vec<_>>();
        let forbidden = imported
            .iter()
            .filter(|to| ours.contains(to) && allowed.split(' ').all(|room| room != *to));
        findings.extend(forbidden.map(|to| {
            format!("{from}/Cargo.toml: found an import of `{to}`, expected only {allowed}; move shared code to these, or pass it in")
        }));
    }
    findings
}

/// Dependencies of a manifest that have their own version or path. Only `features/` may have these: it names third-party
/// crates that none of our crates imports.
pub(crate) fn versions(path: &str, manifest: &str) -> Vec<String> {
    let mut is_dependency = false;
    let mut findings = Vec::new();
    for (number, line) in (1..).zip(manifest.lines()) {
        if line.starts_with('[') {
            is_dependency = line.ends_with("dependencies]") && line != "[workspace.dependencies]";
        } else if is_dependency && line.contains('=') && !line.starts_with('#') && !inherits(line) {
            findings.push(format!(
                "{path}:{number}: found `{line}`, expected `workspace = true`, and the version in the root Cargo.toml"
            ));
        }
    }
    findings.retain(|_| path != "features/Cargo.toml");
    findings
}

fn inherits(line: &str) -> bool {
    line.contains(".workspace = true") || line.contains("{ workspace = true")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn indirect_imports_are_allowed() {
        let allowed = |name: &str| {
            ROOMS
                .iter()
                .find(|(room, _)| *room == name)
                .map(|(_, allowed)| allowed.split_whitespace())
        };
        for (room, _) in ROOMS {
            for below in allowed(room).unwrap() {
                for further in allowed(below).unwrap_or_else(|| panic!("{below} has no line")) {
                    assert!(
                        allowed(room).unwrap().any(|name| name == further),
                        "{room} → {below} → {further}"
                    );
                }
            }
        }
    }

    #[test]
    fn forbidden_imports_are_found() {
        let package = |name: &str, imports: &[&str]| {
            let dependencies: Vec<_> = imports.iter().map(|name| json!({ "name": name })).collect();
            json!({ "name": name, "dependencies": dependencies })
        };
        let check_all = |packages: &[Value], expected: &[&str]| {
            let found = check(&json!({ "packages": packages }));
            assert_eq!(found.len(), expected.len(), "{found:?}");
            assert!(
                found.iter().zip(expected).all(|(found, part)| found.contains(part)),
                "{found:?}"
            );
        };
        let spec = package("driftworld-spec", &["serde", "driftworld-text"]);
        let generator = package("driftworld-generator", &["driftworld-spec"]);
        let text = package("driftworld-text", &[]);
        check_all(&[spec.clone(), generator, text], &[]);
        let similarity = package("driftworld-similarity", &["driftworld-generator"]);
        let generator = package("driftworld-generator", &[]);
        check_all(
            &[similarity, generator],
            &["similarity/Cargo.toml: found an import of `generator`"],
        );
        check_all(&[package("driftworld-sound", &[])], &["the crate `sound`"]);
    }

    #[test]
    fn versions_are_in_the_root() {
        let manifest = "[package]\nname = \"a\"\n[dependencies]\n# Why.\na.workspace = true\nb = { workspace = true, optional = true }\n\
                        c = \"1\"\n[target.'cfg(unix)'.dev-dependencies]\nd = { path = \"../d\" }\n[workspace.dependencies]\ne = \"1\"\n";
        let found = versions("spec/Cargo.toml", manifest);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("spec/Cargo.toml:7: ") && found[1].starts_with("spec/Cargo.toml:9: "));
        assert_eq!(versions("features/Cargo.toml", manifest), [""; 0]);
    }
}
