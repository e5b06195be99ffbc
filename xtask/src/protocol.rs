//! The `protocol` stage and `cargo xtask protocol`: `unity/src/protocol.rs` against the `.proto` files. It is kept in the tree because
//! what makes it takes longer to build than the crate; that is the business of `unity/proto/generate`, a project of its own.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{cargo, run};
use crate::workspace::Workspace;

const COMMITTED: &str = "unity/src/protocol.rs";

/// What the generated text is put behind.
const OPENING: &str = "//! The messages of the ML-Agents protocol and its one call: written by `cargo xtask protocol` from the files in \
                       `unity/proto/`.\n#![allow(clippy::all, clippy::pedantic, clippy::allow_attributes, missing_docs, reason = \"generated\")]\n\n";

/// What stands before the two marks in the file's second line.
const MARKED: &str = "// Marks of the sources and of what follows: ";

/// Fails when the `.proto` files, or the file itself, are others than when it was written. Nothing is generated for that: it would take
/// longer than the rest of the stages.
pub(crate) fn check(workspace: &Workspace) -> Result<(), XtaskError> {
    let path = workspace.root.join(COMMITTED);
    let committed = fs::read_to_string(&path).map_err(|source| XtaskError::File { path, source })?;
    if is_fresh(&sources(workspace)?, &committed) {
        return Ok(());
    }
    Err(XtaskError::Stale {
        path: COMMITTED,
        made_from: "unity/proto/*.proto",
        command: "cargo xtask protocol",
    })
}

/// Writes the file anew.
pub(crate) fn rewrite(workspace: &Workspace) -> Result<(), XtaskError> {
    let path = workspace.root.join(COMMITTED);
    let text = marked(&sources(workspace)?, &generate(workspace)?);
    fs::write(&path, text).map_err(|source| XtaskError::File { path, source })?;
    println!("wrote {COMMITTED}");
    Ok(())
}

/// The `.proto` files one after the other, in the order of their names.
fn sources(workspace: &Workspace) -> Result<String, XtaskError> {
    let folder = workspace.root.join("unity/proto");
    let failed = |source| XtaskError::File {
        path: folder.clone(),
        source,
    };
    let entries = fs::read_dir(&folder).map_err(failed)?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "proto"));
    paths.sort();
    paths
        .iter()
        .map(|path| fs::read_to_string(path).map_err(failed))
        .collect()
}

/// The text with the marks in its second line.
fn marked(sources: &str, text: &str) -> String {
    let (opening, rest) = text.split_once('\n').unwrap_or((text, ""));
    format!("{opening}\n{MARKED}{:016x} {:016x}\n{rest}", mark(sources), mark(rest))
}

fn is_fresh(sources: &str, committed: &str) -> bool {
    let mut lines = committed.splitn(3, '\n');
    let (opening, marks, rest) = (lines.next(), lines.next(), lines.next());
    let (Some(opening), Some(_), Some(rest)) = (opening, marks, rest) else {
        return false;
    };
    committed == marked(sources, &format!("{opening}\n{rest}"))
}

/// FNV-1a: tells edits apart, no more is asked of it.
fn mark(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The file's text, formatted.
fn generate(workspace: &Workspace) -> Result<String, XtaskError> {
    let folder = workspace.target.join("protocol");
    let failed = |path: &PathBuf| {
        let path = path.clone();
        move |source| XtaskError::File { path, source }
    };
    fs::create_dir_all(&folder).map_err(failed(&folder))?;
    let mut generator = cargo(
        workspace,
        &["run", "--quiet", "--manifest-path", "unity/proto/generate/Cargo.toml"],
    );
    generator
        .arg("--target-dir")
        .arg(&folder)
        .args(["--", "unity/proto"])
        .arg(&folder);
    run(generator)?;
    let written = folder.join("communicator_objects.rs");
    let text = fs::read_to_string(&written).map_err(failed(&written))?;
    let formatted = folder.join("protocol.rs");
    fs::write(&formatted, format!("{OPENING}{text}")).map_err(failed(&formatted))?;
    let mut rustfmt = Command::new("rustfmt");
    rustfmt
        .args(["--edition", "2024", "--config-path"])
        .arg(&workspace.root)
        .arg(&formatted);
    run(rustfmt)?;
    fs::read_to_string(&formatted).map_err(failed(&formatted))
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
