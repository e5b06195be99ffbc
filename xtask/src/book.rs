//! The book, second half of the stage `docs`: builds the project in `book/`, which makes HTML of `docs/` and checks every
//! link of it. It has a build folder of its own, for it asks other features of the crates that it shares with us.

use std::path::PathBuf;
use std::process::Command;

use crate::error::XtaskError;
use crate::process::{cargo, run};
use crate::virtual_environment::interpreter;
use crate::workspace::Workspace;

/// Compares the pages of the Python API and the recording with their sources, where there is a Python; then formats, tests and runs the
/// builder. Returns where the book is.
pub(crate) fn build(workspace: &Workspace) -> Result<String, XtaskError> {
    let builder = |arguments: &[&str]| {
        let mut command = cargo(workspace, arguments);
        command.env("CARGO_TARGET_DIR", workspace.target.join("book-builder"));
        command
    };
    if let Some(python) = interpreter() {
        for program in ["python/api_pages.py", "book/record.py"] {
            let mut check = Command::new(&python);
            check.args([program, "--check"]).current_dir(&workspace.root);
            run(check)?;
        }
    }
    let manifest = ["--manifest-path", "book/Cargo.toml"];
    let locked = [&manifest[..], &["--quiet", "--locked"]].concat();
    run(builder(&[&["fmt", "--check"], &manifest[..]].concat()))?;
    run(builder(&[&["test"], &locked[..]].concat()))?;
    let mut make = builder(&[&["run"], &locked[..], &["--", "."]].concat());
    let book = folder(workspace);
    make.arg(&book);
    run(make)?;
    Ok(format!("the book is {}", book.join("index.html").display()))
}

/// Where the finished book is.
fn folder(workspace: &Workspace) -> PathBuf {
    workspace.target.join("book")
}
