//! The stage `protocol` and `cargo xtask protocol`: `unity/src/protocol.rs` against the `.proto` files. It is committed
//! because its generator, `unity/proto/generate`, takes longer to build than the crate.

use std::fs;
use std::path::Path;

use crate::process::{Result, Workspace, about, run};
use crate::stage::Outcome;

const COMMITTED: &str = "unity/src/protocol.rs";

/// What the generated text is put behind.
const OPENING: &str = "//! The messages of the ML-Agents protocol and its one call: written by `cargo xtask protocol` from the files in \
                       `unity/proto/`.\n#![allow(clippy::all, clippy::pedantic, clippy::allow_attributes, missing_docs, reason = \"generated\")]\n\n";

/// What stands before the two marks in the file's second line.
const MARKED: &str = "// Marks of the sources and of what follows: ";

/// Fails when the `.proto` files, or the file itself, changed since it was written. Nothing is generated for that.
pub(crate) fn check(workspace: &Workspace) -> Result<Outcome> {
    let path = workspace.root.join(COMMITTED);
    let committed = fs::read_to_string(&path).map_err(about(&path))?;
    if is_fresh(&sources(workspace)?, &committed) {
        return Ok(Outcome::Passed(String::new()));
    }
    Err(format!(
        "{COMMITTED}: found other text than unity/proto/*.proto makes; write it anew: cargo xtask protocol"
    ))
}

/// Writes the file anew.
pub(crate) fn rewrite(workspace: &Workspace) -> Result {
    let path = workspace.root.join(COMMITTED);
    let text = marked(&sources(workspace)?, &generate(workspace)?);
    fs::write(&path, text).map_err(about(&path))?;
    println!("wrote {COMMITTED}");
    Ok(())
}

/// The `.proto` files one after the other, in the order of their names.
fn sources(workspace: &Workspace) -> Result<String> {
    let folder = workspace.root.join("unity/proto");
    let entries = fs::read_dir(&folder).map_err(about(&folder))?;
    let mut paths: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "proto"));
    paths.sort();
    paths
        .iter()
        .map(|path| fs::read_to_string(path).map_err(about(path)))
        .collect()
}

/// The text with the marks in its second line.
fn marked(sources: &str, text: &str) -> String {
    let (opening, rest) = text.split_once('\n').unwrap_or((text, ""));
    format!("{opening}\n{MARKED}{:016x} {:016x}\n{rest}", mark(sources), mark(rest))
}

fn is_fresh(sources: &str, committed: &str) -> bool {
    let lines: Vec<&str> = committed.splitn(3, '\n').collect();
    matches!(lines[..], [opening, _, rest] if committed == marked(sources, &format!("{opening}\n{rest}")))
}

/// FNV-1a, which tells edits apart; no more is asked of it.
fn mark(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The file's text, formatted.
fn generate(workspace: &Workspace) -> Result<String> {
    let folder = workspace.target.join("protocol");
    fs::create_dir_all(&folder).map_err(about(&folder))?;
    let mut generator = workspace.cargo(&["run", "--quiet", "--manifest-path", "unity/proto/generate/Cargo.toml"]);
    generator
        .arg("--target-dir")
        .arg(&folder)
        .args(["--", "unity/proto"])
        .arg(&folder);
    run(generator)?;
    let written = folder.join("communicator_objects.rs");
    let text = fs::read_to_string(&written).map_err(about(&written))?;
    let formatted = folder.join("protocol.rs");
    fs::write(&formatted, format!("{OPENING}{text}")).map_err(about(&formatted))?;
    let mut rustfmt = workspace.program(Path::new("rustfmt"), &["--edition", "2024", "--config-path", "."]);
    rustfmt.arg(&formatted);
    run(rustfmt)?;
    fs::read_to_string(&formatted).map_err(about(&formatted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_edit_of_either_side_is_noticed() {
        let committed = marked("message A {}", "//! Opening.\nstruct A;\n");
        assert!(is_fresh("message A {}", &committed));
        assert!(!is_fresh("message B {}", &committed));
        assert!(!is_fresh("message A {}", &committed.replace("struct A", "struct B")));
        assert!(!is_fresh("message A {}", "//! Opening.\nstruct A;\n"));
        assert!(!is_fresh("message A {}", ""));
    }
}
