//! The library in `shim.c`, built by the machine's own C compiler: a small disk and a clock that jumps, for one
//! process.

use std::path::PathBuf;
use std::process::Command;

use super::subject::Subject;
use crate::process::{output, works};
use crate::workspace::Workspace;

/// Builds it; else why there is none.
pub(super) fn built(workspace: &Workspace, subject: &Subject) -> Result<PathBuf, &'static str> {
    if !cfg!(target_os = "linux") {
        return Err("LD_PRELOAD is Linux's");
    }
    let library = subject.folder.join("shim.so");
    let mut cc = Command::new("cc");
    cc.args(["-shared", "-fPIC", "-O1", "-o"])
        .arg(&library)
        .arg(workspace.root.join("xtask/src/chaos/shim.c"))
        .arg("-ldl");
    output(cc).map_err(|_| "no C compiler under the name cc")?;
    // As good as there is: a program that is linked statically passes by it.
    let mut full = Command::new("sh");
    full.args(["-c", "echo x > probe"])
        .current_dir(&subject.folder)
        .env("LD_PRELOAD", &library)
        .env("CHAOS_DISK", "0");
    if works(full) {
        return Err("the shim is not loaded here");
    }
    Ok(library)
}
